// Simulated Modbus devices. Their register maps are written here, independently of the drivers' profiles, so that a
// mistake on either side shows. Addresses are those on the wire. Sources: the makers' manuals, drivers/SOURCES.md S1.
#include "simulators/modbus/modbus_devices.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

namespace yuragi::simulators::modbus {
namespace {

constexpr double kTenths = 10.0;

/// The wind force of the Beaufort scale (WMO): element i is the lowest speed of force i + 1.
double beaufort_of(double speed_m_s) {
  constexpr std::array kLeast_m_s = {0.3, 1.6, 3.4, 5.5, 8.0, 10.8, 13.9, 17.2, 20.8, 24.5, 28.5, 32.7};
  return static_cast<double>(std::ranges::upper_bound(kLeast_m_s, speed_m_s) - kLeast_m_s.begin());
}

double compass_point_of(double direction_deg, int points) {
  return static_cast<double>(std::lround(direction_deg * points / 360.0) % points);
}

/// Renke RS-FSJT-N01 (and the clones that copy it): 0x0000 speed, 0.1 m/s.
void measure_cup(const Air& air, RegisterBank& registers) {
  registers.set(0x0000, kTenths * air.speed_m_s);
}

void measure_cup_at_0x16(const Air& air, RegisterBank& registers) {
  registers.set(0x0016, kTenths * air.speed_m_s);
}

/// Renke RS-FXJT-N01: 0x0000 eight points, 0x0001 degrees.
void measure_renke_vane(const Air& air, RegisterBank& registers) {
  registers.set(0x0000, compass_point_of(air.direction_deg, 8));
  registers.set(0x0001, air.direction_deg);
}

/// DFRobot SEN0482 V2: 0x0000 tenths of degrees, 0x0001 sixteen points.
void measure_sen0482(const Air& air, RegisterBank& registers) {
  registers.set(0x0000, kTenths * air.direction_deg);
  registers.set(0x0001, compass_point_of(air.direction_deg, 16));
}

/// DFRobot SEN0482 V1: 0x0000 sixteen points.
void measure_sen0482_v1(const Air& air, RegisterBank& registers) {
  registers.set(0x0000, compass_point_of(air.direction_deg, 16));
}

/// Renke multi-station: 500 speed, 501 Beaufort, 502 eight points, 503 degrees, 504 humidity, 505 temperature, 506 to
/// 508 noise and dust, 509 pressure, 510 to 512 light, 513 rain.
void measure_multi_station(const Air& air, RegisterBank& registers) {
  registers.set(500, kTenths * air.speed_m_s);
  registers.set(501, beaufort_of(air.speed_m_s));
  registers.set(502, compass_point_of(air.direction_deg, 8));
  registers.set(503, air.direction_deg);
  registers.set(504, kTenths * air.humidity_percent);
  registers.set(505, kTenths * air.temperature_c);
  for (int i = 506; i <= 512; ++i) registers.set(i, 0.0);
  registers.set(509, air.pressure_hpa);
  registers.set(513, kTenths * air.rain_mm);
}

/// The same, for makers that send hundredths.
void measure_multi_station_x100(const Air& air, RegisterBank& registers) {
  measure_multi_station(air, registers);
  registers.set(500, 100.0 * air.speed_m_s);
}

/// SEN0657: the wind force is not among its documented registers.
void measure_sen0657(const Air& air, RegisterBank& registers) {
  measure_multi_station(air, registers);
  registers.set(501, 0.0);
}

/// WN90LP: from 0x0160 model, baud rate, id, serial number; from 0x0165 light, UV, temperature with 400 added,
/// humidity, speed, gust, direction, rain, pressure, rain in hundredths.
void measure_wn90lp(const Air& air, RegisterBank& registers) {
  registers.set(0x0160, 0x90);
  registers.set(0x0161, 2);
  registers.set(0x0162, 0x90);
  registers.set(0x0163, 0x1234);
  registers.set(0x0164, 0x5678);
  registers.set(0x0165, 1767.0);
  registers.set(0x0166, 13.0);
  registers.set(0x0167, kTenths * air.temperature_c + 400.0);
  registers.set(0x0168, air.humidity_percent);
  registers.set(0x0169, kTenths * air.speed_m_s);
  registers.set(0x016A, kTenths * air.gust_m_s);
  registers.set(0x016B, air.direction_deg);
  registers.set(0x016C, kTenths * air.rain_mm);
  registers.set(0x016D, kTenths * air.pressure_hpa);
  registers.set(0x016E, 100.0 * air.rain_mm);
}

/// SenseCAP ONE: 0x0000 temperature, 0x0002 humidity, 0x0004 pressure in Pa; from 0x0008 direction, from 0x000E speed,
/// each least, most, mean; thousandths.
void measure_sensecap(const Air& air, RegisterBank& registers) {
  constexpr double kThousandths = 1000.0;
  registers.set_two(0x0000, kThousandths * air.temperature_c);
  registers.set_two(0x0002, kThousandths * air.humidity_percent);
  registers.set_two(0x0004, kThousandths * 100.0 * air.pressure_hpa);
  registers.set_two(0x0006, 0.0);
  for (int i = 0; i < 3; ++i) registers.set_two(0x0008 + 2 * i, kThousandths * air.direction_deg);
  registers.set_two(0x000E, kThousandths * air.lull_m_s);
  registers.set_two(0x0010, kThousandths * air.gust_m_s);
  registers.set_two(0x0012, kThousandths * air.speed_m_s);
}

/// Calypso ULP: 200 status; 201 and 202 speed and direction; means of 2 and 10 min; 207 and 208 gust and its direction.
void measure_calypso(const Air& air, RegisterBank& registers) {
  registers.set(200, 0.0);
  for (int i = 201; i <= 207; i += 2) {
    const double speed_m_s = i == 201 ? air.speed_m_s : i == 207 ? air.gust_m_s : air.mean_m_s;
    registers.set(i, kTenths * speed_m_s);
    registers.set(i + 1, kTenths * air.direction_deg);
  }
}

/// Lufft UMB: from 10 humidity, from 14 pressure, from 18 direction, 31 temperature; speed: 42 actual, 43 minimum, 44
/// maximum, 45 mean, 46 vectorial mean, 47 fast. Channels 0 to 124 exist; those that this model does not measure return
/// an error.
void measure_lufft(const Air& air, RegisterBank& registers) {
  for (int i = 0; i <= 124; ++i) registers.set(i, 0x7FFF);
  for (int i = 10; i <= 13; ++i) registers.set(i, kTenths * air.humidity_percent);
  for (int i = 14; i <= 17; ++i) registers.set(i, kTenths * air.pressure_hpa);
  for (int i = 18; i <= 22; ++i) registers.set(i, kTenths * air.direction_deg);
  registers.set(31, kTenths * air.temperature_c);
  registers.set(42, kTenths * air.mean_m_s);
  registers.set(43, kTenths * air.lull_m_s);
  registers.set(44, kTenths * air.gust_m_s);
  registers.set(45, kTenths * air.mean_m_s);
  registers.set(46, kTenths * air.mean_m_s);
  registers.set(47, kTenths * air.speed_m_s);
}

/// WM80: floats, their low words first; speed and direction in turn: sample, instant, mean; lull; gust; direction of
/// the mean, of the gust.
void measure_wm80(const Air& air, RegisterBank& registers) {
  for (int i = 0x0000; i <= 0x0008; i += 4) {
    registers.set_float_low_word_first(i, i == 0x0008 ? air.mean_m_s : air.speed_m_s);
    registers.set_float_low_word_first(i + 2, air.direction_deg);
  }
  registers.set_float_low_word_first(0x000C, air.lull_m_s);
  registers.set_float_low_word_first(0x000E, air.gust_m_s);
  registers.set_float_low_word_first(0x0010, air.direction_deg);
  registers.set_float_low_word_first(0x0012, air.direction_deg);
}

/// MaxiMet GMX: 40001 node letter, 40003 DIR, 40005 SPEED, 40007 CDIR, less 40001 each.
void measure_gmx(const Air& air, RegisterBank& registers) {
  registers.set_float(0, 'Q');
  registers.set_float(2, air.direction_deg);
  registers.set_float(4, air.speed_m_s);
  registers.set_float(6, air.direction_deg);
}

/// MetSENS200: 40001 DIR, 40003 SPEED.
void measure_metsens(const Air& air, RegisterBank& registers) {
  registers.set_float(0, air.direction_deg);
  registers.set_float(2, air.speed_m_s);
}

/// Lambrecht: from 30001 speed now, mean, most, least.
void measure_lambrecht_cup(const Air& air, RegisterBank& registers) {
  registers.set(30001, kTenths * air.speed_m_s);
  registers.set(30002, kTenths * air.mean_m_s);
  registers.set(30003, kTenths * air.gust_m_s);
  registers.set(30004, kTenths * air.lull_m_s);
}

/// Lambrecht: from 30201 direction now, mean, most, least.
void measure_lambrecht_vane(const Air& air, RegisterBank& registers) {
  for (int i = 30201; i <= 30204; ++i) registers.set(i, kTenths * air.direction_deg);
}

/// Thies: 30001 speed now, 30003 mean, 30011 gust; 30203 direction, 30211 that of the gust; 30401 temperature, 30601
/// humidity, 30801 pressure in hundredths; two registers each.
void measure_thies(const Air& air, RegisterBank& registers) {
  registers.set_two(30001, kTenths * air.speed_m_s);
  registers.set_two(30003, kTenths * air.speed_m_s);
  registers.set_two(30011, kTenths * air.gust_m_s);
  registers.set_two(30203, kTenths * air.direction_deg);
  registers.set_two(30211, kTenths * air.direction_deg);
  registers.set_two(30401, kTenths * air.temperature_c);
  registers.set_two(30601, kTenths * air.humidity_percent);
  registers.set_two(30801, 100.0 * air.pressure_hpa);
}

constexpr std::array kRenkeCup = {Slave{1, 3, measure_cup}};
constexpr std::array kCupAt0x16 = {Slave{1, 3, measure_cup_at_0x16}};
constexpr std::array kRenkePair = {Slave{1, 3, measure_cup}, Slave{2, 3, measure_renke_vane}};
constexpr std::array kDfrobotCup = {Slave{2, 3, measure_cup}};
constexpr std::array kDfrobotPair = {Slave{2, 3, measure_cup}, Slave{3, 3, measure_sen0482}};
constexpr std::array kDfrobotPairV1 = {Slave{2, 3, measure_cup}, Slave{3, 3, measure_sen0482_v1}};
constexpr std::array kMultiStation = {Slave{1, 3, measure_multi_station}};
constexpr std::array kMultiStationX100 = {Slave{1, 3, measure_multi_station_x100}};
constexpr std::array kSen0657 = {Slave{1, 3, measure_sen0657}};
constexpr std::array kWn90lp = {Slave{0x90, 3, measure_wn90lp}};
constexpr std::array kSensecap = {Slave{1, 4, measure_sensecap}};
constexpr std::array kCalypso = {Slave{1, 3, measure_calypso}};
constexpr std::array kLufft = {Slave{1, 4, measure_lufft}};
constexpr std::array kWm80 = {Slave{1, 3, measure_wm80}};
constexpr std::array kGmx = {Slave{1, 3, measure_gmx}};
constexpr std::array kMetsens = {Slave{1, 3, measure_metsens}};
constexpr std::array kLambrecht = {Slave{1, 4, measure_lambrecht_cup, 30002},
                                   Slave{2, 4, measure_lambrecht_vane, 30202}};
constexpr std::array kThies = {Slave{1, 4, measure_thies}};
constexpr std::array kVane = {Slave{1, 3, measure_renke_vane}};
constexpr std::array kDfrobotVane = {Slave{2, 3, measure_sen0482}};

struct DeviceEntry {
  std::string_view name;
  std::span<const Slave> slaves;
};
constexpr std::array<DeviceEntry, 22> kModbusDevices = {{
    {"renke-rs-fsjt-rs-fxjt-n01", kRenkePair},
    {"renke-rs-fsjt-n01", kRenkeCup},
    {"renke-rs-fxjt-n01", kVane},
    {"dfrobot-sen0483", kDfrobotCup},
    {"dfrobot-sen0482", kDfrobotVane},
    {"dfrobot-sen0483-sen0482", kDfrobotPair},
    {"dfrobot-sen0483-sen0482-v1", kDfrobotPairV1},
    {"renke-multi-station", kMultiStation},
    {"renke-multi-station-x100", kMultiStationX100},
    {"dfrobot-sen0657", kSen0657},
    {"ecowitt-wn90lp", kWn90lp},
    {"seeed-sensecap-one", kSensecap},
    {"calypso-ulp", kCalypso},
    {"lufft-umb", kLufft},
    {"vaisala-wm80", kWm80},
    {"gill-maximet-gmx", kGmx},
    {"campbell-metsens200", kMetsens},
    {"lambrecht-industry", kLambrecht},
    {"thies-clima-sensor-us", kThies},
    {"xunchip-xm8589", kRenkeCup},
    {"generic-rs485-cup", kRenkeCup},
    {"generic-rs485-cup-0x16", kCupAt0x16},
}};

constexpr int kMaxSlaveId = 247;

/// 0 for a text that is no id.
int slave_id_in(std::string_view text) {
  int id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  return error == std::errc{} && end == text.data() + text.size() ? id : 0;
}

}  // namespace

void RegisterBank::set(int address, double value) {
  set_bits(address, static_cast<std::uint16_t>(std::lround(value)));
}

void RegisterBank::set_two(int address, double value) {
  const auto bits = static_cast<std::uint32_t>(std::lround(value));
  set_bits(address, static_cast<std::uint16_t>(bits >> 16U));
  set_bits(address + 1, static_cast<std::uint16_t>(bits & 0xFFFFU));
}

void RegisterBank::set_float(int address, double value) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  set_bits(address, static_cast<std::uint16_t>(bits >> 16U));
  set_bits(address + 1, static_cast<std::uint16_t>(bits & 0xFFFFU));
}

