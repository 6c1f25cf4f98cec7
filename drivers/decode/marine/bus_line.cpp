#include "drivers/decode/marine/bus_line.hpp"

#include "drivers/decode/marine/yacht_devices.hpp"
#include "drivers/decode/text_fields.hpp"

namespace yuragi::drivers::decode::marine {
namespace {

BusLineFormat format_by_look(std::string_view line) {
  if (trimmed(line).starts_with('{')) return BusLineFormat::kCanboat;
  return looks_like_candump(line) ? BusLineFormat::kCandump : BusLineFormat::kYachtDevices;
}

}  // namespace

Result<BusWind, Refusal> BusLineDecoder::decode(std::string_view line) {
  switch (options_.format == BusLineFormat::kAuto ? format_by_look(line) : options_.format) {
    case BusLineFormat::kCanboat:
      return decode_json(line);
    case BusLineFormat::kCandump:
      return decode_dump(line);
    case BusLineFormat::kYachtDevices:
    case BusLineFormat::kAuto:
      break;
  }
  return decode_yacht_devices(line);
}

Result<BusWind, Refusal> BusLineDecoder::decode_json(std::string_view line) {
  if (const auto told = canboat_angle_unit(line); told && !options_.angle_unit) angle_unit_ = told;
  const auto said = decode_canboat({.angle_unit = angle_unit_}, line);
  // Without a known unit only angles that must be in degrees are decoded.
  if (said && said->wind.direction_deg && !angle_unit_) angle_unit_ = AngleUnit::kDegrees;
  lacks_angle_unit_ = said && !angle_unit_;
  return said;
}

Result<BusWind, Refusal> BusLineDecoder::decode_dump(std::string_view line) {
  if (const auto told = candump_controller_state(line)) controller_ = *told;
  const auto said = decode_candump(line);
  if (said && controller_ == ControllerState::kBusOff) controller_ = ControllerState::kGood;  // it takes part again
  return said;
}

}  // namespace yuragi::drivers::decode::marine
