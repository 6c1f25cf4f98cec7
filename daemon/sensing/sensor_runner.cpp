#include "daemon/sensing/sensor_runner.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "engine/base/contain.hpp"

namespace yuragi::daemon::sensing {
namespace {

/// How long a driver that threw is left alone.
constexpr Nanoseconds kPauseAfterException = std::chrono::seconds(10);

}  // namespace

SensorRunner::SensorRunner(std::unique_ptr<drivers::sensor::Sensor> sensor, const drivers::sensor::Clock& clock,
                           SensorThread thread)
    : sensor_(std::move(sensor)), clock_(clock), thread_kind_(thread) {
  if (thread == SensorThread::kOwn) begin_thread();
}

void SensorRunner::begin_thread() {
  if (thread_.joinable()) return;
  thread_kind_ = SensorThread::kOwn;
  thread_ = std::jthread([this](const std::stop_token& stop) { contain("a sensor's thread", [&] { run(stop); }); });
}

SensorRunner::~SensorRunner() {
  end();
  if (thread_.joinable()) thread_.join();
}

void SensorRunner::end() noexcept {
  thread_.request_stop();
  sensor_->interrupt();
}

void SensorRunner::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const MonoTime next = poll();
    std::unique_lock lock(sleep_mutex_);
    clock_.wait_until(next, lock, wake_, stop, [this] { return std::exchange(is_woken_, false); });
  }
  has_ended_.store(true, std::memory_order_release);
}

/// A driver never throws because of its device. If one throws all the same (memory, a defect), the others continue,
/// and the state of the sensor shows what happened.
MonoTime SensorRunner::poll() {
  std::optional<MonoTime> next;
  contain(
      "a sensor's driver", [&] { next = sensor_->poll(clock_, *this); },
      [this](const char* what) {
        link(wind::LinkState::kConnecting, std::string("its driver failed (") + what + "); it is tried again");
      });
  return next ? *next : clock_.now().mono + kPauseAfterException;
}

void SensorRunner::wake() {
  {
    const std::lock_guard lock(sleep_mutex_);
    is_woken_ = true;
  }
  wake_.notify_one();
}

void SensorRunner::reading(const wind::Reading& reading) {
  if (!wind::is_plausible(reading)) {
    refused(drivers::decode::Refusal::kImplausible);
  } else if (!readings_.push(reading)) {
    lost_.fetch_add(1, std::memory_order_relaxed);
  }
}

/// Values out of range are dropped silently: they do not concern the wind, whose faults are judged by refusals.
void SensorRunner::quantities(const wind::StationQuantities& quantities) {
  const auto plausible = wind::plausible_part(quantities);
  if (plausible && !quantities_.push(*plausible)) lost_quantities_.fetch_add(1, std::memory_order_relaxed);
}

void SensorRunner::refused(drivers::decode::Refusal why, std::uint64_t times) {
  refused_[static_cast<std::size_t>(why)].fetch_add(times, std::memory_order_relaxed);
}

void SensorRunner::link(wind::LinkState state, std::string_view detail) {
  const std::lock_guard lock(link_mutex_);
  const bool connects = state == wind::LinkState::kConnected && link_.state != wind::LinkState::kConnected;
  if (connects && has_been_connected_) reconnects_.fetch_add(1, std::memory_order_relaxed);
  has_been_connected_ = has_been_connected_ || connects;
  link_.state = state;
  link_.detail = detail;
  link_reports_.fetch_add(1, std::memory_order_release);
}

void SensorRunner::raw(drivers::sensor::RawDirection direction, std::span<const std::uint8_t> message) {
  if (direction == drivers::sensor::RawDirection::kReceived) frames_.fetch_add(1, std::memory_order_relaxed);
  if (!is_trace_wanted_.load(std::memory_order_acquire)) {
    lost_of_trace_ = 0;
    return;
  }
  RawMessage kept{.time = clock_.now(),
                  .direction = direction,
                  .length = static_cast<std::uint32_t>(message.size()),
                  .bytes = {},
                  .lost = lost_of_trace_};
  std::ranges::copy(message.first(kept.kept().size()), kept.bytes.begin());
  lost_of_trace_ = trace_->push(kept) ? 0 : lost_of_trace_ + 1;
}

void SensorRunner::trace(bool wanted) {
  if (wanted == is_trace_wanted_.load(std::memory_order_relaxed)) return;
  if (wanted && !trace_) trace_ = std::make_unique<SpscRing<RawMessage>>(kTraceCapacity);
  if (wanted) drain_trace([](const RawMessage&) {});  // discards the rest of an earlier trace
  is_trace_wanted_.store(wanted, std::memory_order_release);
}

LinkReport SensorRunner::link() const {
  const std::lock_guard lock(link_mutex_);
  return link_;
}

}  // namespace yuragi::daemon::sensing
