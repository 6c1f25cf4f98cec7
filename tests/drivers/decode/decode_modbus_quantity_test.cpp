#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "drivers/decode/modbus/modbus_quantity.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::decode {
namespace {

using Registers = std::vector<std::uint16_t>;

testing::AssertionResult is_refused(const Result<double, Refusal>& decoded, Refusal why) {
  if (!decoded && decoded.error() == why) return testing::AssertionSuccess();
  return testing::AssertionFailure() << (decoded ? "accepted" : name_of(decoded.error())) << ", not " << name_of(why);
}

modbus::Quantity speed(modbus::RegisterType type, modbus::ByteOrder order = modbus::ByteOrder::kABCD) {
  modbus::Quantity quantity;
  quantity.type = type;
  quantity.order = order;
  return quantity;
}

modbus::Quantity direction(modbus::DirectionMap map) {
  modbus::Quantity quantity;
  quantity.unit = modbus::QuantityUnit::kDegrees;
  quantity.map = map;
  return quantity;
}

Registers registers_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return {static_cast<std::uint16_t>(bits >> 16U), static_cast<std::uint16_t>(bits & 0xFFFFU)};
}

TEST(ModbusQuantity, ReadsEveryType) {
  EXPECT_DOUBLE_EQ(*modbus::decode_speed_m_s(speed(modbus::RegisterType::kU16), Registers{86}), 86.0);
  EXPECT_DOUBLE_EQ(*modbus::decode_speed_m_s(speed(modbus::RegisterType::kI16), Registers{86}), 86.0);
  EXPECT_DOUBLE_EQ(*modbus::decode_speed_m_s(speed(modbus::RegisterType::kU32), Registers{0, 86}), 86.0);
  EXPECT_DOUBLE_EQ(*modbus::decode_speed_m_s(speed(modbus::RegisterType::kI32), Registers{0, 86}), 86.0);
  EXPECT_DOUBLE_EQ(*modbus::decode_speed_m_s(speed(modbus::RegisterType::kF32), Registers{0x40B0, 0x0000}), 5.5);
}

TEST(ModbusQuantity, ReadsNegativeNumbersOfSignedTypesAsNegative) {
  modbus::Quantity shifted = speed(modbus::RegisterType::kI16);
  shifted.offset = 10.0;
  EXPECT_DOUBLE_EQ(*modbus::decode_speed_m_s(shifted, Registers{0xFFFE}), 8.0);
  shifted.type = modbus::RegisterType::kI32;
  EXPECT_DOUBLE_EQ(*modbus::decode_speed_m_s(shifted, Registers{0xFFFF, 0xFFFD}), 7.0);
}

TEST(ModbusQuantity, ReadsEveryByteOrder) {
  // 5.5 as f32 is 40 B0 00 00; 0x0000000A as u32; 0x000A as u16.
  const auto read = [](modbus::RegisterType type, modbus::ByteOrder order, const Registers& registers) {
    return *modbus::decode_speed_m_s(speed(type, order), registers);
  };
  EXPECT_EQ(read(modbus::RegisterType::kF32, modbus::ByteOrder::kABCD, {0x40B0, 0x0000}), 5.5);
  EXPECT_EQ(read(modbus::RegisterType::kF32, modbus::ByteOrder::kCDAB, {0x0000, 0x40B0}), 5.5);
  EXPECT_EQ(read(modbus::RegisterType::kF32, modbus::ByteOrder::kBADC, {0xB040, 0x0000}), 5.5);
  EXPECT_EQ(read(modbus::RegisterType::kF32, modbus::ByteOrder::kDCBA, {0x0000, 0xB040}), 5.5);
  EXPECT_EQ(read(modbus::RegisterType::kU32, modbus::ByteOrder::kABCD, {0x0000, 0x000A}), 10.0);
  EXPECT_EQ(read(modbus::RegisterType::kU32, modbus::ByteOrder::kCDAB, {0x000A, 0x0000}), 10.0);
  EXPECT_EQ(read(modbus::RegisterType::kI32, modbus::ByteOrder::kBADC, {0x0000, 0x0A00}), 10.0);
  EXPECT_EQ(read(modbus::RegisterType::kI32, modbus::ByteOrder::kDCBA, {0x0A00, 0x0000}), 10.0);
  EXPECT_EQ(read(modbus::RegisterType::kU16, modbus::ByteOrder::kCDAB, {0x000A}), 10.0);
  EXPECT_EQ(read(modbus::RegisterType::kU16, modbus::ByteOrder::kBADC, {0x0A00}), 10.0);
  EXPECT_EQ(read(modbus::RegisterType::kI16, modbus::ByteOrder::kDCBA, {0x0A00}), 10.0);
}

