// Frames of Lufft's UMB protocol: the manuals' printed ones, and recorded exchanges that others have published
// (drivers/SOURCES.md S13.1).
#include <algorithm>
#include <bit>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/decode/lufft/umb.hpp"
#include "drivers/decode/lufft/umb_assembler.hpp"
#include "tests/support/decoded_winds.hpp"

namespace yuragi::drivers::decode::lufft {
namespace {

using test::is_refused_as;
using testing::ElementsAre;
using testing::ElementsAreArray;
using UmbBytes = std::vector<std::uint8_t>;

constexpr std::uint16_t kStation = umb_address(7, 1);

UmbBytes bytes_of(std::string_view digits) {
  UmbBytes bytes;
  for (std::size_t at = 0; at + 1 < digits.size(); at += 3) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(std::string(digits.substr(at, 2)), nullptr, 16)));
  }
  return bytes;
}

/// V200A manual V25, 20.3.4: its temperature is asked for, and is 22.5 degrees Celsius.
const UmbBytes kPrintedRequest = bytes_of("01 10 01 80 01 F0 04 02 23 10 64 00 03 0B 54 04");
const UmbBytes kPrintedReply = bytes_of("01 10 01 F0 01 80 0A 02 23 10 00 64 00 16 00 00 B4 41 03 1F 94 04");
/// VS20k-UMB and IRS31Pro-UMB manuals: visibility, temperature of a road.
const UmbBytes kPrintedVisibility = bytes_of("01 10 16 F0 01 30 0A 02 23 10 00 59 02 16 00 00 FA 44 03 5E 11 04");
const UmbBytes kPrintedRoad = bytes_of("01 10 01 F0 01 90 0A 02 23 10 00 65 00 16 EC F2 C4 41 03 24 51 04");
/// A WS10 by the UMB Config Tool, of node-red-umbparser (doc/WS10DataDump.txt): five channels of four types.
const UmbBytes kRecordedRequest =
    bytes_of("01 10 09 70 01 F0 0D 02 2F 10 05 C8 00 58 02 5C 12 20 57 24 5E 03 2E 7E 04");
const UmbBytes kRecordedReply = bytes_of(
    "01 10 01 F0 09 70 31 02 2F 10 00 05 08 00 C8 00 16 AB F8 29 42 0C 00 58 02 17 00 00 00 00 00 00 00 00 08 "
    "00 5C 12 14 D3 00 00 00 06 00 20 57 12 0F 05 06 00 24 5E 12 00 00 03 F4 24 04");
const UmbBytes kRecordedStatus = bytes_of("01 10 01 F0 01 50 03 02 26 10 55 03 02 5A 04");

