// Every profile that is shipped: which registers it reads, and what it makes of them. The frames are published
// ones (drivers/SOURCES.md S1), and such as were written by hand from the makers' register maps.
#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/modbus/modbus_plan.hpp"
#include "tests/support/modbus_vectors.hpp"
#include "tests/support/places.hpp"

namespace yuragi::drivers::modbus {
namespace {

/// What a device has in its registers, as the wire counts them.
using DeviceRegisters = std::map<int, std::uint16_t>;

/// What a profile reads in them.
struct ProfileReading {
  Result<double, decode::Refusal> speed_m_s = decode::Refusal::kTimeout;
  Result<double, decode::Refusal> direction_deg = decode::Refusal::kTimeout;
  Result<double, decode::Refusal> gust_m_s = decode::Refusal::kTimeout;
  wind::StationQuantities quantities;
};

Profile shipped_profile(const std::string& name) {
  return load_modbus_profile(name, test::source_path("drivers/modbus/profiles"));
}

/// Registers as a request brings them; nothing if the device lacks one.
std::optional<decode::modbus::Registers> answer_of(const DeviceRegisters& device,
                                                   const decode::modbus::Request& request) {
  decode::modbus::Registers registers;
  for (int i = 0; i < request.count; ++i) {
    const auto found = device.find(request.address + i);
    if (found == device.end()) return std::nullopt;
    registers.values[registers.count++] = found->second;
  }
  return registers;
}

ProfileReading read_with(const Profile& profile, const DeviceRegisters& device) {
  ProfileReading reading;
  for (const RegisterRead& read : plan_modbus_reads(profile)) {
    const auto registers = answer_of(device, read.request);
    if (!registers) continue;
    for (const Measure measure : read.measures) {
      const decode::modbus::Quantity& quantity = quantity_of(profile, measure);
      const auto part = registers_of(quantity, read.request, *registers);
      if (measure == Measure::kSpeed) reading.speed_m_s = decode::modbus::decode_speed_m_s(quantity, part);
      if (measure == Measure::kGust) reading.gust_m_s = decode::modbus::decode_speed_m_s(quantity, part);
      if (measure == Measure::kDirection) reading.direction_deg = decode::modbus::decode_direction_deg(quantity, part);
    }
    for (const std::size_t i : read.stations) {
      const StationQuantity& station = profile.quantities[i];
      const auto value =
          decode::modbus::decode_number(station.quantity, registers_of(station.quantity, read.request, *registers));
      if (value) reading.quantities.*station.what.value = *value;
    }
  }
  return reading;
}

/// One device with known registers and what a person reads in them by the maker's map.
struct KnownReading {
  const char* profile;
  std::uint8_t function;
  DeviceRegisters registers;
  double speed_m_s;
  std::optional<double> direction_deg;
  std::optional<double> gust_m_s;

