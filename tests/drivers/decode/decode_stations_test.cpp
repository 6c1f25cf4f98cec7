// The USB stations that answer in blocks: WMR300, Fine Offset, AcuRite, TE923.
#include <algorithm>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/decode/hid/acurite.hpp"
#include "drivers/decode/hid/fineoffset.hpp"
#include "drivers/decode/hid/te923.hpp"
#include "drivers/decode/hid/wmr300.hpp"
#include "tests/support/byte_vectors.hpp"
#include "tests/support/decoded_winds.hpp"

namespace yuragi::drivers::decode {
namespace {

using StationBytes = std::vector<std::uint8_t>;

constexpr std::string_view kStationVectors = "hid_vectors.json";

/// A number of a vector's "expect", empty where it is null.
std::optional<double> expected_number(const nlohmann::json& vector, const char* key) {
  const auto& number = vector["expect"][key];
  return number.is_null() ? std::nullopt : std::optional<double>(number.get<double>());
}

template <class Array>
StationBytes bytes_from(const Array& array) {
  return {array.begin(), array.end()};
}

// --- WMR300

/// A packet D4 with its length and sum; numbers as in the byte map.
StationBytes wmr300_packet(std::uint16_t gust, std::uint16_t average, std::uint16_t direction) {
  StationBytes packet(hid::kWmr300WindPacket);
  const auto put = [&packet](std::size_t at, std::uint16_t value) {
    packet[at] = static_cast<std::uint8_t>(value >> 8U);
    packet[at + 1] = static_cast<std::uint8_t>(value & 0xFFU);
  };
  packet[0] = 0xD4;
  packet[1] = 54;
  put(8, gust);
  put(10, 300);
  put(12, average);
  put(14, direction);
  put(52, sum_16(ByteSpan(packet).first(52)));
  return packet;
}

TEST(Wmr300Packet, GivesAverageItsDirectionAndGust) {
  const auto decoded = hid::decode_wmr300(wmr300_packet(301, 256, 359));
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(*decoded, (DecodedWind{.speed_m_s = 25.6, .direction_deg = 359.0, .gust_m_s = 30.1}));
  EXPECT_EQ(hid::decode_wmr300(wmr300_packet(0, 0, 360))->direction_deg, 0.0);
}

TEST(Wmr300Packet, MayBePaddedToItsReport) {
  auto report = wmr300_packet(20, 10, 90);
  report.resize(64, 0xEE);
  EXPECT_TRUE(hid::decode_wmr300(report).has_value());
}

TEST(Wmr300Packet, LeavesOutWhatTheConsoleDoesNotHave) {
  const auto decoded = hid::decode_wmr300(wmr300_packet(0x7FFF, 12, 0x7FFD));
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(*decoded, (DecodedWind{.speed_m_s = 1.2, .direction_deg = {}, .gust_m_s = {}}));
  EXPECT_TRUE(test::is_refused_as(hid::decode_wmr300(wmr300_packet(0x7FFF, 0x7FFF, 0x7FFF)), Refusal::kInvalid));
}

TEST(Wmr300Packet, IsRefusedInGrades) {
  EXPECT_TRUE(test::is_refused_as(hid::decode_wmr300({}), Refusal::kTooShort));
  EXPECT_TRUE(test::is_refused_as(hid::decode_wmr300(hid::kWmr300Heartbeat), Refusal::kNotMine));
  const auto packet = wmr300_packet(20, 10, 90);
  EXPECT_TRUE(test::is_refused_as(hid::decode_wmr300(ByteSpan(packet).first(53)), Refusal::kTooShort));
  for (std::size_t bit = 16; bit < 8 * packet.size(); ++bit) {
    auto damaged = packet;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_TRUE(test::is_refused_as(hid::decode_wmr300(damaged), Refusal::kBadChecksum)) << bit;
  }
  auto longer = packet;
  longer[1] = 55;
  EXPECT_TRUE(test::is_refused_as(hid::decode_wmr300(longer), Refusal::kMalformed));
  const auto impossible = hid::decode_wmr300(wmr300_packet(20, 10, 361));
  ASSERT_TRUE(impossible);
  EXPECT_EQ(impossible->speed_m_s, 1.0);
  EXPECT_FALSE(impossible->direction_deg);
  EXPECT_EQ(impossible->status, DecodedStatus::kUncertain);
  EXPECT_TRUE(test::is_refused_as(hid::decode_wmr300(wmr300_packet(20, 1201, 90)), Refusal::kImplausible));
}

TEST(Wmr300Identity, IsAnsweredByItsOwnTwoBytes) {
  // weewx wmr300.py: 57 ... 88 8b 00 00 and the packet 73 e5 0a 26 88 8b.
  const auto identity = test::hex_bytes("57 4d 52 33 30 30 2c 41 30 30 32 2c 88 8b 00 00 2c 2f b5 2c 4b 2c 52 2c");
  ASSERT_TRUE(hid::is_wmr300_identity(identity));
  EXPECT_EQ(bytes_from(hid::encode_wmr300_begin(identity)), test::hex_bytes("73 e5 0a 26 88 8b"));
  EXPECT_FALSE(hid::is_wmr300_identity(ByteSpan(identity).first(13)));
  EXPECT_FALSE(hid::is_wmr300_identity(wmr300_packet(20, 10, 90)));
}

TEST(Wmr300Packet, IsSoundIfItsSumIsRight) {
  auto packet = wmr300_packet(20, 10, 90);
  EXPECT_TRUE(hid::is_sound_wmr300(packet));
  EXPECT_FALSE(hid::is_sound_wmr300(ByteSpan(packet).first(53)));
  packet[20] = 1;
  EXPECT_FALSE(hid::is_sound_wmr300(packet));
  EXPECT_TRUE(hid::is_sound_wmr300(test::hex_bytes("41 43 4b 73 e5 0a 26 0e c1")));
  EXPECT_FALSE(hid::is_sound_wmr300(test::hex_bytes("41 43 4c")));
  EXPECT_FALSE(hid::is_sound_wmr300({}));
}

TEST(Wmr300Vectors, OfTheSharedCollectionDecodeAsTheySay) {
  const auto vectors = test::load_byte_vectors(kStationVectors, "WMR300");
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/hid_vectors.json is not here";
  for (const auto& vector : vectors) {
    const auto packet = test::hex_bytes(vector["bytes"]);
    const auto decoded = hid::decode_wmr300(packet);
    ASSERT_TRUE(decoded.has_value());
    EXPECT_EQ(decoded->speed_m_s, expected_number(vector, "avg_ms"));
    EXPECT_EQ(decoded->direction_deg, expected_number(vector, "avg_dir"));
    auto gust_m_s = expected_number(vector, "gust_ms");
    if (gust_m_s < expected_number(vector, "avg_ms")) gust_m_s.reset();
    EXPECT_EQ(decoded->gust_m_s, gust_m_s);
    EXPECT_TRUE(hid::wants_wmr300_acknowledgement(packet));
    EXPECT_EQ(bytes_from(hid::encode_wmr300_acknowledgement(packet)), test::hex_bytes(vector["expect"]["ack"]));
  }
}

// The packets in the comment of weewx wmr300.py, byte for byte; their sums are right.
const std::string kWmr300TemperatureHex =
    "d3 3d 0e 05 09 12 14 01 00 c3 2d 00 46 7f fd 00 00 0e 05 09 0a 24 00 82 0e 05 09 10 1f 00 3c 0e 05 01 0f 1b 00 82 "
    "0e 05 04 0b 08 ff f6 0e 05 09 00 00 7f ff 0e 05 01 00 00 7f ff 0b 63";
const std::string kWmr300RainHex =
    "d5 28 0e 05 09 12 15 01 00 00 00 00 00 0c 00 00 a1 00 00 0e 04 1d 12 00 0e 05 09 01 0c 00 0b 0e 05 02 04 0c 00 92 "
    "03 1a";
const std::string kWmr300PressureHex =
    "d6 2e 0e 05 0d 0e 30 00 26 59 27 a9 01 2c 03 00 0e 05 0d 0c 33 27 ad 0e 05 0d 00 06 27 9d 0e 05 04 01 15 27 f1 0e "
    "05 0b 00 06 27 5e 06 ec";

/// The packet with other bytes from `at` on, and the sum that then is right.
StationBytes wmr300_changed(const std::string& hex, std::size_t at, const std::string& other_hex) {
  auto packet = test::hex_bytes(hex);
  std::ranges::copy(test::hex_bytes(other_hex), packet.begin() + static_cast<std::ptrdiff_t>(at));
  const std::uint16_t sum = sum_16(ByteSpan(packet).first(packet.size() - 2));
  packet[packet.size() - 2] = static_cast<std::uint8_t>(sum >> 8U);
  packet[packet.size() - 1] = static_cast<std::uint8_t>(sum & 0xFFU);
  return packet;
}

TEST(Wmr300Quantities, OfThePublishedPacketsAreWhatTheirCommentSays) {
  const auto weather = hid::decode_wmr300_quantities(test::hex_bytes(kWmr300TemperatureHex));
  ASSERT_TRUE(weather.has_value());
  EXPECT_EQ(weather->air_temperature_c, 19.5);
  EXPECT_EQ(weather->relative_humidity_percent, 45.0);
  EXPECT_FALSE(weather->pressure_hpa || weather->rain_total_mm || weather->rain_rate_mm_h);

  const auto rain = hid::decode_wmr300_quantities(test::hex_bytes(kWmr300RainHex));
  ASSERT_TRUE(rain.has_value());
  EXPECT_NEAR(rain->rain_total_mm.value_or(0.0), 1.61 * 25.4, 1e-9);
  EXPECT_EQ(rain->rain_rate_mm_h, 0.0);
  EXPECT_FALSE(rain->air_temperature_c || rain->relative_humidity_percent || rain->pressure_hpa);

  const auto pressure = hid::decode_wmr300_quantities(test::hex_bytes(kWmr300PressureHex));
  ASSERT_TRUE(pressure.has_value());
  EXPECT_EQ(pressure->pressure_hpa, 981.7);
}

TEST(Wmr300Quantities, MayBeNegativeOrMissing) {
  const auto frost = hid::decode_wmr300_quantities(wmr300_changed(kWmr300TemperatureHex, 8, "ff f6"));
  ASSERT_TRUE(frost.has_value());
  EXPECT_EQ(frost->air_temperature_c, -1.0);
  const auto none = hid::decode_wmr300_quantities(wmr300_changed(kWmr300TemperatureHex, 8, "7f ff 7f"));
  EXPECT_FALSE(none && (none->air_temperature_c || none->relative_humidity_percent));
  EXPECT_FALSE(hid::decode_wmr300_quantities(wmr300_changed(kWmr300PressureHex, 8, "7f ff"))->pressure_hpa.has_value());
  const auto dry = hid::decode_wmr300_quantities(wmr300_changed(kWmr300RainHex, 15, "7f ff 7f ff"));
  EXPECT_FALSE(dry->rain_total_mm || dry->rain_rate_mm_h);
}

TEST(Wmr300Quantities, OfOtherSensorsAndPacketsAreNone) {
  for (const std::string channel : {"00", "02", "08", "ff"}) {
    EXPECT_FALSE(hid::decode_wmr300_quantities(wmr300_changed(kWmr300TemperatureHex, 7, channel)).has_value());
  }
  EXPECT_FALSE(hid::decode_wmr300_quantities(wmr300_packet(20, 10, 90)).has_value());
  EXPECT_FALSE(hid::decode_wmr300_quantities(hid::kWmr300Heartbeat).has_value());
  EXPECT_FALSE(hid::decode_wmr300_quantities({}).has_value());
}

TEST(Wmr300Quantities, OfADamagedPacketAreNone) {
  for (const std::string& hex : {kWmr300TemperatureHex, kWmr300RainHex, kWmr300PressureHex}) {
    const auto packet = test::hex_bytes(hex);
    for (std::size_t size = 0; size < packet.size(); ++size)
      EXPECT_FALSE(hid::decode_wmr300_quantities(ByteSpan(packet).first(size)).has_value()) << hex << ": " << size;
    for (std::size_t bit = 0; bit < 8 * packet.size(); ++bit) {
      auto damaged = packet;
      damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1U << (bit % 8)));
      EXPECT_FALSE(hid::decode_wmr300_quantities(damaged).has_value()) << hex << ": " << bit;
    }
    auto report = packet;
    report.resize(64, 0xEE);
    EXPECT_TRUE(hid::decode_wmr300_quantities(report).has_value());
  }
}