UmbBytes joined(const std::vector<UmbBytes>& parts) {
  UmbBytes all;
  for (const UmbBytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

UmbBytes frame_of(const UmbBytes& text, std::uint16_t from = kStation, std::uint16_t to = kUmbController) {
  UmbBytes frame = {0x01,
                    0x10,
                    static_cast<std::uint8_t>(to & 0xFFU),
                    static_cast<std::uint8_t>(to >> 8U),
                    static_cast<std::uint8_t>(from & 0xFFU),
                    static_cast<std::uint8_t>(from >> 8U),
                    static_cast<std::uint8_t>(text.size()),
                    0x02};
  frame.insert(frame.end(), text.begin(), text.end());
  frame.push_back(0x03);
  const std::uint16_t sum = umb_checksum(frame);
  frame.insert(frame.end(), {static_cast<std::uint8_t>(sum & 0xFFU), static_cast<std::uint8_t>(sum >> 8U), 0x04});
  return frame;
}

/// A reply to 2Fh with these channels, each with its status, type and value.
UmbBytes reply_of(const std::vector<UmbBytes>& channels) {
  UmbBytes text = {0x2F, 0x10, 0x00, static_cast<std::uint8_t>(channels.size())};
  for (const UmbBytes& channel : channels) {
    text.push_back(static_cast<std::uint8_t>(channel.size()));
    text.insert(text.end(), channel.begin(), channel.end());
  }
  return frame_of(text);
}

UmbBytes single(std::uint16_t channel, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  UmbBytes bytes = {0x00, static_cast<std::uint8_t>(channel & 0xFFU), static_cast<std::uint8_t>(channel >> 8U), 0x16};
  for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>((bits >> shift) & 0xFFU));
  return bytes;
}

UmbBytes without_value(std::uint16_t channel, std::uint8_t status) {
  return {status, static_cast<std::uint8_t>(channel & 0xFFU), static_cast<std::uint8_t>(channel >> 8U)};
}

Result<DecodedWind, Refusal> wind_in(const UmbBytes& frame) {
  const auto reply = decode_umb_reply(kStation, frame);
  if (!reply) return reply.error();
  return wind_of(*reply);
}

double value_in(const UmbBytes& frame, std::uint16_t channel) {
  const auto reply = decode_umb_reply({}, frame);
  const UmbChannel* const found = reply ? reply->find(channel) : nullptr;
  return found == nullptr ? std::numeric_limits<double>::quiet_NaN() : found->value.value_or(-1.0);
}

TEST(UmbFrame, HasTheChecksumOfPrintedAndRecordedOnes) {
  for (const UmbBytes& frame : {kPrintedRequest, kPrintedReply, kPrintedVisibility, kPrintedRoad, kRecordedRequest,
                                kRecordedReply, kRecordedStatus}) {
    const ByteSpan bytes(frame);
    EXPECT_EQ(umb_checksum(bytes.first(frame.size() - 3)), little_endian_16(bytes, frame.size() - 3));
    EXPECT_EQ(umb_frame_size(bytes), frame.size());
    EXPECT_TRUE(begins_umb_frame(bytes));
  }
}

TEST(UmbRequest, IsTheOneThatTheMakersProgramSends) {
  constexpr std::array<std::uint16_t, 5> kChannels = {200, 600, 4700, 22304, 24100};
  EXPECT_THAT(umb_request(umb_address(7, 9), kChannels), ElementsAreArray(kRecordedRequest));
  EXPECT_THAT(umb_request(umb_address(7, 9), std::span(kChannels).first(1)),
              ElementsAreArray(bytes_of("01 10 09 70 01 F0 05 02 2F 10 01 C8 00 03 E9 EB 04")));
  EXPECT_LE(umb_request(kStation, kUmbChannels).size(), kMaxUmbFrame);
}

TEST(UmbReply, IsReadFromPrintedAndRecordedFrames) {
  EXPECT_DOUBLE_EQ(value_in(kPrintedReply, 100), 22.5);
  EXPECT_DOUBLE_EQ(value_in(kPrintedVisibility, 601), 2000.0);
  EXPECT_NEAR(value_in(kPrintedRoad, 101), 24.6186, 1e-4);
  EXPECT_NEAR(value_in(kRecordedReply, 200), 42.4928, 1e-4);
  EXPECT_DOUBLE_EQ(value_in(kRecordedReply, 600), 0.0);
  EXPECT_DOUBLE_EQ(value_in(kRecordedReply, 4700), 211.0);
  EXPECT_DOUBLE_EQ(value_in(kRecordedReply, 22304), 1295.0);
  EXPECT_DOUBLE_EQ(value_in(kRecordedReply, 24100), 0.0);
  const auto reply = decode_umb_reply({}, kRecordedReply);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->address, umb_address(7, 9));
  EXPECT_EQ(reply->count, 5U);
  EXPECT_EQ(quantities_of(*reply).relative_humidity_percent, reply->find(200)->value);
}

TEST(UmbReply, HasValuesOfEightTypes) {
  const auto of_type = [](std::uint8_t type, const std::string& digits) {
    UmbBytes channel = {0x00, 0x64, 0x00, type};
    const UmbBytes value = bytes_of(digits);
    channel.insert(channel.end(), value.begin(), value.end());
    return value_in(reply_of({channel}), 100);
  };
  EXPECT_EQ(of_type(0x10, "FE"), 254.0);
  EXPECT_EQ(of_type(0x11, "FE"), -2.0);
  EXPECT_EQ(of_type(0x12, "FE FF"), 65534.0);
  EXPECT_EQ(of_type(0x13, "FE FF"), -2.0);
  EXPECT_EQ(of_type(0x14, "FE FF FF FF"), 4294967294.0);
  EXPECT_EQ(of_type(0x15, "FE FF FF FF"), -2.0);
  EXPECT_EQ(of_type(0x16, "00 00 B4 41"), 22.5);
  EXPECT_EQ(of_type(0x17, "00 00 00 00 00 80 36 40"), 22.5);
  // No value: an unknown type, another size, not a number, infinite.
  EXPECT_EQ(of_type(0x18, "00"), -1.0);
  EXPECT_EQ(of_type(0x0F, "00"), -1.0);
  EXPECT_EQ(of_type(0x16, "00 00 B4"), -1.0);
  EXPECT_EQ(of_type(0x16, "00 00 C0 7F"), -1.0);
  EXPECT_EQ(of_type(0x17, "00 00 00 00 00 00 F0 7F"), -1.0);
}

