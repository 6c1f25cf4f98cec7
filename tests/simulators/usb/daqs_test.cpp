// The simulated counter and ADC devices, spoken to by hand.
#include "simulators/usb/daqs.hpp"

#include <bit>
#include <numeric>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::simulators::usb {
namespace {

using testing::AnyOf;
using testing::ElementsAre;
using testing::Eq;

constexpr SetupPacket kReadCount = {0xC0, 0x20, 0, 0, 4};
constexpr SetupPacket kClearCount = {0x40, 0x20, 0, 0, 0};
const Bytes kEnableCounter0 = {0x67, 0xF8, 0x03, 0x0B, 0x60, 0x00, 0x0D, 0x00, 0x44, 0x00, 0x0F, 0x00};
const Bytes kReadVaneAndCup = {0x52, 0xF8, 0x03, 0x00, 0x56, 0x00, 0x00, 0x01, 0x00, 0x1F, 0x36, 0x00};

std::uint64_t low_first(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8U | bytes[i];
  return value;
}

std::uint64_t count_of(Device& mcc) {
  const auto reply = mcc.control(kReadCount, {});
  return reply && reply->size() == 4 ? low_first(*reply) : ~std::uint64_t{0};
}

/// The voltage at an input against ground, calibrated as the maker's driver does it.
double volts_of(Device& mcc, std::uint16_t channel) {
  const auto code = mcc.control({0xC0, 0x10, channel, 1, 2}, {});
  const auto memory = mcc.control({0xC0, 0x30, static_cast<std::uint16_t>(0x100 + 8 * channel), 0, 8}, {});
  if (!code || !memory) return -99.0;
  const auto slope = std::bit_cast<float>(static_cast<std::uint32_t>(low_first(std::span(*memory).first(4))));
  const auto intercept = std::bit_cast<float>(static_cast<std::uint32_t>(low_first(std::span(*memory).subspan(4))));
  const double calibrated =
      static_cast<double>(low_first(*code)) * static_cast<double>(slope) + static_cast<double>(intercept);
  return (calibrated - 2048.0) * 10.0 / 2048.0;
}

/// The whole reply to a command; empty if there is none.
Bytes ask(Device& labjack, const Bytes& command) {
  if (!labjack.out(1, command)) return {};
  return labjack.in(2, 64).value_or(Bytes{});
}

double fixed_point(std::span<const std::uint8_t> bytes) {
  return static_cast<double>(static_cast<std::int64_t>(low_first(bytes.first(8)))) / 4294967296.0;
}

TEST(Mcc1208Model, CountsAPulseForEachTenthOfAMetreOfWind) {
  const auto device = make_daq("mcc1208");
  device->advance(0.0, {5.0, 90.0}, {});
  EXPECT_EQ(count_of(*device), 0U);
  for (int step = 1; step <= 100; ++step) device->advance(step * 0.1, {5.0, 90.0}, {});
  EXPECT_NEAR(static_cast<double>(count_of(*device)), 500.0, 1.0);
  EXPECT_TRUE(device->control(kClearCount, {}).has_value());
  EXPECT_EQ(count_of(*device), 0U);
}

TEST(Mcc1208Model, GivesTheVanesVoltageAndItsReference) {
  const auto device = make_daq("mcc1208");
  for (const double direction_deg : {0.0, 89.0, 178.0, 356.0}) {
    device->advance(1.0, {3.0, direction_deg}, {});
    EXPECT_NEAR(volts_of(*device, 0), direction_deg / 356.0 * 5.0, 0.006) << direction_deg;
    EXPECT_NEAR(volts_of(*device, 1), 5.0, 0.006);
  }
  device->advance(2.0, {3.0, 358.0}, {});
  EXPECT_NEAR(volts_of(*device, 0), 5.5, 0.006) << "beside the track";
}

TEST(Mcc1208Model, RefusesWhatTheDeviceDoesNotKnow) {
  const auto device = make_daq("mcc1208");
  EXPECT_FALSE(device->control({0xC0, 0x77, 0, 0, 4}, {}).has_value());
  EXPECT_FALSE(device->control({0xC0, 0x10, 8, 1, 2}, {}).has_value()) << "there are inputs 0 to 7";
  EXPECT_FALSE(device->control({0xC0, 0x30, 768, 0, 4}, {}).has_value());
  EXPECT_FALSE(device->control({0xA1, 0x20, 0, 0, 4}, {}).has_value());
  EXPECT_FALSE(device->in(1, 64).has_value());
  EXPECT_FALSE(device->out(2, Bytes{1}));
}

TEST(Mcc1208Model, SuffersItsFaults) {
  const auto device = make_daq("mcc1208");
  device->advance(0.0, {5.0, 90.0}, {});
  device->advance(1.0, {5.0, 90.0}, {});
  device->advance(3.0, {5.0, 90.0}, core::FaultKind::kFreeze);
  EXPECT_EQ(count_of(*device), 50U);
  device->advance(3.0, {5.0, 90.0}, core::FaultKind::kPartial);
  EXPECT_EQ(device->control(kReadCount, {})->size(), 3U);
  device->advance(3.0, {5.0, 90.0}, core::FaultKind::kException);
  EXPECT_FALSE(device->control(kReadCount, {}).has_value());
  device->advance(3.0, {5.0, 90.0}, core::FaultKind::kGarbage);
  EXPECT_NE(count_of(*device), 50U);
  device->advance(3.0, {5.0, 90.0}, core::FaultKind::kUnplug);
  device->advance(4.0, {5.0, 90.0}, {});
  EXPECT_NEAR(static_cast<double>(count_of(*device)), 50.0, 1.0) << "since it was plugged in again";
}

TEST(LabjackModel, CountsOnlyOnceItsCounterIsOn) {
  const auto device = make_daq("labjack-u3");
  device->advance(0.0, {5.0, 178.0}, {});
  EXPECT_NE(ask(*device, kReadVaneAndCup).at(6), 0) << "the counter is off";
  EXPECT_THAT(ask(*device, kEnableCounter0),
              ElementsAre(0x5A, 0xF8, 0x03, 0x0B, 0x53, 0x00, 0x00, 0x00, 0x44, 0x00, 0x0F, 0x00));
  device->advance(2.0, {5.0, 178.0}, {});
  const Bytes reply = ask(*device, kReadVaneAndCup);
  ASSERT_EQ(reply.size(), 16U);
  EXPECT_EQ(reply[6], 0);
  EXPECT_EQ(low_first(std::span(reply).subspan(11, 4)), 100U);
}

TEST(LabjackModel, GivesTheVanesVoltageByItsCalibration) {
  const auto device = make_daq("labjack-u3");
  device->advance(0.0, {5.0, 178.0}, {});
  ask(*device, kEnableCounter0);
  const Bytes reply = ask(*device, kReadVaneAndCup);
  ASSERT_EQ(reply.size(), 16U);
  const double code = static_cast<double>(low_first(std::span(reply).subspan(9, 2)));
  const Bytes slopes = ask(*device, {0x2A, 0xF8, 0x01, 0x2D, 0x03, 0x00, 0x00, 0x03});
  const Bytes offsets = ask(*device, {0x2B, 0xF8, 0x01, 0x2D, 0x04, 0x00, 0x00, 0x04});
  ASSERT_EQ(slopes.size(), 40U);
  ASSERT_EQ(offsets.size(), 40U);
  EXPECT_NEAR(code * fixed_point(std::span(slopes).subspan(8)) + fixed_point(std::span(offsets).subspan(8)), 2.5,
              0.006);
}

TEST(LabjackModel, SaysWhatItIs) {
  const auto device = make_daq("labjack-u3");
  Bytes command(26, 0);
  command[0] = 0x0B;  // the sum of the three that are not 0, with its carry
  command[1] = 0xF8;
  command[2] = 0x0A;
  command[3] = 0x08;
  const Bytes reply = ask(*device, command);
  ASSERT_EQ(reply.size(), 38U);
  EXPECT_EQ(low_first(std::span(reply).subspan(15, 4)), 320'012'345U);
  EXPECT_EQ(reply[37] & 18, 18) << "a U3-HV";
}

TEST(LabjackModel, AnswersACommandWithAWrongSumAsTheDeviceDoes) {
  const auto device = make_daq("labjack-u3");
  Bytes damaged = kReadVaneAndCup;
  damaged[8] = 1;
  EXPECT_THAT(ask(*device, damaged), ElementsAre(0xB8, 0xB8));
  EXPECT_THAT(ask(*device, {}), ElementsAre(0xB8, 0xB8));
}

TEST(LabjackModel, SuffersItsFaults) {
  const auto device = make_daq("labjack-u3");
  const core::PlayedMoment wind = {5.0, 90.0};
  ask(*device, kEnableCounter0);
  const Bytes right = ask(*device, kReadVaneAndCup);

  device->advance(0.0, wind, core::FaultKind::kSilence);
  EXPECT_TRUE(ask(*device, kReadVaneAndCup).empty());
  device->advance(0.0, wind, core::FaultKind::kPartial);
  EXPECT_EQ(ask(*device, kReadVaneAndCup).size(), right.size() - 1);
  device->advance(0.0, wind, core::FaultKind::kBadChecksum);
  const Bytes damaged = ask(*device, kReadVaneAndCup);
  EXPECT_EQ(damaged.size(), right.size());
  EXPECT_EQ(damaged.at(4) - 1, std::accumulate(damaged.begin() + 6, damaged.end(), 0) & 0xFF);
  device->advance(0.0, wind, core::FaultKind::kWrongTransaction);
  EXPECT_EQ(ask(*device, kReadVaneAndCup).at(8), 0xFF);
  device->advance(0.0, wind, core::FaultKind::kException);
  EXPECT_NE(ask(*device, kReadVaneAndCup).at(6), 0);
  device->advance(0.0, wind, core::FaultKind::kGarbage);
  EXPECT_NE(ask(*device, kReadVaneAndCup).at(1), 0xF8);

  // What is late comes with the answer to the next command.
  device->advance(0.0, wind, core::FaultKind::kLate);
  EXPECT_TRUE(ask(*device, kReadVaneAndCup).empty());
  device->advance(0.0, wind, {});
  EXPECT_EQ(ask(*device, kReadVaneAndCup).size(), right.size());
  EXPECT_TRUE(device->in(2, 64).has_value());
  EXPECT_FALSE(device->in(2, 64).has_value());
}

TEST(DaqModels, ShowDescriptorsOfTheLengthThatTheyTell) {
  for (const std::string& name : daq_names()) {
    const auto device = make_daq(name);
    const Descriptors& descriptors = device->descriptors();
    ASSERT_EQ(descriptors.device.size(), 18U) << name;
    EXPECT_EQ(descriptors.device[0], 18);
    EXPECT_THAT(low_first(std::span(descriptors.device).subspan(8, 4)), AnyOf(Eq(0x00E809DBU), Eq(0x00030CD5U)));
    const Bytes& configuration = descriptors.configuration;
    EXPECT_EQ(low_first(std::span(configuration).subspan(2, 2)), configuration.size()) << name;
    std::size_t at = 0;
    while (at < configuration.size() && configuration[at] > 0) at += configuration[at];
    EXPECT_EQ(at, configuration.size()) << name;
  }
}

TEST(DaqModels, OfAnotherNameAreNotThere) {
  EXPECT_THROW(make_daq("wmr100"), std::runtime_error);
}

TEST(DaqModels, StandAnyBytesFromTheHost) {
  std::mt19937_64 random(20260607);
  const auto kinds = std::array{core::FaultKind::kGarbage, core::FaultKind::kPartial, core::FaultKind::kBadChecksum,
                                core::FaultKind::kLate, core::FaultKind::kUnplug};
  for (const std::string& name : daq_names()) {
    const auto device = make_daq(name);
    for (int round = 0; round < 50'000; ++round) {
      Bytes bytes(random() % 70);
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
      if (bytes.size() >= 4 && random() % 2 == 0) {
        bytes[1] = 0xF8;
        bytes[2] = static_cast<std::uint8_t>((bytes.size() - 6) / 2);
      }
      const auto fault = random() % 8;
      device->advance(round * 0.01, {5.0, 90.0}, fault < kinds.size() ? std::optional(kinds[fault]) : std::nullopt);
      const SetupPacket setup = {static_cast<std::uint8_t>(random() % 2 == 0 ? 0xC0 : random()),
                                 static_cast<std::uint8_t>(random() % 0x50),
                                 static_cast<std::uint16_t>(random() % 0x400), static_cast<std::uint16_t>(random()),
                                 static_cast<std::uint16_t>(random() % 100)};
      if (const auto reply = device->control(setup, bytes)) {
        EXPECT_LE(reply->size(), setup.length);
      }
      static_cast<void>(device->out(static_cast<std::uint8_t>(random() % 3), bytes));
      const std::size_t room = random() % 70;
      if (const auto reply = device->in(2, room)) {
        EXPECT_LE(reply->size(), room);
      }
    }
  }
}

}  // namespace
}  // namespace yuragi::simulators::usb