// --- Fine Offset

StationBytes fineoffset_record(std::uint8_t average, std::uint8_t gust, std::uint8_t high, std::uint8_t direction,
                               std::uint8_t status) {
  return {5, 45, 200, 0, 58, 120, 0, 0xA4, 0x27, average, gust, high, direction, 0, 0, status};
}

TEST(FineOffsetRecord, HasTwelveBitsOfAverageAndGust) {
  const auto decoded = hid::decode_fineoffset_record(fineoffset_record(0x01, 0x03, 0x21, 15, 0));
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(*decoded, (DecodedWind{.speed_m_s = 25.7, .direction_deg = 337.5, .gust_m_s = 51.5}));
}

TEST(FineOffsetRecord, OfTwentyBytesOrAWholeBlockIsReadAlike) {
  auto record = fineoffset_record(10, 20, 0, 4, 0);
  const auto shortest = hid::decode_fineoffset_record(record);
  ASSERT_TRUE(shortest.has_value());
  for (const std::size_t size : {20U, 32U}) {
    record.resize(size, 0xFF);
    EXPECT_EQ(*hid::decode_fineoffset_record(record), *shortest);
  }
}

TEST(FineOffsetRecord, LeavesOutWhatIsMarkedAsNone) {
  EXPECT_EQ(*hid::decode_fineoffset_record(fineoffset_record(10, 0xFF, 0xF0, 0x80, 0)),
            (DecodedWind{.speed_m_s = 1.0, .direction_deg = {}, .gust_m_s = {}}));
  const auto odd_direction = hid::decode_fineoffset_record(fineoffset_record(10, 20, 0, 16, 0));
  ASSERT_TRUE(odd_direction.has_value());
  EXPECT_FALSE(odd_direction->direction_deg.has_value());
  EXPECT_EQ(odd_direction->status, DecodedStatus::kUncertain);
}

