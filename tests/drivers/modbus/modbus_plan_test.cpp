#include "drivers/modbus/modbus_plan.hpp"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::drivers::modbus {
namespace {

using testing::ElementsAre;
using enum Measure;

/// Speed at 10, direction at 11, gust at 14, all on slave 1.
Profile three_quantities() {
  Profile profile;
  profile.speed.address = 10;
  profile.direction = decode::modbus::Quantity{};
  profile.direction->address = 11;
  profile.gust = decode::modbus::Quantity{};
  profile.gust->address = 14;
  return profile;
}

TEST(ModbusPlan, ReadsTogetherWhatAdjoinsAndTheRestByItself) {
  const auto reads = plan_modbus_reads(three_quantities());
  ASSERT_EQ(reads.size(), 2U);
  EXPECT_EQ(reads[0].request.address, 10);
  EXPECT_EQ(reads[0].request.count, 2);
  EXPECT_THAT(reads[0].measures, ElementsAre(kSpeed, kDirection));
  EXPECT_EQ(reads[1].request.address, 14);
  EXPECT_THAT(reads[1].measures, ElementsAre(kGust));
}

TEST(ModbusPlan, ReadsAcrossAGapThatTheProfileAllows) {
  Profile profile = three_quantities();
  profile.block_gap = 1;
  EXPECT_EQ(plan_modbus_reads(profile).size(), 2U);
  profile.block_gap = 2;
  const auto reads = plan_modbus_reads(profile);
  ASSERT_EQ(reads.size(), 1U);
  EXPECT_EQ(reads[0].request.count, 5);
}

TEST(ModbusPlan, BringsTheSpeedFirstWhereverItStands) {
  Profile profile = three_quantities();
  profile.speed.address = 20;
  profile.gust->address = 12;
  const auto reads = plan_modbus_reads(profile);
  ASSERT_EQ(reads.size(), 2U);
  EXPECT_TRUE(reads[0].contains(kSpeed));
  EXPECT_THAT(reads[1].measures, ElementsAre(kDirection, kGust));
  EXPECT_EQ(reads[1].request.address, 11);
}

TEST(ModbusPlan, JoinsTwoThatOnlyTheThirdConnects) {
  Profile profile = three_quantities();
  profile.direction->address = 12;  // speed 10, direction 12, gust 11
  profile.gust->address = 11;
  const auto reads = plan_modbus_reads(profile);
  ASSERT_EQ(reads.size(), 1U);
  EXPECT_EQ(reads[0].request.address, 10);
  EXPECT_EQ(reads[0].request.count, 3);
}

TEST(ModbusPlan, ReadsNothingTogetherThatMayNotBe) {
  const std::vector<std::function<void(Profile&)>> obstacles = {
      [](Profile& profile) { profile.block_read = false; },
      [](Profile& profile) { profile.direction->slave = 2; },
      [](Profile& profile) { profile.direction->function = 4; },
      [](Profile& profile) { profile.direction->read_has_side_effect = true; },
      [](Profile& profile) { profile.speed.read_has_side_effect = true; },
  };
  for (const auto& obstacle : obstacles) {
    Profile profile = three_quantities();
    obstacle(profile);
    EXPECT_EQ(plan_modbus_reads(profile).size(), 3U);
  }
}

TEST(ModbusPlan, NeverAsksForMoreThanOneRequestMay) {
  Profile profile = three_quantities();
  profile.block_gap = 100;
  profile.direction->address = 105;
  profile.gust->address = 200;
  for (const RegisterRead& read : plan_modbus_reads(profile))
    EXPECT_LE(read.request.count, decode::modbus::kModbusMaxRegisters);
}

TEST(ModbusPlan, LeavesADirectionOnItsOwnLineToItself) {
  const auto reads = plan_modbus_reads(three_quantities(), true);
  ASSERT_EQ(reads.size(), 3U);
  EXPECT_THAT(reads[2].measures, ElementsAre(kDirection));
}

/// A quantity of a station in this register of slave 1.
StationQuantity station_at(std::uint16_t address) {
  StationQuantity station;
  station.quantity.address = address;
  return station;
}

TEST(ModbusPlan, ReadsTheOtherQuantitiesAlongWithTheWindWhereTheyAdjoinAndTheRestLast) {
  Profile profile = three_quantities();
  profile.quantities = {station_at(40), station_at(12), station_at(41), station_at(13)};
  const auto reads = plan_modbus_reads(profile);
  ASSERT_EQ(reads.size(), 2U);
  EXPECT_EQ(reads[0].request.address, 10);
  EXPECT_EQ(reads[0].request.count, 5) << "12 and 13 join the gust at 14 to the speed";
  EXPECT_THAT(reads[0].measures, testing::UnorderedElementsAre(kSpeed, kDirection, kGust));
  EXPECT_THAT(reads[0].stations, testing::UnorderedElementsAre(1, 3));
  EXPECT_TRUE(reads[0].has_wind());
  EXPECT_EQ(reads[1].request.address, 40);
  EXPECT_EQ(reads[1].request.count, 2);
  EXPECT_THAT(reads[1].stations, ElementsAre(0, 2));
  EXPECT_FALSE(reads[1].has_wind());
}

TEST(ModbusPlan, ReadsADirectionOnItsOwnLineBeforeTheOtherQuantities) {
  Profile profile = three_quantities();
  profile.quantities = {station_at(40)};
  const auto reads = plan_modbus_reads(profile, true);
  ASSERT_EQ(reads.size(), 4U);
  EXPECT_THAT(reads[2].measures, ElementsAre(kDirection));
  EXPECT_FALSE(reads[3].has_wind());
}

TEST(ModbusPlan, ReadsAQuantityWithSideEffectsAlone) {
  Profile profile = three_quantities();
  profile.quantities = {station_at(12)};
  profile.quantities[0].quantity.read_has_side_effect = true;
  EXPECT_EQ(plan_modbus_reads(profile).size(), 3U);
}

TEST(ModbusPlan, FindsEachQuantityInTheAnswer) {
  Profile profile = three_quantities();
  profile.block_gap = 2;
  const RegisterRead read = plan_modbus_reads(profile).front();
  decode::modbus::Registers registers;
  registers.values = {1, 2, 3, 4, 5};
  registers.count = 5;
  EXPECT_EQ(registers_of(quantity_of(profile, kSpeed), read.request, registers)[0], 1);
  EXPECT_EQ(registers_of(quantity_of(profile, kDirection), read.request, registers)[0], 2);
  EXPECT_EQ(registers_of(quantity_of(profile, kGust), read.request, registers)[0], 5);
}

}  // namespace
}  // namespace yuragi::drivers::modbus