TEST(UmbWind, TakesTheFastChannelsBeforeTheOthers) {
  const auto fast = wind_in(
      reply_of({single(400, 4.0F), single(401, 5.5F), single(500, 90.0F), single(501, 100.0F), single(440, 9.0F)}));
  ASSERT_TRUE(fast);
  EXPECT_DOUBLE_EQ(*fast->speed_m_s, 5.5);
  EXPECT_DOUBLE_EQ(*fast->direction_deg, 100.0);
  EXPECT_DOUBLE_EQ(*fast->gust_m_s, 9.0);
  EXPECT_EQ(fast->reference, WindReference::kUnknown);

  // A VENTUS has none.
  const auto ventus = wind_in(reply_of(
      {without_value(401, 0x24), single(400, 4.0F), without_value(501, 0x24), single(500, 90.0F), single(440, 9.0F)}));
  ASSERT_TRUE(ventus);
  EXPECT_DOUBLE_EQ(*ventus->speed_m_s, 4.0);
  EXPECT_DOUBLE_EQ(*ventus->direction_deg, 90.0);
  EXPECT_EQ(ventus->status, DecodedStatus::kGood);
}

TEST(UmbWind, LeavesOutWhatCannotBe) {
  const auto wind = wind_in(reply_of({single(400, 4.0F), single(500, -1.0F), single(440, 3.0F)}));
  ASSERT_TRUE(wind);
  EXPECT_DOUBLE_EQ(*wind->speed_m_s, 4.0);
  EXPECT_FALSE(wind->direction_deg.has_value());
  EXPECT_FALSE(wind->gust_m_s.has_value()) << "of a time before the gust that blows now";
  EXPECT_EQ(wind->status, DecodedStatus::kUncertain);
  EXPECT_EQ(wind_in(reply_of({single(400, 4.0F), single(500, 360.0F)}))->direction_deg, 0.0);
}

