#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/decode/hid/wmr100.hpp"
#include "tests/support/byte_vectors.hpp"
#include "tests/support/decoded_winds.hpp"

namespace yuragi::drivers::decode {
namespace {

using test::hex_bytes;
using test::is_refused_as;
using Wmr100Results = std::vector<Result<DecodedWind, Refusal>>;

const std::string kWmr100WindHex = "00 48 0a 0c 16 e0 02 00 20 76 01";
/// Its gust, 2.2 m/s, is below its average and left out.
const DecodedWind kWmr100Wind = {.speed_m_s = 4.6, .direction_deg = 225.0, .gust_m_s = {}};

/// All that a stream gives, to its end.
Wmr100Results read_wmr100(const std::string& hex) {
  Wmr100Results results;
  hid::Wmr100Stream stream;
  for (const std::uint8_t byte : test::hex_bytes(hex)) {
    if (const auto result = hid::take_wmr100_byte(stream, byte)) results.push_back(*result);
  }
  if (const auto result = hid::finish_wmr100(stream)) results.push_back(*result);
  return results;
}

/// Wind and refusals' names, in a line.
std::vector<std::string> names_of(const Wmr100Results& results) {
  std::vector<std::string> names;
  for (const auto& result : results) {
    names.emplace_back(result ? (*result == kWmr100Wind ? "wind" : "another wind") : name_of(result.error()));
  }
  return names;
}

using testing::ElementsAre;

TEST(Wmr100Frame, OfThePublishedExampleIsItsWind) {
  const auto decoded = hid::decode_wmr100_frame(test::hex_bytes(kWmr100WindHex));
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(*decoded, kWmr100Wind);
}

TEST(Wmr100Frame, HasTwelveBitsOfGustAndAverage) {
  // 27.5 m/s gust and 25.7 average need the nibbles of byte 5; 90 degrees.
  const auto decoded = hid::decode_wmr100_frame(test::hex_bytes("00 48 04 0c 13 11 10 00 20 ac 00"));
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(*decoded, (DecodedWind{.speed_m_s = 25.7, .direction_deg = 90.0, .gust_m_s = 27.5}));
}

/// A frame and its sum.
std::vector<std::uint8_t> wmr100_summed(const std::string& hex) {
  auto frame = hex_bytes(hex);
  const std::uint16_t sum = sum_16(frame);
  frame.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
  frame.push_back(static_cast<std::uint8_t>(sum >> 8U));
  return frame;
}

TEST(Wmr100Frame, LeavesOutAGustBelowTheAverageAndKeepsOneThatIsAsStrong) {
  EXPECT_FALSE(hid::decode_wmr100_frame(hex_bytes(kWmr100WindHex))->gust_m_s.has_value());
  EXPECT_FALSE(hid::decode_wmr100_frame(wmr100_summed("00 48 0a 0c 2d e0 02 00 20"))->gust_m_s.has_value());
  EXPECT_EQ(hid::decode_wmr100_frame(wmr100_summed("00 48 0a 0c 2e e0 02 00 20"))->gust_m_s, 4.6);
  EXPECT_EQ(hid::decode_wmr100_frame(wmr100_summed("00 48 0a 0c 2f e0 02 00 20"))->gust_m_s, 4.7);
}

// The first of each kind is quoted by ejeklint/WLoggerDaemon.

TEST(Wmr100Quantities, OfTheOutdoorSensorAreTemperatureAndHumidity) {
  auto said = hid::decode_wmr100_quantities(hex_bytes("20 42 d1 91 00 48 64 00 00 20 90 02"));
  ASSERT_TRUE(said.has_value());
  EXPECT_EQ(said->air_temperature_c, 14.5);
  EXPECT_EQ(said->relative_humidity_percent, 72.0);
  EXPECT_FALSE(said->pressure_hpa || said->rain_total_mm || said->rain_rate_mm_h || said->vertical_speed_m_s);

  said = hid::decode_wmr100_quantities(wmr100_summed("20 42 01 91 80 48 64 00 00 20"));  // frost
  ASSERT_TRUE(said.has_value());
  EXPECT_EQ(said->air_temperature_c, -14.5);
}

TEST(Wmr100Quantities, OfOtherSensorsAreNone) {
  for (const std::string channel : {"d0", "d2", "d8", "df"}) {
    EXPECT_FALSE(hid::decode_wmr100_quantities(wmr100_summed("20 42 " + channel + " 91 00 48 64 00 00 20")).has_value())
        << channel;
  }
  EXPECT_FALSE(hid::decode_wmr100_quantities(hex_bytes("00 47 05 4c 00")).has_value());      // UV
  EXPECT_FALSE(hid::decode_wmr100_quantities(wmr100_summed("20 44 d1 91 00")).has_value());  // water
  EXPECT_FALSE(hid::decode_wmr100_quantities(hex_bytes(kWmr100WindHex)).has_value());
}

TEST(Wmr100Quantities, ArePressureAtTheStation) {
  EXPECT_EQ(hid::decode_wmr100_quantities(hex_bytes("00 46 ed 03 ed 33 56 02"))->pressure_hpa, 1005.0);
  // A forecast in the high nibble, and 1013 hPa at sea level.
  EXPECT_EQ(hid::decode_wmr100_quantities(wmr100_summed("00 46 b0 33 f5 03"))->pressure_hpa, 944.0);
}

TEST(Wmr100Quantities, AreTheRainSinceItWasReset) {
  const auto said = hid::decode_wmr100_quantities(hex_bytes("00 41 ff 02 0c 00 00 00 25 00 00 0c 01 01 06 87 01"));
  ASSERT_TRUE(said.has_value());
  EXPECT_NEAR(said->rain_total_mm.value_or(0.0), 0.37 * 25.4, 1e-9);
  EXPECT_FALSE(said->rain_rate_mm_h.has_value()) << "sources differ about it";
}

TEST(Wmr100Quantities, OfADamagedFrameAreNone) {
  for (const std::string hex : {"20 42 d1 91 00 48 64 00 00 20 90 02", "00 46 ed 03 ed 33 56 02",
                                "00 41 ff 02 0c 00 00 00 25 00 00 0c 01 01 06 87 01"}) {
    const auto frame = hex_bytes(hex);
    for (std::size_t size = 0; size < frame.size(); ++size)
      EXPECT_FALSE(hid::decode_wmr100_quantities(ByteSpan(frame).first(size)).has_value()) << hex << ": " << size;
    for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit) {
      auto damaged = frame;
      damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1U << (bit % 8)));
      EXPECT_FALSE(hid::decode_wmr100_quantities(damaged).has_value()) << hex << ": " << bit;
    }
    // Its sum is right, its length is not.
    auto longer = frame;
    longer.resize(frame.size() - 2);
    longer.push_back(0);
    const std::uint16_t sum = sum_16(longer);
    longer.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
    longer.push_back(static_cast<std::uint8_t>(sum >> 8U));
    EXPECT_FALSE(hid::decode_wmr100_quantities(longer).has_value()) << hex;
  }
}

