#include "engine/wire/message_reader.hpp"

#include <gtest/gtest.h>

#include "tests/engine/wire/samples.hpp"

namespace yuragi::wire {
namespace {

Bytes joined(const std::vector<Bytes>& messages) {
  Bytes stream;
  for (const Bytes& message : messages) stream.insert(stream.end(), message.begin(), message.end());
  return stream;
}

/// The kinds (as indices of Message) of all that the reader has; an error is -1.
void drain(MessageReader& reader, std::vector<int>& kinds) {
  while (auto message = reader.next()) kinds.push_back(*message ? static_cast<int>((*message)->index()) : -1);
}

const std::vector kOneOfEach{0, 1, 2, 3, 4, 5, 6, 7, 2, 3, 5, 5, 6, 5};

TEST(MessageReader, AStreamSplitAtAnyPlaceGivesTheSameMessages) {
  const Bytes stream = joined(samples::one_of_each());
  for (std::size_t split = 0; split <= stream.size(); ++split) {
    MessageReader reader;
    std::vector<int> kinds;
    reader.feed(std::span(stream).first(split));
    drain(reader, kinds);
    reader.feed(std::span(stream).subspan(split));
    drain(reader, kinds);
    ASSERT_EQ(kinds, kOneOfEach) << split;
    ASSERT_EQ(reader.buffered_bytes(), 0u);
  }
}

TEST(MessageReader, AStreamInPiecesOfAnySizeGivesTheSameMessages) {
  const Bytes stream = joined(samples::one_of_each());
  for (const std::size_t piece : {1u, 2u, 3u, 5u, 64u, 1000u}) {
    MessageReader reader;
    std::vector<int> kinds;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      reader.feed(std::span(stream).subspan(at, std::min(piece, stream.size() - at)));
      drain(reader, kinds);
    }
    ASSERT_EQ(kinds, kOneOfEach) << piece;
  }
}

TEST(MessageReader, AMessageIsOnlyThereWhenItIsWhole) {
  const Bytes hello = encode(samples::hello());
  MessageReader reader;
  reader.feed(std::span(hello).first(hello.size() - 1));
  EXPECT_FALSE(reader.next().has_value());
  EXPECT_EQ(reader.buffered_bytes(), hello.size() - 1);
  reader.feed(std::span(hello).last(1));
  EXPECT_EQ(std::get<Hello>(reader.next().value().value()).software, "yuragi 0.1.0");
}

TEST(MessageReader, ABadMessageIsToldOnceAndTheNextOneIsRead) {
  Bytes bad = encode(samples::hello());
  bad[kSizePrefixBytes + 4] = 'X';  // the file identifier
  MessageReader reader;
  reader.feed(joined({bad, encode(samples::hello())}));
  EXPECT_EQ(reader.next().value().error(), Error::kNotVerified);
  EXPECT_TRUE(reader.next().value().has_value());
  EXPECT_FALSE(reader.next().has_value());
}

TEST(MessageReader, AnAbsurdLengthEndsTheStream) {
  const Bytes huge{0xff, 0xff, 0xff, 0x7f};
  MessageReader reader;
  reader.feed(huge);
  EXPECT_EQ(reader.next().value().error(), Error::kTooLong);
  reader.feed(encode(samples::hello()));
  EXPECT_EQ(reader.next().value().error(), Error::kTooLong);
  EXPECT_EQ(reader.buffered_bytes(), 0u);
}

TEST(MessageReader, AnEmptyMessageEndsTheStream) {
  MessageReader reader;
  reader.feed(Bytes{0, 0, 0, 0});
  EXPECT_EQ(reader.next().value().error(), Error::kTooLong);
}

TEST(MessageReader, ItsLimitIsTheCallers) {
  const Bytes hello = encode(samples::hello());
  MessageReader enough(hello.size() - kSizePrefixBytes);
  enough.feed(hello);
  EXPECT_TRUE(enough.next().value().has_value());
  MessageReader too_little(hello.size() - kSizePrefixBytes - 1);
  too_little.feed(hello);
  EXPECT_EQ(too_little.next().value().error(), Error::kTooLong);
}

TEST(MessageReader, BytesThatNobodyTakesOutDoNotPileUp) {
  const Bytes chunk(1000, 1);
  MessageReader reader(4096);
  for (int i = 0; i < 1000; ++i) {
    reader.feed(chunk);
    ASSERT_LE(reader.buffered_bytes(), 4096 + kSizePrefixBytes + chunk.size());
  }
  EXPECT_EQ(reader.next().value().error(), Error::kTooLong);
}

}  // namespace
}  // namespace yuragi::wire