TEST(UmbWind, IsRefusedForTheFirstThingThatIsWrong) {
  const UmbBytes good = reply_of({single(400, 4.0F), single(500, 90.0F)});
  ASSERT_TRUE(wind_in(good));
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_TRUE(
        is_refused_as(wind_in({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}), Refusal::kTooShort));
  }
  EXPECT_TRUE(is_refused_as(wind_in(joined({good, {0x04}})), Refusal::kMalformed));
  for (const std::size_t at : {0U, 1U, 7U}) {
    UmbBytes other = good;
    ++other[at];
    EXPECT_TRUE(is_refused_as(wind_in(other), Refusal::kMalformed)) << at;
  }
  UmbBytes no_end = good;
  no_end.back() = 0x05;
  EXPECT_TRUE(is_refused_as(wind_in(no_end), Refusal::kMalformed));
  UmbBytes wrong_sum = good;
  wrong_sum[16] ^= 1U;
  EXPECT_TRUE(is_refused_as(wind_in(wrong_sum), Refusal::kBadChecksum));

  EXPECT_TRUE(is_refused_as(wind_in(kRecordedRequest), Refusal::kNotMine)) << "a request";
  EXPECT_TRUE(is_refused_as(wind_in(kRecordedReply), Refusal::kNotMine)) << "of another device";
  EXPECT_TRUE(is_refused_as(wind_in(kRecordedStatus), Refusal::kNotMine)) << "another command";
  EXPECT_TRUE(is_refused_as(wind_in(frame_of({0x2F, 0x10})), Refusal::kMalformed));
  EXPECT_TRUE(is_refused_as(wind_in(frame_of({0x2F, 0x10, 0x11})), Refusal::kException));
  EXPECT_TRUE(is_refused_as(wind_in(frame_of({0x23, 0x10, 0x55, 0x90, 0x01})), Refusal::kException));

  EXPECT_TRUE(is_refused_as(wind_in(frame_of({0x2F, 0x10, 0x00})), Refusal::kMalformed));
  EXPECT_TRUE(is_refused_as(wind_in(frame_of({0x2F, 0x10, 0x00, 0x01})), Refusal::kMalformed));
  EXPECT_TRUE(is_refused_as(wind_in(frame_of({0x2F, 0x10, 0x00, 0x01, 0x00})), Refusal::kMalformed));
  EXPECT_TRUE(is_refused_as(wind_in(frame_of({0x2F, 0x10, 0x00, 0x01, 0x02, 0x00, 0x90})), Refusal::kMalformed));
  EXPECT_TRUE(is_refused_as(wind_in(frame_of({0x2F, 0x10, 0x00, 0x01, 0x09, 0x00, 0x90, 0x01})), Refusal::kMalformed));
  EXPECT_TRUE(is_refused_as(wind_in(frame_of({0x2F, 0x10, 0x00, 0x00, 0x00})), Refusal::kMalformed)) << "more";
  EXPECT_TRUE(is_refused_as(wind_in(frame_of({0x2F, 0x10, 0x00, 0x15})), Refusal::kMalformed)) << "21 channels";

  EXPECT_TRUE(is_refused_as(wind_in(frame_of({0x2F, 0x10, 0x00, 0x00})), Refusal::kInvalid));
  EXPECT_TRUE(
      is_refused_as(wind_in(reply_of({without_value(400, 0x55), without_value(500, 0x55)})), Refusal::kInvalid));
  EXPECT_TRUE(is_refused_as(wind_in(reply_of({single(100, 20.0F)})), Refusal::kInvalid));
  EXPECT_TRUE(is_refused_as(wind_in(reply_of({single(400, -1.0F)})), Refusal::kImplausible));
  EXPECT_TRUE(is_refused_as(wind_in(reply_of({single(400, 1e6F)})), Refusal::kImplausible));
}

TEST(UmbQuantities, AreThoseOfTheirChannels) {
  const auto reply = decode_umb_reply({}, reply_of({single(100, -3.5F), single(200, 65.0F), single(300, 1013.25F),
                                                    single(620, 7.5F), single(820, 3.0F)}));
  ASSERT_TRUE(reply);
  const wind::StationQuantities said = quantities_of(*reply);
  EXPECT_EQ(said.air_temperature_c, -3.5);
  EXPECT_EQ(said.relative_humidity_percent, 65.0);
  EXPECT_EQ(said.pressure_hpa, 1013.25);
  EXPECT_EQ(said.rain_total_mm, 7.5);
  EXPECT_EQ(said.rain_rate_mm_h, 3.0);
  EXPECT_FALSE(said.vertical_speed_m_s.has_value());
}

/// What an assembler makes of bytes that come in pieces of this size.
struct UmbAssembled {
  std::vector<UmbBytes> frames;
  std::vector<Refusal> refusals;
};

UmbAssembled assemble(UmbAssembler& assembler, const UmbBytes& bytes, std::size_t piece = 7) {
  UmbAssembled all;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    ByteSpan part = ByteSpan(bytes).subspan(at, std::min(piece, bytes.size() - at));
    while (const auto frame = assembler.next(part)) {
      if (*frame) {
        all.frames.emplace_back((*frame)->begin(), (*frame)->end());
      } else {
        all.refusals.push_back(frame->error());
      }
    }
  }
  return all;
}

TEST(UmbAssembler, MakesFramesOfBytesInAnyPieces) {
  const UmbBytes sent = joined({kPrintedReply, kRecordedReply, kPrintedRoad});
  for (std::size_t piece = 1; piece <= sent.size(); ++piece) {
    UmbAssembler assembler;
    const UmbAssembled all = assemble(assembler, sent, piece);
    EXPECT_THAT(all.frames, ElementsAre(kPrintedReply, kRecordedReply, kPrintedRoad));
    EXPECT_TRUE(all.refusals.empty());
    EXPECT_FALSE(assembler.cut());
  }
}

