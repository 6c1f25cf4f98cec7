#include "drivers/sensor/reopening_sensor.hpp"

#include <functional>

#include "engine/base/contain.hpp"

namespace yuragi::drivers::sensor {
namespace {

constexpr Nanoseconds kFirstWait = std::chrono::milliseconds(250);
constexpr Nanoseconds kMaxWait = std::chrono::seconds(10);

}  // namespace

ReopeningSensor::ReopeningSensor(std::uint32_t seed) : backoff_(kFirstWait, kMaxWait, seed) {}

MonoTime ReopeningSensor::poll(const Clock& clock, Sink& sink) {
  if (clock.now().mono < next_poll_) {
    if (is_open_ || !poll_for_return()) return next_poll_;
    backoff_.reset();
  }

  Result<MonoTime, Failure> next = Failure{};
  contain(
      "a sensor's driver", [&] { next = is_open_ ? work(clock, sink) : open(clock); },
      [&](const char* what) { next = Failure{std::string("its driver failed (") + what + "): reopening it"}; });
  if (next) {
    is_open_ = true;
    next_poll_ = *next;
    return next_poll_;
  }
  if (is_open_) close();
  is_open_ = false;
  report(sink, wind::LinkState::kConnecting, next.error().message);
  next_poll_ = clock.now().mono + backoff_.next();
  return next_poll_;
}

void ReopeningSensor::report_connected(Sink& sink, const std::string& detail) {
  backoff_.reset();
  report(sink, wind::LinkState::kConnected, detail);
}

void ReopeningSensor::report_unusable(Sink& sink, const std::string& detail) {
  report(sink, wind::LinkState::kConnecting, detail);
}

void ReopeningSensor::report_finished(Sink& sink, const std::string& detail) {
  report(sink, wind::LinkState::kFinished, detail);
}

void ReopeningSensor::report(Sink& sink, wind::LinkState state, const std::string& detail) {
  if (state == reported_state_ && detail == reported_detail_) return;
  reported_state_ = state;
  reported_detail_ = detail;
  sink.link(state, detail);
}

std::uint32_t seed_of(std::string_view name) noexcept {
  return static_cast<std::uint32_t>(std::hash<std::string_view>{}(name));
}

}  // namespace yuragi::drivers::sensor
