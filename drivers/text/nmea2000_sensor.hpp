#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/decode/marine/bus_line.hpp"
#include "drivers/text/chosen_wind.hpp"
#include "drivers/text/text_sensor.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::text {

struct Nmea2000SensorSettings {
  SensorSettings text;
  decode::marine::BusLineOptions lines;
  std::optional<std::uint8_t> address;  ///< take only this device's wind; nullopt: any
  ChosenWindSettings wind = {};
};

/// The values of kNmea2000Driver's parameters. Throws std::runtime_error if they cannot work together.
Nmea2000SensorSettings nmea2000_sensor_settings_of(const ParameterValues& values);

/// Wind of an NMEA 2000 bus, as a gateway or program writes it in lines, or from a CAN interface.
class Nmea2000Sensor final : public Sensor {
 public:
  Nmea2000Sensor(Nmea2000SensorSettings settings, std::unique_ptr<bus::BytePort> port);

 private:
  Judgement judge(std::string_view line, const Instant& now) override;
  std::optional<wind::Reading> take_held() override { return wind_.take_held(); }
  void begin() override;
  std::string name() const override;
  std::string_view driver() const override { return "nmea2000"; }
  std::string reported_trouble() const override;
  std::string advice(decode::Refusal why, std::string_view line) const override;

  Nmea2000SensorSettings settings_;
  decode::marine::BusLineDecoder lines_;
  ChosenWind wind_;
};

}  // namespace yuragi::drivers::text
