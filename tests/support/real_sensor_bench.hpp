#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "daemon/sensing/system_clock.hpp"
#include "drivers/sensor/sensor.hpp"
#include "tests/support/recording_sink.hpp"

namespace yuragi::test {

/// A sensor that is polled in real time, when it wants to be, as the daemon does it.
class RealSensorBench {
 public:
  explicit RealSensorBench(std::unique_ptr<Sensor> sensor) : sensor_(std::move(sensor)) {}

  RecordingSink sink;

  /// Polls until `is_there`; false if that takes longer than anything should.
  bool poll_until(const std::function<bool()>& is_there) {
    poll_until(std::chrono::steady_clock::now() + kPatience, is_there);
    return is_there();
  }
  bool poll_for_readings(std::size_t count) {
    const std::size_t wanted = sink.readings.size() + count;
    return poll_until([&] { return sink.readings.size() >= wanted; });
  }
  /// Polls for so long, whatever comes.
  void poll_for(std::chrono::milliseconds duration) {
    poll_until(std::chrono::steady_clock::now() + duration, [] { return false; });
  }

 private:
  static constexpr std::chrono::seconds kPatience{40};
  static constexpr std::chrono::milliseconds kTurn{20};

  void poll_until(std::chrono::steady_clock::time_point deadline, const std::function<bool()>& is_there) {
    while (!is_there() && std::chrono::steady_clock::now() < deadline) {
      const MonoTime now = clock_.now().mono;
      if (now < due_) std::this_thread::sleep_for(std::min<Nanoseconds>(due_ - now, kTurn));
      if (clock_.now().mono >= due_) due_ = sensor_->poll(clock_, sink);
    }
  }

  SystemClock clock_;
  std::unique_ptr<Sensor> sensor_;
  MonoTime due_{};
};

}  // namespace yuragi::test
