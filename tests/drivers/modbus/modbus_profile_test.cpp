#include "drivers/modbus/modbus_profile.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::modbus {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kProfileDirectory = test::source_path("drivers/modbus/profiles");

/// What every profile says in front.
const std::string kHead = "name = \"x\"\nsource = \"y\"\nconfirmed_by = [\"maker\"]\nunconfirmed = \"\"\n";

/// A profile that says no more than it must; `more` goes where top-level keys go, `tail` behind everything.
std::string minimal(const std::string& more = "", const std::string& tail = "") {
  return kHead + more + "[speed]\nslave = 1\naddress = 0\ntype = \"u16\"\nunit = \"m/s\"\n" + tail;
}

std::string error_of(const std::string& text) {
  try {
    parse_modbus_profile(text, "device.toml");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(ModbusProfile, OfTheRenkePairIsWhatItsRegisterMapSays) {
  const Profile profile = load_modbus_profile("renke-rs-fsjt-rs-fxjt-n01", kProfileDirectory);
  EXPECT_TRUE(profile.is_serial);
  EXPECT_EQ(profile.baud, 4800);
  EXPECT_EQ(profile.parity, 'N');
  EXPECT_EQ(profile.stop_bits, 1);

  EXPECT_EQ(profile.speed.slave, 1);
  EXPECT_EQ(profile.speed.function, 3);
  EXPECT_EQ(profile.speed.address, 0);
  EXPECT_NEAR(*decode::modbus::decode_speed_m_s(profile.speed, std::vector<std::uint16_t>{86}), 8.6, 1e-12);

  ASSERT_TRUE(profile.direction.has_value());
  EXPECT_EQ(profile.direction->slave, 2);
  EXPECT_EQ(profile.direction->address, 1);
  EXPECT_EQ(*decode::modbus::decode_direction_deg(*profile.direction, std::vector<std::uint16_t>{360}), 0.0);
}

TEST(ModbusProfile, StatesWhatItsSpeedIsWithTheSource) {
  EXPECT_EQ(parse_modbus_profile(minimal(), "").value, std::nullopt);
  const auto of = [](const std::string& lines) {
    return parse_modbus_profile(minimal("", lines), "device.toml").value;
  };
  EXPECT_EQ(of("value = \"instant\"\nvalue_source = \"z p. 1\"\n"),
            (sensor::StatedValue{.value = wind::ReadingValue::kInstant, .source = "z p. 1"}));
  EXPECT_EQ(of("value = \"maximum\"\naveraging_s = 60\nvalue_source = \"z p. 1\"\n"),
            (sensor::StatedValue{.value = wind::ReadingValue::kMaximum, .averaging_s = 60.0, .source = "z p. 1"}));

  EXPECT_THAT(error_of(minimal("", "value = \"median\"\nvalue_source = \"z\"\n")),
              AllOf(StartsWith("device.toml:"), HasSubstr("speed.value: is \"median\"; allowed: one of \"mean\"")));
  EXPECT_THAT(error_of(minimal("", "value = \"mean\"\n")), HasSubstr("speed.value_source: is missing"));
  EXPECT_THAT(error_of(minimal("", "value = \"mean\"\nvalue_source = \"\"\n")), HasSubstr("value_source: is empty"));
  EXPECT_THAT(error_of(minimal("", "averaging_s = 3\n")), HasSubstr("speed.averaging_s: is set without value"));
  EXPECT_THAT(error_of(minimal("", "value = \"instant\"\naveraging_s = 3\nvalue_source = \"z\"\n")),
              HasSubstr("speed.averaging_s: is above 0"));
  EXPECT_THAT(
      error_of(minimal("", "[gust]\nslave = 1\naddress = 1\ntype = \"u16\"\nunit = \"m/s\"\nvalue = \"mean\"\n")),
      HasSubstr("gust.value: is not known here"));
}

TEST(ModbusProfile, OfTheCupAloneHasNoDirection) {
  EXPECT_FALSE(load_modbus_profile("renke-rs-fsjt-n01", kProfileDirectory).direction.has_value());
}

TEST(ModbusProfile, ThatIsShippedCanBeRead) {
  int profiles = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kProfileDirectory)) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_NO_THROW(load_modbus_profile(entry.path().string(), "")) << entry.path();
    ++profiles;
  }
  EXPECT_GE(profiles, 2);
}

