// What stations say besides the wind, in recordings.
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/windlog/recording_parts.hpp"
#include "tests/drivers/windlog/hostile_recordings.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::windlog {
namespace {

using test::reading_at;

wind::StationQuantities temperature_at(std::int64_t mono_ms, double air_temperature_c) {
  wind::StationQuantities quantities;
  quantities.time = test::at_ms(mono_ms, test::kSampleUtc_ms + mono_ms);
  quantities.air_temperature_c = air_temperature_c;
  return quantities;
}

/// A session from 1 s on, of a mast with a reading a second, and what its station said.
void write_quantities(const std::filesystem::path& file, const std::vector<wind::StationQuantities>& said,
                      std::int64_t begin_ms = 1000) {
  auto writer = WindlogWriter::open(file);
  ASSERT_TRUE(writer) << writer.error().message;
  ASSERT_TRUE(writer->begin_session({test::at_ms(begin_ms, test::kSampleUtc_ms + begin_ms), "yuragi test", ""}));
  const auto mast = writer->add_sensor("mast", "nmea", "");
  ASSERT_TRUE(mast);
  for (int second = 0; second < 10; ++second)
    ASSERT_TRUE(writer->append(*mast, reading_at(begin_ms + 1000 * second, 3.0)));
  for (const wind::StationQuantities& quantities : said) {
    const auto added = writer->append(*mast, quantities);
    ASSERT_TRUE(added) << added.error().message;
    EXPECT_TRUE(*added);
  }
  ASSERT_TRUE(writer->close());
}

struct ReadQuantities {
  std::vector<LoggedQuantities> rows;
  std::size_t skipped = 0;
};
ReadQuantities quantities_of(const std::filesystem::path& file, Nanoseconds from = Nanoseconds{0},
                             Nanoseconds to = Nanoseconds::max()) {
  ReadQuantities all;
  const auto reader = WindlogReader::open(file);
  EXPECT_TRUE(reader) << (reader ? "" : reader.error().message);
  if (!reader) return all;
  const auto skipped =
      reader->each_quantities(from, to, [&](const LoggedQuantities& logged) { all.rows.push_back(logged); });
  EXPECT_TRUE(skipped) << (skipped ? "" : skipped.error().message);
  all.skipped = skipped ? *skipped : 0;
  return all;
}

TEST(WindlogQuantities, ComeBackAsTheyWereSaid) {
  const test::TemporaryFolder folder;
  wind::StationQuantities all = temperature_at(3000, -12.25);
  all.vertical_speed_m_s = -0.5;
  all.pressure_hpa = 1013.25;
  all.relative_humidity_percent = 55.0;
  all.rain_total_mm = 12.75;
  all.rain_rate_mm_h = 0.0;
  write_quantities(folder / "a.windlog", {temperature_at(1500, 20.0), all});

  const auto read = quantities_of(folder / "a.windlog");
  ASSERT_EQ(read.rows.size(), 2U);
  EXPECT_EQ(read.skipped, 0U);
  EXPECT_EQ(read.rows[0].quantities.air_temperature_c, 20.0);
  EXPECT_FALSE(read.rows[0].quantities.pressure_hpa.has_value());
  EXPECT_EQ(read.rows[1].log_time, std::chrono::seconds(2));
  EXPECT_EQ(read.rows[1].quantities.time.utc, all.time.utc);
  EXPECT_EQ(read.rows[1].quantities.time.mono, all.time.mono);
  for (const wind::StationQuantity& each : wind::kStationQuantities) {
    EXPECT_EQ(read.rows[1].quantities.*each.value, all.*each.value) << each.name;
  }
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 10U);
}

TEST(WindlogQuantities, OfOneSecondAreOneRowWithTheLastOfEach) {
  const test::TemporaryFolder folder;
  wind::StationQuantities pressure;
  pressure.time = test::at_ms(2300, test::kSampleUtc_ms + 2300);
  pressure.pressure_hpa = 990.0;
  std::vector<wind::StationQuantities> said = {temperature_at(2100, 10.0), pressure};
  for (int i = 0; i < 50; ++i) said.push_back(temperature_at(2400 + i, 11.0 + i));
  write_quantities(folder / "a.windlog", said);
  const auto read = quantities_of(folder / "a.windlog");
  ASSERT_EQ(read.rows.size(), 1U);
  EXPECT_EQ(read.rows[0].quantities.air_temperature_c, 60.0);
  EXPECT_EQ(read.rows[0].quantities.pressure_hpa, 990.0);
  EXPECT_EQ(read.rows[0].quantities.time.utc, test::at_ms(0, test::kSampleUtc_ms + 2000).utc);
}

TEST(WindlogQuantities, AreThoseOfARange) {
  const test::TemporaryFolder folder;
  std::vector<wind::StationQuantities> said;
  for (int second = 0; second < 10; ++second) said.push_back(temperature_at(1000 + 1000 * second, second));
  write_quantities(folder / "a.windlog", said);
  const auto read = quantities_of(folder / "a.windlog", std::chrono::seconds(3), std::chrono::seconds(5));
  ASSERT_EQ(read.rows.size(), 2U);
  EXPECT_EQ(read.rows[0].quantities.air_temperature_c, 3.0);
  EXPECT_EQ(read.rows[1].quantities.air_temperature_c, 4.0);
}