TEST(Wmr100Frame, OfALowBatteryIsUncertain) {
  const auto decoded = hid::decode_wmr100_frame(test::hex_bytes("40 48 0a 0c 16 e0 02 00 20 b6 01"));
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(decoded->status, DecodedStatus::kUncertain);
}

TEST(Wmr100Frame, IsRefusedInGrades) {
  EXPECT_TRUE(test::is_refused_as(hid::decode_wmr100_frame({}), Refusal::kTooShort));
  EXPECT_TRUE(test::is_refused_as(hid::decode_wmr100_frame(test::hex_bytes("00 48 0a 0c 16 e0 02 00 20 76")),
                                  Refusal::kTooShort));
  EXPECT_TRUE(test::is_refused_as(hid::decode_wmr100_frame(test::hex_bytes("00 48 0a 0c 16 e0 02 00 20 77 01")),
                                  Refusal::kBadChecksum));
  EXPECT_TRUE(
      test::is_refused_as(hid::decode_wmr100_frame(test::hex_bytes("00 46 ed 03 ed 33 56 02")), Refusal::kNotMine));
  EXPECT_TRUE(test::is_refused_as(hid::decode_wmr100_frame(test::hex_bytes("00 48 0a 0c 16 e0 02 00 20 00 76 01")),
                                  Refusal::kMalformed));
  // 409.5 m/s on average
  EXPECT_TRUE(test::is_refused_as(hid::decode_wmr100_frame(test::hex_bytes("00 48 0a 0c 16 f0 ff 00 20 83 02")),
                                  Refusal::kImplausible));
}