TEST(ModbusQuantity, ConvertsEveryUnitToMetresPerSecond) {
  modbus::Quantity quantity = speed(modbus::RegisterType::kU16);
  quantity.scale = 0.1;
  quantity.unit = modbus::QuantityUnit::kMetresPerSecond;
  EXPECT_NEAR(*modbus::decode_speed_m_s(quantity, Registers{360}), 36.0, 1e-12);
  quantity.unit = modbus::QuantityUnit::kKmh;
  EXPECT_NEAR(*modbus::decode_speed_m_s(quantity, Registers{360}), 10.0, 1e-12);
  quantity.unit = modbus::QuantityUnit::kKnots;
  EXPECT_NEAR(*modbus::decode_speed_m_s(quantity, Registers{360}), 36.0 * 0.514444444, 1e-6);
  quantity.unit = modbus::QuantityUnit::kMph;
  EXPECT_NEAR(*modbus::decode_speed_m_s(quantity, Registers{360}), 36.0 * 0.44704, 1e-12);
}

TEST(ModbusQuantity, RefusesTheDevicesMarksForNoValue) {
  modbus::Quantity lufft = speed(modbus::RegisterType::kI16);
  lufft.invalid = {0x7FFF};
  EXPECT_TRUE(is_refused(modbus::decode_speed_m_s(lufft, Registers{0x7FFF}), Refusal::kInvalid));

  modbus::Quantity lambrecht = speed(modbus::RegisterType::kI16);
  lambrecht.invalid = {-9999};
  EXPECT_TRUE(is_refused(modbus::decode_speed_m_s(lambrecht, Registers{0xD8F1}), Refusal::kInvalid));

  modbus::Quantity gill = speed(modbus::RegisterType::kF32);
  gill.invalid = {0x7FFFFFFF};
  EXPECT_TRUE(is_refused(modbus::decode_speed_m_s(gill, Registers{0x7FFF, 0xFFFF}), Refusal::kInvalid));
  EXPECT_TRUE(is_refused(modbus::decode_direction_deg(gill, Registers{0x7FFF, 0xFFFF}), Refusal::kInvalid));
}