TEST(WindlogQuantities, OfASeriesOfFilesFollowEachOther) {
  const test::TemporaryFolder folder;
  const UtcTime begin = test::at_ms(0, test::kSampleUtc_ms + 1000).utc;
  write_quantities(part_name(folder / "a.windlog", begin), {temperature_at(2000, 1.0), temperature_at(9000, 2.0)});
  write_quantities(folder / "a.windlog", {temperature_at(101'000, 3.0), temperature_at(105'000, 4.0)}, 101'000);

  const auto whole = quantities_of(folder / "a.windlog");
  ASSERT_EQ(whole.rows.size(), 4U);
  EXPECT_EQ(whole.rows[2].log_time, std::chrono::seconds(100));
  EXPECT_EQ(whole.rows[2].sensor, 1U);
  const auto range = quantities_of(folder / "a.windlog", std::chrono::seconds(8), std::chrono::seconds(104));
  ASSERT_EQ(range.rows.size(), 2U);
  EXPECT_EQ(range.rows[0].quantities.air_temperature_c, 2.0);
  EXPECT_EQ(range.rows[1].quantities.air_temperature_c, 3.0);
}

TEST(WindlogQuantities, AreNoneInAFileWithoutTheTable) {
  const test::TemporaryFolder folder;
  test::write_session(folder / "a.windlog", test::numbered_readings(5));
  EXPECT_TRUE(quantities_of(folder / "a.windlog").rows.empty());

  // A recording that has none is continued with some.
  write_quantities(folder / "a.windlog", {temperature_at(5000, 7.0)}, 5000);
  EXPECT_EQ(quantities_of(folder / "a.windlog").rows.size(), 1U);
}

TEST(WindlogQuantities, ThatCannotBeAreNotWritten) {
  const test::TemporaryFolder folder;
  auto writer = WindlogWriter::open(folder / "a.windlog");
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->begin_session({test::at_ms(0, test::kSampleUtc_ms), "yuragi test", ""}));
  const auto mast = writer->add_sensor("mast", "nmea", "");
  ASSERT_TRUE(writer->append(*mast, reading_at(1000, 3.0)));
  for (const double impossible :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -273.0, 1000.0}) {
    EXPECT_FALSE(*writer->append(*mast, temperature_at(1000, impossible)));
  }
  EXPECT_FALSE(*writer->append(*mast + 1, temperature_at(1000, 20.0)));
  EXPECT_FALSE(*writer->append(*mast, temperature_at(-1000, 20.0)));

  // One value that cannot be leaves the others.
  wind::StationQuantities mixed = temperature_at(1000, 20.0);
  mixed.pressure_hpa = -1.0;
  EXPECT_TRUE(*writer->append(*mast, mixed));
  ASSERT_TRUE(writer->close());
  const auto read = quantities_of(folder / "a.windlog");
  ASSERT_EQ(read.rows.size(), 1U);
  EXPECT_FALSE(read.rows[0].quantities.pressure_hpa.has_value());
}

TEST(WindlogQuantities, OfHostileRowsAreSkippedAndCounted) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  write_quantities(file, {temperature_at(2000, 20.0)});
  test::tamper(file,
               "INSERT INTO quantity (time_ns, series, clock_ns, air_temperature_c) VALUES (7, 99, 0, 20), "
               "(8, 1, 9223372036854775807, 20), (9, 1, 0, 1e300), (10, 1, 0, 9e999), (11, 1, 0, NULL), "
               "(-5, 1, 0, 20)");
  const auto strict = quantities_of(file);
  EXPECT_EQ(strict.rows.size(), 1U);
  EXPECT_EQ(strict.skipped, 5U);

  // A table of another kind, with any type in it.
  test::tamper(file,
               "DROP TABLE quantity; CREATE TABLE quantity (time_ns, series, clock_ns, vertical_speed_m_s, "
               "air_temperature_c, pressure_hpa, relative_humidity_percent, rain_total_mm, rain_rate_mm_h); "
               "INSERT INTO quantity (time_ns, series, clock_ns, air_temperature_c) VALUES (1, 'x', 0, 1.5), "
               "(2, 1, x'00', 1.5), (3, 1, 0, 'warm'), (4, 1, 0, 1.5)");
  const auto loose = quantities_of(file);
  EXPECT_EQ(loose.rows.size(), 1U);
  EXPECT_EQ(loose.skipped, 3U);
  EXPECT_EQ(test::read_all(file).size(), 10U);
}

TEST(WindlogQuantities, OfADamagedTableHoldUpNoReading) {
  for (const char* damage : {"CREATE TABLE quantity (text TEXT)", "CREATE VIEW quantity AS SELECT 1 AS time_ns"}) {
    SCOPED_TRACE(damage);
    const test::TemporaryFolder folder;
    const auto file = folder / "a.windlog";
    test::write_session(file, test::numbered_readings(5));
    test::tamper(file, damage);

    auto writer = WindlogWriter::open(file);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->begin_session({test::at_ms(5000, test::kSampleUtc_ms + 5000), "yuragi test", ""}));
    const auto mast = writer->add_sensor("mast", "nmea", "");
    ASSERT_TRUE(writer->append(*mast, reading_at(6000, 3.0)));
    const auto added = writer->append(*mast, temperature_at(6000, 20.0));
    ASSERT_TRUE(added) << added.error().message;
    EXPECT_FALSE(*added);
    ASSERT_TRUE(writer->append(*mast, reading_at(7000, 3.0)));
    ASSERT_TRUE(writer->close());
    EXPECT_EQ(test::read_all(file).size(), 7U);
  }
}

TEST(WindlogQuantities, SurviveACopy) {
  const test::TemporaryFolder folder;
  write_quantities(folder / "a.windlog", {temperature_at(2000, 20.0)});
  auto reader = WindlogReader::open(folder / "a.windlog");
  ASSERT_TRUE(reader);
  ASSERT_TRUE(reader->copy_to(folder / "b.windlog"));
  EXPECT_EQ(quantities_of(folder / "b.windlog").rows.size(), 1U);
}

}  // namespace
}  // namespace yuragi::drivers::windlog
