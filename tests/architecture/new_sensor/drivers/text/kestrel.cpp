// The Kestrel. Its lines: see its decoder.
#include "drivers/decode/text/kestrel.hpp"

#include <array>
#include <cmath>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/text/byte_port_parameters.hpp"
#include "drivers/text/text_sensor.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::text {
namespace {

struct KestrelSettings {
  SensorSettings text;
  double north_offset_deg = 0.0;  ///< what to add to each direction
};

const Fields<KestrelSettings> kKestrelFields = {
    {{"north_offset", "deg", 0.0, -360.0, 360.0, "bearing of the mark on its housing, clockwise from north"},
     &KestrelSettings::north_offset_deg},
};
const std::vector<Parameter> kKestrelParameters = with_byte_port_parameters(kKestrelFields.parameters(), 0.0);

KestrelSettings kestrel_settings_of(const ParameterValues& values) {
  KestrelSettings settings = kKestrelFields.of(values);
  settings.text = text_sensor_settings_of(values);
  return settings;
}

class KestrelSensor final : public Sensor {
 public:
  KestrelSensor(const KestrelSettings& settings, std::unique_ptr<bus::BytePort> port)
      : Sensor(settings.text, std::move(port)), north_offset_deg_(settings.north_offset_deg) {}

 private:
  Judgement judge(std::string_view line, const Instant& now) override {
    const auto wind = decode::text::decode_kestrel(line);
    if (!wind) return wind.error();
    if (!wind->speed_m_s) return decode::Refusal::kInvalid;
    wind::Reading reading{.time = now, .speed_m_s = *wind->speed_m_s};
    if (wind->direction_deg)
      reading.direction_deg =
          decode::wrapped_direction_deg(*wind->direction_deg + std::fmod(north_offset_deg_ + 360.0, 360.0));
    return std::optional(reading);
  }
  std::string name() const override { return "Kestrel"; }
  std::string_view driver() const override { return "kestrel"; }

  double north_offset_deg_;
};

constexpr std::array kKestrelFormats = {sensor::MessageFormat{
    .name = "kestrel",
    .is_text = true,
    .unit = "a line",
    .devices = "the Kestrel",
    .example = "kestrel roof.log",
    .decode = [](decode::ByteSpan line) noexcept {
      return decode::text::decode_kestrel({reinterpret_cast<const char*>(line.data()), line.size()});
    }}};

sensor::ValueSelection kestrel_selection(const ParameterValues& values) {
  return text_selection(kestrel_settings_of(values).text, {});
}

Result<sensor::SimulatedDevice, Failure> kestrel_simulated(const ParameterValues& values) {
  sensor::SimulatedDevice simulated = sensor::simulated_by_tcp("kestrel", values);
  simulated.north_offset_deg = values.number("north_offset");
  return simulated;
}

}  // namespace

std::unique_ptr<sensor::Sensor> make_kestrel_sensor(const ParameterValues& values,
                                                    std::unique_ptr<bus::BytePort> port) {
  return std::make_unique<KestrelSensor>(kestrel_settings_of(values), std::move(port));
}

extern const sensor::DriverDescription kKestrelDriver;
const sensor::DriverDescription kKestrelDriver{.name = "kestrel",
                                               .summary = "the Kestrel, by its lines",
                                               .parameters = kKestrelParameters,
                                               .open =
                                                   [](const ParameterValues& values) {
                                                     return make_kestrel_sensor(
                                                         values, bus::make_byte_port(byte_port_address_of(values)));
                                                   },
                                               .endpoints = byte_port_endpoints,
                                               .selection = kestrel_selection,
                                               .simulated = kestrel_simulated,
                                               .message_formats = kKestrelFormats};

}  // namespace yuragi::drivers::text