TEST(Wmr100Frame, WithAnyBitFlippedIsRefused) {
  for (std::size_t bit = 0; bit < 88; ++bit) {
    auto damaged = test::hex_bytes(kWmr100WindHex);
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_TRUE(test::is_refused_as(hid::decode_wmr100_frame(damaged), Refusal::kBadChecksum)) << bit;
  }
}

TEST(Wmr100Report, GivesItsValidBytesAndNeverMoreThanItHas) {
  const auto bytes_of = [](const std::string& hex) {
    const auto report = test::hex_bytes(hex);
    const auto valid = hid::wmr100_report_bytes(report);
    return std::vector<std::uint8_t>(valid.begin(), valid.end());
  };
  EXPECT_EQ(bytes_of("02 00 47 30 01 0c 01 00"), test::hex_bytes("00 47"));
  EXPECT_EQ(bytes_of("ff 01 02 03 04 05 06 07"), test::hex_bytes("01 02 03 04 05 06 07"));
  EXPECT_EQ(bytes_of("07 01 02"), test::hex_bytes("01 02"));
  EXPECT_EQ(bytes_of("00 01 02"), test::hex_bytes(""));
  EXPECT_EQ(bytes_of(""), test::hex_bytes(""));
}

TEST(Wmr100Stream, GivesWindAtItsLastByte) {
  hid::Wmr100Stream stream;
  const auto bytes = test::hex_bytes("ff ff " + kWmr100WindHex);
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i)
    EXPECT_FALSE(hid::take_wmr100_byte(stream, bytes[i]).has_value()) << i;
  EXPECT_EQ(**hid::take_wmr100_byte(stream, bytes.back()), kWmr100Wind);
  EXPECT_FALSE(hid::take_wmr100_byte(stream, 0xFF).has_value());
  EXPECT_FALSE(hid::take_wmr100_byte(stream, 0xFF).has_value());
}

TEST(Wmr100Stream, NeedsNoGapBeforeItsFirstFrameNorBehindItsLast) {
  EXPECT_THAT(names_of(read_wmr100(kWmr100WindHex)), ElementsAre("wind"));
  EXPECT_THAT(names_of(read_wmr100("00 47 08 4f 00")), ElementsAre("not mine"));
  EXPECT_THAT(names_of(read_wmr100("")), ElementsAre());
}

TEST(Wmr100Stream, TakesOneFfForDataAndManyForOneGap) {
  EXPECT_THAT(names_of(read_wmr100("00 47 ff 46 01 ff ff ff ff ff " + kWmr100WindHex)),
              ElementsAre("not mine", "wind"));
}

TEST(Wmr100Stream, ReadsTheFrameBehindTheNextGapWhateverIsBroken) {
  const std::string good = " ff ff " + kWmr100WindHex + " ff ff";
  EXPECT_THAT(names_of(read_wmr100("0c 16 e0 02 00 20 76 01" + good)), ElementsAre("bad checksum", "wind"));  // a tail
  EXPECT_THAT(names_of(read_wmr100("00 48 0a 0c" + good)), ElementsAre("too short", "wind"));
  EXPECT_THAT(names_of(read_wmr100("00 48 0a 0c 16 e0 02 00 20 76" + good)), ElementsAre("bad checksum", "wind"));
  EXPECT_THAT(names_of(read_wmr100("00 48 0a 0c 16 e0 02 00 20 ff ff" + good)), ElementsAre("too short", "wind"));
  EXPECT_THAT(names_of(read_wmr100("00 48 0a 0c 16 e0 02 00 20 77 01" + good)), ElementsAre("bad checksum", "wind"));
  EXPECT_THAT(names_of(read_wmr100(kWmr100WindHex + " 11 22 33" + good)), ElementsAre("wind", "wind"));
}

TEST(Wmr100Stream, ShowsTheFrameThatHasJustEnded) {
  hid::Wmr100Stream stream;
  std::vector<std::vector<std::uint8_t>> ended;
  const auto look = [&](bool has_ended) {
    const ByteSpan frame = hid::ended_wmr100_frame(stream);
    EXPECT_EQ(!frame.empty(), has_ended);
    if (has_ended) ended.emplace_back(frame.begin(), frame.end());
  };
  const std::string pressure = "00 46 ed 03 ed 33 56 02";
  for (const std::uint8_t byte : hex_bytes(pressure + " ff ff ff " + kWmr100WindHex + " ff ff 20 42 d1 91")) {
    look(hid::take_wmr100_byte(stream, byte).has_value());
  }
  look(hid::finish_wmr100(stream).has_value());
  look(hid::finish_wmr100(stream).has_value());
  EXPECT_THAT(ended, ElementsAre(hex_bytes(pressure), hex_bytes(kWmr100WindHex), hex_bytes("20 42 d1 91")));
}

