#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "tests/support/recording_sink.hpp"
#include "tests/support/running_sensor.hpp"

namespace yuragi::test {

/// A sensor that runs as in the daemon, and a sink of the test's own, into which what it says comes while the test
/// waits.
class LiveSensor {
 public:
  explicit LiveSensor(std::unique_ptr<drivers::sensor::Sensor> sensor) : sensor_(std::move(sensor)) {}

  RecordingSink sink;

  /// Waits until `holds()`, which looks at the sink; false if it hangs, or does not within a shorter time.
  template <class Condition>
  bool wait_until(Condition&& holds, Nanoseconds at_most = RunningSensor::kHang) {
    return sensor_.take_until(sink, std::forward<Condition>(holds), at_most);
  }
  /// Waits for so many readings more.
  bool wait_for_readings(std::size_t count) {
    take();
    const std::size_t wanted = sink.readings.size() + count;
    return wait_until([&] { return sink.readings.size() >= wanted; });
  }
  /// What it says in that time.
  void listen_for(Nanoseconds duration) {
    wait_until([] { return false; }, duration);
  }
  void end() {
    sensor_.end();
    take();
  }

 private:
  void take() {
    wait_until([] { return true; });
  }

  RunningSensor sensor_;
};

}  // namespace yuragi::test