TEST(ModbusProfile, ReadsEveryField) {
  const Profile profile = parse_modbus_profile(R"(
name = "n"
source = "s"
confirmed_by = ["recording", "decoder"]
unconfirmed = "the id"
revision = "V2"
transport = "tcp"
block_read = false
block_gap = 3
north_offset_deg = -12.5
address_base = 40001
[serial]
baud = 19200
parity = "even"
stop_bits = 2
[timing]
poll_interval_s = 1
min_gap_s = 0.5
response_timeout_s = 0.8
byte_timeout_s = 0.02
delay_after_open_s = 2.5
warm_up_s = 10
quantities_interval_s = 60
[speed]
slave = 17
function = 4
address = 40005
type = "f32"
order = "CDAB"
scale = 0.5
offset = 1
unit = "kn"
invalid = [0x7FFFFFFF, 1]
min = 0
max = 100.5
read_has_side_effect = true
[direction]
slave = 18
address = 40003
type = "i16"
unit = "deg"
map = "16-point"
[gust]
slave = 17
address = 40007
type = "u16"
unit = "km/h"
[beaufort]
slave = 17
address = 40010
type = "u16"
[quantities.pressure_hpa]
slave = 18
function = 4
address = 40009
type = "i16"
scale = 0.1
offset = -40
invalid = [-1]
[quantities.air_temperature_c]
slave = 17
address = 40008
type = "u16"
)",
                                               "device.toml");
  EXPECT_EQ(profile.confirmed_by, (std::vector{ProfileEvidence::kRecording, ProfileEvidence::kDecoder}));
  EXPECT_EQ(profile.unconfirmed, "the id");
  EXPECT_EQ(profile.revision, "V2");
  EXPECT_FALSE(profile.is_serial);
  EXPECT_FALSE(profile.block_read);
  EXPECT_EQ(profile.north_offset_deg, -12.5);
  EXPECT_EQ(profile.baud, 19200);
  EXPECT_EQ(profile.parity, 'E');
  EXPECT_EQ(profile.stop_bits, 2);
  EXPECT_EQ(profile.poll_interval, std::chrono::seconds(1));
  EXPECT_EQ(profile.min_gap, std::chrono::milliseconds(500));
  EXPECT_EQ(profile.response_timeout, std::chrono::milliseconds(800));
  EXPECT_EQ(profile.byte_timeout, std::chrono::milliseconds(20));
  EXPECT_EQ(profile.delay_after_open, std::chrono::milliseconds(2500));
  EXPECT_EQ(profile.warm_up, std::chrono::seconds(10));
  EXPECT_EQ(profile.quantities_interval, std::chrono::seconds(60));
  EXPECT_EQ(profile.speed.slave, 17);
  EXPECT_EQ(profile.speed.function, 4);
  EXPECT_EQ(profile.speed.address, 4);
  EXPECT_EQ(profile.speed.type, decode::modbus::RegisterType::kF32);
  EXPECT_EQ(profile.speed.order, decode::modbus::ByteOrder::kCDAB);
  EXPECT_EQ(profile.speed.scale, 0.5);
  EXPECT_EQ(profile.speed.offset, 1.0);
  EXPECT_EQ(profile.speed.unit, decode::modbus::QuantityUnit::kKnots);
  EXPECT_EQ(profile.speed.invalid, (std::vector<std::int64_t>{0x7FFFFFFF, 1}));
  EXPECT_EQ(profile.speed.min, 0.0);
  EXPECT_EQ(profile.speed.max, 100.5);
  EXPECT_TRUE(profile.speed.read_has_side_effect);
  ASSERT_TRUE(profile.direction.has_value());
  EXPECT_EQ(profile.direction->slave, 18);
  EXPECT_EQ(profile.direction->address, 2);
  EXPECT_EQ(profile.direction->type, decode::modbus::RegisterType::kI16);
  EXPECT_EQ(profile.direction->map, decode::modbus::DirectionMap::kPoint16);
  EXPECT_EQ(profile.block_gap, 3);
  ASSERT_TRUE(profile.gust.has_value());
  EXPECT_EQ(profile.gust->address, 6);
  EXPECT_EQ(profile.gust->unit, decode::modbus::QuantityUnit::kKmh);
  ASSERT_TRUE(profile.beaufort.has_value());
  EXPECT_EQ(profile.beaufort->address, 9);
  ASSERT_EQ(profile.quantities.size(), 2U);
  EXPECT_EQ(profile.quantities[0].what.name, "air_temperature_c");
  EXPECT_EQ(profile.quantities[0].quantity.address, 7);
  EXPECT_EQ(profile.quantities[1].what.name, "pressure_hpa");
  EXPECT_EQ(profile.quantities[1].quantity.slave, 18);
  EXPECT_EQ(profile.quantities[1].quantity.function, 4);
  EXPECT_EQ(profile.quantities[1].quantity.scale, 0.1);
  EXPECT_EQ(profile.quantities[1].quantity.offset, -40.0);
  EXPECT_EQ(profile.quantities[1].quantity.invalid, (std::vector<std::int64_t>{-1}));
}