  friend void PrintTo(const KnownReading& known, std::ostream* out) { *out << known.profile; }
};

/// A multi-station with that raw speed, from 271 degrees.
DeviceRegisters multi_station_of(std::uint16_t speed) {
  return {{500, speed}, {501, 6}, {502, 6},    {503, 271}, {504, 608}, {505, 0xFF9B}, {506, 0},
          {507, 0},     {508, 0}, {509, 1009}, {510, 0},   {511, 0},   {512, 0},      {513, 126}};
}

/// The registers 10 to 47 of a Lufft that measures no wind direction: 0x7FFF where nothing else is given.
DeviceRegisters lufft_with(const DeviceRegisters& given) {
  DeviceRegisters registers = given;
  for (int i = 10; i <= 47; ++i) registers.try_emplace(i, std::uint16_t{0x7FFF});
  return registers;
}

const std::vector<KnownReading> kKnownReadings = {
    {"renke-rs-fsjt-n01", 3, {{0, 86}}, 8.6, {}, {}},
    {"renke-rs-fsjt-rs-fxjt-n01", 3, {{0, 2}, {1, 90}}, 0.2, 90.0, {}},
    {"dfrobot-sen0483", 3, {{0, 37}}, 3.7, {}, {}},
    {"dfrobot-sen0483-sen0482", 3, {{0, 324}}, 32.4, 32.4, {}},
    {"dfrobot-sen0483-sen0482-v1", 3, {{0, 15}}, 1.5, 337.5, {}},
    {"renke-multi-station", 3, multi_station_of(123), 12.3, 271.0, {}},
    {"renke-multi-station-x100", 3, multi_station_of(1230), 12.3, 271.0, {}},
    // The example of the maker's document, with its 0x90 0x03 0x01 0x65 0x00 0x09, but a wind that blows.
    {"ecowitt-wn90lp",
     3,
     {{0x165, 1767},
      {0x166, 13},
      {0x167, 662},
      {0x168, 60},
      {0x169, 12},
      {0x16A, 28},
      {0x16B, 150},
      {0x16C, 18},
      {0x16D, 10010}},
     1.2,
     150.0,
     2.8},
    // 95.000 degrees; most 5.000, mean 3.500 m/s: a published frame (drivers/SOURCES.md S1).
    {"seeed-sensecap-one",
     4,
     {{8, 1},
      {9, 0x5F90},
      {10, 1},
      {11, 0x86A0},
      {12, 1},
      {13, 0x7318},
      {14, 0},
      {15, 2000},
      {16, 0},
      {17, 5000},
      {18, 0},
      {19, 3500}},
     3.5,
     95.0,
     5.0},
    {"calypso-ulp",
     3,
     {{200, 0}, {201, 52}, {202, 3599}, {203, 1}, {204, 2}, {205, 3}, {206, 4}, {207, 81}, {208, 10}},
     5.2,
     359.9,
     8.1},
    {"lufft-umb", 4, lufft_with({{18, 2705}, {42, 55}, {43, 20}, {44, 98}, {45, 52}, {46, 51}, {47, 60}}), 6.0, 270.5,
     9.8},
    // 5.5, 90.5 and 8.25 as IEEE 754, the least significant word first.
    {"vaisala-wm80",
     3,
     {{0, 0},
      {1, 0x40B0},
      {2, 0},
      {3, 0x42B5},
      {4, 0},
      {5, 0},
      {6, 0},
      {7, 0},
      {8, 0},
      {9, 0},
      {10, 0},
      {11, 0},
      {12, 0},
      {13, 0},
      {14, 0},
      {15, 0x4104}},
     5.5,
     90.5,
     8.25},
    {"gill-maximet-gmx",
     3,
     {{0, 0x42A2}, {1, 0}, {2, 0x42B5}, {3, 0}, {4, 0x40B0}, {5, 0}, {6, 0x4334}, {7, 0}},
     5.5,
     90.5,
     {}},
    {"campbell-metsens200", 3, {{0, 0x42B5}, {1, 0}, {2, 0x40B0}, {3, 0}}, 5.5, 90.5, {}},
    {"lambrecht-industry",
     4,
     {{30001, 44}, {30002, 1}, {30003, 2}, {30004, 3}, {30201, 2705}, {30202, 4}},
     4.4,
     270.5,
     {}},
    {"thies-clima-sensor-us",
     4,
     {{30001, 0}, {30002, 1}, {30003, 0}, {30004, 62}, {30011, 0}, {30012, 99}, {30203, 0}, {30204, 3594}},
     6.2,
     359.4,
     9.9},
    {"xunchip-xm8589", 3, {{0, 121}}, 12.1, {}, {}},
    {"generic-rs485-cup", 3, {{0, 30}}, 3.0, {}, {}},
    {"generic-rs485-cup-0x16", 3, {{0x16, 42}}, 4.2, {}, {}},
};

/// The registers that a published frame carries.
DeviceRegisters device_registers_of(const ModbusVector& vector) {
  DeviceRegisters registers;
  const int from = (vector.request[2] << 8) | vector.request[3];
  for (std::size_t i = 0; 3 + 2 * i + 1 < vector.response.size() - 2; ++i) {
    registers[from + static_cast<int>(i)] =
        static_cast<std::uint16_t>((vector.response[3 + 2 * i] << 8U) | vector.response[4 + 2 * i]);
  }
  return registers;
}

class ShippedProfileTest : public testing::TestWithParam<KnownReading> {};

TEST_P(ShippedProfileTest, ReadsWhatTheRegistersSay) {
  const KnownReading& known = GetParam();
  const Profile profile = shipped_profile(known.profile);
  EXPECT_EQ(profile.speed.function, known.function);
  EXPECT_EQ(profile.direction.has_value(), known.direction_deg.has_value());
  EXPECT_EQ(profile.gust.has_value(), known.gust_m_s.has_value());

  const ProfileReading reading = read_with(profile, known.registers);
  ASSERT_TRUE(reading.speed_m_s) << name_of(reading.speed_m_s.error());
  EXPECT_NEAR(*reading.speed_m_s, known.speed_m_s, 1e-9);
  if (known.direction_deg) {
    ASSERT_TRUE(reading.direction_deg) << name_of(reading.direction_deg.error());
    EXPECT_NEAR(*reading.direction_deg, *known.direction_deg, 1e-9);
  }
  if (known.gust_m_s) {
    ASSERT_TRUE(reading.gust_m_s) << name_of(reading.gust_m_s.error());
    EXPECT_NEAR(*reading.gust_m_s, *known.gust_m_s, 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, ShippedProfileTest, testing::ValuesIn(kKnownReadings), [](const auto& test) {
  std::string name = test.param.profile;
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST(ShippedProfiles, AreAllTestedAndSayWhereTheyWereRead) {
  std::set<std::string> shipped;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_path("drivers/modbus/profiles"))) {
    if (entry.path().extension() != ".toml") continue;
    shipped.insert(entry.path().stem().string());
    const Profile profile = load_modbus_profile(entry.path().string(), "");
    EXPECT_GT(profile.source.size(), 10U) << entry.path();
    EXPECT_FALSE(profile.confirmed_by.empty()) << entry.path();
    EXPECT_TRUE(profile.speed.max.has_value()) << entry.path();
  }
  std::set<std::string> tested;
  for (const KnownReading& known : kKnownReadings) tested.insert(known.profile);
  EXPECT_EQ(shipped, tested);
}

TEST(ShippedProfiles, TakeTheMarksForNoValueAsNone) {
  const ProfileReading lufft = read_with(shipped_profile("lufft-umb"), lufft_with({{44, 98}}));
  EXPECT_EQ(lufft.speed_m_s.error(), decode::Refusal::kInvalid);
  EXPECT_EQ(lufft.direction_deg.error(), decode::Refusal::kInvalid);
  EXPECT_NEAR(*lufft.gust_m_s, 9.8, 1e-9);
  EXPECT_FALSE(lufft.quantities.air_temperature_c.has_value());
  const ProfileReading thies = read_with(shipped_profile("thies-clima-sensor-us"), {{30003, 0xFFFF}, {30004, 0xFFFF}});
  EXPECT_EQ(thies.speed_m_s.error(), decode::Refusal::kInvalid);
  EXPECT_EQ(read_with(shipped_profile("lambrecht-industry"), {{30001, 0xD8F1}}).speed_m_s.error(),
            decode::Refusal::kInvalid);
  const ProfileReading gill =
      read_with(shipped_profile("gill-maximet-gmx"), {{2, 0x7FFF}, {3, 0xFFFF}, {4, 0x40B0}, {5, 0}});
  EXPECT_TRUE(gill.speed_m_s.has_value());
  EXPECT_EQ(gill.direction_deg.error(), decode::Refusal::kInvalid);
}

TEST(ShippedProfiles, ReadTheLeastSignificantWordOfAWm80First) {
  // 5.5 m/s from 90.5 degrees in the other order: the profile shall not find a wind in it.
  const DeviceRegisters swapped = {{0, 0x40B0}, {1, 0}, {2, 0x42B5}, {3, 0}};
  Profile wm80 = shipped_profile("vaisala-wm80");
  wm80.gust.reset();
  EXPECT_LT(*read_with(wm80, swapped).speed_m_s, 1e-30);
}

TEST(ShippedProfiles, FindALambrechtsCupAndVaneOnSlavesOfTheirOwn) {
  const Profile lambrecht = shipped_profile("lambrecht-industry");
  EXPECT_EQ(lambrecht.speed.slave, 1);
  EXPECT_EQ(lambrecht.direction->slave, 2);
  EXPECT_EQ(lambrecht.baud, 19200);
  EXPECT_EQ(lambrecht.parity, 'E');
}

/// What a station says besides the wind, by its maker's map.
TEST(ShippedProfiles, ReadWhatStationsSayBesidesTheWind) {
  const auto said_by = [](const char* profile, const DeviceRegisters& device) {
    return read_with(shipped_profile(profile), device).quantities;
  };
  const auto multi = said_by("renke-multi-station", multi_station_of(123));
  EXPECT_NEAR(multi.air_temperature_c.value(), -10.1, 1e-9);
  EXPECT_NEAR(multi.relative_humidity_percent.value(), 60.8, 1e-9);
  EXPECT_NEAR(multi.pressure_hpa.value(), 1009.0, 1e-9);
  EXPECT_NEAR(multi.rain_total_mm.value(), 12.6, 1e-9);

  const auto of_name = std::ranges::find(kKnownReadings, std::string("ecowitt-wn90lp"),
                                         [](const KnownReading& known) { return std::string(known.profile); });
  const auto ecowitt = said_by("ecowitt-wn90lp", of_name->registers);
  EXPECT_NEAR(ecowitt.air_temperature_c.value(), 26.2, 1e-9);
  EXPECT_NEAR(ecowitt.relative_humidity_percent.value(), 60.0, 1e-9);
  EXPECT_NEAR(ecowitt.pressure_hpa.value(), 1001.0, 1e-9);
  EXPECT_NEAR(ecowitt.rain_total_mm.value(), 1.8, 1e-9);

  const auto lufft = said_by("lufft-umb", lufft_with({{10, 641}, {14, 10134}, {31, 0xFFDB}, {47, 60}}));
  EXPECT_NEAR(lufft.air_temperature_c.value(), -3.7, 1e-9);
  EXPECT_NEAR(lufft.relative_humidity_percent.value(), 64.1, 1e-9);
  EXPECT_NEAR(lufft.pressure_hpa.value(), 1013.4, 1e-9);

  const auto thies =
      said_by("thies-clima-sensor-us",
              {{30401, 0xFFFF}, {30402, 0xFFDB}, {30601, 0}, {30602, 355}, {30801, 1}, {30802, 0x9A28}});  // 105000
  EXPECT_NEAR(thies.air_temperature_c.value(), -3.7, 1e-9);
  EXPECT_NEAR(thies.relative_humidity_percent.value(), 35.5, 1e-9);
  EXPECT_NEAR(thies.pressure_hpa.value(), 1050.0, 1e-9);

  const auto seeed = said_by("seeed-sensecap-one", {{0, 0}, {1, 21500}, {2, 0}, {3, 45000}, {4, 0x0609}, {5, 0x8A2C}});
  EXPECT_NEAR(seeed.air_temperature_c.value(), 21.5, 1e-9);
  EXPECT_NEAR(seeed.relative_humidity_percent.value(), 45.0, 1e-9);
  EXPECT_NEAR(seeed.pressure_hpa.value(), 0x06098A2C * 1e-5, 1e-9);  // 1012.88 hPa
}

/// The frame that a WS85 sent, which has the registers of the WN90LP, its temperature, and nothing else but a calm.
TEST(ShippedProfiles, ReadAPublishedFrameOfAWs85) {
  const ModbusVector frame = {.device = "Ecowitt WS85",
                              .request = {0x85, 0x03, 0x01, 0x65, 0x00, 0x09, 0x8A, 0x6B},
                              .response = {0x85, 0x03, 0x12, 0xFF, 0xFF, 0xFF, 0xFF, 0x02, 0x67, 0xFF, 0xFF, 0x00,
                                           0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xFF, 0xFF, 0x0B, 0x4D}};
  EXPECT_EQ(decode::modbus::modbus_crc(frame.request), 0);
  EXPECT_EQ(decode::modbus::modbus_crc(frame.response), 0);
  const ProfileReading reading = read_with(shipped_profile("ecowitt-wn90lp"), device_registers_of(frame));
  EXPECT_EQ(*reading.speed_m_s, 0.0);
  EXPECT_EQ(*reading.direction_deg, 0.0);
  EXPECT_NEAR(reading.quantities.air_temperature_c.value(), 21.5, 1e-9);
  EXPECT_FALSE(reading.quantities.relative_humidity_percent.has_value());
  EXPECT_FALSE(reading.quantities.pressure_hpa.has_value());
}

TEST(ShippedProfiles, NeverReadARegisterThatClearsOthers) {
  for (const RegisterRead& read : plan_modbus_reads(shipped_profile("lambrecht-industry"))) {
    for (const int clearing : {30002, 30202}) {
      EXPECT_FALSE(clearing >= read.request.address && clearing < read.request.address + read.request.count);
    }
  }
}

TEST(ShippedProfiles, KeepTheirSerialLinesAndPaces) {
  EXPECT_EQ(shipped_profile("lufft-umb").parity, 'E');
  EXPECT_EQ(shipped_profile("lufft-umb").baud, 19200);
  EXPECT_EQ(shipped_profile("vaisala-wm80").poll_interval, std::chrono::milliseconds(100));
  EXPECT_EQ(shipped_profile("generic-rs485-cup").min_gap, std::chrono::milliseconds(500));
  EXPECT_EQ(shipped_profile("gill-maximet-gmx").warm_up, std::chrono::seconds(10));
  EXPECT_EQ(shipped_profile("dfrobot-sen0483-sen0482-v1").revision, "V1");
  EXPECT_EQ(shipped_profile("thies-clima-sensor-us").speed.address, 0x7533);
}

TEST(ShippedProfiles, ReadTheSharedCollectionsFramesAsItSays) {
  const auto vectors = load_modbus_vectors();
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/modbus_vectors.json is not here";
  int checked = 0;
  const auto reading_of = [&](const std::string& device, const std::string& profile) {
    const auto found = std::ranges::find(vectors, device, &ModbusVector::device);
    EXPECT_NE(found, vectors.end()) << device;
    ++checked;
    return found != vectors.end() ? read_with(shipped_profile(profile), device_registers_of(*found)) : ProfileReading{};
  };

  EXPECT_NEAR(*reading_of("Renke RS-FSJT-N01 / PR-3000-FSJT-N01", "renke-rs-fsjt-n01").speed_m_s, 8.6, 1e-9);
  EXPECT_NEAR(*reading_of("Xunchip XM8589", "xunchip-xm8589").speed_m_s, 12.1, 1e-9);
  EXPECT_NEAR(*reading_of("DFRobot SEN0482/SEN0483", "dfrobot-sen0483").speed_m_s, 3.7, 1e-9);
  EXPECT_NEAR(*reading_of("Renke RS-FXJT-N01", "renke-rs-fsjt-rs-fxjt-n01").direction_deg, 90.0, 1e-9);

  const ProfileReading seeed = reading_of("SenseCAP ONE S500/S700", "seeed-sensecap-one");
  EXPECT_NEAR(*seeed.speed_m_s, 3.5, 1e-9);
  EXPECT_NEAR(*seeed.direction_deg, 95.0, 1e-9);
  EXPECT_NEAR(*seeed.gust_m_s, 5.0, 1e-9);
  // The collection's Lufft sends 42 to 47 alone; the profile asks for more along with them.
  const auto umb = std::ranges::find(vectors, "Lufft WS-UMB / VENTUS", &ModbusVector::device);
  ASSERT_NE(umb, vectors.end());
  const ProfileReading lufft = read_with(shipped_profile("lufft-umb"), lufft_with(device_registers_of(*umb)));
  EXPECT_EQ(lufft.speed_m_s.error(), decode::Refusal::kInvalid);
  EXPECT_NEAR(*lufft.gust_m_s, 9.8, 1e-9);

  // The frame of the WM80 was made with its words the wrong way round, and ends before the gust, which this profile
  // reads along.
  Profile wm80 = shipped_profile("vaisala-wm80");
  wm80.gust.reset();
  const auto found = std::ranges::find(vectors, "Vaisala WM80", &ModbusVector::device);
  ASSERT_NE(found, vectors.end());
  DeviceRegisters registers = device_registers_of(*found);
  std::swap(registers[0], registers[1]);
  std::swap(registers[2], registers[3]);
  const ProfileReading vaisala = read_with(wm80, registers);
  EXPECT_NEAR(*vaisala.speed_m_s, 5.5, 1e-9);
  EXPECT_NEAR(*vaisala.direction_deg, 90.5, 1e-9);
  EXPECT_EQ(checked, 5);
}

}  // namespace
}  // namespace yuragi::drivers::modbus
