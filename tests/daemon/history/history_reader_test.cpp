#include "daemon/history/history_reader.hpp"

#include <atomic>
#include <future>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace yuragi::daemon::history {
namespace {

/// What ask() replies, however long it takes.
Result<std::string, Failure> asked(Reader& reader, unsigned hours) {
  std::promise<Result<std::string, Failure>> reply;
  auto replied = reply.get_future();
  reader.ask(hours, [&reply](const Result<std::string, Failure>& result) { reply.set_value(result); });
  return replied.get();
}

TEST(HistoryReader, WhatWasReadIsKept_ForThoseHours) {
  std::atomic<int> readings = 0;
  Reader reader(
      [&readings](unsigned hours, const std::stop_token&) -> Result<std::string, Failure> {
        ++readings;
        return {boost::system::in_place_value, std::to_string(hours)};
      },
      std::chrono::hours(1));
  EXPECT_EQ(asked(reader, 24).value(), "24");
  EXPECT_EQ(asked(reader, 24).value(), "24");
  EXPECT_EQ(readings, 1);
  EXPECT_EQ(asked(reader, 2).value(), "2");
  EXPECT_EQ(readings, 2);
}

TEST(HistoryReader, WhatIsTooOldIsReadAgain_AndFailuresAreNotKept) {
  std::atomic<int> readings = 0;
  Reader reader(
      [&readings](unsigned, const std::stop_token&) -> Result<std::string, Failure> {
        if (++readings == 1) throw std::runtime_error("no memory");
        return {boost::system::in_place_value, std::to_string(readings.load())};
      },
      Nanoseconds(0));
  EXPECT_EQ(asked(reader, 24).error().message, "no memory");
  EXPECT_EQ(asked(reader, 24).value(), "2");
  EXPECT_EQ(asked(reader, 24).value(), "3");
}

TEST(HistoryReader, OneAtATime_NobodyWaits_AndItsEndStopsTheReading) {
  std::promise<void> begun;
  std::promise<Result<std::string, Failure>> first;
  {
    Reader reader([&begun](unsigned, const std::stop_token& stop) -> Result<std::string, Failure> {
      begun.set_value();
      while (!stop.stop_requested()) std::this_thread::yield();
      return Failure{"stopped"};
    });
    reader.ask(24, [&first](const Result<std::string, Failure>& result) { first.set_value(result); });
    begun.get_future().get();
    for (const unsigned hours : {24U, 1U}) EXPECT_EQ(asked(reader, hours).error().kind, FailureKind::kUnavailable);
  }
  EXPECT_EQ(first.get_future().get().error().message, "stopped");
}

}  // namespace
}  // namespace yuragi::daemon::history
