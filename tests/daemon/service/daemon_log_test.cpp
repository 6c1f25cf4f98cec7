#include "daemon/service/daemon_log.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "engine/base/contain.hpp"

namespace yuragi::daemon::service {
namespace {

/// A pipe as a stream to write to, whose reader reads only when it is told to.
class Pipe {
 public:
  Pipe() {
    EXPECT_EQ(pipe2(ends_.data(), O_CLOEXEC), 0);
    EXPECT_GT(fcntl(ends_[0], F_SETPIPE_SZ, 16384), 0);
    stream_ = fdopen(ends_[1], "w");
  }
  ~Pipe() {
    std::fclose(stream_);
    if (ends_[0] >= 0) close(ends_[0]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  std::FILE* stream() const { return stream_; }

  /// What has been written so far.
  std::string read_all() {
    fcntl(ends_[0], F_SETFL, O_NONBLOCK);
    std::string text;
    std::array<char, 4096> block{};
    for (ssize_t size = 0; (size = read(ends_[0], block.data(), block.size())) > 0;) {
      text.append(block.data(), static_cast<std::size_t>(size));
    }
    return text;
  }

  void close_reader() {
    close(ends_[0]);
    ends_[0] = -1;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
  std::FILE* stream_ = nullptr;
};

spdlog::details::log_msg message_of(std::string_view text) {
  return {"yuragi", spdlog::level::info, spdlog::string_view_t(text.data(), text.size())};
}

TEST(BoundedLogSink, WhatNobodyReadsIsDroppedAndCountedInTheNextLine) {
  Pipe pipe;
  BoundedLogSink sink(pipe.stream());
  for (int i = 0; i < 500; ++i) sink.log(message_of("a line of the log"));  // many times what the pipe takes
  const std::string read = pipe.read_all();
  const auto lines = std::count(read.begin(), read.end(), '\n');
  EXPECT_GT(lines, 10);
  EXPECT_LT(lines, 500);

  sink.log(message_of("the next one"));
  const std::string later = pipe.read_all();
  EXPECT_NE(later.find(std::to_string(500 - lines) + " lines of the log lost"), std::string::npos) << later;
  EXPECT_NE(later.find("the next one"), std::string::npos) << later;
}

TEST(BoundedLogSink, ALineIsCutToWhatAPipeTakesAtOnce) {
  Pipe pipe;
  BoundedLogSink sink(pipe.stream());
  sink.log(message_of(std::string(1'000'000, 'x')));
  const std::string read = pipe.read_all();
  EXPECT_GT(read.size(), BoundedLogSink::kMaxTextBytes);
  EXPECT_LE(read.size(), 4096U);
  EXPECT_EQ(read.back(), '\n');
}

TEST(BoundedLogSink, WithoutAReaderItDropsAtOnce) {
  std::signal(SIGPIPE, SIG_IGN);
  Pipe pipe;
  BoundedLogSink sink(pipe.stream());
  pipe.close_reader();
  for (int i = 0; i < 1000; ++i) sink.log(message_of("a line of the log"));
  std::signal(SIGPIPE, SIG_DFL);
}

TEST(DaemonLog, ItsLastLinesAreKept_AlsoThoseThatNobodyReads) {
  web::LogTail tail;
  {
    const DaemonLog log(false);
    for (int i = 0; i < 600; ++i) spdlog::info("line {} of the log", i);
    spdlog::debug("not said");
    spdlog::warn("{}", std::string(10'000, 'x'));
    tail = log.tail();
  }  // which waits until all is written
  const auto lines = tail(3);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[1].text, "line 599 of the log");
  EXPECT_EQ(lines[1].level, "info");
  EXPECT_GT(lines[1].time_s, 1.7e9);
  EXPECT_EQ(lines[2].level, "warning");
  EXPECT_EQ(lines[2].text.size(), BoundedLogSink::kMaxTextBytes);
  EXPECT_EQ(tail(10'000).size(), DaemonLog::kMaxKept);
}

TEST(DaemonLog, IsDelayedByNobodyAndEndsAlthoughNobodyReads) {
  Pipe pipe;
  std::fflush(stderr);
  const int before = dup(STDERR_FILENO);
  dup2(fileno(pipe.stream()), STDERR_FILENO);
  {
    const DaemonLog log(false);
    for (int i = 0; i < 20'000; ++i) spdlog::info("line {} of the log", i);
  }
  spdlog::info("said after its end");
  dup2(before, STDERR_FILENO);
  close(before);
  EXPECT_NE(pipe.read_all().find("of the log"), std::string::npos);
}

TEST(DaemonLog, EndsWhileItsThreadWrites) {
  Pipe pipe;
  std::fflush(stderr);
  const int before = dup(STDERR_FILENO);
  dup2(fileno(pipe.stream()), STDERR_FILENO);
  for (int end = 0; end < 200; ++end) {
    {
      const DaemonLog log(false);
      for (int i = 0; i < 20; ++i) spdlog::info("line {}", i);
    }
    EXPECT_NE(pipe.read_all().find("line 19"), std::string::npos);
  }
  dup2(before, STDERR_FILENO);
  close(before);
}

TEST(DaemonLog, ContainedExceptionsAreInTheLog) {
  web::LogTail tail;
  {
    const DaemonLog log(false);
    EXPECT_FALSE(contain("a task of the test", [] { throw 1; }));
    tail = log.tail();
  }
  const auto lines = tail(1);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_TRUE(lines[0].text.starts_with("a task of the test failed")) << lines[0].text;
  EXPECT_EQ(lines[0].level, "error");
}
TEST(DaemonLog, ContainedExceptionsAreCounted) {
  const DaemonLog log(false);
  const web::FaultCounter counter = DaemonLog::fault_counter();
  for (int fault = 0; fault < 3; ++fault) EXPECT_FALSE(contain("a counted task of the test", [] { throw 1; }));
  EXPECT_EQ(counter().at("a counted task of the test"), 3U);
}

}  // namespace
}  // namespace yuragi::daemon::service
