#include "daemon/alerts/shell_command.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::alerts {
namespace {

using namespace std::chrono_literals;

constexpr auto kForever = 10min;

std::string why_not(const std::string& command, Nanoseconds most = kForever) {
  const auto result = run_command({.alert = "roof", .command = command}, most, {});
  return result ? "none" : result.error().message;
}

TEST(ShellCommand, IsToldByItsEnvironment) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "told";
  // No shell takes this apart: it is data.
  const AlertNews news{.alert = "a $(touch x) \"b\"",
                       .has_begun = true,
                       .message = "sensor `roof`; is\nsilent",
                       .command =
                           "printf '%s|%s|%s' \"$YURAGI_ALERT\" \"$YURAGI_ALERT_STATE\" "
                           "\"$YURAGI_ALERT_MESSAGE\" > " +
                           file.string()};
  ASSERT_TRUE(run_command(news, kForever, {}).has_value());
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_EQ(text.str(), "a $(touch x) \"b\"|began|sensor `roof`; is\nsilent");
}

TEST(ShellCommand, SaysHowItFailed) {
  EXPECT_EQ(why_not("true"), "none");
  EXPECT_EQ(why_not("exit 3"), "has failed with exit code 3");
  EXPECT_EQ(why_not("kill -TERM $$"), "was killed by signal 15");
  EXPECT_EQ(why_not("/nowhere/program"), "has failed with exit code 127");
}

TEST(ShellCommand, IsKilledWhenItTakesTooLong) {
  EXPECT_EQ(why_not("sleep 1000 & sleep 1000", 10ms), "was killed, as it had not ended after 0 s");
}

TEST(ShellCommand, IsKilledWhenAStopIsRequested) {
  std::stop_source stop;
  std::thread other([&stop] { stop.request_stop(); });
  EXPECT_FALSE(run_command({.command = "sleep 1000"}, kForever, stop.get_token()).has_value());
  other.join();
}

TEST(ShellCommand, ReadsNothing) {
  EXPECT_EQ(why_not("! read line"), "none");
}

}  // namespace
}  // namespace yuragi::daemon::alerts