TEST(ModbusQuantity, RefusesNotANumberThoughNoProfileListsIt) {
  const auto registers = registers_of(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(is_refused(modbus::decode_speed_m_s(speed(modbus::RegisterType::kF32), registers), Refusal::kInvalid));
}

TEST(ModbusQuantity, RefusesWhatLiesOutsideTheStatedRangeOrAnyWinds) {
  modbus::Quantity cup = speed(modbus::RegisterType::kU16);
  cup.scale = 0.1;
  cup.min = 0.0;
  cup.max = 60.0;
  EXPECT_DOUBLE_EQ(*modbus::decode_speed_m_s(cup, Registers{600}), 60.0);
  EXPECT_TRUE(is_refused(modbus::decode_speed_m_s(cup, Registers{601}), Refusal::kImplausible));

  EXPECT_TRUE(
      is_refused(modbus::decode_speed_m_s(speed(modbus::RegisterType::kU16), Registers{121}), Refusal::kImplausible));
  EXPECT_TRUE(is_refused(modbus::decode_speed_m_s(speed(modbus::RegisterType::kI16), Registers{0xFFFF}),
                         Refusal::kImplausible));
  for (const float wild : {-0.5F, 1e30F, std::numeric_limits<float>::infinity()}) {
    EXPECT_TRUE(is_refused(modbus::decode_speed_m_s(speed(modbus::RegisterType::kF32), registers_of(wild)),
                           Refusal::kImplausible));
  }
}

TEST(ModbusQuantity, RefusesFewerRegistersThanItsTypeTakes) {
  EXPECT_TRUE(is_refused(modbus::decode_speed_m_s(speed(modbus::RegisterType::kU16), Registers{}), Refusal::kTooShort));
  EXPECT_TRUE(
      is_refused(modbus::decode_speed_m_s(speed(modbus::RegisterType::kF32), Registers{0x40B0}), Refusal::kTooShort));
}

TEST(ModbusDirection, InDegreesRunsFrom0To360And360IsNorth) {
  const modbus::Quantity vane = direction(modbus::DirectionMap::kDegrees);
  EXPECT_EQ(*modbus::decode_direction_deg(vane, Registers{0}), 0.0);
  EXPECT_EQ(*modbus::decode_direction_deg(vane, Registers{359}), 359.0);
  EXPECT_EQ(*modbus::decode_direction_deg(vane, Registers{360}), 0.0);
  EXPECT_TRUE(is_refused(modbus::decode_direction_deg(vane, Registers{361}), Refusal::kImplausible));
}

TEST(ModbusDirection, OfEightPointsStepsBy45Degrees) {
  const modbus::Quantity vane = direction(modbus::DirectionMap::kGear8);
  for (std::uint16_t gear = 0; gear < 8; ++gear) {
    EXPECT_EQ(*modbus::decode_direction_deg(vane, Registers{gear}), 45.0 * gear);
  }
  EXPECT_TRUE(is_refused(modbus::decode_direction_deg(vane, Registers{8}), Refusal::kImplausible));
}

TEST(ModbusDirection, OfSixteenPointsStepsBy22AndAHalfDegrees) {
  const modbus::Quantity vane = direction(modbus::DirectionMap::kPoint16);
  for (std::uint16_t point = 0; point < 16; ++point) {
    EXPECT_EQ(*modbus::decode_direction_deg(vane, Registers{point}), 22.5 * point);
  }
  EXPECT_TRUE(is_refused(modbus::decode_direction_deg(vane, Registers{16}), Refusal::kImplausible));
}

TEST(ModbusDirection, BetweenTwoPointsIsNone) {
  modbus::Quantity vane = direction(modbus::DirectionMap::kGear8);
  vane.scale = 0.5;
  EXPECT_TRUE(is_refused(modbus::decode_direction_deg(vane, Registers{3}), Refusal::kImplausible));
}

TEST(ModbusQuantity, GivesNothingButAPhysicalValueForAnyRegisters) {
  std::mt19937_64 random(7);
  int accepted = 0;
  for (int round = 0; round < 100'000; ++round) {
    modbus::Quantity quantity;
    quantity.type = static_cast<modbus::RegisterType>(random() % 5);
    quantity.order = static_cast<modbus::ByteOrder>(random() % 4);
    quantity.unit = static_cast<modbus::QuantityUnit>(random() % 4);
    quantity.map = static_cast<modbus::DirectionMap>(random() % 3);
    quantity.scale = random() % 2 == 0 ? 0.001 : -1e300;
    const Registers registers = {static_cast<std::uint16_t>(random()), static_cast<std::uint16_t>(random())};

    if (const auto speed_m_s = modbus::decode_speed_m_s(quantity, registers)) {
      ++accepted;
      EXPECT_TRUE(*speed_m_s >= 0.0 && *speed_m_s <= wind::kMaxPlausibleSpeed_m_s) << *speed_m_s;
    }
    if (const auto direction_deg = modbus::decode_direction_deg(quantity, registers)) {
      ++accepted;
      EXPECT_TRUE(*direction_deg >= 0.0 && *direction_deg < 360.0) << *direction_deg;
    }
  }
  EXPECT_GT(accepted, 1000);
}

}  // namespace
}  // namespace yuragi::drivers::decode
