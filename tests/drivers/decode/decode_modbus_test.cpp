#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/decode/modbus/modbus.hpp"
#include "tests/support/modbus_vectors.hpp"

namespace yuragi::drivers::decode {
namespace {

using Bytes = std::vector<std::uint8_t>;
using testing::ElementsAre;

const modbus::Request kSpeedOfSlave1 = {.transaction = 0x1234, .unit = 1, .function = 3, .address = 0, .count = 1};

std::vector<std::uint16_t> registers_of(const Result<modbus::Registers, modbus::RefusedReply>& decoded) {
  if (!decoded) return {};
  return {decoded->span().begin(), decoded->span().end()};
}

/// What is wrong with a message; a test that expects a refusal fails if nothing is.
testing::AssertionResult is_refused_reply(const Result<modbus::Registers, modbus::RefusedReply>& decoded, Refusal why) {
  if (!decoded && decoded.error().why == why) return testing::AssertionSuccess();
  return testing::AssertionFailure() << (decoded ? "accepted" : name_of(decoded.error().why)) << ", not "
                                     << name_of(why);
}

Bytes with_crc(Bytes message) {
  const std::uint16_t crc = modbus::modbus_crc(message);
  message.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  message.push_back(static_cast<std::uint8_t>(crc >> 8U));
  return message;
}

TEST(ModbusRequestBytes, GoOnTcpWithTransactionLengthAndUnitInFront) {
  const modbus::Request request = {.transaction = 0x0102, .unit = 17, .function = 4, .address = 0x7531, .count = 2};
  EXPECT_THAT(modbus::encode_tcp(request), ElementsAre(1, 2, 0, 0, 0, 6, 17, 4, 0x75, 0x31, 0, 2));
}

TEST(ModbusRequestBytes, OnASerialLineHaveTheCrcOfThePublishedFrame) {
  const auto body = modbus::encode_rtu_without_crc(kSpeedOfSlave1);
  EXPECT_EQ(with_crc({body.begin(), body.end()}), (Bytes{0x01, 0x03, 0x00, 0x00, 0x00, 0x01, 0x84, 0x0A}));
}

TEST(ModbusTcpAnswer, GivesItsRegisters) {
  const modbus::Request request = {.transaction = 7, .unit = 2, .function = 3, .address = 0, .count = 2};
  const Bytes answer = {0, 7, 0, 0, 0, 7, 2, 3, 4, 0x00, 0x02, 0x01, 0x5A};
  EXPECT_THAT(registers_of(modbus::decode_tcp(request, answer)), ElementsAre(2, 346));
}

TEST(ModbusTcpAnswer, ThatEndsAnywhereBeforeItsEndIsTooShort) {
  const Bytes answer = {0x12, 0x34, 0, 0, 0, 5, 1, 3, 2, 0, 86};
  for (std::size_t size = 0; size < answer.size(); ++size) {
    EXPECT_TRUE(is_refused_reply(modbus::decode_tcp(kSpeedOfSlave1, std::span(answer).first(size)), Refusal::kTooShort))
        << size;
  }
}

TEST(ModbusTcpAnswer, WithAnEarlierTransactionOrAnotherUnitIsNotMine) {
  EXPECT_TRUE(is_refused_reply(modbus::decode_tcp(kSpeedOfSlave1, Bytes{0x12, 0x33, 0, 0, 0, 5, 1, 3, 2, 0, 86}),
                               Refusal::kNotMine));
  EXPECT_TRUE(is_refused_reply(modbus::decode_tcp(kSpeedOfSlave1, Bytes{0x12, 0x34, 0, 0, 0, 5, 2, 3, 2, 0, 86}),
                               Refusal::kNotMine));
}

TEST(ModbusTcpAnswer, ThatIsAnExceptionSaysWhich) {
  const auto decoded = modbus::decode_tcp(kSpeedOfSlave1, Bytes{0x12, 0x34, 0, 0, 0, 3, 1, 0x83, 2});
  ASSERT_TRUE(is_refused_reply(decoded, Refusal::kException));
  EXPECT_EQ(modbus::modbus_exception_name(decoded.error().exception), "illegal data address");
}

TEST(ModbusTcpAnswer, WithAnotherProtocolLengthFunctionOrByteCountIsMalformed) {
  const std::vector<Bytes> messages = {
      {0x12, 0x34, 0, 1, 0, 5, 1, 3, 2, 0, 86},         // protocol id
      {0x12, 0x34, 0, 0, 0, 0, 1, 3, 2, 0, 86},         // a length that leaves no unit id
      {0x12, 0x34, 0, 0, 9, 5, 1, 3, 2, 0, 86},         // a length that no message has
      {0x12, 0x34, 0, 0, 0, 5, 1, 3, 2, 0, 86, 0},      // longer than it says
      {0x12, 0x34, 0, 0, 0, 5, 1, 4, 2, 0, 86},         // function
      {0x12, 0x34, 0, 0, 0, 5, 1, 0x84, 2, 0, 86},      // another function's exception
      {0x12, 0x34, 0, 0, 0, 5, 1, 3, 4, 0, 86},         // byte count
      {0x12, 0x34, 0, 0, 0, 7, 1, 3, 4, 0, 86, 0, 86},  // more registers than were asked for
      {0x12, 0x34, 0, 0, 0, 6, 1, 3, 2, 0, 86, 0},      // more bytes than the byte count
      {0x12, 0x34, 0, 0, 0, 4, 1, 0x83, 2, 0},          // an exception with something behind
  };
  for (const Bytes& message : messages) {
    EXPECT_TRUE(is_refused_reply(modbus::decode_tcp(kSpeedOfSlave1, message), Refusal::kMalformed))
        << testing::PrintToString(message);
  }
}

TEST(ModbusTcpAnswer, OfAllRegistersThatOneRequestMayAskForIsTaken) {
  const modbus::Request request = {.transaction = 1, .unit = 1, .function = 3, .address = 0, .count = 125};
  Bytes answer = {0, 1, 0, 0, 0, 253, 1, 3, 250};
  answer.resize(answer.size() + 250, 0x11);
  ASSERT_EQ(registers_of(modbus::decode_tcp(request, answer)), std::vector<std::uint16_t>(125, 0x1111));
}

TEST(ModbusRtuAnswer, OfTheCupIsTheRealTranscriptsSpeed) {
  const Bytes answer = {0x01, 0x03, 0x02, 0x00, 0x56, 0x38, 0x7A};
  EXPECT_THAT(registers_of(modbus::decode_rtu(kSpeedOfSlave1, answer)), ElementsAre(86));
}

TEST(ModbusRtuAnswer, WithAStrayByteInFrontIsStillRead) {
  EXPECT_THAT(registers_of(modbus::decode_rtu(kSpeedOfSlave1, Bytes{0x00, 1, 3, 2, 0x00, 0x56, 0x38, 0x7A})),
              ElementsAre(86));
  EXPECT_THAT(registers_of(modbus::decode_rtu(kSpeedOfSlave1, Bytes{0xFF, 1, 3, 2, 0x00, 0x56, 0x38, 0x7A})),
              ElementsAre(86));
}

TEST(ModbusRtuAnswer, WithAnyBitFlippedIsRefused) {
  const Bytes answer = {0x01, 0x03, 0x02, 0x00, 0x56, 0x38, 0x7A};
  for (std::size_t bit = 0; bit < 8 * answer.size(); ++bit) {
    Bytes damaged = answer;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (1U << (bit % 8)));
    const auto decoded = modbus::decode_rtu(kSpeedOfSlave1, damaged);
    // A longer byte count makes it look cut off; everything else is a wrong sum.
    EXPECT_TRUE(is_refused_reply(decoded, Refusal::kBadChecksum) || is_refused_reply(decoded, Refusal::kTooShort))
        << bit;
  }
}

TEST(ModbusRtuAnswer, ThatEndsTooEarlyIsTooShort) {
  const Bytes answer = {0x01, 0x03, 0x02, 0x00, 0x56, 0x38, 0x7A};
  for (std::size_t size = 0; size < answer.size(); ++size) {
    EXPECT_TRUE(is_refused_reply(modbus::decode_rtu(kSpeedOfSlave1, std::span(answer).first(size)), Refusal::kTooShort))
        << size;
  }
}

TEST(ModbusRtuAnswer, OfAnotherSlaveIsNotMine) {
  EXPECT_TRUE(is_refused_reply(modbus::decode_rtu(kSpeedOfSlave1, Bytes{0x02, 0x03, 0x02, 0x00, 0x25, 0x3D, 0x9F}),
                               Refusal::kNotMine));
}

TEST(ModbusRtuAnswer, ThatIsAnExceptionSaysWhich) {
  const auto decoded = modbus::decode_rtu(kSpeedOfSlave1, Bytes{0x01, 0x83, 0x02, 0xC0, 0xF1});
  ASSERT_TRUE(is_refused_reply(decoded, Refusal::kException));
  EXPECT_EQ(decoded.error().exception, 2);
}

TEST(ModbusRtuAnswer, WithARightSumAndAnotherFunctionOrLengthIsMalformed) {
  EXPECT_TRUE(is_refused_reply(modbus::decode_rtu(kSpeedOfSlave1, with_crc({1, 4, 2, 0, 86})), Refusal::kMalformed));
  EXPECT_TRUE(
      is_refused_reply(modbus::decode_rtu(kSpeedOfSlave1, with_crc({1, 3, 4, 0, 86, 0, 86})), Refusal::kMalformed));
}

TEST(ModbusVectors, OfTheSharedCollectionDecodeAsTheySay) {
  const auto vectors = load_modbus_vectors();
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/modbus_vectors.json is not here";

  for (const ModbusVector& vector : vectors) {
    SCOPED_TRACE(vector.device);
    ASSERT_EQ(vector.request.size(), 8U);
    const modbus::Request request = {
        .transaction = 0,
        .unit = vector.request[0],
        .function = vector.request[1],
        .address = static_cast<std::uint16_t>((vector.request[2] << 8U) | vector.request[3]),
        .count = vector.request[5]};
    const auto body = modbus::encode_rtu_without_crc(request);
    EXPECT_EQ(with_crc({body.begin(), body.end()}), vector.request);

    const auto decoded = modbus::decode_rtu(request, vector.response);
    if (vector.device == "any") {
      EXPECT_TRUE(is_refused_reply(decoded, Refusal::kException));
    } else if (vector.device == "late answer of another slave") {
      EXPECT_TRUE(is_refused_reply(decoded, Refusal::kNotMine));
    } else {
      // The registers are the data bytes: what stands between the byte count and the CRC.
      ASSERT_TRUE(decoded.has_value());
      const std::size_t data = vector.response.size() - 2 - 2 * decoded->count;
      for (std::size_t i = 0; i < decoded->count; ++i) {
        EXPECT_EQ(decoded->values[i], (vector.response[data + 2 * i] << 8U) | vector.response[data + 2 * i + 1]);
      }
    }
  }
}

TEST(ModbusDecoder, TakesNoRandomBytesForAnAnswer) {
  std::mt19937_64 random(20240601);
  int accepted = 0;
  for (int round = 0; round < 200'000; ++round) {
    Bytes bytes(random() % 32);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const modbus::Request request = {.transaction = static_cast<std::uint16_t>(random()),
                                     .unit = static_cast<std::uint8_t>(random()),
                                     .function = 3,
                                     .address = 0,
                                     .count = static_cast<std::uint16_t>(random() % 200)};
    for (const auto framing : {modbus::Framing::kTcp, modbus::Framing::kRtu}) {
      const auto decoded = modbus::decode_modbus(framing, request, bytes);
      if (decoded) {
        EXPECT_EQ(decoded->count, request.count);
        ++accepted;
      }
    }
  }
  EXPECT_EQ(accepted, 0);
}

}  // namespace
}  // namespace yuragi::drivers::decode