TEST(FineOffsetRecord, IsRefusedInGrades) {
  const auto record = fineoffset_record(10, 20, 0, 4, 0);
  EXPECT_TRUE(test::is_refused_as(hid::decode_fineoffset_record(ByteSpan(record).first(15)), Refusal::kTooShort));
  EXPECT_TRUE(test::is_refused_as(hid::decode_fineoffset_record(StationBytes(33, 1)), Refusal::kMalformed));
  EXPECT_TRUE(test::is_refused_as(hid::decode_fineoffset_record(StationBytes(16, 0)), Refusal::kMalformed));
  EXPECT_TRUE(test::is_refused_as(hid::decode_fineoffset_record(StationBytes(16, 0xFF)), Refusal::kInvalid));
  EXPECT_TRUE(
      test::is_refused_as(hid::decode_fineoffset_record(fineoffset_record(10, 20, 0, 4, 0x40)), Refusal::kInvalid));
  EXPECT_TRUE(test::is_refused_as(hid::decode_fineoffset_record(fineoffset_record(0xFE, 20, 0x0F, 4, 0)),
                                  Refusal::kImplausible));
}

TEST(FineOffsetRecord, HasTheWeatherBesides) {
  auto record = fineoffset_record(10, 20, 0, 4, 0);
  record[13] = 0x02;
  record[14] = 0x01;
  auto said = hid::decode_fineoffset_quantities(record);
  ASSERT_TRUE(said.has_value());
  EXPECT_EQ(said->relative_humidity_percent, 58.0);
  EXPECT_EQ(said->air_temperature_c, 12.0);
  EXPECT_EQ(said->pressure_hpa, 1014.8);
  EXPECT_NEAR(said->rain_total_mm.value_or(0.0), 258 * 0.3, 1e-9);
  EXPECT_FALSE(said->rain_rate_mm_h.has_value());

  // Frost, and values that are not there.
  record[5] = 0x37;
  record[6] = 0x80;
  EXPECT_EQ(hid::decode_fineoffset_quantities(record)->air_temperature_c, -5.5);
  for (const std::size_t at : {4U, 5U, 6U, 7U, 8U}) record[at] = 0xFF;
  said = hid::decode_fineoffset_quantities(record);
  EXPECT_FALSE(said->relative_humidity_percent || said->air_temperature_c || said->pressure_hpa);

  // Without contact the console itself still measures the pressure.
  said = hid::decode_fineoffset_quantities(fineoffset_record(10, 20, 0, 4, 0x40));
  EXPECT_EQ(said->pressure_hpa, 1014.8);
  EXPECT_FALSE(said->air_temperature_c || said->relative_humidity_percent || said->rain_total_mm);
  EXPECT_FALSE(hid::decode_fineoffset_quantities(StationBytes(16, 0)).has_value());
  EXPECT_FALSE(hid::decode_fineoffset_quantities(StationBytes(15, 1)).has_value());
}

