#include "drivers/decode/microphone/mic_frame.hpp"

#include <array>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace yuragi::drivers::microphone {
namespace {

decode::microphone::MicHello a_hello(std::uint8_t channels = 2) {
  decode::microphone::MicHello hello;
  hello.rate_hz = 48000.0;
  hello.channels = channels;
  hello.bands = 3;
  hello.bins = {1, 2, 3};
  hello.high_bins = 700;
  hello.device = "windmic (ALSA)";
  return hello;
}

decode::microphone::MicBlock a_block(const decode::microphone::MicHello& hello) {
  decode::microphone::MicBlock block;
  block.end_sample = 123456789012345;
  block.end_mono_ns = -5;
  block.lost_samples = 7;
  block.segments = 12;
  float value = 0.25F;
  for (std::size_t channel = 0; channel < hello.channels; ++channel) {
    decode::microphone::MicChannel& heard = block.channels[channel];
    for (std::size_t band = 0; band < hello.bands; ++band) heard.power[band] = value *= 0.5F;
    heard.high_power = value;
    heard.total_power = 0.5F;
    heard.clipped = 0.125F;
    heard.peak = 1.0F;
  }
  for (std::size_t pair = 0; pair < decode::microphone::mic_pair_count(hello.channels); ++pair) {
    for (std::size_t band = 0; band < hello.bands; ++band) block.cross[pair][band] = {value, 2.0F * value};
  }
  return block;
}

std::vector<std::uint8_t> joined(std::initializer_list<std::vector<std::uint8_t>> parts) {
  std::vector<std::uint8_t> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::vector<Result<decode::microphone::MicFrame, decode::Refusal>> frames_of(
    decode::microphone::MicFrameReader& reader) {
  std::vector<Result<decode::microphone::MicFrame, decode::Refusal>> frames;
  while (auto item = reader.next()) frames.push_back(item->frame);
  return frames;
}

TEST(MicFrameReader, ReadsWhatWasWrittenInPiecesOfAnySize) {
  for (std::uint8_t channels = 1; channels <= 4; ++channels) {
    const decode::microphone::MicHello hello = a_hello(channels);
    const decode::microphone::MicBlock block = a_block(hello);
    const auto bytes =
        joined({decode::microphone::encode_mic_frame(hello), decode::microphone::encode_mic_frame(block, hello),
                decode::microphone::encode_mic_frame(block, hello),
                decode::microphone::encode_mic_frame(decode::microphone::MicTrouble{"unplugged"})});
    for (const std::size_t piece : {1U, 3U, 16U, 100000U}) {
      decode::microphone::MicFrameReader reader;
      std::vector<Result<decode::microphone::MicFrame, decode::Refusal>> frames;
      for (std::size_t at = 0; at < bytes.size(); at += piece) {
        reader.push(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
        for (auto& frame : frames_of(reader)) frames.push_back(frame);
      }
      ASSERT_EQ(frames.size(), 4U);
      EXPECT_EQ(std::get<decode::microphone::MicHello>(*frames[0]), hello);
      EXPECT_EQ(std::get<decode::microphone::MicBlock>(*frames[1]), block);
      EXPECT_EQ(std::get<decode::microphone::MicBlock>(*frames[2]), block);
      EXPECT_EQ(std::get<decode::microphone::MicTrouble>(*frames[3]).message, "unplugged");
    }
  }
}

TEST(MicFrameReader, SkipsWhatALibraryPrintsInBetween) {
  const decode::microphone::MicHello hello = a_hello();
  const std::string words = "Cannot connect to server YMI YM\n";
  decode::microphone::MicFrameReader reader;
  reader.push(std::vector<std::uint8_t>(words.begin(), words.end()));
  reader.push(decode::microphone::encode_mic_frame(hello));
  const auto frames = frames_of(reader);
  ASSERT_FALSE(frames.empty());
  EXPECT_EQ(std::get<decode::microphone::MicHello>(*frames.back()), hello);
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) EXPECT_EQ(frames[i].error(), decode::Refusal::kMalformed);
}

TEST(MicFrameReader, RefusesEveryFlippedBitAndFindsTheNextFrame) {
  const decode::microphone::MicHello hello = a_hello();
  const auto good = decode::microphone::encode_mic_frame(a_block(hello), hello);
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    auto bad = good;
    bad[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    decode::microphone::MicFrameReader reader;
    reader.push(joined({decode::microphone::encode_mic_frame(hello), bad}));
    // A size that grew waits for so many bytes more, which come.
    for (int i = 0; i < 40; ++i) reader.push(good);
    const auto frames = frames_of(reader);
    int blocks = 0;
    bool is_refused = false;
    for (const auto& frame : frames) {
      is_refused = is_refused || !frame;
      if (!frame || !std::holds_alternative<decode::microphone::MicBlock>(*frame)) continue;
      EXPECT_EQ(std::get<decode::microphone::MicBlock>(*frame), a_block(hello)) << "bit " << bit;
      ++blocks;
    }
    // The two bytes that mean nothing may be anything; an altered kind is a frame of that kind, with this checksum.
    const bool is_unused = bit / 8 == 6 || bit / 8 == 7 || bit / 8 == 5;
    EXPECT_TRUE(is_refused || is_unused) << "bit " << bit;
    EXPECT_GE(blocks, 30) << "bit " << bit;
  }
}

TEST(MicFrameReader, RefusesBlocksThatCannotBe) {
  const decode::microphone::MicHello hello = a_hello();
  const auto refusal_of = [&](auto&& spoil) {
    decode::microphone::MicBlock block = a_block(hello);
    spoil(block);
    decode::microphone::MicFrameReader reader;
    reader.push(
        joined({decode::microphone::encode_mic_frame(hello), decode::microphone::encode_mic_frame(block, hello)}));
    const auto frames = frames_of(reader);
    return frames.size() == 2 && !frames[1] ? std::optional(frames[1].error()) : std::nullopt;
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal_of([](decode::microphone::MicBlock& block) { block.channels[1].power[2] = kNan; }),
            decode::Refusal::kInvalid);
  EXPECT_EQ(refusal_of([](decode::microphone::MicBlock& block) { block.channels[0].power[0] = -1.0F; }),
            decode::Refusal::kInvalid);
  EXPECT_EQ(refusal_of([](decode::microphone::MicBlock& block) { block.channels[0].clipped = 1.5F; }),
            decode::Refusal::kInvalid);
  EXPECT_EQ(refusal_of([](decode::microphone::MicBlock& block) {
              block.cross[0][1] = {0.0F, kNan};
            }),
            decode::Refusal::kInvalid);
  EXPECT_EQ(refusal_of([](decode::microphone::MicBlock& block) { block.segments = 0; }), decode::Refusal::kInvalid);
  EXPECT_EQ(refusal_of([](decode::microphone::MicBlock&) {}), std::nullopt);
}

TEST(MicFrameReader, RefusesABlockThatAgreesWithNoHello) {
  const decode::microphone::MicHello two = a_hello(2);
  const decode::microphone::MicHello one = a_hello(1);
  decode::microphone::MicFrameReader reader;
  reader.push(decode::microphone::encode_mic_frame(a_block(two), two));
  EXPECT_EQ(frames_of(reader).at(0).error(), decode::Refusal::kNotMine);
  reader.push(
      joined({decode::microphone::encode_mic_frame(one), decode::microphone::encode_mic_frame(a_block(two), two)}));
  EXPECT_EQ(frames_of(reader).at(1).error(), decode::Refusal::kNotMine);
  reader.clear();
  reader.push(decode::microphone::encode_mic_frame(a_block(one), one));
  EXPECT_EQ(frames_of(reader).at(0).error(), decode::Refusal::kNotMine) << "a new worker has to say hello";
}

TEST(MicFrameReader, MakesTroubleFitForALog) {
  decode::microphone::MicFrameReader reader;
  reader.push(
      decode::microphone::encode_mic_frame(decode::microphone::MicTrouble{"a\x1b[31m\nb" + std::string(5000, 'x')}));
  const auto frames = frames_of(reader);
  const std::string& message = std::get<decode::microphone::MicTrouble>(*frames.at(0)).message;
  EXPECT_LE(message.size(), 1024U);
  EXPECT_EQ(message.substr(0, 8), "a [31m b");
}

TEST(MicFrameReader, StaysBoundedUnderRandomBytes) {
  std::mt19937_64 random(1);
  decode::microphone::MicFrameReader reader;
  reader.push(decode::microphone::encode_mic_frame(a_hello()));
  constexpr std::array<std::uint64_t, 4> mark = {'Y', 'M', 'I', 'C'};
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> bytes(random() % 200);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random() % 4 == 0 ? mark[random() % 4] : random());
    reader.push(bytes);
    for (const auto& frame : frames_of(reader)) {
      if (frame) {
        EXPECT_FALSE(std::holds_alternative<decode::microphone::MicBlock>(*frame));
      }
    }
  }
  EXPECT_LE(reader.waiting_bytes(), decode::microphone::kMicMaxPayload + 16);
}

}  // namespace
}  // namespace yuragi::drivers::microphone
