#pragma once

#include <memory>
#include <string>

#include "drivers/text/line_sensor.hpp"
#include "drivers/text/nmea_sensor.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/scripted_port.hpp"

namespace yuragi {

/// A text driver with a script at the far end.
struct ScriptedText {
  FarEnd far_end;
  ManualClock clock;
  RecordingSink sink;
  std::unique_ptr<drivers::sensor::Sensor> sensor;

  void make_nmea(ParameterValues::Map given = {}) {
    given.try_emplace("device", std::string("/dev/script"));
    sensor =
        std::make_unique<drivers::text::NmeaSensor>(drivers::text::nmea_sensor_settings_of(values_for("nmea", given)),
                                                    std::make_unique<ScriptedPort>(far_end, clock));
  }
  void make_line(ParameterValues::Map given = {}) {
    given.try_emplace("device", std::string("/dev/script"));
    given.try_emplace("delay_after_open", 0.0);
    sensor =
        std::make_unique<drivers::text::LineSensor>(drivers::text::line_sensor_settings_of(values_for("line", given)),
                                                    std::make_unique<ScriptedPort>(far_end, clock));
  }

  /// Polls for so long, as the daemon does: whenever the sensor wants it.
  void run(Nanoseconds duration) {
    const MonoTime end = clock.now().mono + duration;
    for (int idle = 0; clock.now().mono < end && idle < 100'000; ++idle) clock.advance_to(sensor->poll(clock, sink));
  }
  /// Polls until all that is said has been read, and a pause besides.
  void receive(std::string_view text) {
    far_end.send(text);
    while (!far_end.incoming.empty()) clock.advance_to(sensor->poll(clock, sink));
    run(std::chrono::milliseconds(250));
  }
};

}  // namespace yuragi
