#include "drivers/text/nmea2000_sensor.hpp"

#include <span>
#include <utility>

#include <fmt/format.h>

#include "drivers/bus/can_interfaces.hpp"

namespace yuragi::drivers::text {

Nmea2000Sensor::Nmea2000Sensor(Nmea2000SensorSettings settings, std::unique_ptr<bus::BytePort> port)
    : Sensor(settings.text, std::move(port)),
      settings_(std::move(settings)),
      lines_(settings_.lines),
      wind_(settings_.wind) {}

void Nmea2000Sensor::begin() {
  wind_.restart();
  lines_.restart();
}

Sensor::Judgement Nmea2000Sensor::judge(std::string_view line, const Instant& now) {
  const auto said = lines_.decode(line);
  if (!said) return said.error();
  if (settings_.address && said->address != *settings_.address) return decode::Refusal::kNotMine;
  const auto reference = decode::marine::kWindDataReferenceNames[static_cast<std::size_t>(said->reference)];
  return wind_.offer(fmt::format("wind {} of device {}", reference, said->address), said->wind, now);
}

std::string Nmea2000Sensor::name() const {
  std::string taken = wind_.taken().empty() ? "NMEA 2000" : wind_.taken();
  if (lines_.lacks_angle_unit()) taken += " without a direction (unknown unit: set angle_unit)";
  if (lines_.controller() == decode::marine::ControllerState::kPassive) taken += " over a bus with many errors";
  return taken;
}

std::string Nmea2000Sensor::reported_trouble() const {
  using State = decode::marine::ControllerState;
  constexpr std::string_view kSuspects = "check the bit rate (250000), the wires and both terminators of the bus";
  const bus::BytePortAddress& address = settings().address;
  switch (lines_.controller()) {
    case State::kGood:
      break;
    case State::kPassive:
      return fmt::format("{} receives only errors (error passive): {}", describe(address), kSuspects);
    case State::kBusOff: {
      const std::string command =
          address.kind == bus::BytePortKind::kCan
              ? fmt::format("; then sudo ip link set {} down, and {}", address.path, bus::can_up_command(address.path))
              : "";
      return fmt::format("{} has left the bus after too many errors (bus off): {}{}", describe(address), kSuspects,
                         command);
    }
  }
  return {};
}

std::string Nmea2000Sensor::advice(decode::Refusal why, std::string_view line) const {
  using decode::marine::BusLineFormat;
  using decode::marine::kBusLineFormatNames;
  if (why == decode::Refusal::kMalformed || why == decode::Refusal::kTooShort) {
    const auto format = decode::marine::bus_line_format_of(line);
    const BusLineFormat accepted = settings_.lines.format;
    const auto name_of = [](BusLineFormat of) { return kBusLineFormatNames.at(static_cast<std::size_t>(of)); };
    const std::string where = describe(settings().address);
    if (!format) {
      return fmt::format(
          "lines arrive from {}, but in no format of NMEA 2000 that is read (the first: \"{}\"): set the "
          "gateway to one of {}",
          where, shown(line), fmt::join(std::span(kBusLineFormatNames).subspan(1), ", "));
    }
    if (accepted != BusLineFormat::kAuto && *format != accepted) {
      return fmt::format("lines arrive from {} in the format {}, not {} (the first: \"{}\"): set format = \"auto\"",
                         where, name_of(*format), name_of(accepted), shown(line));
    }
  }
  if (why == decode::Refusal::kNotMine) {
    return Sensor::advice(why, line) + " (format, address, reference), and that PGN 130306 is on the bus";
  }
  return Sensor::advice(why, line);
}

}  // namespace yuragi::drivers::text
