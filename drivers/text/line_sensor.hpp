#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/decode/text/line.hpp"
#include "drivers/text/text_sensor.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::text {

struct LineSensorSettings {
  SensorSettings text;
  decode::text::LineOptions line;
  double north_offset_deg = 0.0;  ///< what to add to each direction
};

/// The parameters of the format of a line: the driver's first ones, and the options of `yuragi decode line`.
std::span<const Parameter> line_reading_parameters();

/// Their values. Throws std::runtime_error, `name: what is wrong`, if they cannot work together.
decode::text::LineOptions line_options_of(const ParameterValues& values);

/// The values of kLineDriver's parameters. Throws std::runtime_error if they cannot work together.
LineSensorSettings line_sensor_settings_of(const ParameterValues& values);

/// A microcontroller that prints numbers, one reading a line, without a checksum. In place of a
/// checksum the shape of lines is checked: a line of another shape than the one before it, or next to bytes that are no
/// text, is refused.
class LineSensor final : public Sensor {
 public:
  LineSensor(LineSensorSettings settings, std::unique_ptr<bus::BytePort> port);

 private:
  Judgement judge(std::string_view line, const Instant& now) override;
  void begin() override;
  std::string name() const override { return "lines of numbers"; }

  LineSensorSettings settings_;
  std::optional<std::size_t> shape_;       // shape of the accepted lines
  std::optional<std::size_t> last_shape_;  // of the line before
  bool follows_garbage_ = false;
};

}  // namespace yuragi::drivers::text
