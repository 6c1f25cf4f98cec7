#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>

#include "drivers/recording/recording_player.hpp"
#include "drivers/sensor/sensor.hpp"
#include "engine/base/spsc_ring.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::sensing {

/// The last change of a sensor's link, for a person.
struct LinkReport {
  wind::LinkState state = wind::LinkState::kConnecting;
  std::string detail;
};

/// A message to or from a device, as passed to sensor::Sink::raw(), and its time.
struct RawMessage {
  Instant time{};
  drivers::sensor::RawDirection direction = drivers::sensor::RawDirection::kReceived;
  std::uint32_t length = 0;  ///< of the whole message
  std::array<std::uint8_t, wire::kMaxRawBytes> bytes{};
  std::uint64_t lost = 0;  ///< messages dropped just before this one, for lack of room

  std::span<const std::uint8_t> kept() const {
    return std::span(bytes).first(std::min<std::size_t>(length, bytes.size()));
  }
};

/// On which thread a sensor is polled.
enum class SensorThread : std::uint8_t {
  kOwn,
  kOfCaller,  ///< in drain(), when it is due: for sensors that wait for nothing, in steps of a clock that the caller
              ///< moves
};

/// Runs one sensor on a thread of its own, since a device may block. Readings wait in a ring until the I/O thread takes
/// them, so that no device delays that thread.
///
/// Thread-safe: the public functions may be called from one other thread.
class SensorRunner final : private drivers::sensor::Sink {
 public:
  SensorRunner(std::unique_ptr<drivers::sensor::Sensor> sensor, const drivers::sensor::Clock& clock,
               SensorThread thread = SensorThread::kOwn);
  ~SensorRunner() override;  ///< ends the thread and waits for that, interrupting a poll that waits

  SensorRunner(const SensorRunner&) = delete;
  SensorRunner& operator=(const SensorRunner&) = delete;

  /// Polls the sensor on a thread of its own from now on, unless it does already.
  void begin_thread();

  /// Passes each reading that has arrived to `use`, oldest first.
  template <class Use>
  void drain(Use&& use) {
    if (thread_kind_ == SensorThread::kOfCaller && clock_.now().mono >= next_poll_) next_poll_ = poll();
    readings_.drain(use);
  }

  /// Passes what the station has reported besides the wind to `use`, oldest first.
  template <class Use>
  void drain_quantities(Use&& use) {
    quantities_.drain(use);
  }

  /// Starts or stops keeping the messages exchanged with the device for drain_trace(). Allocates the ring at the first
  /// start. While the ring is full, further messages are dropped and counted.
  void trace(bool wanted);

  /// Passes each message that was kept to `use`, oldest first.
  template <class Use>
  void drain_trace(Use&& use) {
    if (trace_) trace_->drain(use);
  }

  /// Ends the thread, without waiting for that.
  void end() noexcept;
  /// Returns true if the thread has ended; then the destructor does not wait.
  bool has_ended() const noexcept { return has_ended_.load(std::memory_order_acquire); }

  /// Polls the sensor at once, if it is waiting.
  void wake();

  /// The sensor's controls, if it plays a recording; nullptr otherwise. They live as long as the runner.
  drivers::recording::Player* player() noexcept { return dynamic_cast<drivers::recording::Player*>(sensor_.get()); }

  LinkReport link() const;
  /// The number of reports of the link: a cheap check whether link() has changed.
  std::uint64_t link_reports() const noexcept { return link_reports_.load(std::memory_order_acquire); }
  std::uint64_t refused_count(drivers::decode::Refusal why) const noexcept {
    return refused_[static_cast<std::size_t>(why)].load(std::memory_order_relaxed);
  }
  /// Messages from the device, used or refused.
  std::uint64_t frame_count() const noexcept { return frames_.load(std::memory_order_relaxed); }
  /// How often the device was reconnected after it had been lost.
  std::uint64_t reconnect_count() const noexcept { return reconnects_.load(std::memory_order_relaxed); }
  /// Readings dropped because the ring was full.
  std::uint64_t lost_count() const noexcept { return lost_.load(std::memory_order_relaxed); }
  /// Further quantities of a station dropped for the same reason.
  std::uint64_t lost_quantities_count() const noexcept { return lost_quantities_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t kRingCapacity = 1024;
  static constexpr std::size_t kQuantitiesCapacity = 256;
  static constexpr std::size_t kTraceCapacity = 256;

  void run(const std::stop_token& stop);
  MonoTime poll();
  void reading(const wind::Reading& reading) override;
  void quantities(const wind::StationQuantities& quantities) override;
  void refused(drivers::decode::Refusal why, std::uint64_t times = 1) override;
  void link(wind::LinkState state, std::string_view detail) override;
  void raw(drivers::sensor::RawDirection direction, std::span<const std::uint8_t> message) override;

  std::unique_ptr<drivers::sensor::Sensor> sensor_;
  const drivers::sensor::Clock& clock_;
  SensorThread thread_kind_;
  MonoTime next_poll_ = MonoTime::min();  ///< by the caller
  SpscRing<wind::Reading> readings_{kRingCapacity};
  SpscRing<wind::StationQuantities> quantities_{kQuantitiesCapacity};
  std::array<std::atomic<std::uint64_t>, drivers::decode::kRefusalCount> refused_{};
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::uint64_t> lost_quantities_{0};
  std::atomic<std::uint64_t> frames_{0};
  std::atomic<std::uint64_t> reconnects_{0};
  bool has_been_connected_ = false;  // of the sensor's thread

  std::unique_ptr<SpscRing<RawMessage>> trace_;  // allocated at the first trace(true), never replaced
  std::atomic<bool> is_trace_wanted_{false};
  std::uint64_t lost_of_trace_ = 0;  // of the sensor's thread: since the last message that was kept

  mutable std::mutex link_mutex_;  // for link_: seldom locked, and never by the animation
  LinkReport link_;
  std::atomic<std::uint64_t> link_reports_{0};

  std::atomic<bool> has_ended_{false};
  std::mutex sleep_mutex_;
  bool is_woken_ = false;
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace yuragi::daemon::sensing