TEST(ModbusProfile, CannotLeaveOutWhoConfirmsIt) {
  const std::string speed = "[speed]\nslave = 1\naddress = 0\ntype = \"u16\"\nunit = \"m/s\"\n";
  const std::string name = "name = \"x\"\nsource = \"y\"\n";
  EXPECT_THAT(
      error_of(name + "unconfirmed = \"\"\n" + speed),
      HasSubstr(": confirmed_by: is missing; allowed: a list of \"recording\" \"maker\" \"decoder\" \"seller\""));
  EXPECT_THAT(error_of(name + "confirmed_by = [\"maker\"]\n" + speed),
              HasSubstr(": unconfirmed: is missing; allowed: a text"));
  EXPECT_THAT(error_of(name + "confirmed_by = [\"hearsay\"]\nunconfirmed = \"\"\n" + speed),
              StartsWith("device.toml:3:16: confirmed_by: contains an entry that is not allowed"));
  EXPECT_THAT(error_of(name + "confirmed_by = \"maker\"\nunconfirmed = \"\"\n" + speed),
              HasSubstr("confirmed_by: is not a list"));
  EXPECT_THAT(error_of(name + "confirmed_by = []\nunconfirmed = \"\"\n" + speed),
              StartsWith("device.toml:4:15: unconfirmed: is empty, but confirmed_by is empty, too"));
  EXPECT_EQ(error_of(name + "confirmed_by = []\nunconfirmed = \"all\"\n" + speed), "no error");
}

TEST(ModbusProfile, ThatIsAPipeIsRefusedWithoutWaiting) {
  const test::TemporaryFolder folder;
  const std::string pipe = (folder.path() / "device.toml").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT([&] { load_modbus_profile(pipe, ""); },
              testing::ThrowsMessage<std::runtime_error>(
                  pipe + ": the profile cannot be read; check that it is a file, and its permissions"));
}

TEST(ModbusProfile, HasNoControlCharacters) {
  EXPECT_EQ(error_of("name = \"a\\u001b[2J\"\n"), "device.toml:1:8: name: contains a control character; type it again");
  EXPECT_THAT(error_of(minimal("", "[quantities.\"a\\u001b\"]\n")), HasSubstr("quantities.a?: is not known here"));
}

TEST(ModbusProfile, KnowsNoOtherQuantitiesThanRecordings) {
  const std::string where = "slave = 1\naddress = 0\ntype = \"u16\"\n";
  EXPECT_EQ(error_of(minimal("", "[quantities.rain_rate_mm_h]\n" + where)), "no error");
  EXPECT_THAT(error_of(minimal("", "[quantities.light_lux]\n" + where)),
              HasSubstr("quantities.light_lux: is not known here; allowed: air_temperature_c, "));
  EXPECT_THAT(error_of(minimal("", "[quantities.rain_rate_mm_h]\nunit = \"mm/h\"\n" + where)),
              HasSubstr("quantities.rain_rate_mm_h.unit: is not known here"));
  EXPECT_THAT(error_of(minimal("", "[quantities]\npressure_hpa = 7\n")),
              HasSubstr("quantities.pressure_hpa: is not a table"));
}

TEST(ModbusProfile, ThatIsMovedToAnotherSlaveTakesAlongWhatWasOnTheSame) {
  Profile profile;
  profile.direction = decode::modbus::Quantity{};
  profile.direction->slave = 2;
  profile.gust = decode::modbus::Quantity{};
  profile.beaufort = decode::modbus::Quantity{};
  profile.quantities.resize(2);
  profile.quantities[1].quantity.slave = 2;
  set_slave(profile, 7);
  EXPECT_EQ(profile.speed.slave, 7);
  EXPECT_EQ(profile.direction->slave, 2);
  EXPECT_EQ(profile.gust->slave, 7);
  EXPECT_EQ(profile.beaufort->slave, 7);
  EXPECT_EQ(profile.quantities[0].quantity.slave, 7);
  EXPECT_EQ(profile.quantities[1].quantity.slave, 2);
}

TEST(ModbusProfile, KeepsALiteral30001OnTheWire) {
  const auto profile =
      parse_modbus_profile(kHead + "[speed]\nslave = 1\naddress = 30001\ntype = \"u16\"\nunit = \"m/s\"\n", "");
  EXPECT_EQ(profile.speed.address, 0x7531);
}

TEST(ModbusProfile, ErrorsNameFileLineColumnKeyAndWhatIsAllowed) {
  EXPECT_EQ(error_of(minimal("transport = \"usb\"\n")),
            "device.toml:5:13: transport: is \"usb\"; allowed: one of \"rtu\" \"tcp\"");
  EXPECT_EQ(error_of(minimal("", "order = 3\n")),
            "device.toml:10:9: speed.order: is not a text; allowed: one of \"ABCD\" \"CDAB\" \"BADC\" \"DCBA\"");
  EXPECT_EQ(error_of(minimal("", "min = 5\nmax = 4.5\n")),
            "device.toml:11:7: speed.max: is below min; allowed: min or more");
}

