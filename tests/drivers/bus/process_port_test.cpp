// The watchdog's grip on real processes, also on those that do not want to end.
#include "drivers/bus/process_port.hpp"

#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/sensing/system_clock.hpp"
#include "drivers/microphone/microphone_sensor.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// Does a condition come true within some seconds?
template <class Condition>
bool comes_true(Condition&& condition) {
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  while (!condition() && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(2ms);
  return condition();
}

class ProcessPortTest : public testing::Test {
 protected:
  /// A program of this text, which leaves its number in the file "pid".
  std::string script(const std::string& text) {
    std::string path = folder_ / "script";
    std::ofstream(path) << "#!/bin/sh\necho $$ > " << (folder_ / "pid").string() << ".new\nmv "
                        << (folder_ / "pid").string() << ".new " << (folder_ / "pid").string() << "\n"
                        << text << "\n";
    chmod(path.c_str(), 0755);
    return path;
  }
  /// The number that the script left; 0 before.
  pid_t script_pid() const {
    pid_t pid = 0;
    std::ifstream(folder_ / "pid") >> pid;
    return pid;
  }
  /// Neither running nor waiting to be reaped by us.
  static bool is_gone(pid_t pid) {
    std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
    std::string number;
    std::string name;
    std::string state;
    return !(stat >> number >> name >> state);
  }
  /// Ended, though whoever has inherited it may not have noticed.
  static bool has_ended(pid_t pid) {
    std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
    std::string number;
    std::string name;
    std::string state;
    return !(stat >> number >> name >> state) || state == "Z" || state == "X";
  }

  static std::string read_all(BytePort& port) {
    std::string text;
    std::array<std::uint8_t, 64> buffer{};
    for (;;) {
      const ByteArrival arrival = port.read(buffer, 5s);
      if (arrival.status != ByteStatus::kBytes) return text;
      text.append(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(arrival.size));
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(ProcessPortTest, ReadsWhatAProgramSaysUntilItEnds) {
  const auto port = make_process_port({"/bin/sh", "-c", "echo one; echo two; cat; echo $0 three", "argument"});
  ASSERT_TRUE(port->open());
  EXPECT_EQ(read_all(*port), "one\ntwo\nargument three\n");
  std::array<std::uint8_t, 8> buffer{};
  EXPECT_EQ(port->read(buffer, 1s).status, ByteStatus::kLost);
  ASSERT_TRUE(port->open()) << "again";
  EXPECT_EQ(read_all(*port), "one\ntwo\nargument three\n");
}

TEST_F(ProcessPortTest, SaysWhyAProgramDoesNotStart) {
  const auto missing = make_process_port({"/nowhere/yuragi"});
  const auto opened = missing->open();
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, HasSubstr("/nowhere/yuragi (No such file"));
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "no zombie is left";
}

TEST_F(ProcessPortTest, WaitsNoLongerThanItShould) {
  const auto port = make_process_port({"/bin/sleep", "1000"});
  ASSERT_TRUE(port->open());
  std::array<std::uint8_t, 8> buffer{};
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_EQ(port->read(buffer, 50ms).status, ByteStatus::kSilence);
  EXPECT_GE(std::chrono::steady_clock::now() - begun, 50ms);
}

TEST_F(ProcessPortTest, KillsAProgramThatSpinsAndWillNotEnd) {
  const auto port = make_process_port({script("trap '' TERM INT HUP\nwhile :; do :; done")});
  ASSERT_TRUE(port->open());
  ASSERT_TRUE(comes_true([&] { return script_pid() > 0; }));
  const auto begun = std::chrono::steady_clock::now();
  port->close();
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 5s);
  EXPECT_TRUE(is_gone(script_pid()));
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "no zombie is left";
}

TEST_F(ProcessPortTest, LeavesNoProgramBehindWhenItIsDestroyed) {
  {
    const auto port = make_process_port({script("exec sleep 1000")});
    ASSERT_TRUE(port->open());
    ASSERT_TRUE(comes_true([&] { return script_pid() > 0; }));
  }
  EXPECT_TRUE(is_gone(script_pid()));
}

TEST_F(ProcessPortTest, TheProgramDiesWithItsParent) {
  const std::string path = script("exec sleep 1000");
  const pid_t parent = fork();
  ASSERT_GE(parent, 0);
  if (parent == 0) {
    const auto port = make_process_port({path});
    if (!port->open()) _exit(1);
    while (script_pid() == 0) std::this_thread::sleep_for(2ms);
    kill(getpid(), SIGKILL);  // nobody tidies up
  }
  int status = 0;
  waitpid(parent, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  const pid_t child = script_pid();
  ASSERT_GT(child, 0);
  EXPECT_TRUE(comes_true([&] { return has_ended(child); }));
}

TEST_F(ProcessPortTest, InterruptEndsAWaitFromAnotherThread) {
  const auto port = make_process_port({"/bin/sleep", "1000"});
  ASSERT_TRUE(port->open());
  std::atomic<bool> is_waiting = false;
  ByteStatus status = ByteStatus::kSilence;
  std::thread reader([&] {
    std::array<std::uint8_t, 8> buffer{};
    is_waiting = true;
    status = port->read(buffer, 100s).status;
  });
  comes_true([&] { return is_waiting.load(); });
  port->interrupt();
  reader.join();
  EXPECT_EQ(status, ByteStatus::kInterrupted);
  EXPECT_FALSE(port->open()) << "it is not started again";
}

/// A sensor whose worker is a script; impatient, so that the test is short.
class MicrophoneWatchdog : public ProcessPortTest {
 protected:
  std::string detail_after(const std::string& worker_text, std::size_t attempts = 2) {
    MicrophoneSettings settings;
    settings.start_timeout = 300ms;
    settings.sound_timeout = 300ms;
    MicrophoneSensor sensor(settings, 1, make_process_port({script(worker_text)}));
    MonoTime next{};
    comes_true([&] {
      if (clock_.now().mono >= next) next = sensor.poll(clock_, sink_);
      return !sink_.links.empty() && failures() >= attempts;
    });
    EXPECT_GE(failures(), attempts);
    return sink_.last_detail();
  }
  /// ReopeningSensor says the same thing once: attempts are counted by what the script leaves.
  std::size_t failures() const {
    std::ifstream in(folder_ / "attempts");
    return static_cast<std::size_t>(std::count(std::istreambuf_iterator<char>(in), {}, '\n'));
  }
  std::string count() const { return "echo >> " + (folder_ / "attempts").string() + "\n"; }

  SystemClock clock_;
  RecordingSink sink_;
};

TEST_F(MicrophoneWatchdog, BeginsAWorkerAgainThatSpins) {
  EXPECT_THAT(detail_after(count() + "while :; do :; done"), HasSubstr("has not begun within 0.3 s"));
  EXPECT_TRUE(comes_true([&] { return is_gone(script_pid()); }));
  EXPECT_TRUE(sink_.readings.empty());
}

TEST_F(MicrophoneWatchdog, BeginsAWorkerAgainThatCrashes) {
  EXPECT_THAT(detail_after(count() + "kill -SEGV $$"), HasSubstr("ended without a word"));
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "no zombie is left";
}

TEST_F(MicrophoneWatchdog, BeginsAWorkerAgainThatBabbles) {
  EXPECT_THAT(detail_after(count() + "yes YMIC | head -c 100000; exec sleep 1000"), HasSubstr("has not begun"));
  EXPECT_GT(sink_.count(Refusal::kMalformed), 0);
  EXPECT_TRUE(sink_.readings.empty());
}

}  // namespace
}  // namespace yuragi
