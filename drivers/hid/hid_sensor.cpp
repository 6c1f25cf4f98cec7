#include "drivers/hid/hid_sensor.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace yuragi::drivers::hid {
namespace {

constexpr Nanoseconds kLookAfterEvery = std::chrono::seconds(1);

}  // namespace

Sensor::Sensor(std::span<const StationKind> kinds, bus::HidPlace place, const StationTiming& timing, std::uint32_t seed,
               std::unique_ptr<bus::HidDevice> device)
    : sensor::ReopeningSensor(seed),
      kinds_(kinds),
      place_(std::move(place)),
      timing_(timing),
      device_(std::move(device)) {}

Result<MonoTime, Failure> Sensor::open(const sensor::Clock& clock) {
  std::vector<bus::HidId> ids;
  for (const StationKind& kind : kinds_) ids.push_back(kind.id);
  const Result<bus::HidInfo, Failure> opened = device_->open(ids, place_);
  if (!opened) return opened.error();
  const auto kind = std::ranges::find(kinds_, opened->id, &StationKind::id);
  station_ = kind->make(timing_);
  name_ = std::string(kind->title) + " at " + bus::where_is(*opened);
  next_step_ = clock.now().mono;
  return next_step_;
}

Result<MonoTime, Failure> Sensor::work(const sensor::Clock& clock, sensor::Sink& sink) {
  Exchange exchange(*device_, clock, sink);
  if (exchange.now() < next_step_) return look_after(exchange);

  const Result<StationStep, Failure> step = station_->step(exchange);
  if (is_interrupted_) return exchange.now();  // the step was interrupted: its result does not count
  if (!step)
    return Failure{name_ + " " + (step.error().message.empty() ? why_useless(exchange) : step.error().message)};
  if (step->health == StationHealth::kWell) report_connected(sink, name_);
  if (step->health == StationHealth::kUnwell) report_unusable(sink, name_ + " " + step->trouble);
  next_step_ = step->next;
  return std::min(next_step_, exchange.now() + kLookAfterEvery);
}

/// The reason why the device could not be used: gone, or not accepting reports.
std::string Sensor::why_useless(Exchange& exchange) {
  if (exchange.read(Nanoseconds::zero()).status == bus::HidStatus::kLost) return "is gone: plug it in again";
  exchange.refuse(decode::Refusal::kTimeout);
  return "does not accept requests: unplug its cable, remove its batteries, then connect both again";
}

/// Checks between two steps that the device is still present.
Result<MonoTime, Failure> Sensor::look_after(Exchange& exchange) {
  const Message message = exchange.read(Nanoseconds::zero());
  if (message.status == bus::HidStatus::kLost) return Failure{name_ + " is gone: plug it in again"};
  if (message.status == bus::HidStatus::kReport) exchange.refuse(decode::Refusal::kNotMine);
  return std::min(next_step_, exchange.now() + kLookAfterEvery);
}

void Sensor::interrupt() noexcept {
  is_interrupted_ = true;
  device_->interrupt();
}

void Sensor::close() noexcept {
  station_.reset();
  device_->close();
}

}  // namespace yuragi::drivers::hid