TEST(FineOffsetFixedBlock, SaysWhereTheCurrentRecordStands) {
  StationBytes block(32);
  block[0] = 0x55;
  block[1] = 0xAA;
  block[16] = 5;
  block[30] = 0xD0;
  block[31] = 0x56;
  const auto fixed = hid::decode_fineoffset_fixed_block(block, hid::FineOffsetModel::kWh1080);
  ASSERT_TRUE(fixed.has_value());
  EXPECT_EQ(fixed->current_position, 0x56D0);
  EXPECT_EQ(hid::decode_fineoffset_fixed_block(block, hid::FineOffsetModel::kWh3080).error(), Refusal::kImplausible);
  EXPECT_EQ(hid::decode_fineoffset_fixed_block(ByteSpan(block).first(31), hid::FineOffsetModel::kWh1080).error(),
            Refusal::kTooShort);
  block[1] = 0xAB;
  EXPECT_EQ(hid::decode_fineoffset_fixed_block(block, hid::FineOffsetModel::kWh1080).error(), Refusal::kMalformed);
}

TEST(FineOffsetFixedBlock, OfARealConsoleDecodes) {
  std::ifstream in(test::source_path("../shared/data/hid/fineoffset_fixed_block_pywws.txt"));
  if (!in) GTEST_SKIP() << "../shared/data/hid/fineoffset_fixed_block_pywws.txt is not here";
  StationBytes block;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const auto bytes = test::hex_bytes(line.substr(line.find(' ') + 1));
    block.insert(block.end(), bytes.begin(), bytes.end());
  }
  ASSERT_EQ(block.size(), 256U);
  const auto fixed = hid::decode_fineoffset_fixed_block(block, hid::FineOffsetModel::kWh1080);
  ASSERT_TRUE(fixed.has_value());
  EXPECT_EQ(fixed->read_period_min, 5);
  EXPECT_EQ(fixed->record_count, 0x0107);
  EXPECT_EQ(fixed->current_position, 0x56D0);
}

