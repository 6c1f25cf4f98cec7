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
const DecodedWind kWmr100Wind = {.speed_m_s = 4.6, .direction_deg = 225.0, .gust_m_s = 2.2};

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
  // 25.7 m/s gust and 27.5 average need the nibbles of byte 5; 90 degrees.
  const auto decoded = hid::decode_wmr100_frame(test::hex_bytes("00 48 04 0c 01 31 11 00 20 bb 00"));
  ASSERT_TRUE(decoded.has_value());
  EXPECT_EQ(*decoded, (DecodedWind{.speed_m_s = 27.5, .direction_deg = 90.0, .gust_m_s = 25.7}));
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
        EXPECT_EQ(decoded->gust_m_s, vector["expect"]["gust_ms"].get<double>());
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
    EXPECT_LE(stream.size, hid::kWmr100LongestFrame + 1);
    if (!result) continue;
    EXPECT_TRUE(test::is_refused_or_physical(*result));
  }
}

}  // namespace
}  // namespace yuragi::drivers::decode
