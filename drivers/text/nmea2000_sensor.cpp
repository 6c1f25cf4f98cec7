#include "drivers/text/nmea2000_sensor.hpp"

#include <utility>

#include <fmt/format.h>

#include "drivers/decode/marine/yacht_devices.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::text {
namespace {

using decode::marine::ControllerState;

/// Of gateways and programs.
Nmea2000Format bus_format_by_look(std::string_view line) {
  if (decode::trimmed(line).starts_with('{')) return Nmea2000Format::kCanboat;
  return decode::marine::looks_like_candump(line) ? Nmea2000Format::kCandump : Nmea2000Format::kYachtDevices;
}

}  // namespace

Nmea2000Sensor::Nmea2000Sensor(Nmea2000SensorSettings settings, std::unique_ptr<bus::BytePort> port)
    : TextSensor(settings.text, std::move(port)),
      settings_(std::move(settings)),
      wind_(settings_.wind),
      angle_unit_(settings_.angle_unit) {}

void Nmea2000Sensor::begin() {
  wind_.restart();
  angle_unit_ = settings_.angle_unit;
  lacks_angle_unit_ = false;
  controller_ = ControllerState::kGood;
}

Result<decode::marine::BusWind, decode::Refusal> Nmea2000Sensor::decode(std::string_view line) {
  const Nmea2000Format format = settings_.format == Nmea2000Format::kAuto ? bus_format_by_look(line) : settings_.format;
  if (format == Nmea2000Format::kYachtDevices) return decode::marine::decode_yacht_devices(line);
  if (format == Nmea2000Format::kCandump) {
    if (const auto told = decode::marine::candump_controller_state(line)) controller_ = *told;
    return decode::marine::decode_candump(line);
  }

  if (const auto told = decode::marine::canboat_angle_unit(line); told && !settings_.angle_unit) angle_unit_ = told;
  const auto said = decode::marine::decode_canboat({.angle_unit = angle_unit_}, line);
  // Without a known unit only what can be nothing but degrees is decoded.
  if (said && said->wind.direction_deg && !angle_unit_) angle_unit_ = decode::marine::AngleUnit::kDegrees;
  lacks_angle_unit_ = said && !angle_unit_;
  return said;
}

TextSensor::Judgement Nmea2000Sensor::judge(std::string_view line, const Instant& now) {
  const auto said = decode(line);
  if (!said) return said.error();
  if (controller_ == ControllerState::kBusOff) controller_ = ControllerState::kGood;  // it takes part again
  if (settings_.address && said->address != *settings_.address) return decode::Refusal::kNotMine;
  const auto reference = decode::marine::kWindDataReferenceNames[static_cast<std::size_t>(said->reference)];
  return wind_.offer(fmt::format("wind {} of device {}", reference, said->address), said->wind, now);
}

std::string Nmea2000Sensor::name() const {
  std::string taken = wind_.taken().empty() ? "NMEA 2000" : wind_.taken();
  if (lacks_angle_unit_) taken += " without a direction (set angle_unit: nothing says it)";
  if (controller_ == ControllerState::kPassive) taken += " over a bus with many errors";
  return taken;
}

std::string Nmea2000Sensor::told_trouble() const {
  constexpr std::string_view kSuspects = "check the bit rate (250000), the wires and both terminators of the bus";
  switch (controller_) {
    case ControllerState::kGood:
      break;
    case ControllerState::kPassive:
      return fmt::format("{} receives errors alone (error passive): {}", describe(settings().address), kSuspects);
    case ControllerState::kBusOff:
      return fmt::format("{} has left the bus after too many errors (bus off): {}, and switch it off and on again",
                         describe(settings().address), kSuspects);
  }
  return {};
}

std::string Nmea2000Sensor::advice(decode::Refusal why, std::string_view line) const {
  if (why == decode::Refusal::kNotMine) {
    return TextSensor::advice(why, line) + " (format, address, reference), and that PGN 130306 is on the bus";
  }
  return TextSensor::advice(why, line);
}

}  // namespace yuragi::drivers::text
