#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "drivers/sensor/sensor.hpp"
#include "tests/support/recording_sink.hpp"

namespace yuragi {

/// A sensor on a thread of its own and in real time, as the daemon runs it; the test looks at what it has said.
class RunningSensor final : private SensorSink {
 public:
  explicit RunningSensor(std::unique_ptr<Sensor> sensor)
      : sensor_(std::move(sensor)), thread_([this](const std::stop_token& stop) { run(stop); }) {}
  ~RunningSensor() override {
    thread_.request_stop();
    sensor_->interrupt();
  }
  RunningSensor(const RunningSensor&) = delete;
  RunningSensor& operator=(const RunningSensor&) = delete;

  /// Waits until `holds(sink)`; false if that takes longer than anything should.
  template <class Condition>
  bool wait_until(Condition&& holds, std::chrono::seconds at_most = std::chrono::seconds(30)) {
    std::unique_lock lock(mutex_);
    return said_.wait_for(lock, at_most, [&] { return holds(std::as_const(sink_)); });
  }
  /// What `use(sink)` returns, while the sensor holds still.
  template <class Use>
  auto look(Use&& use) {
    const std::lock_guard lock(mutex_);
    return use(std::as_const(sink_));
  }
  /// Forgets readings, refusals and messages; what the link was stays.
  void forget() {
    const std::lock_guard lock(mutex_);
    sink_.readings.clear();
    sink_.refusals.clear();
    sink_.raws.clear();
  }

 private:
  class SteadyClock final : public Clock {
    Instant now() const noexcept override {
      return {.mono = std::chrono::time_point_cast<Nanoseconds>(std::chrono::steady_clock::now()),
              .utc = std::chrono::time_point_cast<Nanoseconds>(std::chrono::system_clock::now())};
    }
  };

  void run(const std::stop_token& stop) {
    const SteadyClock owned;
    const Clock& clock = owned;
    while (!stop.stop_requested()) {
      const MonoTime next = sensor_->poll(clock, *this);
      std::unique_lock lock(sleep_mutex_);
      sleep_.wait_until(lock, stop, next, [] { return false; });
    }
  }

  template <class Change>
  void change(Change&& what) {
    {
      const std::lock_guard lock(mutex_);
      what(sink_);
    }
    said_.notify_all();
  }
  void reading(const WindReading& reading) override {
    change([&](RecordingSink& sink) { sink.reading(reading); });
  }
  void refused(Refusal why) override {
    change([&](RecordingSink& sink) { sink.refused(why); });
  }
  void link(LinkState state, std::string_view detail) override {
    change([&](RecordingSink& sink) { sink.link(state, detail); });
  }
  void raw(RawDirection direction, std::span<const std::uint8_t> message) override {
    change([&](RecordingSink& sink) { sink.raw(direction, message); });
  }

  std::unique_ptr<Sensor> sensor_;
  std::mutex mutex_;
  std::condition_variable said_;
  RecordingSink sink_;
  std::mutex sleep_mutex_;
  std::condition_variable_any sleep_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace yuragi
