// Wind of an NMEA 2000 bus, as gateways write it. The formats are written here, independently of the drivers' decoders,
// so that a mistake on either side shows.
//
//   yacht-devices  17:33:21.179 R 09FD0223 64 56 01 37 9D FA FF FF      a frame's identifier and bytes
//   canboat        {"version":"4.12.0","units":"std"}                   to each new client; then, in degrees:
//                  {"timestamp":"...","prio":2,"src":35,"dst":255,"pgn":130306,"description":"Wind Data",
//                   "fields":{"SID":100,"Wind Speed":3.42,"Wind Angle":230.6,"Reference":"Apparent"}}
//   canboat-si     the same of analyzer -si -nv -camel: in radians, the reference as number and name
//
//   candump        (1436509052.249713) can0 09FD0223#645601379DFAFFFF   can-utils, candump -L
//   canboat-plain  2026-06-21T15:00:00.626Z,2,130306,35,255,8,64,56,01,37,9d,fa,ff,ff   canboat's actisense-serial
//   actisense      A150000.626 23FF2 1FD02 645601379DFAFFFF            N2K ASCII of Actisense's gateways
//   on a bus       struct can_frame of linux/can.h: the identifier with its flags, the size, 3 bytes, 8 of data
//
// Sources: Yacht Devices YDNU-02 manual, appendix E; canboat analyzer/analyzer.c,
// actisense-serial/actisense-serial.c; canboatjs lib/stringMsg.ts; the bytes: canboat docs, PGN 130306.
#include "simulators/text/nmea2000_device.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/error.h>

#include "engine/base/units.hpp"

namespace yuragi::simulators::text {
namespace {

constexpr unsigned kAddress = 35;
constexpr unsigned kOtherAddress = 36;
constexpr unsigned kPriorityAndPgn = 0x09FD02;  // 2, 130306
/// The analyzer's names of the references, by their numbers on the bus.
struct BusReference {
  std::string_view name;
  std::string_view text;
};
constexpr std::array<BusReference, 5> kBusReferences = {{{"north", "True (ground referenced to North)"},
                                                         {"magnetic", "Magnetic (ground referenced to Magnetic North)"},
                                                         {"apparent", "Apparent"},
                                                         {"boat", "True (boat referenced)"},
                                                         {"water", "True (water referenced)"}}};
constexpr unsigned kReservedBits = 0xF8;
constexpr unsigned kSequenceIds = 253;

/// One message of the anemometer.
struct BusMessage {
  unsigned number = 0;
  unsigned address = kAddress;
  double speed_m_s = 0.0;
  double angle_rad = 0.0;
  unsigned reference = 0;  // its place in kBusReferences

  unsigned sequence_id() const { return number % kSequenceIds; }
};

using BusData = std::array<unsigned char, CAN_MAX_DLEN>;

BusData data_of(const BusMessage& message) {
  const auto speed = static_cast<unsigned>(std::lround(message.speed_m_s * 100.0));
  const auto angle = static_cast<unsigned>(std::lround(message.angle_rad * 10000.0));
  BusData data;
  data.fill(0xFF);
  const std::array<unsigned, 6> said = {message.sequence_id(), speed & 0xFFU, speed >> 8U,
                                        angle & 0xFFU,         angle >> 8U,   kReservedBits | message.reference};
  std::ranges::transform(said, data.begin(), [](unsigned byte) { return static_cast<unsigned char>(byte); });
  return data;
}

std::string yacht_devices_line(const BusMessage& message) {
  return fmt::format("{:02}:{:02}:{:02}.179 R {:06X}{:02X} {:02X}\r\n", message.number / 3600 % 24,
                     message.number / 60 % 60, message.number % 60, kPriorityAndPgn, message.address,
                     fmt::join(data_of(message), " "));
}

std::string candump_line(const BusMessage& message) {
  return fmt::format("({}.249713) can0 {:06X}{:02X}#{:02X}\n", 1436509052 + message.number, kPriorityAndPgn,
                     message.address, fmt::join(data_of(message), ""));
}

std::string canboat_plain_line(const BusMessage& message) {
  return fmt::format("2026-06-21T{:02}:{:02}:{:02}.626Z,2,130306,{},255,8,{:02x}\r\n", message.number / 3600 % 24,
                     message.number / 60 % 60, message.number % 60, message.address, fmt::join(data_of(message), ","));
}

std::string actisense_line(const BusMessage& message) {
  return fmt::format("A{:02}{:02}{:02}.626 {:02X}FF2 1FD02 {:02X}\r\n", message.number / 3600 % 24,
                     message.number / 60 % 60, message.number % 60, message.address, fmt::join(data_of(message), ""));
}

/// The bytes of a frame as the kernel takes them.
std::string bytes_of_frame(canid_t identifier, const BusData& data) {
  can_frame frame{};
  frame.can_id = identifier;
  frame.can_dlc = CAN_MAX_DLEN;
  std::ranges::copy(data, std::begin(frame.data));
  return {reinterpret_cast<const char*>(&frame), sizeof frame};
}

std::string canboat_line(const BusMessage& message) {
  return fmt::format(R"({{"timestamp":"2026-06-21-15:{:02}:{:02}.626","prio":2,"src":{},"dst":255,"pgn":130306,)"
                     R"("description":"Wind Data","fields":{{"SID":{},"Wind Speed":{:.2f},"Wind Angle":{:.1f},)"
                     R"("Reference":"{}"}}}})"
                     "\n",
                     message.number / 60 % 60, message.number % 60, message.address, message.sequence_id(),
                     message.speed_m_s, message.angle_rad / kRadPerDeg, kBusReferences.at(message.reference).text);
}

std::string canboat_si_line(const BusMessage& message) {
  return fmt::format(
      R"({{"windData":{{"timestamp":"2026-06-21T15:{:02}:{:02}.626Z","prio":2,"src":{},"dst":255,"pgn":130306,)"
      R"("description":"windData","fields":{{"sid":{},"windSpeed":{:.2f},"windAngle":{:.4f},)"
      R"("reference":{{"value":{},"name":"{}"}}}}}}}})"
      "\n",
      message.number / 60 % 60, message.number % 60, message.address, message.sequence_id(), message.speed_m_s,
      message.angle_rad, message.reference, kBusReferences.at(message.reference).text);
}

struct BusFormat {
  std::string_view name;
  std::string_view greeting;
  std::string (*line)(const BusMessage& message);
};
constexpr std::array<BusFormat, 6> kBusFormats = {
    {{"yacht-devices", "", yacht_devices_line},
     {"canboat", "{\"version\":\"4.12.0\",\"units\":\"std\"}\n", canboat_line},
     {"canboat-si", "{\"version\":\"4.12.0\",\"units\":\"si\"}\n", canboat_si_line},
     {"candump", "", candump_line},
     {"canboat-plain", "", canboat_plain_line},
     {"actisense", "", actisense_line}}};

class Nmea2000Device final : public Device {
 public:
  Nmea2000Device(const BusFormat& format, unsigned reference) : format_(format), reference_(reference) {}

  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kWrongId};
    return kKnown;
  }
  std::string greeting() const override { return std::string(format_.greeting); }
  std::vector<std::string> send_messages(const core::PlayedMoment& moment,
                                         std::optional<core::FaultKind> fault) override {
    return {format_.line({.number = number_++,
                          .address = fault == core::FaultKind::kWrongId ? kOtherAddress : kAddress,
                          .speed_m_s = moment.speed_m_s,
                          .angle_rad = moment.direction_deg * kRadPerDeg,
                          .reference = reference_})};
  }
  bool is_request(std::string_view /*line*/) const override { return false; }