void RegisterBank::set_float_low_word_first(int address, double value) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  set_bits(address, static_cast<std::uint16_t>(bits & 0xFFFFU));
  set_bits(address + 1, static_cast<std::uint16_t>(bits >> 16U));
}

std::optional<std::uint16_t> RegisterBank::at(std::uint16_t address) const {
  const auto found = registers_.find(address);
  return found != registers_.end() ? std::optional(found->second) : std::nullopt;
}

std::vector<std::string> modbus_device_names() {
  std::vector<std::string> names;
  names.reserve(kModbusDevices.size());
  for (const DeviceEntry& device : kModbusDevices) names.emplace_back(device.name);
  return names;
}

std::vector<Slave> modbus_slaves(std::string_view name_and_id) {
  const std::size_t at = name_and_id.find('@');
  const std::string_view name = name_and_id.substr(0, at);
  const auto device = std::ranges::find(kModbusDevices, name, &DeviceEntry::name);
  if (device == kModbusDevices.end()) {
    throw std::runtime_error(
        fmt::format("no simulated Modbus device \"{}\"; known: {}", name, fmt::join(modbus_device_names(), ", ")));
  }
  std::vector<Slave> slaves(device->slaves.begin(), device->slaves.end());
  if (at == std::string_view::npos) return slaves;

  const int first = slave_id_in(name_and_id.substr(at + 1));
  const int last = first + static_cast<int>(slaves.size()) - 1;
  if (first < 1 || last > kMaxSlaveId) {
    throw std::runtime_error(fmt::format("\"{}\" is not a slave id; allowed: 1 to {}", name_and_id, kMaxSlaveId));
  }
  for (std::size_t i = 0; i < slaves.size(); ++i) slaves[i].id = static_cast<std::uint8_t>(first + static_cast<int>(i));
  return slaves;
}

}  // namespace yuragi::simulators::modbus
