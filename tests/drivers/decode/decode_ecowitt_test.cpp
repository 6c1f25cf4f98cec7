// Replies of real gateways that others have published, replies made after the maker's document, and what is left of
// them when they are hurt.
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/decode/network/ecowitt.hpp"
#include "drivers/decode/network/ecowitt_gateway.hpp"
#include "tests/support/byte_vectors.hpp"
#include "tests/support/decoded_winds.hpp"

namespace yuragi::drivers::decode::network {
namespace {

using test::hex_bytes;
using test::is_refused_as;

using ReplyBytes = std::vector<std::uint8_t>;

/// hkskoglund/gw, lib/binary.sh: a GW1000 with a WH65 in a calm, and sensors of soil, leaks and channels.
const std::string kCalmReply =
    "ff ff 27 00 53 01 00 e1 06 25 08 27 b3 09 27 c2 02 00 05 07 5d 0a 01 59 0b 00 00 0c 00 00 15 00 00 93 bc 16 00 20 "
    "17 00 2c 12 1a 00 87 22 32 1b 00 b0 23 27 1c 00 dd 24 31 58 00 19 00 47 0e 00 00 10 00 08 11 00 42 12 00 00 02 9a "
    "13 00 00 0f 8b 0d 00 42 63";
/// gjr80/weewx-gw1000, tests/test_gw1000.py: a GW1000 without an anemometer.
const std::string kReplyWithoutWind =
    "ff ff 27 00 40 01 01 40 06 26 08 27 d2 09 27 d2 2a 00 5a 4d 00 65 2c 27 2e 14 1a 00 ed 22 3a 1b 01 0b 23 3a 4c 06 "
    "00 00 00 05 ff ff 00 f6 ff ff ff ff ff ff ff 62 00 00 00 00 61 ff ff ff ff 60 ff ec";

/// A reply of these items, with its size and checksum.
ReplyBytes reply_of(const std::string& items) {
  const ReplyBytes values = hex_bytes(items);
  const std::size_t size = values.size() + 4;
  ReplyBytes reply = hex_bytes("ff ff 27");
  reply.push_back(static_cast<std::uint8_t>(size >> 8U));
  reply.push_back(static_cast<std::uint8_t>(size & 0xFFU));
  for (const std::uint8_t value : values) reply.push_back(value);
  unsigned sum = 0;
  for (std::size_t i = 2; i < reply.size(); ++i) sum += reply[i];
  reply.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
  return reply;
}

/// The wind in a reply, or why it has none.
Result<DecodedWind, Refusal> wind_in_reply(const ReplyBytes& reply) {
  const auto values = decode_ecowitt(reply);
  if (!values) return values.error();
  return values->wind;
}

TEST(Ecowitt, ReadsAGatewayInACalm) {
  const auto values = decode_ecowitt(hex_bytes(kCalmReply));
  ASSERT_TRUE(values.has_value());
  EXPECT_EQ(*values->wind, (DecodedWind{.speed_m_s = 0.0, .direction_deg = 345.0, .gust_m_s = 0.0}));
  EXPECT_NEAR(values->quantities.air_temperature_c.value(), 0.5, 1e-9);
  EXPECT_EQ(values->quantities.relative_humidity_percent, 93.0);
  EXPECT_NEAR(values->quantities.pressure_hpa.value(), 1016.3, 1e-9);
  EXPECT_EQ(values->quantities.rain_rate_mm_h, 0.0);
  EXPECT_NEAR(values->quantities.rain_total_mm.value(), 397.9, 1e-9);
}

TEST(Ecowitt, ReadsAGatewayWithoutAnAnemometer) {
  const auto values = decode_ecowitt(hex_bytes(kReplyWithoutWind));
  ASSERT_TRUE(values.has_value());
  EXPECT_TRUE(is_refused_as(values->wind, Refusal::kInvalid));
  EXPECT_NEAR(values->quantities.pressure_hpa.value(), 1019.4, 1e-9);
  EXPECT_FALSE(values->quantities.air_temperature_c.has_value());
}

TEST(Ecowitt, ReadsWindFrostAndPiezoRain) {
  const auto values = decode_ecowitt(reply_of("02 ff fb 0a 01 0e 0b 00 70 0c 00 9c 80 00 0c 86 00 00 0f 8b"));
  ASSERT_TRUE(values.has_value());
  ASSERT_TRUE(values->wind.has_value());
  EXPECT_NEAR(values->wind->speed_m_s.value(), 11.2, 1e-9);
  EXPECT_NEAR(values->wind->gust_m_s.value(), 15.6, 1e-9);
  EXPECT_EQ(values->wind->direction_deg, 270.0);
  EXPECT_NEAR(values->quantities.air_temperature_c.value(), -0.5, 1e-9);
  EXPECT_NEAR(values->quantities.rain_rate_mm_h.value(), 1.2, 1e-9);
  EXPECT_NEAR(values->quantities.rain_total_mm.value(), 397.9, 1e-9);
}

TEST(Ecowitt, StopsAtWhatItDoesNotKnow) {
  EXPECT_EQ(wind_in_reply(reply_of("0b 00 70 f0 01 02 03"))->direction_deg, std::nullopt);
  EXPECT_TRUE(is_refused_as(wind_in_reply(reply_of("f0 01 02 0b 00 70")), Refusal::kInvalid));
}

TEST(Ecowitt, LeavesOutWhatIsNoValue) {
  EXPECT_TRUE(is_refused_as(wind_in_reply(reply_of("0b ff ff 0a 00 70")), Refusal::kInvalid));
  EXPECT_FALSE(wind_in_reply(reply_of("0b 00 70 0a ff ff"))->direction_deg.has_value());
  EXPECT_FALSE(wind_in_reply(reply_of("0b 00 70 0c 00 6f"))->gust_m_s.has_value()) << "a gust below the mean";
}

TEST(Ecowitt, RefusesWhatNoAnemometerMeasures) {
  EXPECT_TRUE(is_refused_as(wind_in_reply(reply_of("0b 04 b1")), Refusal::kImplausible)) << "120.1 m/s";
  const auto impossible = wind_in_reply(reply_of("0b 00 70 0a 02 d0"));
  ASSERT_TRUE(impossible) << "720 degrees leave the speed";
  EXPECT_FALSE(impossible->direction_deg);
  EXPECT_EQ(impossible->status, DecodedStatus::kUncertain);
}

TEST(Ecowitt, RefusesWhatIsNoSuchReply) {
  EXPECT_TRUE(is_refused_as(wind_in_reply(hex_bytes("fe ff 27 00 04 2b")), Refusal::kMalformed));
  EXPECT_TRUE(is_refused_as(wind_in_reply(hex_bytes("ff ff 50 11 0d 47")), Refusal::kNotMine));
  EXPECT_TRUE(is_refused_as(wind_in_reply(hex_bytes("ff ff 27 00 03 2a")), Refusal::kMalformed))
      << "no room for the sum";
  EXPECT_TRUE(is_refused_as(wind_in_reply(hex_bytes("ff ff 27 ff ff 25")), Refusal::kMalformed)) << "too long";
  EXPECT_TRUE(is_refused_as(wind_in_reply(reply_of("0b 00")), Refusal::kMalformed)) << "an item that is cut off";
  EXPECT_TRUE(is_refused_as(wind_in_reply(reply_of("0b 00 70 0b 00 71")), Refusal::kMalformed)) << "an item twice";
  ReplyBytes longer = reply_of("0b 00 70");
  longer.push_back(0);
  EXPECT_TRUE(is_refused_as(wind_in_reply(longer), Refusal::kMalformed));
  EXPECT_TRUE(is_refused_as(wind_in_reply(reply_of("")), Refusal::kInvalid));
}

TEST(Ecowitt, TellsTheSizeAsSoonAsItIsThere) {
  const ReplyBytes whole = hex_bytes(kCalmReply);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto told = ecowitt_reply_size(ByteSpan(whole).first(size));
    if (size < 5) {
      EXPECT_EQ(told.error(), Refusal::kTooShort);
    } else {
      EXPECT_EQ(*told, whole.size());
    }
    EXPECT_TRUE(is_refused_as(wind_in_reply({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}),
                              Refusal::kTooShort));
  }
}

TEST(Ecowitt, FindsEachByteThatIsChanged) {
  const ReplyBytes whole = hex_bytes(kCalmReply);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    ReplyBytes hurt = whole;
    for (int change = 1; change < 256; ++change) {
      hurt[at] = static_cast<std::uint8_t>(whole[at] ^ change);
      ASSERT_FALSE(decode_ecowitt(hurt).has_value()) << at << ' ' << change;
    }
  }
}