 private:
  BusFormat format_;
  unsigned reference_;
  unsigned number_ = 0;
};

class Nmea2000CanDevice final : public Device {
 public:
  explicit Nmea2000CanDevice(unsigned reference) : reference_(reference) {}

  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kWrongId, core::FaultKind::kException};
    return kKnown;
  }
  std::vector<std::string> send_messages(const core::PlayedMoment& moment,
                                         std::optional<core::FaultKind> fault) override {
    if (fault == core::FaultKind::kException) return {bytes_of_frame(CAN_ERR_FLAG | CAN_ERR_BUSOFF, {})};
    const unsigned address = fault == core::FaultKind::kWrongId ? kOtherAddress : kAddress;
    const BusMessage message = {.number = number_++,
                                .address = address,
                                .speed_m_s = moment.speed_m_s,
                                .angle_rad = moment.direction_deg * kRadPerDeg,
                                .reference = reference_};
    return {bytes_of_frame(CAN_EFF_FLAG | (kPriorityAndPgn << 8U) | address, data_of(message))};
  }
  bool is_request(std::string_view /*line*/) const override { return false; }

 private:
  unsigned reference_;
  unsigned number_ = 0;
};

unsigned reference_named(const std::string& name) {
  const auto* const found = std::ranges::find(kBusReferences, name, &BusReference::name);
  if (found == kBusReferences.end()) {
    throw std::runtime_error(
        fmt::format("no reference \"{}\"; known: {}", name, fmt::join(nmea2000_reference_names(), ", ")));
  }
  return static_cast<unsigned>(found - kBusReferences.begin());
}

}  // namespace

std::vector<std::string> nmea2000_format_names() {
  std::vector<std::string> names;
  names.reserve(kBusFormats.size());
  for (const BusFormat& format : kBusFormats) names.emplace_back(format.name);
  return names;
}

std::vector<std::string> nmea2000_reference_names() {
  std::vector<std::string> names;
  names.reserve(kBusReferences.size());
  for (const BusReference& reference : kBusReferences) names.emplace_back(reference.name);
  return names;
}

std::unique_ptr<Device> make_nmea2000_device(const std::string& format, const std::string& reference) {
  const auto* const found = std::ranges::find(kBusFormats, format, &BusFormat::name);
  if (found == kBusFormats.end()) {
    throw std::runtime_error(
        fmt::format("no simulated format \"{}\"; known: {}", format, fmt::join(nmea2000_format_names(), ", ")));
  }
  return std::make_unique<Nmea2000Device>(*found, reference_named(reference));
}

std::unique_ptr<Device> make_nmea2000_can_device(const std::string& reference) {
  return std::make_unique<Nmea2000CanDevice>(reference_named(reference));
}

}  // namespace yuragi::simulators::text
