#include "daemon/alerts/shell_command.hpp"

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/descriptor.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::alerts {
namespace {

using namespace std::chrono_literals;

constexpr auto kForever = 10min;
constexpr int kHang_ms = 60'000;  // so long waits only who waits for something that hangs

std::string why_not(const std::string& command, Nanoseconds most = kForever) {
  std::string output;
  const auto result = run_command({.alert = "roof", .command = command}, most, {}, output);
  return result ? "none" : result.error().message;
}

std::string output_of(const std::string& command) {
  std::string output;
  EXPECT_TRUE(run_command({.alert = "roof", .command = command}, kForever, {}, output).has_value());
  return output;
}

TEST(ShellCommand, IsToldByItsEnvironment) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "told";
  // No shell takes this apart: it is data.
  const News news{.alert = "a $(touch x) \"b\"",
                  .has_begun = true,
                  .message = "sensor `roof`; is\nsilent",
                  .command =
                      "printf '%s|%s|%s' \"$YURAGI_ALERT\" \"$YURAGI_ALERT_STATE\" "
                      "\"$YURAGI_ALERT_MESSAGE\" > " +
                      file.string()};
  std::string output;
  ASSERT_TRUE(run_command(news, kForever, {}, output).has_value());
  EXPECT_EQ(output, "");
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_EQ(text.str(), "a $(touch x) \"b\"|began|sensor `roof`; is\nsilent");
}

TEST(ShellCommand, SaysHowItFailed) {
  EXPECT_EQ(why_not("true"), "none");
  EXPECT_EQ(why_not("exit 3"), "has failed with exit code 3");
  EXPECT_EQ(why_not("kill -TERM $$"), "was killed by signal 15 (Terminated)");
  EXPECT_EQ(why_not("/nowhere/program"), "has failed with exit code 127");
}

TEST(ShellCommand, IsKilledWhenItTakesTooLong) {
  EXPECT_EQ(why_not("sleep 1000 & sleep 1000", 10ms), "was killed because it had not ended after 0 s");
}

/// Runs a command that holds a named pipe open for writing, as its background job does. True: nobody holds it any more.
bool ends_background_job(const std::string& command, Nanoseconds most) {
  const test::TemporaryFolder folder;
  const std::string pipe = (folder.path() / "alive").string();
  if (mkfifo(pipe.c_str(), S_IRUSR | S_IWUSR) != 0) return false;
  const Descriptor alive(open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  why_not("exec 9>" + pipe + "; sleep 1000 & " + command, most);
  char byte = 0;
  if (read(alive.get(), &byte, 1) == 0) return true;
  pollfd wait{.fd = alive.get(), .events = POLLIN, .revents = 0};
  return poll(&wait, 1, kHang_ms) == 1;
}

TEST(ShellCommand, WhatItHasStartedEndsWithIt) {
  EXPECT_TRUE(ends_background_job("wait", 300ms)) << "at its time-out";
  EXPECT_TRUE(ends_background_job("exit 0", kForever)) << "at its end";
}

TEST(ShellCommand, GivesTheFirst64KiBOfItsOutput) {
  EXPECT_EQ(output_of("echo one; echo two >&2"), "one\ntwo\n");
  EXPECT_EQ(output_of("head -c 1000000 /dev/zero | tr '\\0' x"), std::string(64UL * 1024, 'x'));
  EXPECT_EQ(why_not("yes", 100ms), "was killed because it had not ended after 0 s");
}

TEST(ShellCommand, InheritsNothing) {
  std::array<int, 2> leaking{};
  ASSERT_EQ(::pipe(leaking.data()), 0);
  const Descriptor first(leaking[0]);
  const Descriptor second(leaking[1]);
  // What the shell itself opened to list them is closed again.
  EXPECT_EQ(output_of("for file in /proc/$$/fd/*; do if [ -e $file ]; then echo ${file##*/}; fi; done"), "0\n1\n2\n");
}

TEST(ShellCommand, IsKilledWhenAStopIsRequested) {
  std::stop_source stop;
  std::thread other([&stop] { stop.request_stop(); });
  std::string output;
  EXPECT_FALSE(run_command({.command = "sleep 1000"}, kForever, stop.get_token(), output).has_value());
  other.join();
}

TEST(ShellCommand, ReadsNothing) {
  EXPECT_EQ(why_not("! read line"), "none");
}

}  // namespace
}  // namespace yuragi::daemon::alerts
