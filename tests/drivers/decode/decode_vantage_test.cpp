// Packets of Davis consoles. Six are recorded ones that others have published (drivers/SOURCES.md S10.1).
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/decode/davis/vantage.hpp"
#include "drivers/decode/davis/vantage_assembler.hpp"
#include "tests/support/decoded_winds.hpp"

namespace yuragi::drivers::decode::davis {
namespace {

using test::is_refused_as;
using Bytes = std::vector<std::uint8_t>;

constexpr double kMph = 0.44704;

Bytes bytes_of_digits(std::string_view digits) {
  Bytes bytes;
  for (std::size_t at = 0; at + 1 < digits.size(); at += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(std::string(digits.substr(at, 2)), nullptr, 16)));
  }
  return bytes;
}

void put_word(Bytes& packet, std::size_t at, unsigned value) {
  packet[at] = static_cast<std::uint8_t>(value & 0xFFU);
  packet[at + 1] = static_cast<std::uint8_t>(value >> 8U);
}

void mend_checksum(Bytes& packet) {
  const std::uint16_t sum = vantage_checksum(ByteSpan(packet).first(packet.size() - 2));
  packet[packet.size() - 2] = static_cast<std::uint8_t>(sum >> 8U);
  packet[packet.size() - 1] = static_cast<std::uint8_t>(sum & 0xFFU);
}

/// LOOP2, of PyVantagePro's tests.
const Bytes kRecordedLoop2 = bytes_of_digits(
    "4C4F4FEC01FF7F95745D033A860305FF3B012300180007003B01FF7FFF7F4A00FF3CFF65005A0066000000FF78000000FFFF00000000000"
    "0BF000000020000C9FF0E720E72BE74FF07060C0E0D090C39160202FF7FFF7FFF7FFF7FFF7FFF7F0A0DCBFD");
/// LOOP, of the sample data of a converter in JavaScript.
const Bytes kRecordedLoop = bytes_of_digits(
    "4c4f4fec00a0045b7434032d24030201a300ffffffffffffffffffffffffffffff2bffffffffffffff000050ca030000ffff00000d000d0061"
    "002e016004ffffffffffffff000000000000000000000000000000000000c70003c06f02f9070a0d3387");

/// The recorded LOOP2 with another wind.
Bytes loop2(unsigned speed_mph, unsigned direction_deg, unsigned gust_mph, unsigned average_tenths_mph) {
  Bytes packet = kRecordedLoop2;
  packet[14] = static_cast<std::uint8_t>(speed_mph);
  put_word(packet, 16, direction_deg);
  put_word(packet, 18, average_tenths_mph);
  put_word(packet, 22, gust_mph);
  mend_checksum(packet);
  return packet;
}

TEST(VantageChecksum, IsThatOfTheManualsExample) {
  EXPECT_EQ(vantage_checksum(Bytes{0xC6, 0xCE, 0xA2, 0x03}), 0xE2B4);
  EXPECT_EQ(vantage_checksum(Bytes{0xC6, 0xCE, 0xA2, 0x03, 0xE2, 0xB4}), 0);
}

struct RecordedPacket {
  std::string_view digits;
  double speed_mph;
  double direction_deg;
  std::optional<double> gust_mph;
};

