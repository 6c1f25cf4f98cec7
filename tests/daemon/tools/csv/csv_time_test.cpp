#include "daemon/tools/csv/csv_time.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace yuragi::daemon::tools::csv {
namespace {

using namespace std::chrono_literals;

constexpr UtcTime kAfternoon{std::chrono::seconds(1'532'095'200)};  // 2018-07-20T14:00:00Z

TEST(CsvTime, ReadsIso8601) {
  EXPECT_EQ(parse_time("2018-07-20 14:00:00.5", CsvTimeFormat::kIso), kAfternoon + 500ms);
  EXPECT_EQ(parse_time("1532095200", CsvTimeFormat::kIso), std::nullopt);
  EXPECT_EQ(parse_time("1532095200", CsvTimeFormat::kAuto), std::nullopt);
}

TEST(CsvTime, ReadsNumbersExactly) {
  EXPECT_EQ(parse_time("1532095200.1", CsvTimeFormat::kUnix), kAfternoon + 100ms);
  EXPECT_EQ(parse_time("1532095200.123456789", CsvTimeFormat::kUnix), kAfternoon + 123'456'789ns);
  EXPECT_EQ(parse_time("1532095200100", CsvTimeFormat::kUnixMs), kAfternoon + 100ms);
  EXPECT_EQ(parse_time("1532095200100.25", CsvTimeFormat::kUnixMs), kAfternoon + 100'250us);
  EXPECT_EQ(parse_time("0.3", CsvTimeFormat::kSeconds), UtcTime(300ms));
  EXPECT_EQ(parse_time("99999999999999999999", CsvTimeFormat::kUnix), std::nullopt);
  EXPECT_EQ(parse_time("9000000000", CsvTimeFormat::kUnix), std::nullopt) << "beyond what a recording holds";
}

TEST(CsvTime, DecimalsAreKeptToTheLastDigit) {
  EXPECT_EQ(parse_decimal("1.25", 9), 1'250'000'000);
  EXPECT_EQ(parse_decimal("-1.25", 1), -12);
  EXPECT_EQ(parse_decimal("1,25", 2), 125);
  EXPECT_EQ(parse_decimal("+7", 0), 7);
  EXPECT_EQ(parse_decimal(".5", 3), 500);
  EXPECT_EQ(parse_decimal("5.", 3), 5000);
  EXPECT_EQ(parse_decimal("9223372036854775807", 0), std::numeric_limits<std::int64_t>::max());
  for (const char* text :
       {"", ".", "-", "+", "1e3", "0x10", "1.2.3", "1,532,095", "--1", " 1", "9223372036854775808"}) {
    EXPECT_EQ(parse_decimal(text, 0), std::nullopt) << text;
  }
  EXPECT_EQ(parse_decimal("9223372036854775807", 1), std::nullopt);
}

TEST(CsvTime, GuessesTheFormatFromWhatItSees) {
  EXPECT_EQ(guess_time_format("2018-07-20T14:00:00Z"), CsvTimeFormat::kIso);
  EXPECT_EQ(guess_time_format("1532095200.1"), CsvTimeFormat::kUnix);
  EXPECT_EQ(guess_time_format("1532095200100"), CsvTimeFormat::kUnixMs);
  EXPECT_EQ(guess_time_format("0.1"), CsvTimeFormat::kSeconds);
  EXPECT_EQ(guess_time_format("86400"), CsvTimeFormat::kSeconds);
}

}  // namespace
}  // namespace yuragi::daemon::tools::csv