TEST(FineOffsetRead, AsksForAPosition) {
  EXPECT_EQ(bytes_from(hid::encode_fineoffset_read(0x56D0)), test::hex_bytes("a1 56 d0 20 a1 56 d0 20"));
}

TEST(FineOffsetVectors, OfTheSharedCollectionDecodeAsTheySay) {
  const auto vectors = test::load_byte_vectors(kStationVectors, "Fine Offset WH1080 1941");
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/hid_vectors.json is not here";
  for (const auto& vector : vectors) {
    const auto decoded = hid::decode_fineoffset_record(test::hex_bytes(vector["bytes"]));
    if (vector["expect"]["status_lost"].get<bool>()) {
      EXPECT_TRUE(test::is_refused_as(decoded, Refusal::kInvalid));
      continue;
    }
    ASSERT_TRUE(decoded.has_value());
    EXPECT_EQ(decoded->speed_m_s, expected_number(vector, "avg_ms"));
    EXPECT_EQ(decoded->gust_m_s, expected_number(vector, "gust_ms"));
    EXPECT_EQ(decoded->direction_deg, expected_number(vector, "dir_deg"));
  }
}

// --- AcuRite

TEST(AcuriteReport, HasADirectionInEverySecondOne) {
  const auto with_direction = hid::decode_acurite(test::hex_bytes("01 11 22 71 01 2e 00 00 02 00"));
  ASSERT_TRUE(with_direction.has_value());
  EXPECT_NEAR(*with_direction->speed_m_s, (0.8278 * 10 + 1.0) / 3.6, 1e-12);
  EXPECT_EQ(with_direction->direction_deg, 22.5);
  const auto without = hid::decode_acurite(test::hex_bytes("01 11 22 78 01 2e 00 00 02 00"));
  ASSERT_TRUE(without.has_value());
  EXPECT_EQ(without->speed_m_s, with_direction->speed_m_s);
  EXPECT_FALSE(without->direction_deg.has_value());
}

TEST(AcuriteReport, OfALowBatteryIsUncertain) {
  EXPECT_EQ(hid::decode_acurite(test::hex_bytes("01 11 22 b1 01 2e 00 00 02 00"))->status, DecodedStatus::kUncertain);
}