TEST(VantagePacket, ThatWasRecordedGivesItsWind) {
  const std::array<RecordedPacket, 4> recorded = {{
      {"4c4f4fec01ff7fcf74c30236230200ff39011c00150006003b01ff7fff7f3100ff50ff37003700ff000000ffff7f0000ffff02000000010"
       "000000200020000dfff896c896ce074ff060b0a1500081338060909ff7fff7fff7fff7fff7fff7f0a0dcdd5",
       0.0, 313.0, 6.0},
      {"4c4f4f1401ff7fa7759a0239e70103ff67002200290008005a00ff7fff7f2f00ff5eff31003000ff000000ffff7f0000ffff01000000000"
       "000000100020000dfff406d406da275ff0016021302020132070909ff7fff7fff7fff7fff7fff7f0a0d175e",
       3.0, 103.0, 8.0},
      {"4c4f4f1400e2056f74270332bf020c0c4801ffffffffffffffffffffffffffffff41ffffffffffffff00000902010000ffff00000d000d0"
       "0ca002e016004ffffffffffffff000000000000000000000000000000000000c60002876e02f9070a0d03be",
       12.0, 328.0, std::nullopt},
      // North.
      {"4c4f4fec00f5087274a4040f8a030a076801ffffffffffffffffffffffffffffff1cffffffffffffff00002aef020000ffff00007901d10"
       "67e0034029206ffffffffffffff000000000000000000000000000000000000b503062df907bd030a0d1298",
       10.0, 0.0, std::nullopt},
  }};
  for (const RecordedPacket& packet : recorded) {
    const auto wind = decode_vantage_packet(bytes_of_digits(packet.digits));
    ASSERT_TRUE(wind.has_value()) << packet.digits;
    EXPECT_DOUBLE_EQ(*wind->speed_m_s, packet.speed_mph * kMph);
    EXPECT_EQ(wind->direction_deg, packet.direction_deg);
    EXPECT_EQ(wind->reference, WindReference::kNorth);
    EXPECT_EQ(wind->status, DecodedStatus::kGood);
    ASSERT_EQ(wind->gust_m_s.has_value(), packet.gust_mph.has_value());
    if (packet.gust_mph) {
      EXPECT_DOUBLE_EQ(*wind->gust_m_s, *packet.gust_mph * kMph) << "whole mph: of 0.1 mph it were below the average";
    }
  }
}

TEST(VantagePacket, ThatWasRecordedGivesTheWeather) {
  const auto loop2 = decode_vantage_quantities(kRecordedLoop2, 0.2);
  ASSERT_TRUE(loop2.has_value());
  EXPECT_NEAR(*loop2->air_temperature_c, (90.2 - 32.0) / 1.8, 1e-9);
  EXPECT_NEAR(*loop2->pressure_hpa, 1010.67, 0.01);
  EXPECT_EQ(loop2->relative_humidity_percent, 60.0);
  EXPECT_EQ(loop2->rain_rate_mm_h, 0.0);
  EXPECT_EQ(loop2->rain_total_mm, 0.0);

  const auto loop = decode_vantage_quantities(kRecordedLoop, std::nullopt);
  ASSERT_TRUE(loop.has_value());
  EXPECT_NEAR(*loop->air_temperature_c, (80.4 - 32.0) / 1.8, 1e-9);
  EXPECT_NEAR(*loop->pressure_hpa, 1008.70, 0.01);
  EXPECT_EQ(loop->relative_humidity_percent, 43.0);
  EXPECT_FALSE(loop->rain_total_mm.has_value()) << "nobody knows what a tip is";
}

TEST(VantagePacket, LeavesOutWeatherThatTheConsoleDoesNotHave) {
  Bytes packet = kRecordedLoop2;
  put_word(packet, 7, 0);
  put_word(packet, 12, 0x7FFF);
  packet[33] = 0xFF;
  put_word(packet, 41, 0xFFFF);
  put_word(packet, 50, 37);
  mend_checksum(packet);
  const auto said = decode_vantage_quantities(packet, 0.254);
  ASSERT_TRUE(said.has_value());
  EXPECT_FALSE(said->pressure_hpa || said->air_temperature_c || said->relative_humidity_percent ||
               said->rain_rate_mm_h);
  EXPECT_NEAR(*said->rain_total_mm, 9.398, 1e-9);
  put_word(packet, 12, 0xFF9C);  // -10.0
  mend_checksum(packet);
  EXPECT_NEAR(*decode_vantage_quantities(packet, {})->air_temperature_c, -42.0 / 1.8, 1e-9);
  packet[33] = 1;
  EXPECT_FALSE(decode_vantage_quantities(packet, 0.254).has_value()) << "its checksum is wrong";
}

