#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <iterator>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/sensing/system_clock.hpp"
#include "drivers/sensor/sensor.hpp"
#include "tests/support/recording_sink.hpp"

namespace yuragi {

/// A sensor on a thread of its own and in real time, as the daemon runs it; the test looks at what it has said.
class RunningSensor final : private drivers::sensor::Sink {
 public:
  explicit RunningSensor(std::unique_ptr<drivers::sensor::Sensor> sensor)
      : sensor_(std::move(sensor)), thread_([this](const std::stop_token& stop) { run(stop); }) {}
  ~RunningSensor() override { end(); }
  RunningSensor(const RunningSensor&) = delete;
  RunningSensor& operator=(const RunningSensor&) = delete;

  /// So long waits only who waits for something that hangs.
  static constexpr std::chrono::seconds kHang{60};

  /// Waits until `holds(sink)`; false if it hangs, or does not within a shorter time.
  template <class Condition>
  bool wait_until(Condition&& holds, Nanoseconds at_most = kHang) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, at_most, [&] { return holds(std::as_const(sink_)); });
  }
  /// Moves what it said in whole polls into the test's own sink, until `holds()`; false as above.
  template <class Condition>
  bool take_until(RecordingSink& taken, Condition&& holds, Nanoseconds at_most = kHang) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, at_most, [&] {
      for (const wind::Reading& reading : take(sink_.readings, whole_.readings)) taken.reading(reading);
      for (const drivers::decode::Refusal why : take(sink_.refusals, whole_.refusals)) taken.refused(why);
      for (const auto& link : take(sink_.links, whole_.links)) taken.link(link.state, link.detail);
      for (const auto& raw : take(sink_.raws, whole_.raws)) taken.raw(raw.direction, raw.message);
      return holds();
    });
  }
  /// What `use(sink)` returns, while the sensor holds still.
  template <class Use>
  auto look(Use&& use) {
    const std::lock_guard lock(mutex_);
    return use(std::as_const(sink_));
  }
  /// Ends it as the daemon does: what it waits for is interrupted, and it is polled once more.
  void end() {
    if (!thread_.joinable()) return;
    thread_.request_stop();
    sensor_->interrupt();
    thread_.join();
    poll();
  }
  /// Forgets readings, refusals and messages; what the link was stays.
  void forget() {
    const std::lock_guard lock(mutex_);
    sink_.readings.clear();
    sink_.refusals.clear();
    sink_.raws.clear();
    whole_ = {.links = sink_.links.size()};
  }

 private:
  /// How much of what is in the sink was said in polls that are over.
  struct Whole {
    std::size_t readings = 0;
    std::size_t refusals = 0;
    std::size_t links = 0;
    std::size_t raws = 0;
  };

  /// The first `count` of these, which are no longer there then.
  template <class Value>
  static std::vector<Value> take(std::vector<Value>& values, std::size_t& count) {
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(std::exchange(count, 0));
    std::vector<Value> taken(std::make_move_iterator(values.begin()), std::make_move_iterator(end));
    values.erase(values.begin(), end);
    return taken;
  }

  MonoTime poll() {
    const MonoTime next = sensor_->poll(clock_, *this);
    change([this](const RecordingSink& sink) {
      whole_ = {sink.readings.size(), sink.refusals.size(), sink.links.size(), sink.raws.size()};
    });
    return next;
  }

  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const MonoTime next = poll();
      std::unique_lock lock(sleep_mutex_);
      clock_.wait_until(next, lock, sleep_, stop, [] { return false; });
    }
  }

  template <class Change>
  void change(Change&& what) {
    {
      const std::lock_guard lock(mutex_);
      what(sink_);
    }
    changed_.notify_all();
  }
  void reading(const wind::Reading& reading) override {
    change([&](RecordingSink& sink) { sink.reading(reading); });
  }
  void quantities(const wind::StationQuantities& quantities) override {
    change([&](RecordingSink& sink) { sink.quantities(quantities); });
  }
  void refused(drivers::decode::Refusal why, std::uint64_t times) override {
    change([&](RecordingSink& sink) { sink.refused(why, times); });
  }
  void link(wind::LinkState state, std::string_view detail) override {
    change([&](RecordingSink& sink) { sink.link(state, detail); });
  }
  void raw(drivers::sensor::RawDirection direction, std::span<const std::uint8_t> message) override {
    change([&](RecordingSink& sink) { sink.raw(direction, message); });
  }

  const daemon::sensing::SystemClock clock_;
  std::unique_ptr<drivers::sensor::Sensor> sensor_;
  std::mutex mutex_;
  std::condition_variable changed_;
  RecordingSink sink_;
  Whole whole_;
  std::mutex sleep_mutex_;
  std::condition_variable_any sleep_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace yuragi
