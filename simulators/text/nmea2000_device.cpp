// Wind of an NMEA 2000 bus, as gateways write it. The formats are written here, independently of the drivers' decoders,
// so that a mistake on either side shows.
//
//   yacht-devices  17:33:21.179 R 09FD0223 64 56 01 37 9D FA FF FF      a frame's identifier and bytes
//   canboat        {"version":"4.12.0","units":"std"}                   to each new client; then, in degrees:
//                  {"timestamp":"...","prio":2,"src":35,"dst":255,"pgn":130306,"description":"Wind Data",
//                   "fields":{"SID":100,"Wind Speed":3.42,"Wind Angle":230.6,"Reference":"Apparent"}}
//   canboat-si     the same of analyzer -si -nv -camel: in radians, the reference as number and name
//
// Sources: Yacht Devices YDNU-02 manual, appendix E; canboat analyzer/analyzer.c; the bytes: canboat docs, PGN 130306.
#include "simulators/text/nmea2000_device.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "engine/base/units.hpp"

namespace yuragi::simulators::text {
namespace {

constexpr unsigned kAddress = 35;
constexpr unsigned kOtherAddress = 36;
constexpr unsigned kPriorityAndPgn = 0x09FD02;  // 2, 130306
constexpr unsigned kApparentReference = 2;
constexpr unsigned kReservedBits = 0xF8;
constexpr unsigned kSequenceIds = 253;

/// One message of the anemometer.
struct BusMessage {
  unsigned number = 0;
  unsigned address = kAddress;
  double speed_m_s = 0.0;
  double angle_rad = 0.0;

  unsigned sequence_id() const { return number % kSequenceIds; }
};

std::string yacht_devices_line(const BusMessage& message) {
  const auto speed = static_cast<unsigned>(std::lround(message.speed_m_s * 100.0));
  const auto angle = static_cast<unsigned>(std::lround(message.angle_rad * 10000.0));
  return fmt::format("{:02}:{:02}:{:02}.179 R {:06X}{:02X} {:02X} {:02X} {:02X} {:02X} {:02X} {:02X} FF FF\r\n",
                     message.number / 3600 % 24, message.number / 60 % 60, message.number % 60, kPriorityAndPgn,
                     message.address, message.sequence_id(), speed & 0xFFU, speed >> 8U, angle & 0xFFU, angle >> 8U,
                     kReservedBits | kApparentReference);
}

std::string canboat_line(const BusMessage& message) {
  return fmt::format(R"({{"timestamp":"2026-06-21-15:{:02}:{:02}.626","prio":2,"src":{},"dst":255,"pgn":130306,)"
                     R"("description":"Wind Data","fields":{{"SID":{},"Wind Speed":{:.2f},"Wind Angle":{:.1f},)"
                     R"("Reference":"Apparent"}}}})"
                     "\n",
                     message.number / 60 % 60, message.number % 60, message.address, message.sequence_id(),
                     message.speed_m_s, message.angle_rad / kRadPerDeg);
}

std::string canboat_si_line(const BusMessage& message) {
  return fmt::format(
      R"({{"windData":{{"timestamp":"2026-06-21T15:{:02}:{:02}.626Z","prio":2,"src":{},"dst":255,"pgn":130306,)"
      R"("description":"windData","fields":{{"sid":{},"windSpeed":{:.2f},"windAngle":{:.4f},)"
      R"("reference":{{"value":2,"name":"Apparent"}}}}}}}})"
      "\n",
      message.number / 60 % 60, message.number % 60, message.address, message.sequence_id(), message.speed_m_s,
      message.angle_rad);
}

struct BusFormat {
  std::string_view name;
  std::string_view greeting;
  std::string (*line)(const BusMessage& message);
};
constexpr std::array<BusFormat, 3> kBusFormats = {
    {{"yacht-devices", "", yacht_devices_line},
     {"canboat", "{\"version\":\"4.12.0\",\"units\":\"std\"}\n", canboat_line},
     {"canboat-si", "{\"version\":\"4.12.0\",\"units\":\"si\"}\n", canboat_si_line}}};

class Nmea2000Device final : public TextDevice {
 public:
  explicit Nmea2000Device(const BusFormat& format) : format_(format) {}

  std::span<const FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {FaultKind::kWrongId};
    return kKnown;
  }
  std::string greeting() const override { return std::string(format_.greeting); }
  std::vector<std::string> send_messages(const PlayedMoment& moment, std::optional<FaultKind> fault) override {
    return {format_.line({.number = number_++,
                          .address = fault == FaultKind::kWrongId ? kOtherAddress : kAddress,
                          .speed_m_s = moment.speed_m_s,
                          .angle_rad = moment.direction_deg * kRadPerDeg})};
  }
  bool is_request(std::string_view /*line*/) const override { return false; }

 private:
  BusFormat format_;
  unsigned number_ = 0;
};

}  // namespace

std::vector<std::string> nmea2000_format_names() {
  std::vector<std::string> names;
  names.reserve(kBusFormats.size());
  for (const BusFormat& format : kBusFormats) names.emplace_back(format.name);
  return names;
}

std::unique_ptr<TextDevice> make_nmea2000_device(const std::string& format) {
  const auto* const found = std::ranges::find(kBusFormats, format, &BusFormat::name);
  if (found == kBusFormats.end()) {
    throw std::runtime_error(
        fmt::format("no simulated format \"{}\"; known: {}", format, fmt::join(nmea2000_format_names(), ", ")));
  }
  return std::make_unique<Nmea2000Device>(*found);
}

}  // namespace yuragi::simulators::text
