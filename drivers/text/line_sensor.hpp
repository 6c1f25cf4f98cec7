#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/decode/text/line.hpp"
#include "drivers/sensor/held_wind.hpp"
#include "drivers/text/text_sensor.hpp"
#include "engine/base/parameter.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::text {

struct LineSensorSettings {
  SensorSettings text;
  decode::text::LineOptions line;
  double north_offset_deg = 0.0;                ///< what to add to each direction
  Nanoseconds hold = std::chrono::seconds(60);  ///< how long a direction or gust of another line is used
};

/// The parameters of the format of a line: the driver's first ones, and the options of `yuragi decode line`.
std::span<const Parameter> line_reading_parameters();

/// Their values. Throws std::runtime_error, `name: what is wrong`, if they cannot work together.
decode::text::LineOptions line_options_of(const ParameterValues& values);

/// The values of kLineDriver's parameters. Throws std::runtime_error if they cannot work together.
LineSensorSettings line_sensor_settings_of(const ParameterValues& values);

/// A microcontroller that prints numbers, one reading or one value a line, without a checksum. Each speed gives a
/// reading, with the direction and gust of its own line or of earlier ones (sensor::HeldWind). In place of a checksum
/// the shape of lines is checked: a line of another shape than those before it, or next to bytes that are no text, is
/// refused.
class LineSensor final : public Sensor {
 public:
  LineSensor(LineSensorSettings settings, std::unique_ptr<bus::BytePort> port);

 private:
  Judgement judge(std::string_view line, const Instant& now) override;
  void begin() override;
  std::string name() const override { return "lines of numbers"; }
  std::string_view driver() const override { return "line"; }
  std::string reported_trouble() const override;
  std::string advice(decode::Refusal why, std::string_view line) const override;

  bool has_known_shape(std::string_view line);
  void hold(const decode::text::LineWind& line, MonoTime now);

  LineSensorSettings settings_;
  sensor::HeldWind held_;
  std::optional<std::size_t> shape_;                            // shape of the accepted lines
  std::array<std::optional<std::size_t>, 3> last_shapes_ = {};  // of the lines before, the newest first
  std::string without_speed_;  // the first line with a direction or gust since the last one with a speed; empty: none
  bool follows_garbage_ = false;
};

}  // namespace yuragi::drivers::text