TEST(VantagePacket, OfACalmIsToldFromALostAnemometer) {
  const auto calm = decode_vantage_packet(loop2(0, 313, 6, 28));
  ASSERT_TRUE(calm.has_value());
  EXPECT_EQ(calm->speed_m_s, 0.0);
  // The manual: a dashed speed is said as 0, and a direction of 0 is none.
  EXPECT_TRUE(is_refused_as(decode_vantage_packet(loop2(0, 0, 6, 28)), Refusal::kInvalid));
  EXPECT_TRUE(is_refused_as(decode_vantage_packet(loop2(0, 0x7FFF, 6, 28)), Refusal::kInvalid));
  EXPECT_TRUE(is_refused_as(decode_vantage_packet(loop2(255, 90, 6, 28)), Refusal::kInvalid));
}

TEST(VantagePacket, KeepsTheSpeedBesideABadDirection) {
  for (const unsigned none : {0U, 0x7FFFU, 0xFFFFU}) {
    const auto wind = decode_vantage_packet(loop2(5, none, 7, 35));
    ASSERT_TRUE(wind.has_value());
    EXPECT_FALSE(wind->direction_deg.has_value());
    EXPECT_EQ(wind->status, DecodedStatus::kGood);
  }
  const auto wind = decode_vantage_packet(loop2(5, 361, 7, 35));
  ASSERT_TRUE(wind.has_value());
  EXPECT_DOUBLE_EQ(*wind->speed_m_s, 5 * kMph);
  EXPECT_FALSE(wind->direction_deg.has_value());
  EXPECT_EQ(wind->status, DecodedStatus::kUncertain);
  EXPECT_EQ(decode_vantage_packet(loop2(5, 360, 7, 35))->direction_deg, 0.0);
  EXPECT_EQ(decode_vantage_packet(loop2(5, 1, 7, 35))->direction_deg, 1.0);
}

TEST(VantagePacket, LeavesOutAGustThatCannotBe) {
  EXPECT_DOUBLE_EQ(*decode_vantage_packet(loop2(5, 90, 7, 70))->gust_m_s, 7 * kMph);
  for (const unsigned gust_mph : {6U, 255U, 0x7FFFU, 0xFFFFU, 269U}) {
    const auto wind = decode_vantage_packet(loop2(5, 90, gust_mph, 70));
    ASSERT_TRUE(wind.has_value());
    EXPECT_DOUBLE_EQ(*wind->speed_m_s, 5 * kMph);
    EXPECT_FALSE(wind->gust_m_s.has_value()) << gust_mph;
  }
  for (const unsigned none : {0x7FFFU, 0xFFFFU}) {
    EXPECT_TRUE(decode_vantage_packet(loop2(5, 90, 6, none))->gust_m_s.has_value());
  }
}

