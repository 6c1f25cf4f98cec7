#include "daemon/service/fault_log.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::service {
namespace {

using namespace std::chrono_literals;

TEST(FaultLog, TheFirstOfAKindIsLoggedAtOnce) {
  FaultLog log;
  const MonoTime now{1h};
  EXPECT_EQ(log.line_for("an HTTP request", "bad\x1b[2J", now),
            "an HTTP request failed: bad?[2J; this is a fault of the program, please report it");
  EXPECT_TRUE(log.line_for("a stream connection", "bad", now));
}

TEST(FaultLog, FurtherOnesAreCountedAndLoggedOnceAMinute) {
  FaultLog log;
  MonoTime now{1h};
  int lines = 0;
  std::string last;
  for (int request = 0; request < 600; ++request, now += 1s) {
    if (const auto line = log.line_for("an HTTP request", "bad", now)) {
      ++lines;
      last = *line;
    }
  }
  EXPECT_EQ(lines, 10);
  EXPECT_EQ(last,
            "an HTTP request failed: bad (59 more since the last such line); this is a fault of the program, please "
            "report it");
}

TEST(FaultLog, FaultsAreCountedByKind_AndKindsAreBounded) {
  FaultLog log;
  for (int request = 0; request < 5; ++request) log.line_for("an HTTP request", "bad", MonoTime{1h});
  EXPECT_EQ(log.counts(), (web::FaultCounts{{"an HTTP request", 5}}));
  for (int kind = 0; kind < 1000; ++kind) log.line_for(std::to_string(kind), "bad", MonoTime{1h});
  EXPECT_EQ(log.counts().size(), FaultLog::kMaxKinds + 1);
  EXPECT_EQ(log.counts().at(std::string(FaultLog::kOtherKind)), 1001 - FaultLog::kMaxKinds);
  log.line_for("an HTTP request", "bad", MonoTime{1h});
  EXPECT_EQ(log.counts().at("an HTTP request"), 6U);
}

}  // namespace
}  // namespace yuragi::daemon::service