/// gjr80/weewx-gw1000, tests/test_gw1000.py: a GW1000 that was searched for.
const std::string kGatewayAnswer =
    "ff ff 12 00 26 50 02 91 e3 fd 32 c0 a8 02 20 af c8 16 47 57 31 30 30 30 2d 57 49 46 49 46 44 33 32 20 56 31 2e 36 "
    "2e 38 5f";

TEST(DecodeEcowittGateway, ReadsARecordedAnswer) {
  const auto gateway = decode_ecowitt_gateway(hex_bytes(kGatewayAnswer));
  ASSERT_TRUE(gateway.has_value());
  EXPECT_EQ(gateway->mac, "50:02:91:e3:fd:32");
  EXPECT_EQ(gateway->port, 45000);
  EXPECT_EQ(gateway->name, "GW1000-WIFIFD32 V1.6.8");
}

TEST(DecodeEcowittGateway, RefusesWhatIsHurt) {
  const ReplyBytes whole = hex_bytes(kGatewayAnswer);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode_ecowitt_gateway(decode::ByteSpan(whole).first(size)).has_value()) << size;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    ReplyBytes hurt = whole;
    hurt[at] ^= 0x40U;
    EXPECT_FALSE(decode_ecowitt_gateway(hurt).has_value()) << at;
  }
  ReplyBytes other = whole;
  other[2] = 0x27;
  EXPECT_EQ(decode_ecowitt_gateway(other).error(), Refusal::kNotMine);
}

TEST(DecodeEcowittGateway, ShowsNothingThatATerminalObeys) {
  ReplyBytes answer = hex_bytes(kGatewayAnswer);
  answer[18] = 0x1B;
  answer.back() = static_cast<std::uint8_t>(answer.back() - 0x47U + 0x1BU);
  const auto gateway = decode_ecowitt_gateway(answer);
  ASSERT_TRUE(gateway.has_value());
  EXPECT_EQ(gateway->name, "?W1000-WIFIFD32 V1.6.8");
}

}  // namespace
}  // namespace yuragi::drivers::decode::network
