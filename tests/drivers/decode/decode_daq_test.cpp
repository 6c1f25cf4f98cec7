// Counter and ADC: MCC USB-1208FS-Plus, LabJack U3, and the cup and vane behind them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/decode/usb/cup_counter.hpp"
#include "drivers/decode/usb/labjack.hpp"
#include "drivers/decode/usb/mcc1208.hpp"
#include "drivers/decode/usb/potentiometer_vane.hpp"
#include "engine/wind/wind_reading.hpp"
#include "tests/support/byte_vectors.hpp"

namespace yuragi::drivers::decode {
namespace {

using test::hex_bytes;
using DaqBytes = std::vector<std::uint8_t>;

// --- MCC USB-1208FS-Plus

TEST(Mcc1208Reply, IsACountOrAnAnalogValue) {
  EXPECT_EQ(*usb::decode_mcc1208_count(test::hex_bytes("d2 04 00 00")), 1234U);
  EXPECT_EQ(*usb::decode_mcc1208_count(test::hex_bytes("ff ff ff ff")), 0xFFFFFFFFU);
  EXPECT_EQ(*usb::decode_mcc1208_analog(test::hex_bytes("ff 0f")), 4095);
}

TEST(Mcc1208Reply, OfAnotherLengthOrMoreThanTwelveBitsIsRefused) {
  EXPECT_EQ(usb::decode_mcc1208_count({}).error(), Refusal::kTooShort);
  EXPECT_EQ(usb::decode_mcc1208_count(test::hex_bytes("01 02")).error(), Refusal::kTooShort)
      << "no analog value for a count";
  EXPECT_EQ(usb::decode_mcc1208_count(test::hex_bytes("01 02 03 04 05")).error(), Refusal::kMalformed);
  EXPECT_EQ(usb::decode_mcc1208_analog(test::hex_bytes("01")).error(), Refusal::kTooShort);
  EXPECT_EQ(usb::decode_mcc1208_analog(test::hex_bytes("01 02 03")).error(), Refusal::kMalformed);
  EXPECT_EQ(usb::decode_mcc1208_analog(test::hex_bytes("00 10")).error(), Refusal::kMalformed);
}

TEST(Mcc1208Volts, AreThoseOfTheInputsAgainstGround) {
  EXPECT_DOUBLE_EQ(usb::mcc1208_volts(2048, {}), 0.0);
  EXPECT_DOUBLE_EQ(usb::mcc1208_volts(0, {}), -10.0);
  EXPECT_DOUBLE_EQ(usb::mcc1208_volts(3072, {}), 5.0);
  EXPECT_NEAR(usb::mcc1208_volts(2048, {.slope = 1.0, .intercept_steps = 2.048}), 0.01, 1e-12);
}

TEST(Mcc1208Calibration, IsTwoFloatsOfWhichBothMustBeBelievable) {
  const auto calibration = usb::decode_mcc1208_calibration(test::hex_bytes("00 00 80 3f 00 00 20 c1"));
  ASSERT_TRUE(calibration.has_value());
  EXPECT_DOUBLE_EQ(calibration->slope, 1.0);
  EXPECT_DOUBLE_EQ(calibration->intercept_steps, -10.0);
  for (const char* const hex : {"ff ff ff ff ff ff ff ff", "00 00 00 00 00 00 00 00", "00 00 80 3f 00 00 80 7f",
                                "00 00 80 3f 00 00 80 44", "00 00 00 40 00 00 00 00"}) {
    EXPECT_EQ(usb::decode_mcc1208_calibration(test::hex_bytes(hex)).error(), Refusal::kInvalid) << hex;
  }
  EXPECT_EQ(usb::decode_mcc1208_calibration(test::hex_bytes("00 00 80 3f")).error(), Refusal::kTooShort);
}

TEST(Mcc1208Transfers, AreThePublishedOnes) {
  EXPECT_EQ(usb::mcc1208_read_analog(3), (usb::Mcc1208Transfer{0xC0, 0x10, 3, 1, 2}));
  EXPECT_EQ(usb::mcc1208_read_calibration(7), (usb::Mcc1208Transfer{0xC0, 0x30, 0x138, 0, 8}));
}

// --- LabJack U3

const std::string kLabjackReplyHex = "ff f8 05 00 00 02 00 00 00 b0 7a d2 04 00 00 00";

/// A reply with these bytes behind its header, and right sums.
DaqBytes labjack_reply(const std::string& data_hex, std::uint8_t command = 0) {
  const auto data = test::hex_bytes(data_hex);
  const std::uint16_t sum = sum_16(data);
  DaqBytes reply(6 + data.size());
  reply[1] = 0xF8;
  reply[2] = static_cast<std::uint8_t>(data.size() / 2);
  reply[3] = command;
  reply[4] = static_cast<std::uint8_t>(sum & 0xFFU);
  reply[5] = static_cast<std::uint8_t>(sum >> 8U);
  std::ranges::copy(data, reply.begin() + 6);
  unsigned head = 0;
  for (std::size_t i = 1; i < 6; ++i) head += reply[i];
  while (head > 0xFF) head = (head & 0xFFU) + (head >> 8U);
  reply[0] = static_cast<std::uint8_t>(head);
  return reply;
}

testing::AssertionResult is_refused_by_labjack(const usb::LabjackRequest& request, const DaqBytes& reply, Refusal why) {
  const auto decoded = usb::decode_labjack(request, reply);
  if (!decoded && decoded.error().why == why) return testing::AssertionSuccess();
  return testing::AssertionFailure() << (decoded ? "accepted" : name_of(decoded.error().why));
}

TEST(LabjackReply, HoldsWhatWasAskedFor) {
  const auto both = usb::decode_labjack({}, test::hex_bytes(kLabjackReplyHex));
  ASSERT_TRUE(both.has_value());
  EXPECT_EQ(both->analog, 31408);
  EXPECT_EQ(both->count, 1234U);

  const auto analog = usb::decode_labjack({.echo = 7, .counter = {}}, labjack_reply("00 00 07 34 12 00"));
  ASSERT_TRUE(analog.has_value());
  EXPECT_EQ(analog->analog, 0x1234);
  EXPECT_FALSE(analog->count.has_value());

  const auto count = usb::decode_labjack({.analog_channel = {}}, labjack_reply("00 00 00 01 02 03 04 00"));
  ASSERT_TRUE(count.has_value());
  EXPECT_EQ(count->count, 0x04030201U);
  EXPECT_FALSE(count->analog.has_value());
}

TEST(LabjackReply, IsRefusedInGrades) {
  const auto reply = test::hex_bytes(kLabjackReplyHex);
  for (std::size_t size = 0; size < reply.size(); ++size) {
    EXPECT_TRUE(is_refused_by_labjack({}, {reply.begin(), reply.begin() + static_cast<std::ptrdiff_t>(size)},
                                      Refusal::kTooShort))
        << size;
  }
  for (std::size_t i = 3; i < reply.size(); ++i) {
    auto damaged = reply;
    damaged[i] = static_cast<std::uint8_t>(damaged[i] ^ 0x10U);
    EXPECT_TRUE(is_refused_by_labjack({}, damaged, Refusal::kBadChecksum)) << i;
  }
  EXPECT_TRUE(is_refused_by_labjack({}, labjack_reply("00 00 00 00", 0x0B), Refusal::kNotMine));
  EXPECT_TRUE(is_refused_by_labjack({.echo = 1}, reply, Refusal::kNotMine));
  EXPECT_TRUE(is_refused_by_labjack({}, labjack_reply("00 00 00 34 12 00"), Refusal::kMalformed));
  EXPECT_TRUE(is_refused_by_labjack({}, labjack_reply("00 00"), Refusal::kMalformed));
  auto longer = reply;
  longer.push_back(0);
  EXPECT_TRUE(is_refused_by_labjack({}, longer, Refusal::kMalformed));
  EXPECT_TRUE(is_refused_by_labjack({}, test::hex_bytes("ff f9 05 00 00 02"), Refusal::kMalformed));
}

TEST(LabjackReply, ThatIsAnErrorSaysWhich) {
  const auto refused = usb::decode_labjack({}, labjack_reply("31 01 00 00"));
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().why, Refusal::kException);
  EXPECT_EQ(refused.error().error, 0x31);
  EXPECT_TRUE(is_refused_by_labjack({}, test::hex_bytes("b8 b8"), Refusal::kException));
}

TEST(LabjackReply, HoldsAReferenceBetweenTheTwo) {
  const usb::LabjackRequest request = {.echo = 9, .reference_channel = 1, .counter = 1};
  const auto command = usb::encode_labjack_feedback(request);
  const auto data = test::hex_bytes("09 01 00 1f 01 01 1f 37 00 00");
  EXPECT_TRUE(std::ranges::equal(command.span().subspan(6), std::span(data).first(command.size - 6)));
  const auto reply = usb::decode_labjack(request, labjack_reply("00 00 09 10 27 e8 03 05 00 00 00 00"));
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->analog, 10'000);
  EXPECT_EQ(reply->reference, 1'000);
  EXPECT_EQ(reply->count, 5U);
}

TEST(LabjackConfiguration, IsRefusedWhereTheDeviceDidSomethingElse) {
  EXPECT_TRUE(usb::decode_labjack_configuration(0, labjack_reply("00 00 44 00 0f 00", 0x0B)).has_value());
  EXPECT_TRUE(usb::decode_labjack_configuration(1, labjack_reply("00 00 48 00 ff 00", 0x0B)).has_value());
  EXPECT_EQ(usb::decode_labjack_configuration(1, labjack_reply("00 00 44 00 0f 00", 0x0B)).error().why,
            Refusal::kInvalid);
  EXPECT_EQ(usb::decode_labjack_configuration(0, labjack_reply("00 00 44 00 0e 00", 0x0B)).error().why,
            Refusal::kInvalid);
  const auto refused = usb::decode_labjack_configuration(0, labjack_reply("51 00 44 00 0f 00", 0x0B));
  EXPECT_EQ(refused.error().why, Refusal::kException);
  EXPECT_EQ(refused.error().error, 0x51);
  EXPECT_EQ(usb::decode_labjack_configuration(0, labjack_reply("00 00 44 00", 0x0B)).error().why, Refusal::kMalformed);
}

TEST(LabjackIdentity, IsItsSerialNumberAndHowItsInputsAreBuilt) {
  std::string hex = "00 00 00 00 00 00 00 00 00 39 30 13 13";
  for (int i = 13; i < 31; ++i) hex += " 00";
  const auto high = usb::decode_labjack_identity(labjack_reply(hex + " 12", 0x08));
  ASSERT_TRUE(high.has_value());
  EXPECT_EQ(high->serial, 320'024'633U);
  EXPECT_EQ(high->input, usb::LabjackInput::kHighVoltage);
  EXPECT_EQ(usb::decode_labjack_identity(labjack_reply(hex + " 02", 0x08))->input, usb::LabjackInput::kLowVoltage);
  EXPECT_EQ(usb::decode_labjack_identity(labjack_reply(hex, 0x08)).error().why, Refusal::kMalformed);
}

TEST(LabjackMemory, HoldsFourNumbersWithThePointInTheMiddle) {
  const auto block =
      usb::decode_labjack_memory(labjack_reply("00 00  00 00 00 80 01 00 00 00  00 00 00 40 f5 ff ff ff"
                                               "  00 00 00 00 00 00 00 00  00 00 00 00 02 00 00 00",
                                               0x2D));
  ASSERT_TRUE(block.has_value());
  EXPECT_THAT(*block, testing::ElementsAre(1.5, -10.75, 0.0, 2.0));
}

TEST(LabjackCommands, HaveTheSumsThatTheMakersDriverComputes) {
  const auto identity = usb::encode_labjack_identity();
  EXPECT_EQ(identity.size, 26U);
  EXPECT_EQ(identity.bytes[0], 11);  // as LJUSB_U3_FirmwareHardwareVersion() has it
  const auto memory = usb::encode_labjack_memory(3);
  EXPECT_EQ(DaqBytes(memory.span().begin(), memory.span().end()), test::hex_bytes("2a f8 01 2d 03 00 00 03"));
}

TEST(LabjackVolts, AreNominal) {
  EXPECT_NEAR(usb::nominal_labjack_calibration(usb::LabjackInput::kLowVoltage).volts(65535), 2.44, 1e-3);
  EXPECT_NEAR(usb::nominal_labjack_calibration(usb::LabjackInput::kHighVoltage).volts(32803), 0.0, 1e-3);
}

TEST(LabjackCalibration, OfWhatNoInputIsOffByIsNotBelieved) {
  EXPECT_TRUE(is_believable({0.000316, -10.4}, usb::LabjackInput::kHighVoltage));
  EXPECT_FALSE(is_believable({0.000316, -12.0}, usb::LabjackInput::kHighVoltage));
  EXPECT_FALSE(is_believable({0.0, 0.0}, usb::LabjackInput::kLowVoltage));
  EXPECT_FALSE(is_believable({std::numeric_limits<double>::quiet_NaN(), 0.0}, usb::LabjackInput::kLowVoltage));
}

TEST(DaqVectors, OfTheSharedCollectionDecodeAsTheySay) {
  const auto vectors = test::load_byte_vectors("usb_vectors.json", "");
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/usb_vectors.json is not here";

  int checked_count = 0;
  for (const auto& vector : vectors) {
    const std::string operation = vector["op"];
    SCOPED_TRACE(operation);
    if (operation == "read counter 0") {
      EXPECT_EQ(*usb::decode_mcc1208_count(test::hex_bytes(vector["reply"])),
                vector["expect"]["count"].get<unsigned>());
      ++checked_count;
    } else if (operation.starts_with("ConfigIO")) {
      const auto command = usb::encode_labjack_configuration(0);
      EXPECT_EQ(DaqBytes(command.span().begin(), command.span().end()), test::hex_bytes(vector["bytes"]));
      ++checked_count;
    } else if (operation.starts_with("Feedback")) {
      const auto command = usb::encode_labjack_feedback({});
      EXPECT_EQ(DaqBytes(command.span().begin(), command.span().end()), test::hex_bytes(vector["bytes"]));
      const auto decoded = usb::decode_labjack({}, test::hex_bytes(vector["reply"]));
      ASSERT_TRUE(decoded.has_value());
      EXPECT_EQ(decoded->analog, vector["expect"]["ain_raw"].get<unsigned>());
      EXPECT_EQ(decoded->count, vector["expect"]["counter"].get<unsigned>());
      ++checked_count;
    }
  }
  EXPECT_EQ(checked_count, 3);
}

// --- the cup

/// A cup in steady wind, polled at a rate; the counter starts where one likes.
std::vector<double> speeds_in_steady_wind(const usb::CupCalibration& cup, double speed_m_s, double rate_hz,
                                          std::uint32_t start) {
  std::vector<double> speeds;
  usb::CupState state;
  const double pulses_per_poll = speed_m_s / cup.metres_per_pulse / rate_hz;
  for (int poll = 0; poll < 600; ++poll) {
    const auto count = start + static_cast<std::uint32_t>(std::floor(pulses_per_poll * poll));
    const auto speed = usb::advance_cup(state, cup, count, 1.0 / rate_hz);
    if (speed) speeds.push_back(**speed);
  }
  return speeds;
}

TEST(Cup, InSteadyWindGivesItsSpeedWithinOnePulseOfTheWindow) {
  const usb::CupCalibration cup = {.metres_per_pulse = 0.667};
  for (const double speed_m_s : {0.3, 1.0, 5.0, 20.0, 60.0}) {
    const auto speeds = speeds_in_steady_wind(cup, speed_m_s, 10.0, 0);
    ASSERT_GE(speeds.size(), 50U) << speed_m_s;  // at least one a second
    double sum_m_s = 0.0;
    for (const double each_m_s : speeds) {
      // A window of 4 pulses or of a second is off by at most one pulse in it.
      EXPECT_NEAR(each_m_s, speed_m_s, std::max(0.667, speed_m_s * 0.34)) << speed_m_s;
      sum_m_s += each_m_s;
    }
    EXPECT_NEAR(sum_m_s / static_cast<double>(speeds.size()), speed_m_s, 0.05 * speed_m_s + 0.02);
  }
}

TEST(Cup, IsTheSameAcrossTheWrapOfItsCounter) {
  const usb::CupCalibration cup = {.metres_per_pulse = 0.1};
  EXPECT_EQ(speeds_in_steady_wind(cup, 5.0, 10.0, 0xFFFFFFFFU - 1000), speeds_in_steady_wind(cup, 5.0, 10.0, 0));
}

TEST(Cup, WithoutPulsesIsCalmAfterTheLongestWindowAndWithoutItsOffset) {
  const usb::CupCalibration cup = {.metres_per_pulse = 0.1, .offset_m_s = 0.4};
  usb::CupState state;
  EXPECT_FALSE(usb::advance_cup(state, cup, 7, 0.0).has_value());
  EXPECT_FALSE(usb::advance_cup(state, cup, 7, 0.5).has_value());
  EXPECT_EQ(**usb::advance_cup(state, cup, 7, 0.5), 0.0);
  EXPECT_FALSE(usb::advance_cup(state, cup, 8, 0.5).has_value());
  EXPECT_DOUBLE_EQ(**usb::advance_cup(state, cup, 8, 0.5), 0.5);
}

TEST(Cup, WhoseCounterGoesBackBeginsAnew) {
  const usb::CupCalibration cup = {.metres_per_pulse = 0.1};
  usb::CupState state;
  EXPECT_FALSE(usb::advance_cup(state, cup, 1'000'000, 0.1).has_value());
  EXPECT_FALSE(usb::advance_cup(state, cup, 1'000'003, 0.1).has_value());
  EXPECT_EQ(usb::advance_cup(state, cup, 2, 0.1)->error(), Refusal::kImplausible);
  EXPECT_DOUBLE_EQ(**usb::advance_cup(state, cup, 7, 0.1), 5.0);  // 5 pulses of 0.1 m in 0.1 s
}

TEST(Cup, DrivenByNoWindIsImplausible) {
  const usb::CupCalibration cup = {.metres_per_pulse = 0.1};
  for (const double elapsed_s :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 0.1}) {
    usb::CupState state;
    EXPECT_FALSE(usb::advance_cup(state, cup, 0, 0.1).has_value());
    EXPECT_EQ(usb::advance_cup(state, cup, 100'000, elapsed_s)->error(), Refusal::kImplausible) << elapsed_s;
  }
}

TEST(Cup, ReadTwiceAtOnceMakesNoGustOfALateRead) {
  const usb::CupCalibration cup = {.metres_per_pulse = 0.1};
  usb::CupState state;
  EXPECT_FALSE(usb::advance_cup(state, cup, 0, 0.1).has_value());
  EXPECT_FALSE(usb::advance_cup(state, cup, 5, 0.001).has_value());
  EXPECT_NEAR(**usb::advance_cup(state, cup, 5, 0.099), 5.0, 1e-9);
}

TEST(Cup, GivesNoSpeedOutOfRangeForAnyCounts) {
  std::mt19937_64 random(20240606);
  const usb::CupCalibration cup = {.metres_per_pulse = 0.05, .offset_m_s = -0.2};
  usb::CupState state;
  std::uint32_t count = 0;
  for (int round = 0; round < 200'000; ++round) {
    count =
        random() % 4 == 0 ? static_cast<std::uint32_t>(random()) : count + static_cast<std::uint32_t>(random() % 300);
    const auto speed = usb::advance_cup(state, cup, count, static_cast<double>(random() % 400) / 1000.0);
    if (speed && speed->has_value()) {
      EXPECT_GE(**speed, 0.0);
      EXPECT_LE(**speed, wind::kMaxPlausibleSpeed_m_s);
    }
  }
}

// --- the vane

TEST(Vane, IsAShareOfItsTrack) {
  const usb::VaneCalibration vane;
  EXPECT_EQ(usb::vane_direction_deg(vane, 0.0, 5.0), 0.0);
  EXPECT_EQ(usb::vane_direction_deg(vane, 2.5, 5.0), 178.0);
  EXPECT_EQ(usb::vane_direction_deg(vane, 5.0, 5.0), 356.0);
}

TEST(Vane, HasNoDirectionInItsDeadBand) {
  const usb::VaneCalibration vane = {.lowest_ratio = 0.05, .highest_ratio = 0.95};
  EXPECT_FALSE(usb::vane_direction_deg(vane, 0.0, 5.0).has_value());
  EXPECT_FALSE(usb::vane_direction_deg(vane, 5.0, 5.0).has_value());
  EXPECT_FALSE(usb::vane_direction_deg(vane, -0.3, 5.0).has_value());
  EXPECT_EQ(usb::vane_direction_deg(vane, 0.245, 5.0), 0.0);  // noise at the very end of the track
}

TEST(Vane, IsTurnedByWhereItsTrackBegins) {
  const usb::VaneCalibration vane = {.electrical_deg = 360.0, .start_deg = 270.0};
  EXPECT_EQ(usb::vane_direction_deg(vane, 2.5, 5.0), 90.0);
  EXPECT_EQ(usb::vane_direction_deg(vane, 1.25, 5.0), 0.0);
  EXPECT_EQ(usb::vane_direction_deg({.electrical_deg = 360.0, .start_deg = -1e-20}, 0.0, 5.0), 0.0);
}

TEST(Vane, WithoutAReferenceOrANumberHasNoDirection) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(usb::vane_direction_deg({}, 1.0, 0.0).has_value());
  EXPECT_FALSE(usb::vane_direction_deg({}, 1.0, -5.0).has_value());
  EXPECT_FALSE(usb::vane_direction_deg({}, nan, 5.0).has_value());
  EXPECT_FALSE(usb::vane_direction_deg({}, 1.0, nan).has_value());
}

TEST(Vane, IsNeverOutOfRange) {
  std::mt19937_64 random(20240607);
  std::uniform_real_distribution<double> anything(-10.0, 10.0);
  for (int round = 0; round < 100'000; ++round) {
    const usb::VaneCalibration vane = {.start_deg = 100.0 * anything(random)};
    const auto direction_deg = usb::vane_direction_deg(vane, anything(random), anything(random));
    if (direction_deg) {
      EXPECT_GE(*direction_deg, 0.0);
      EXPECT_LT(*direction_deg, 360.0);
    }
  }
}

// --- all

TEST(DaqDecoders, TakeNoRandomBytesForALabjacksReply) {
  std::mt19937_64 random(20240608);
  for (int round = 0; round < 200'000; ++round) {
    auto bytes = test::random_bytes(random, random() % 20);
    if (bytes.size() >= 3 && random() % 2 == 0) {
      bytes[1] = 0xF8;
      bytes[2] = 5;
    }
    EXPECT_FALSE(usb::decode_labjack({}, bytes).has_value());
    EXPECT_FALSE(usb::decode_labjack_identity(bytes).has_value());
    EXPECT_FALSE(usb::decode_labjack_configuration(0, bytes).has_value());
    EXPECT_FALSE(usb::decode_labjack_memory(bytes).has_value());
  }
}

}  // namespace
}  // namespace yuragi::drivers::decode
