// What stations say besides the wind, in recordings.
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/windlog/recording_parts.hpp"
#include "drivers/windlog/windlog_rewrite.hpp"
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
  auto writer = Writer::open(file);
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
  const auto reader = Reader::open(file);
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

/// A session of the mast with quantities and no reading.
void write_no_reading(const std::filesystem::path& file, const std::vector<wind::StationQuantities>& said,
                      std::int64_t begin_ms) {
  auto writer = Writer::open(file);
  ASSERT_TRUE(writer) << writer.error().message;
  ASSERT_TRUE(writer->begin_session({test::at_ms(begin_ms, test::kSampleUtc_ms + begin_ms), "yuragi test", ""}));
  const auto mast = writer->add_sensor("mast", "nmea", "");
  ASSERT_TRUE(mast);
  for (const wind::StationQuantities& quantities : said) ASSERT_TRUE(*writer->append(*mast, quantities));
  ASSERT_TRUE(writer->close());
}

std::vector<double> temperatures_of(const ReadQuantities& read) {
  std::vector<double> all;
  for (const LoggedQuantities& row : read.rows) all.push_back(row.quantities.air_temperature_c.value_or(999.0));
  return all;
}

TEST(WindlogQuantities, OfFilesWithoutAReadingFollowTheOthers) {
  const test::TemporaryFolder folder;
  const auto part = [&](std::int64_t begin_ms) {
    return part_name(folder / "a.windlog", test::at_ms(0, test::kSampleUtc_ms + begin_ms).utc);
  };
  write_no_reading(part(10'000), {temperature_at(12'000, 1.0)}, 10'000);  // two of them first
  write_no_reading(part(20'000), {temperature_at(22'000, 2.0)}, 20'000);
  write_quantities(part(101'000), {temperature_at(103'000, 3.0)}, 101'000);
  write_no_reading(part(201'000), {temperature_at(203'000, 4.0)}, 201'000);
  write_quantities(part(301'000), {temperature_at(303'000, 5.0)}, 301'000);
  write_no_reading(folder / "a.windlog", {temperature_at(403'000, 6.0)}, 401'000);

  const auto whole = quantities_of(folder / "a.windlog");
  EXPECT_EQ(temperatures_of(whole), (std::vector{1.0, 2.0, 3.0, 4.0, 5.0, 6.0}));
  EXPECT_EQ(whole.skipped, 0U);
  for (const LoggedQuantities& row : whole.rows) {
    const std::int64_t mono_ms = row.quantities.time.mono.time_since_epoch().count() / 1'000'000;
    EXPECT_EQ(row.log_time, std::chrono::milliseconds(mono_ms - 101'000)) << "from the first reading of all on";
    EXPECT_EQ(row.quantities.time.utc, test::at_ms(0, test::kSampleUtc_ms + mono_ms).utc);
  }
  const auto reader = Reader::open(folder / "a.windlog");
  ASSERT_TRUE(reader);
  for (const LoggedQuantities& row : whole.rows) EXPECT_EQ(reader->sensors()[row.sensor].name, "mast");
  EXPECT_EQ(reader->sessions().size(), 2U);
  EXPECT_EQ(test::read_all(folder / "a.windlog").size(), 20U);

  using std::chrono::seconds;
  EXPECT_EQ(temperatures_of(quantities_of(folder / "a.windlog", seconds(1), seconds(102))), (std::vector{3.0}));
  EXPECT_EQ(temperatures_of(quantities_of(folder / "a.windlog", seconds(50), seconds(250))), (std::vector{4.0, 5.0}));
  EXPECT_EQ(temperatures_of(quantities_of(folder / "a.windlog", seconds(250))), (std::vector{6.0}));
}

TEST(WindlogQuantities, OfASeriesWithoutAnyReadingAreRead) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  write_no_reading(part_name(file, test::at_ms(0, test::kSampleUtc_ms + 1000).utc), {temperature_at(2000, 1.0)}, 1000);
  write_no_reading(file, {temperature_at(63'000, 2.0)}, 61'000);
  EXPECT_EQ(temperatures_of(quantities_of(file)), (std::vector{1.0, 2.0}));
  EXPECT_TRUE(test::read_all(file).empty());
}

TEST(WindlogQuantities, AreKeptApartFromThoseOfASessionWhoseClockWasSetBack) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  write_quantities(file, {temperature_at(2000, 1.0), temperature_at(3'000'000, 2.0)});  // long after the last reading
  // The next start, on a machine whose clock is two hours slow.
  auto writer = Writer::open(file);
  ASSERT_TRUE(writer);
  const std::int64_t utc_ms = test::kSampleUtc_ms - 7'200'000;
  ASSERT_TRUE(writer->begin_session({test::at_ms(5000, utc_ms), "yuragi test", ""}));
  const auto mast = writer->add_sensor("mast", "nmea", "");
  ASSERT_TRUE(mast);
  ASSERT_TRUE(writer->append(*mast, reading_at(6000, 3.0)));
  auto said = temperature_at(7000, 3.0);
  said.time.utc = test::at_ms(0, utc_ms + 2000).utc;
  ASSERT_TRUE(*writer->append(*mast, said));
  ASSERT_TRUE(writer->close());

  const auto read = quantities_of(file);
  EXPECT_EQ(temperatures_of(read), (std::vector{1.0, 2.0, 3.0}));
  EXPECT_EQ(read.rows[1].quantities.time.utc, test::at_ms(0, test::kSampleUtc_ms + 3'000'000).utc);
  EXPECT_EQ(read.rows[2].quantities.time.utc, said.time.utc);
}

TEST(WindlogQuantities, AreNoReasonToRefuseASessionWhereTheirTimesCannotBe) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  write_quantities(file, {temperature_at(2000, 20.0)});
  test::tamper(file,
               "INSERT INTO quantity (time_ns, series, clock_ns, air_temperature_c) VALUES "
               "(9223372036854775807, 1, 0, 20), (4611686018427387902, 1, 0, 20)");
  auto writer = Writer::open(file);
  ASSERT_TRUE(writer);
  EXPECT_TRUE(writer->begin_session({test::at_ms(20'000, test::kSampleUtc_ms + 20'000), "yuragi test", ""}));
}

TEST(WindlogQuantities, SayWhenAFileWithoutAReadingWasBegun) {
  const test::TemporaryFolder folder;
  const auto began_of = [](const std::filesystem::path& file) {
    auto writer = Writer::open(file);
    return writer ? writer->began().value() : std::nullopt;
  };
  write_no_reading(folder / "a.windlog", {}, 5000);
  EXPECT_FALSE(began_of(folder / "a.windlog").has_value());
  write_no_reading(folder / "a.windlog", {temperature_at(9000, 1.0)}, 8000);
  EXPECT_EQ(began_of(folder / "a.windlog"), test::at_ms(0, test::kSampleUtc_ms + 5000).utc);
  test::tamper(folder / "a.windlog", "DROP TABLE quantity; CREATE TABLE quantity (text TEXT)");
  EXPECT_FALSE(began_of(folder / "a.windlog").has_value());
}

TEST(WindlogQuantities, SurviveThatSecretsAreTakenOut) {
  const test::TemporaryFolder folder;
  const auto file = folder / "a.windlog";
  write_quantities(file, {temperature_at(2000, 1.0), temperature_at(5000, 2.0)});
  const auto before = quantities_of(file);
  const auto changed = rewrite_texts(file, {.configuration = [](const std::string&) { return "withheld"; },
                                            .options = [](const std::string&, const std::string&) { return "none"; }});
  ASSERT_TRUE(changed) << changed.error().message;
  EXPECT_EQ(*changed, 2U);
  const auto after = quantities_of(file);
  ASSERT_EQ(after.rows.size(), before.rows.size());
  for (std::size_t i = 0; i < after.rows.size(); ++i) {
    EXPECT_EQ(after.rows[i].log_time, before.rows[i].log_time);
    EXPECT_EQ(after.rows[i].quantities.time.utc, before.rows[i].quantities.time.utc);
    EXPECT_EQ(after.rows[i].quantities.air_temperature_c, before.rows[i].quantities.air_temperature_c);
  }
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
  auto writer = Writer::open(folder / "a.windlog");
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

    auto writer = Writer::open(file);
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
  auto reader = Reader::open(folder / "a.windlog");
  ASSERT_TRUE(reader);
  ASSERT_TRUE(reader->copy_to(folder / "b.windlog"));
  EXPECT_EQ(quantities_of(folder / "b.windlog").rows.size(), 1U);
}

}  // namespace
}  // namespace yuragi::drivers::windlog
