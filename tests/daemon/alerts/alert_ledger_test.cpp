#include "daemon/alerts/alert_ledger.hpp"

#include <chrono>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::alerts {
namespace {

using namespace std::chrono_literals;
using settings::AlertCondition;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

const UtcTime kTime{1'700'000'000s};
const Active kStorm{.alert = "storm \"a\"", .when = AlertCondition::kWindAbove, .begun = kTime};
const Active kRoof{.alert = "silent", .when = AlertCondition::kSensorSilent, .subject = "roof", .begun = kTime};

News storm(bool has_begun) {
  return {.alert = kStorm.alert,
          .has_begun = has_begun,
          .message = "the wind\nis strong",
          .time = kTime,
          .command = "secret command",
          .webhook = Secret("http://secret/")};
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

class LedgerTest : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "alerts.json";
};

TEST_F(LedgerTest, KeepsWhatIsOnAndWhatIsUndelivered) {
  {
    Ledger ledger(file_);
    EXPECT_THAT(ledger.record().on, IsEmpty());
    ledger.set({kStorm, kRoof}, {storm(true)});
    ledger.set({kRoof}, {storm(false)});
    ledger.settle(Channel::kCommand, storm(true));
  }
  EXPECT_THAT(content_of(file_), Not(HasSubstr("secret")));
  const Record record = Ledger(file_).record();
  EXPECT_THAT(record.on, testing::ElementsAre(kRoof));
  ASSERT_THAT(record.undelivered, SizeIs(3));
  EXPECT_EQ(record.undelivered[0].way, Channel::kWebhook);
  EXPECT_TRUE(record.undelivered[0].news.has_begun);
  EXPECT_EQ(record.undelivered[0].news.message, "the wind\nis strong");
  EXPECT_EQ(record.undelivered[0].news.time, kTime);
  EXPECT_EQ(record.undelivered[1].way, Channel::kCommand);
  EXPECT_FALSE(record.undelivered[1].news.has_begun);
}

TEST_F(LedgerTest, LeavesNoFileWhenAllIsTold) {
  {
    Ledger ledger(file_);
    ledger.set({}, {storm(true)});
  }
  EXPECT_TRUE(exists(file_));
  {
    Ledger ledger(file_);
    ledger.settle(Channel::kCommand, storm(true));
    ledger.settle(Channel::kWebhook, storm(true));
  }
  EXPECT_FALSE(exists(file_));
}

TEST_F(LedgerTest, ADamagedFileIsIgnoredAndOverwritten) {
  const std::string good = text_of({.on = {kRoof}, .undelivered = {{Channel::kCommand, storm(true)}}});
  ASSERT_TRUE(parse_alert_record(good));
  // Cut anywhere, or with any byte another one, it is invalid or another record; it never ends the program.
  for (std::size_t i = 0; i + 2 < good.size(); ++i) {
    EXPECT_FALSE(parse_alert_record(good.substr(0, i)));
    for (const char other : {'\0', '"', '9', '-', '{', '\xff'}) {
      std::string changed = good;
      changed[i] = other;
      (void)parse_alert_record(changed);
    }
  }
  for (const char* const text :
       {"null", "[]", "{}", R"({"on": {}, "undelivered": []})", R"({"on": [1], "undelivered": []})",
        R"({"on": [{"alert": "a", "when": "no_such", "subject": "", "time_ns": 1}], "undelivered": []})",
        R"({"on": [{"alert": "a", "when": 3, "subject": "", "time_ns": 1}], "undelivered": []})",
        R"({"on": [{"alert": "a", "when": "no_frame", "subject": "", "time_ns": -1}], "undelivered": []})",
        R"({"on": [{"alert": "a", "when": "no_frame", "subject": "", "time_ns": 1e300}], "undelivered": []})",
        R"({"on": [{"alert": "a", "when": "no_frame", "subject": "", "time_ns": 18446744073709551615}],
            "undelivered": []})"}) {
    EXPECT_FALSE(parse_alert_record(text)) << text;
    std::ofstream(file_) << text;
    Ledger ledger(file_);
    EXPECT_THAT(ledger.record().on, IsEmpty());
    ledger.set({kRoof}, {});
  }
  EXPECT_THAT(Ledger(file_).record().on, SizeIs(1));
}

TEST_F(LedgerTest, AFolderInItsPlaceOrNoneAtAllCostsOnlyTheSaving) {
  create_directory(file_);
  Ledger(file_).set({kRoof}, {});
  EXPECT_TRUE(is_directory(file_));
  Ledger ledger(folder_.path() / "nowhere" / "alerts.json");
  ledger.set({kRoof}, {});
  EXPECT_THAT(ledger.record().on, SizeIs(1));
}

}  // namespace
}  // namespace yuragi::daemon::alerts