TEST(AcuriteReport, IsRefusedInGrades) {
  const auto report = test::hex_bytes("01 11 22 71 01 2e 00 00 02 00");
  EXPECT_TRUE(test::is_refused_as(hid::decode_acurite(ByteSpan(report).first(9)), Refusal::kTooShort));
  EXPECT_TRUE(test::is_refused_as(hid::decode_acurite({}), Refusal::kTooShort));
  EXPECT_TRUE(
      test::is_refused_as(hid::decode_acurite(test::hex_bytes("02 11 22 71 01 2e 00 00 02 00")), Refusal::kNotMine));
  EXPECT_TRUE(test::is_refused_as(hid::decode_acurite(test::hex_bytes("01 11 22 71 01 2e 00 00 02 00 00")),
                                  Refusal::kMalformed));
  EXPECT_TRUE(
      test::is_refused_as(hid::decode_acurite(test::hex_bytes("01 11 22 73 01 2e 00 00 02 00")), Refusal::kMalformed));
  EXPECT_TRUE(
      test::is_refused_as(hid::decode_acurite(test::hex_bytes("01 11 22 71 01 2e 00 00 02 01")), Refusal::kMalformed));
  EXPECT_TRUE(
      test::is_refused_as(hid::decode_acurite(test::hex_bytes("01 11 22 71 01 2e 00 00 04 00")), Refusal::kMalformed));
  EXPECT_TRUE(
      test::is_refused_as(hid::decode_acurite(test::hex_bytes("01 17 f5 e3 01 81 21 c9 09 00")), Refusal::kMalformed));
  EXPECT_TRUE(
      test::is_refused_as(hid::decode_acurite(test::hex_bytes("01 11 22 71 01 2e 00 00 00 00")), Refusal::kInvalid));
}

// The reports are quoted in the comment of weewx acurite.py.

TEST(AcuriteQuantities, AreTemperatureAndHumidityOrRainByTurns) {
  const auto weather = hid::decode_acurite_quantities(test::hex_bytes("01 c0 5c 78 00 08 1f 53 03 ff"));
  ASSERT_TRUE(weather.has_value());
  EXPECT_NEAR(weather->air_temperature_c.value_or(0.0), 1055.0 / 18.0 - 40.0, 1e-12);
  EXPECT_EQ(weather->relative_humidity_percent, 83.0);
  EXPECT_FALSE(weather->rain_total_mm.has_value());

  const auto rain = hid::decode_acurite_quantities(test::hex_bytes("01 c0 5c 71 00 05 00 0c 03 ff"));
  ASSERT_TRUE(rain.has_value());
  EXPECT_NEAR(rain->rain_total_mm.value_or(0.0), 12 * 0.254, 1e-12);
  EXPECT_FALSE(rain->air_temperature_c || rain->relative_humidity_percent);
}

TEST(AcuriteQuantities, HaveThirteenBitsOfTipsAndNoParity) {
  const auto rain = hid::decode_acurite_quantities(test::hex_bytes("01 cd ff 71 00 6c 39 71 03 ff"));
  EXPECT_NEAR(rain.value().rain_total_mm.value_or(0.0), (0x39 * 128 + 0x71) * 0.254, 1e-9);
  EXPECT_EQ(hid::decode_acurite_quantities(test::hex_bytes("01 cd ff 71 00 6c f9 f1 03 ff"))->rain_total_mm,
            rain->rain_total_mm);
  const auto frost = hid::decode_acurite_quantities(test::hex_bytes("01 cd ff 78 00 60 80 81 03 ff"));
  EXPECT_EQ(frost.value().air_temperature_c, -40.0);
  EXPECT_EQ(frost->relative_humidity_percent, 1.0);
}

TEST(AcuriteQuantities, OfNoSensorALostLinkOrAnUnknownReportAreNone) {
  for (const char* hex :
       {"01 cf ff ff ff ff ff ff 00 00", "01 ff ff ff ff ff ff ff ff 00", "01 8b fa 71 00 06 00 0c 00 00",
        "01 8b fa 73 00 08 75 24 01 00", "01 8b fa 78 00 08 75 24 01 01", "01 8b fa 78 00 08 75 24 01",
        "02 8b fa 78 00 08 75 24 01 00", "01 8b fa 78 00 08 75 24 01 00 00", ""}) {
    EXPECT_FALSE(hid::decode_acurite_quantities(test::hex_bytes(hex)).has_value()) << hex;
  }
}

TEST(AcuriteVectors, OfTheSharedCollectionDecodeAsTheySay) {
  const auto vectors = test::load_byte_vectors(kStationVectors, "AcuRite");
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/hid_vectors.json is not here";
  for (const auto& vector : vectors) {
    SCOPED_TRACE(vector["bytes"].get<std::string>());
    const auto decoded = hid::decode_acurite(test::hex_bytes(vector["bytes"]));
    if (!vector["expect"]["valid"].get<bool>()) {
      EXPECT_TRUE(test::is_refused_as(decoded, Refusal::kInvalid));
      continue;
    }
    ASSERT_TRUE(decoded.has_value());
    EXPECT_NEAR(*decoded->speed_m_s, vector["expect"]["speed_ms"].get<double>(), 5e-5);
    EXPECT_EQ(decoded->direction_deg, expected_number(vector, "dir_deg"));
  }
}

