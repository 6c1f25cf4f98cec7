#pragma once

#include <memory>
#include <string>

#include "drivers/usb/usb_sensor.hpp"
#include "simulators/usb/daqs.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/simulated_usb_bus.hpp"

namespace yuragi {

/// The USB driver on a simulated bus, wired as CupAndVane is, and what comes of it.
struct UsbBench {
  ManualClock clock;
  SimulatedUsbBus bus{clock};
  RecordingSink sink;
  drivers::usb::Settings settings;
  std::unique_ptr<drivers::usb::Sensor> sensor;
  MonoTime due{};

  /// With one device plugged in.
  explicit UsbBench(const std::string& device) : UsbBench() { plug(device, "1-2"); }
  UsbBench() {
    settings.models.assign(drivers::usb::usb_daq_models().begin(), drivers::usb::usb_daq_models().end());
    settings.cup.metres_per_pulse = 0.1;
  }

  void plug(const std::string& device, const std::string& port, const std::string& serial = "") {
    bus.sockets.push_back({port, serial, simulators::usb::make_daq(device)});
  }

  /// One poll, when it is due; makes the sensor the first time.
  Nanoseconds poll() {
    if (!sensor)
      sensor = std::make_unique<drivers::usb::Sensor>(settings, 1, std::make_unique<SimulatedUsbDevice>(bus));
    clock.advance_to(due);
    due = sensor->poll(clock, sink);
    return due - clock.now().mono;
  }
  void poll_for(double duration_s) {
    const MonoTime end = clock.now().mono + from_seconds(duration_s);
    do poll();
    while (due < end);
    clock.advance_to(end);
  }
  /// Polls until a new reading is there; false if none comes in that time.
  bool poll_for_reading(double within_s) {
    const auto before = sink.readings.size();
    const MonoTime end = clock.now().mono + from_seconds(within_s);
    while (sink.readings.size() == before && due <= end) poll();
    return sink.readings.size() > before;
  }
};

}  // namespace yuragi