TEST(UmbAssembler, FindsTheNextFrameAfterADamagedOne) {
  UmbBytes hurt = kRecordedReply;
  hurt[20] ^= 0x10U;
  UmbAssembler assembler;
  UmbAssembled all = assemble(assembler, joined({hurt, kPrintedReply}));
  EXPECT_THAT(all.frames, ElementsAre(kPrintedReply));
  EXPECT_THAT(all.refusals, ElementsAre(Refusal::kBadChecksum));

  // A length that hides the frames that follow.
  hurt = kPrintedReply;
  hurt[6] = 60;
  all = assemble(assembler, joined({hurt, kPrintedRoad, kPrintedVisibility, kPrintedReply}));
  EXPECT_THAT(all.frames, ElementsAre(kPrintedRoad, kPrintedVisibility, kPrintedReply));
  EXPECT_THAT(all.refusals, ElementsAre(Refusal::kBadChecksum));

  all = assemble(assembler, joined({{0xFF, 0x00, 0x01, 0x01}, kPrintedReply}));
  EXPECT_THAT(all.frames, ElementsAre(kPrintedReply));
  EXPECT_THAT(all.refusals, ElementsAre(Refusal::kMalformed));

  EXPECT_TRUE(assemble(assembler, {kPrintedReply.begin(), kPrintedReply.end() - 1}).frames.empty());
  EXPECT_TRUE(assembler.cut());
  EXPECT_FALSE(assembler.cut());
  EXPECT_THAT(assemble(assembler, kPrintedReply).frames, ElementsAre(kPrintedReply));
}

/// A frame as a bad line hands it on.
UmbBytes hurt(UmbBytes frame, std::mt19937_64& random) {
  const auto any = [&random](std::size_t count) { return static_cast<std::size_t>(random() % count); };
  const auto place = [&] { return frame.begin() + static_cast<std::ptrdiff_t>(any(frame.size())); };
  switch (any(5)) {
    case 0:  // flipped bits
      for (std::size_t i = 0; i <= any(3); ++i) *place() ^= static_cast<std::uint8_t>(1U << any(8));
      break;
    case 1:  // other bytes
      for (std::size_t i = 0; i <= any(4); ++i) *place() = static_cast<std::uint8_t>(random());
      break;
    case 2:  // lost bytes
      for (std::size_t i = 0; i <= any(3); ++i) frame.erase(place());
      break;
    case 3:  // doubled bytes
      for (std::size_t i = 0; i <= any(3); ++i) {
        const auto at = place();
        frame.insert(at, *at);
      }
      break;
    default:  // cut
      frame.resize(any(frame.size()));
      break;
  }
  return frame;
}

/// Of so many hurt frames, each before a whole one, how many gave a wind that no device has said; -1 where a whole one
/// was lost though the hurt one before it cannot have hidden it.
int false_umb_winds_of(int messages, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const UmbBytes whole = reply_of({single(400, 1.0F), single(500, 10.0F), single(440, 2.0F)});
  const auto whole_wind = wind_in(whole);
  int false_winds = 0;
  for (int i = 0; i < messages; ++i) {
    const auto speed_m_s = static_cast<float>(random() % 600) / 10.0F;
    const UmbBytes sent = reply_of({single(400, speed_m_s), single(500, static_cast<float>(random() % 360)),
                                    single(440, speed_m_s), single(100, 20.0F)});
    const auto truth = wind_in(sent);
    UmbAssembler assembler;
    const UmbAssembled all =
        assemble(assembler, joined({hurt(sent, random), whole, whole, whole, whole, whole, whole}));
    for (const UmbBytes& frame : all.frames) {
      const auto wind = wind_in(frame);
      if (wind && *wind != *truth && *wind != *whole_wind) ++false_winds;
    }
    if (all.frames.empty() || all.frames.back() != whole) return -1;
  }
  return false_winds;
}

TEST(UmbWind, ThatIsHurtIsNotFalse) {
  EXPECT_EQ(false_umb_winds_of(20'000, 1), 0);
}

}  // namespace
}  // namespace yuragi::drivers::decode::lufft