// --- TE923

/// A block with these six bytes from 26 on (gust, speed, direction) and its check byte.
StationBytes te923_block(const std::string& wind_hex) {
  StationBytes block(hid::kTe923Block, 0x11);
  block[0] = 0x5A;
  const auto wind = test::hex_bytes(wind_hex);
  std::ranges::copy(wind, block.begin() + 26);
  block[33] = 0;
  block[33] = xor_8(block);
  return block;
}

TEST(Te923Block, GivesMilesAnHourInDecimalDigits) {
  const auto decoded = hid::decode_te923(te923_block("23 01 87 00 fc"));
  ASSERT_TRUE(decoded.has_value());
  EXPECT_NEAR(*decoded->gust_m_s, 12.3 * 0.44704, 1e-12);
  EXPECT_NEAR(*decoded->speed_m_s, 8.7 * 0.44704, 1e-12);
  EXPECT_EQ(decoded->direction_deg, 270.0);
  EXPECT_NEAR(*hid::decode_te923(te923_block("00 00 50 12 00"))->speed_m_s, 125.0 * 0.44704, 1e-12);
}

TEST(Te923Block, WithoutAGustIsStillWindAndWithoutASpeedNone) {
  const auto decoded = hid::decode_te923(te923_block("ee 8e 87 00 04"));
  ASSERT_TRUE(decoded.has_value());
  EXPECT_FALSE(decoded->gust_m_s.has_value());
  EXPECT_TRUE(test::is_refused_as(hid::decode_te923(te923_block("23 01 ee 8e 04")), Refusal::kInvalid));
  EXPECT_TRUE(test::is_refused_as(hid::decode_te923(te923_block("23 01 ff ff 04")), Refusal::kInvalid));
  EXPECT_TRUE(test::is_refused_as(hid::decode_te923(te923_block("23 01 1a 00 04")), Refusal::kInvalid));
}

TEST(Te923Block, IsRefusedInGrades) {
  const auto block = te923_block("23 01 87 00 0c");
  EXPECT_TRUE(test::is_refused_as(hid::decode_te923({}), Refusal::kTooShort));
  EXPECT_TRUE(test::is_refused_as(hid::decode_te923(ByteSpan(block).first(33)), Refusal::kTooShort));
  EXPECT_TRUE(test::is_refused_as(hid::decode_te923(ByteSpan(block).subspan(1)), Refusal::kMalformed));
  auto longer = block;
  longer.push_back(0);
  EXPECT_TRUE(test::is_refused_as(hid::decode_te923(longer), Refusal::kMalformed));
  for (std::size_t bit = 8; bit < 8 * block.size(); ++bit) {
    auto damaged = block;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_TRUE(test::is_refused_as(hid::decode_te923(damaged), Refusal::kBadChecksum)) << bit;
  }
}

/// A block with no wind, whose bytes from `at` on are these.
StationBytes te923_block_with(std::size_t at, const std::string& hex) {
  auto block = te923_block("ee 8e ee 8e 00");
  std::ranges::copy(test::hex_bytes(hex), block.begin() + static_cast<std::ptrdiff_t>(at));
  block[33] = 0;
  block[33] = xor_8(block);
  return block;
}

TEST(Te923Quantities, AreOfChannelOneTheConsoleAndTheRainGauge) {
  auto said = hid::decode_te923_quantities(te923_block_with(4, "96 c1 58"));
  ASSERT_TRUE(said.has_value());
  EXPECT_EQ(said->air_temperature_c, 19.6);
  EXPECT_EQ(said->relative_humidity_percent, 58.0);
  EXPECT_EQ(hid::decode_te923_quantities(te923_block_with(4, "96 e1 58"))->air_temperature_c, 19.65);
  EXPECT_EQ(hid::decode_te923_quantities(te923_block_with(4, "96 61 58"))->air_temperature_c, -19.65);
  EXPECT_EQ(hid::decode_te923_quantities(te923_block_with(21, "54 3f"))->pressure_hpa, 1013.25);
  EXPECT_NEAR(*hid::decode_te923_quantities(te923_block_with(31, "24 01"))->rain_total_mm, 292 * 25.4 / 36.0, 1e-9);
}

