// The watchdog's grip on real processes, also on those that do not want to end.
#include "drivers/bus/process_port.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "drivers/microphone/microphone_sensor.hpp"
#include "tests/support/descriptor.hpp"
#include "tests/support/live_sensor.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::bus {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr auto kHang = 60s;  // so long waits only who waits for something that hangs

class ProcessPortTest : public testing::Test {
 protected:
  /// A program of this text, which leaves its number in the file "pid" first.
  std::string script(const std::string& text) {
    std::string path = folder_ / "script";
    std::ofstream(path) << "#!/bin/sh\necho $$ > " << (folder_ / "pid").string() << "\n" << text << "\n";
    chmod(path.c_str(), 0755);
    return path;
  }
  /// The number that the script left.
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
  /// Waits for the program's first word.
  static bool says_something(BytePort& port) {
    std::array<std::uint8_t, 64> buffer{};
    return port.read(buffer, kHang).status == ByteStatus::kBytes;
  }

  static std::string read_all(BytePort& port) {
    std::string text;
    std::array<std::uint8_t, 64> buffer{};
    for (;;) {
      const ByteArrival arrival = port.read(buffer, kHang);
      if (arrival.status != ByteStatus::kBytes) return text;
      text.append(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(arrival.size));
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(ProcessPortTest, AProgramInheritsNothing) {
  std::array<int, 2> leaking{};
  ASSERT_EQ(pipe(leaking.data()), 0);
  const Descriptor first(leaking[0]);
  const Descriptor second(leaking[1]);
  // What the shell itself opened to list them is closed again.
  const auto port = make_process_port(
      {"/bin/sh", "-c", "for file in /proc/$$/fd/*; do if [ -e $file ]; then echo ${file##*/}; fi; done"});
  ASSERT_TRUE(port->open());
  EXPECT_EQ(read_all(*port), "0\n1\n2\n");
}

TEST_F(ProcessPortTest, ReadsWhatAProgramSaysUntilItEnds) {
  const auto port = make_process_port({"/bin/sh", "-c", "echo one; echo two; cat; echo $0 three", "argument"});
  ASSERT_TRUE(port->open());
  EXPECT_EQ(read_all(*port), "one\ntwo\nargument three\n");
  std::array<std::uint8_t, 8> buffer{};
  EXPECT_EQ(port->read(buffer, kHang).status, ByteStatus::kLost);
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
  const auto port = make_process_port({script("trap '' TERM INT HUP\necho here\nwhile :; do :; done")});
  ASSERT_TRUE(port->open());
  ASSERT_TRUE(says_something(*port));
  port->close();
  EXPECT_TRUE(is_gone(script_pid()));
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "no zombie is left";
}

TEST_F(ProcessPortTest, LeavesNoProgramBehindWhenItIsDestroyed) {
  {
    const auto port = make_process_port({script("echo here\nexec sleep 1000")});
    ASSERT_TRUE(port->open());
    ASSERT_TRUE(says_something(*port));
  }
  EXPECT_TRUE(is_gone(script_pid()));
}

TEST_F(ProcessPortTest, TheProgramDiesWithItsParent) {
  // The program holds the only other end of this pipe: it ends when the program does.
  const std::string alive = folder_ / "alive";
  ASSERT_EQ(mkfifo(alive.c_str(), 0600), 0);
  const std::string path = script("exec 3>" + alive + "\necho here\nexec sleep 1000");
  const Descriptor still_alive(open(alive.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  const pid_t parent = fork();
  ASSERT_GE(parent, 0);
  if (parent == 0) {
    const auto port = make_process_port({path});
    if (!port->open() || !says_something(*port)) _exit(1);
    kill(getpid(), SIGKILL);  // nobody tidies up
  }
  int status = 0;
  waitpid(parent, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  pollfd ended{still_alive.get(), 0, 0};
  EXPECT_EQ(poll(&ended, 1, 60'000), 1) << "the program lives on";
  EXPECT_NE(ended.revents & POLLHUP, 0);
}

TEST_F(ProcessPortTest, InterruptEndsAWaitFromAnotherThread) {
  const auto port = make_process_port({"/bin/sleep", "1000"});
  ASSERT_TRUE(port->open());
  std::atomic<bool> is_waiting = false;
  ByteStatus status = ByteStatus::kSilence;
  std::thread reader([&] {
    std::array<std::uint8_t, 8> buffer{};
    is_waiting = true;
    is_waiting.notify_one();
    status = port->read(buffer, kHang).status;
  });
  is_waiting.wait(false);
  port->interrupt();
  reader.join();
  EXPECT_EQ(status, ByteStatus::kInterrupted);
  EXPECT_FALSE(port->open()) << "it is not started again";
}

/// A sensor whose worker is a script; impatient, so that the test is short.
class MicrophoneWatchdog : public ProcessPortTest {
 protected:
  MicrophoneWatchdog() {
    if (mkfifo((folder_ / "attempts").c_str(), 0600) != 0) throw std::runtime_error("no pipe");
    attempts_ = Descriptor(open((folder_ / "attempts").c_str(), O_RDWR | O_CLOEXEC));
  }

  /// What the sensor says of a worker, when it has been started so often.
  std::string detail_after(const std::string& worker_text, int attempts = 3) {
    microphone::Settings settings;
    settings.start_timeout = 300ms;
    settings.sound_timeout = 300ms;
    test::LiveSensor sensor(
        std::make_unique<microphone::Sensor>(settings, 1, make_process_port({script(worker_text)})));
    for (int attempt = 0; attempt < attempts; ++attempt) {
      pollfd wait{attempts_.get(), POLLIN, 0};
      char newline = 0;
      EXPECT_EQ(poll(&wait, 1, 60'000), 1) << "it was not started again";
      EXPECT_EQ(read(attempts_.get(), &newline, 1), 1);
    }
    sensor.wait_until([&] { return !sensor.sink.links.empty(); });
    sink_ = std::move(sensor.sink);
    return sink_.last_detail();
  }
  /// A worker's first line: it is counted.
  std::string count() const { return "echo > " + (folder_ / "attempts").string() + "\n"; }

  RecordingSink sink_;

 private:
  Descriptor attempts_;
};

TEST_F(MicrophoneWatchdog, BeginsAWorkerAgainThatSpins) {
  EXPECT_THAT(detail_after(count() + "while :; do :; done"), HasSubstr("has not started within"));
  EXPECT_TRUE(is_gone(script_pid()));
  EXPECT_TRUE(sink_.readings.empty());
}

TEST_F(MicrophoneWatchdog, BeginsAWorkerAgainThatCrashes) {
  EXPECT_THAT(detail_after(count() + "kill -SEGV $$"), HasSubstr("ended without a message"));
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "no zombie is left";
}

TEST_F(MicrophoneWatchdog, BeginsAWorkerAgainThatBabbles) {
  EXPECT_THAT(detail_after(count() + "yes YMIC | head -c 100000; exec sleep 1000"), HasSubstr("has not started"));
  EXPECT_GT(sink_.count(decode::Refusal::kMalformed), 0);
  EXPECT_TRUE(sink_.readings.empty());
}

TEST_F(MicrophoneWatchdog, InterruptEndsItsWaitForTheWorker) {
  microphone::Settings settings;
  settings.start_timeout = 1h;
  test::LiveSensor sensor(
      std::make_unique<microphone::Sensor>(settings, 1, make_process_port({script("exec sleep 10000")})));
  sensor.end();  // hangs if it waits for the worker
  EXPECT_EQ(sensor.sink.count(decode::Refusal::kTimeout), 0);
}

}  // namespace
}  // namespace yuragi::drivers::bus