TEST(ModbusProfile, ErrorsAreFoundWhereverTheyAre) {
  EXPECT_THAT(error_of("name = \n"), StartsWith("device.toml:1:8: not TOML: "));
  EXPECT_THAT(error_of("source = \"y\"\n"), HasSubstr(": name: is missing; allowed: a text"));
  EXPECT_THAT(error_of(kHead), HasSubstr(": speed: is missing; allowed: a table [speed]"));
  EXPECT_THAT(error_of(kHead + "speed = 3\n"), StartsWith("device.toml:5:9: speed: is not a table"));
  EXPECT_THAT(error_of(minimal("", "slaves = 2\n")),
              StartsWith("device.toml:10:10: speed.slaves: is not known here; allowed: address, "));
  EXPECT_THAT(error_of(minimal("", "[directions]\nslave = 2\n")), HasSubstr(": directions: is not known here"));
  EXPECT_THAT(error_of(minimal("", "function = 5\n")),
              HasSubstr("speed.function: is 5; allowed: a whole number from 3 to 4"));
  EXPECT_THAT(error_of(minimal("", "scale = 0.0\n")), HasSubstr("speed.scale: is 0;"));
  EXPECT_THAT(error_of(minimal("", "scale = nan\n")), HasSubstr("speed.scale: is nan; allowed: a finite number"));
  EXPECT_THAT(error_of(minimal("", "scale = \"1\"\n")), HasSubstr("speed.scale: is not a number"));
  EXPECT_THAT(
      error_of(minimal("", "invalid = [70000]\n")),
      HasSubstr(
          "speed.invalid: contains an entry that is not allowed; allowed: a list of whole numbers from 0 to 65535"));
  EXPECT_THAT(error_of(minimal("", "invalid = 3\n")), HasSubstr("speed.invalid: is not a list"));
  EXPECT_THAT(error_of(minimal("", "map = \"degrees\"\n")), HasSubstr("speed.map: is not known here"));
  EXPECT_THAT(error_of(minimal("", "read_has_side_effect = 1\n")),
              HasSubstr("is neither true nor false; allowed: true or false"));
  EXPECT_THAT(error_of(minimal("address_base = 2\n")),
              HasSubstr("address_base: is 2; allowed: one of 0 1 30001 40001"));
  EXPECT_THAT(error_of(minimal("address_base = 1\n")),
              HasSubstr("speed.address: is 0; allowed: a whole number from 1 to 65536"));
  EXPECT_THAT(error_of(minimal("", "[serial]\nbaud = 1000\n")),
              StartsWith("device.toml:11:8: serial.baud: is 1000; allowed: one of 1200 "));
  EXPECT_THAT(error_of(minimal("", "[timing]\nmin_gap_s = -1\n")),
              HasSubstr("timing.min_gap_s: is -1; allowed: a finite number from 0 to 10"));
  EXPECT_THAT(error_of(minimal("", "[direction]\nslave = 2\naddress = 0\ntype = \"u16\"\nunit = \"m/s\"\n")),
              HasSubstr("direction.unit: is \"m/s\"; allowed: one of \"deg\""));
}

TEST(ModbusProfile, ThatTakesTwoRegistersEndsBeforeTheLastAddress) {
  const std::string two = kHead + "[speed]\nslave = 1\ntype = \"u32\"\nunit = \"m/s\"\naddress = ";
  EXPECT_EQ(error_of(two + "65534\n"), "no error");
  EXPECT_THAT(error_of(two + "65535\n"), HasSubstr("speed.address: is 65535"));
}

TEST(ModbusProfileSearch, OfAnUnknownNameListsTheKnownOnes) {
  try {
    load_modbus_profile("no-such-device", "");
    FAIL() << "found";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("no Modbus profile named \"no-such-device\""));
    EXPECT_THAT(error.what(), HasSubstr("renke-rs-fsjt-n01, renke-rs-fsjt-rs-fxjt-n01"));
  }
}

TEST(ModbusProfileSearch, OfAPathThatIsNotThereSaysWhich) {
  try {
    load_modbus_profile("/no/such/file.toml", "");
    FAIL() << "found";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), StartsWith("/no/such/file.toml: "));
  }
}

TEST(ModbusProfileSearch, LooksInTheGivenDirectoryFirst) {
  const std::filesystem::path directory = testing::TempDir() + "yuragi_profiles";
  std::filesystem::create_directories(directory);
  std::ofstream(directory / "renke-rs-fsjt-n01.toml") << minimal("revision = \"mine\"\n");
  EXPECT_EQ(load_modbus_profile("renke-rs-fsjt-n01", directory.string()).revision, "mine");
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace yuragi::drivers::modbus