TEST(VantagePacket, IsRefusedInGrades) {
  EXPECT_TRUE(is_refused_as(decode_vantage_packet({}), Refusal::kTooShort));
  EXPECT_TRUE(is_refused_as(decode_vantage_packet(ByteSpan(kRecordedLoop2).first(98)), Refusal::kTooShort));
  Bytes packet = kRecordedLoop2;
  packet.push_back(0);
  EXPECT_TRUE(is_refused_as(decode_vantage_packet(packet), Refusal::kMalformed));
  for (const std::size_t at : {std::size_t{0}, std::size_t{2}, std::size_t{4}, std::size_t{95}, std::size_t{96}}) {
    packet = kRecordedLoop2;
    packet[at] = 2;
    mend_checksum(packet);
    EXPECT_TRUE(is_refused_as(decode_vantage_packet(packet), Refusal::kMalformed)) << at;
  }
  for (std::size_t bit = 5 * 8; bit < 95 * 8; ++bit) {
    packet = kRecordedLoop2;
    packet[bit / 8] = static_cast<std::uint8_t>(packet[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_TRUE(is_refused_as(decode_vantage_packet(packet), Refusal::kBadChecksum)) << bit;
  }
}

TEST(VantageSetup, SaysWhatATipIs) {
  const auto tip_mm = [](std::uint8_t setup) {
    Bytes reply = {setup, 0, 0};
    mend_checksum(reply);
    return decode_vantage_rain_of_a_tip_mm(reply);
  };
  EXPECT_EQ(*tip_mm(0x0F), 0.254);
  EXPECT_EQ(*tip_mm(0x1A), 0.2);
  EXPECT_EQ(*tip_mm(0xE3), 0.1);
  EXPECT_EQ(tip_mm(0x30).error(), Refusal::kInvalid);
  EXPECT_EQ(decode_vantage_rain_of_a_tip_mm({}).error(), Refusal::kTooShort);
  EXPECT_EQ(decode_vantage_rain_of_a_tip_mm(Bytes(4)).error(), Refusal::kMalformed);
  EXPECT_EQ(decode_vantage_rain_of_a_tip_mm(Bytes{0x10, 1, 1}).error(), Refusal::kBadChecksum);
}

// --- The assembler

/// What an assembler makes of bytes that come in pieces of so many.
struct Assembled {
  std::vector<Bytes> packets;
  std::vector<Refusal> refusals;
};

Assembled assemble(VantageAssembler& assembler, ByteSpan bytes, std::size_t piece_size = 1000) {
  Assembled all;
  while (!bytes.empty()) {
    ByteSpan piece = bytes.first(std::min(piece_size, bytes.size()));
    bytes = bytes.subspan(piece.size());
    while (const auto packet = assembler.next(piece)) {
      if (*packet) {
        all.packets.emplace_back((*packet)->begin(), (*packet)->end());
      } else {
        all.refusals.push_back(packet->error());
      }
    }
  }
  return all;
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(VantageAssembler, MakesPacketsOfAnyPieces) {
  const Bytes stream = joined({kRecordedLoop2, kRecordedLoop, kRecordedLoop2});
  for (std::size_t piece_size = 1; piece_size <= stream.size(); ++piece_size) {
    VantageAssembler assembler;
    const Assembled all = assemble(assembler, stream, piece_size);
    EXPECT_EQ(all.packets, (std::vector<Bytes>{kRecordedLoop2, kRecordedLoop, kRecordedLoop2}));
    EXPECT_TRUE(all.refusals.empty());
    EXPECT_FALSE(assembler.cut());
  }
}

TEST(VantageAssembler, LosesOnePacketToAByteThatIsLostOrAdded) {
  for (std::size_t at = 0; at < kVantagePacket; ++at) {
    Bytes lost = kRecordedLoop2;
    lost.erase(lost.begin() + static_cast<std::ptrdiff_t>(at));
    Bytes added = kRecordedLoop2;
    added.insert(added.begin() + static_cast<std::ptrdiff_t>(at), 'L');
    for (const Bytes& hurt : {lost, added}) {
      VantageAssembler assembler;
      const Assembled all = assemble(assembler, joined({hurt, kRecordedLoop, kRecordedLoop}), 7);
      ASSERT_GE(all.packets.size(), 2U) << at;
      EXPECT_EQ(all.packets.back(), kRecordedLoop);
      EXPECT_EQ(all.packets[all.packets.size() - 2], kRecordedLoop);
      EXPECT_FALSE(all.refusals.empty());
      EXPECT_LE(all.refusals.size(), 2U);
    }
  }
}

TEST(VantageAssembler, TellsOnceOfBytesThatBelongToNothing) {
  VantageAssembler assembler;
  const Assembled all = assemble(assembler, joined({Bytes(500, 'O'), kRecordedLoop, Bytes(3, 0x06), kRecordedLoop2}));
  EXPECT_EQ(all.packets, (std::vector<Bytes>{kRecordedLoop, kRecordedLoop2}));
  EXPECT_EQ(all.refusals, (std::vector<Refusal>{Refusal::kMalformed, Refusal::kMalformed}));
}

TEST(VantageAssembler, ForgetsWhatWasCut) {
  VantageAssembler assembler;
  assemble(assembler, ByteSpan(kRecordedLoop).first(60));
  EXPECT_TRUE(assembler.cut());
  EXPECT_FALSE(assembler.cut());
  EXPECT_EQ(assemble(assembler, kRecordedLoop2).packets.size(), 1U);
  EXPECT_FALSE(assembler.cut()) << "a whole packet was not cut";
}

}  // namespace
}  // namespace yuragi::drivers::decode::davis