TEST(Te923Quantities, LeaveOutWhatIsMarkedAsNone) {
  for (const char* none : {"9a c1", "a6 c1", "96 ca", "96 81", "ff ff", "ee 8e"}) {
    EXPECT_FALSE(hid::decode_te923_quantities(te923_block_with(4, none))->air_temperature_c.has_value()) << none;
  }
  for (const char* none : {"5a", "a5", "ff"}) {
    EXPECT_FALSE(hid::decode_te923_quantities(te923_block_with(6, none))->relative_humidity_percent.has_value())
        << none;
  }
  EXPECT_FALSE(hid::decode_te923_quantities(te923_block_with(21, "ff ff"))->pressure_hpa.has_value());
  EXPECT_FALSE(hid::decode_te923_quantities(te923_block_with(21, "00 f0"))->pressure_hpa.has_value());
}

TEST(Te923Quantities, OfADamagedBlockAreNone) {
  const auto block = te923_block_with(4, "96 c1 58");
  for (std::size_t size = 0; size < block.size(); ++size)
    EXPECT_FALSE(hid::decode_te923_quantities(ByteSpan(block).first(size)).has_value()) << size;
  for (std::size_t bit = 0; bit < 8 * block.size(); ++bit) {
    auto damaged = block;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_FALSE(hid::decode_te923_quantities(damaged).has_value()) << bit;
  }
}

TEST(Te923Request, CarriesAddressAndCheckByte) {
  EXPECT_EQ(bytes_from(hid::encode_te923_request(hid::kTe923Readings)), test::hex_bytes("05 af 01 00 02 ac 00 00"));
  EXPECT_EQ(bytes_from(hid::encode_te923_acknowledgement(hid::kTe923Readings)),
            test::hex_bytes("24 af 01 00 02 ac 00 00"));
}

// --- all

TEST(StationDecoders, LeaveOutAGustBelowTheSpeed) {
  EXPECT_EQ(*hid::decode_wmr300(wmr300_packet(255, 256, 359)),
            (DecodedWind{.speed_m_s = 25.6, .direction_deg = 359.0, .gust_m_s = {}}));
  const auto fineoffset = hid::decode_fineoffset_record(fineoffset_record(50, 49, 0, 4, 0));
  EXPECT_EQ(fineoffset->speed_m_s, 5.0);
  EXPECT_FALSE(fineoffset->gust_m_s);
  EXPECT_EQ(hid::decode_fineoffset_record(fineoffset_record(50, 50, 0, 4, 0))->gust_m_s, 5.0);
}

TEST(StationDecoders, GiveNoWindOutOfRangeForRandomBytes) {
  std::mt19937_64 random(20240605);
  for (int round = 0; round < 100'000; ++round) {
    auto bytes = test::random_bytes(random, random() % 66);
    // Heads and sums as they should be, so that values are reached.
    const bool is_mended = random() % 2 == 0;
    for (const int head : {0xD4, 0x5A, 0x01}) {
      if (is_mended && bytes.size() >= 2) bytes[0] = static_cast<std::uint8_t>(head);
      if (is_mended && head == 0xD4 && bytes.size() >= hid::kWmr300WindPacket) {
        bytes[1] = 54;
        const auto sum = sum_16(ByteSpan(bytes).first(52));
        bytes[52] = static_cast<std::uint8_t>(sum >> 8U);
        bytes[53] = static_cast<std::uint8_t>(sum & 0xFFU);
      }
      if (is_mended && head == 0x5A && bytes.size() >= hid::kTe923Block) {
        bytes.resize(hid::kTe923Block);
        bytes[33] = static_cast<std::uint8_t>(bytes[33] ^ xor_8(bytes));
      }
      if (is_mended && head == 0x01 && bytes.size() >= hid::kAcuriteReport1) bytes.resize(hid::kAcuriteReport1);
      EXPECT_TRUE(test::is_refused_or_physical(hid::decode_wmr300(bytes)));
      EXPECT_TRUE(test::is_refused_or_physical(hid::decode_te923(bytes)));
      EXPECT_TRUE(test::is_refused_or_physical(hid::decode_acurite(bytes)));
      EXPECT_TRUE(test::is_refused_or_physical(hid::decode_fineoffset_record(bytes)));
    }
  }
}

}  // namespace
}  // namespace yuragi::drivers::decode
