#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/decode/marine/canboat.hpp"
#include "drivers/decode/marine/candump.hpp"
#include "drivers/text/chosen_wind.hpp"
#include "drivers/text/text_sensor.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::text {

/// How a gateway or program writes what is said on an NMEA 2000 bus.
enum class Nmea2000Format : std::uint8_t {
  kAuto,  ///< detected, line by line
  kYachtDevices,
  kCanboat,
  kCandump,  ///< also a CAN interface's
};

struct Nmea2000SensorSettings {
  TextSensorSettings text;
  Nmea2000Format format = Nmea2000Format::kAuto;
  std::optional<std::uint8_t> address;                       ///< take this device's wind only; nothing: any
  std::optional<decode::marine::AngleUnit> angle_unit = {};  ///< of canboat; nothing: as it says
  ChosenWindSettings wind = {};
};

/// The values of kNmea2000Driver's parameters. Throws std::runtime_error where they cannot work together.
Nmea2000SensorSettings nmea2000_sensor_settings_of(const ParameterValues& values);

/// Wind of an NMEA 2000 bus, as a gateway or program writes it in lines, or from a CAN interface.
class Nmea2000Sensor final : public TextSensor {
 public:
  Nmea2000Sensor(Nmea2000SensorSettings settings, std::unique_ptr<bus::BytePort> port);

 private:
  Judgement judge(std::string_view line, const Instant& now) override;
  std::optional<wind::WindReading> take_held() override { return wind_.take_held(); }
  void begin() override;
  std::string name() const override;
  std::string told_trouble() const override;
  std::string advice(decode::Refusal why, std::string_view line) const override;

  Result<decode::marine::BusWind, decode::Refusal> decode(std::string_view line);

  Nmea2000SensorSettings settings_;
  ChosenWind wind_;
  std::optional<decode::marine::AngleUnit> angle_unit_;  // nothing: not known yet
  bool lacks_angle_unit_ = false;
  decode::marine::ControllerState controller_ = decode::marine::ControllerState::kGood;
};

}  // namespace yuragi::drivers::text