TEST(Wmr100Stream, EndsAFrameWithoutEnd) {
  std::string endless = "00 41";
  for (int i = 0; i < 1000; ++i) endless += " 01";
  EXPECT_THAT(names_of(read_wmr100(endless + " ff ff " + kWmr100WindHex)), ElementsAre("malformed", "wind"));
}

TEST(Wmr100Stream, TakesTheLongestFrameWhole) {
  // Rain: 17 bytes, of which 13 ones.
  const std::string rain = "00 41 01 01 01 01 01 01 01 01 01 01 01 01 01 4e 00";
  EXPECT_THAT(names_of(read_wmr100("ff ff " + rain + " ff ff " + kWmr100WindHex)), ElementsAre("not mine", "wind"));
}

TEST(Wmr100Vectors, OfTheSharedCollectionDecodeAsTheySay) {
  const auto vectors = test::load_byte_vectors("hid_vectors.json", "WMR100");
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/hid_vectors.json is not here";

  int checked_count = 0;
  for (const auto& vector : vectors) {
    const std::string layer = vector["layer"];
    const std::string hex = vector["bytes"];
    SCOPED_TRACE(testing::Message() << layer << ": " << hex);
    if (layer.starts_with("frame")) {
      const auto decoded = hid::decode_wmr100_frame(test::hex_bytes(hex));
      if (vector["expect"].contains("type")) {
        EXPECT_TRUE(test::is_refused_as(decoded, Refusal::kNotMine));
      } else {
        ASSERT_TRUE(decoded.has_value());
        EXPECT_EQ(decoded->speed_m_s, vector["expect"]["avg_ms"].get<double>());
        // The collection has the number as it stands there; one below the average is no gust.
        const double gust_m_s = vector["expect"]["gust_ms"];
        EXPECT_EQ(decoded->gust_m_s, gust_m_s < *decoded->speed_m_s ? std::nullopt : std::optional(gust_m_s));
        EXPECT_EQ(decoded->direction_deg, vector["expect"]["dir_deg"].get<double>());
      }
      ++checked_count;
    } else if (layer.starts_with("byte stream")) {
      // The tail of a frame, the one that is expected (UV), the head of another.
      EXPECT_THAT(names_of(read_wmr100(hex)), ElementsAre("too short", "not mine", "too short"));
      ++checked_count;
    } else if (layer.starts_with("8-byte HID report")) {
      const auto report = test::hex_bytes(hex);
      const auto valid = hid::wmr100_report_bytes(report);
      EXPECT_EQ((std::vector<std::uint8_t>(valid.begin(), valid.end())),
                test::hex_bytes(vector["expect"]["valid_bytes"]));
      ++checked_count;
    } else if (vector["device"] == "WMR100 init") {
      EXPECT_EQ((std::vector<std::uint8_t>(hid::kWmr100Start.begin(), hid::kWmr100Start.end())), test::hex_bytes(hex));
      ++checked_count;
    }
  }
  EXPECT_EQ(checked_count, 6);
}

TEST(Wmr100Stream, OfRandomBytesGivesNoWindOutOfRange) {
  std::mt19937_64 random(20240604);
  hid::Wmr100Stream stream;
  for (int i = 0; i < 500'000; ++i) {
    // Many gaps and wind frames' beginnings, so that frames do come together.
    const auto choice = random() % 8;
    const auto byte = choice == 0 ? 0xFFU : choice == 1 ? 0x48U : static_cast<unsigned>(random() & 0xFFU);
    const auto result = hid::take_wmr100_byte(stream, static_cast<std::uint8_t>(byte));
    EXPECT_LE(hid::ended_wmr100_frame(stream).size(), hid::kWmr100LongestFrame + 1);
    EXPECT_LE(stream.size, hid::kWmr100LongestFrame + 1);
    if (!result) continue;
    EXPECT_TRUE(test::is_refused_or_physical(*result));
  }
}

}  // namespace
}  // namespace yuragi::drivers::decode
