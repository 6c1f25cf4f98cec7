#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "drivers/bus/hid_device.hpp"
#include "drivers/hid/hid_sensor.hpp"
#include "simulators/core/faults.hpp"
#include "simulators/usb/hid_stations.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"

namespace yuragi::test {

/// A simulated station in the wind, on a bus whose time a test moves: the station goes on and the host asks it for a
/// report, every 10 ms while somebody reads, otherwise every 50 ms. What the kernel does with reports is done here as
/// in Linux' hidraw.
class HidBus {
 public:
  HidBus(std::unique_ptr<simulators::usb::Device> device, drivers::bus::HidId id)
      : device_(std::move(device)), id_(id) {}

  ManualClock clock;
  /// The wind of each moment.
  std::function<simulators::core::PlayedMoment(double)> wind = [](double) {
    return simulators::core::PlayedMoment{8.6, 225.0};
  };
  /// What goes wrong at each moment; kUnplug pulls the plug.
  std::function<std::optional<simulators::core::FaultKind>(double)> fault = [](double) { return std::nullopt; };
  int opened = 0;
  bool is_interrupted = false;

  double now_s() const { return seconds(clock.now().mono - start_); }
  bool is_plugged_in() const { return is_plugged_in_; }
  simulators::usb::Device& device() { return *device_; }
  drivers::bus::HidId id() const { return id_; }

  /// Lets time pass; up to `until` if no report comes first and `stops_at_report`.
  void run_to(MonoTime until, bool stops_at_report = false) {
    const Nanoseconds step = std::chrono::milliseconds(stops_at_report ? 10 : 50);
    while (clock.now().mono < until) {
      clock.advance(std::min(step, until - clock.now().mono));
      go_on();
      if (stops_at_report && (!reports_.empty() || !is_plugged_in_)) return;
    }
  }

  /// The station's first moment, if nothing was before.
  void begin() {
    if (!measured_) go_on();
  }

  void open() {
    ++opened;
    is_open_ = true;
    reports_.clear();
  }
  void close() { is_open_ = false; }
  bool is_open() const { return is_open_ && is_plugged_in_; }

  std::optional<simulators::usb::Bytes> next_report() {
    if (reports_.empty()) return std::nullopt;
    simulators::usb::Bytes report = std::move(reports_.front());
    reports_.pop_front();
    return report;
  }

 private:
  void go_on() {
    const auto kind = fault(now_s());
    is_plugged_in_ = kind != simulators::core::FaultKind::kUnplug;
    // A wind that does not change, and one that leaps, are what the air in front of the sensor does.
    simulators::core::PlayedMoment moment = measured_.value_or(wind(now_s()));
    if (kind != simulators::core::FaultKind::kFreeze) moment = wind(now_s());
    measured_ = moment;
    if (kind == simulators::core::FaultKind::kSpike) moment.speed_m_s = 55.0;
    device_->advance(now_s(), moment, kind);
    if (!is_plugged_in_) {
      is_open_ = false;  // whoever had it open has nothing any more
      reports_.clear();
      return;
    }
    constexpr std::size_t kKernelKeeps = 63;
    if (!is_open_) return;
    if (auto report = device_->in(1, 64); report && reports_.size() < kKernelKeeps) reports_.push_back(*report);
  }

  std::unique_ptr<simulators::usb::Device> device_;
  drivers::bus::HidId id_;
  MonoTime start_ = clock.now().mono;
  bool is_plugged_in_ = true;
  bool is_open_ = false;
  std::deque<simulators::usb::Bytes> reports_;  ///< that the kernel keeps for whoever has it open
  std::optional<simulators::core::PlayedMoment> measured_;
};

/// The device on that bus, in place of hidapi's.
class BridgedHid final : public drivers::bus::HidDevice {
 public:
  explicit BridgedHid(HidBus& bus) : bus_(bus) {}

  Result<drivers::bus::HidInfo, Failure> open(std::span<const drivers::bus::HidId> ids,
                                              const drivers::bus::HidPlace&) override {
    if (!bus_.is_plugged_in() || std::ranges::find(ids, bus_.id()) == ids.end()) return Failure{"plug it in"};
    bus_.open();
    return drivers::bus::HidInfo{
        .id = bus_.id(), .node = "/dev/hidraw7", .port = "1-1.2", .serial = "", .interface = 0};
  }
  void close() noexcept override { bus_.close(); }

  drivers::bus::HidArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) override {
    if (bus_.is_interrupted) return {drivers::bus::HidStatus::kInterrupted};
    if (!bus_.is_open()) return {drivers::bus::HidStatus::kLost};
    auto report = bus_.next_report();
    if (!report) {
      bus_.run_to(bus_.clock.now().mono + timeout, true);
      if (!bus_.is_open()) return {drivers::bus::HidStatus::kLost};
      report = bus_.next_report();
    }
    if (!report) return {drivers::bus::HidStatus::kSilence};
    const std::size_t size = std::min(report->size(), buffer.size());
    std::copy_n(report->begin(), size, buffer.begin());
    return {drivers::bus::HidStatus::kReport, size};
  }

  bool write(std::span<const std::uint8_t> report) override {
    if (bus_.is_interrupted || !bus_.is_open() || report.empty() || report[0] != 0) return false;
    const auto bytes = report.subspan(1);
    // By the OUT end point, which the second end point of the configuration is, or else by SET_REPORT.
    const bool has_out_endpoint = bus_.device().descriptors().configuration[9 + 4] > 1;
    if (has_out_endpoint) return bus_.device().out(1, bytes);
    return bus_.device().control({0x21, 0x09, 0x0200, 0, static_cast<std::uint16_t>(bytes.size())}, bytes).has_value();
  }

  drivers::bus::HidArrival get_input_report(std::uint8_t id, std::span<std::uint8_t> buffer) override {
    if (bus_.is_interrupted) return {drivers::bus::HidStatus::kInterrupted};
    if (!bus_.is_open()) return {drivers::bus::HidStatus::kLost};
    const auto value = static_cast<std::uint16_t>(0x0100U | id);
    const auto report = bus_.device().control({0xA1, 0x01, value, 0, static_cast<std::uint16_t>(buffer.size())}, {});
    if (!report) return {drivers::bus::HidStatus::kSilence};
    std::ranges::copy(*report, buffer.begin());
    return {drivers::bus::HidStatus::kReport, report->size()};
  }

  void interrupt() noexcept override { bus_.is_interrupted = true; }

 private:
  HidBus& bus_;
};

/// The station's name in a configuration, of the name of its model ("fineoffset-wh3080").
inline const drivers::hid::StationKind& kind_of_model(std::string_view model) {
  const auto kinds = drivers::hid::station_kinds();
  return *std::ranges::find_if(kinds,
                               [model](const drivers::hid::StationKind& kind) { return model.starts_with(kind.name); });
}

/// A simulated station, and the driver that reads it.
class HidBench {
 public:
  explicit HidBench(std::string_view model, drivers::hid::StationTiming timing = {}, std::uint64_t seed = 1)
      : HidBench(simulators::usb::make_hid_station(model, timing.pace, seed), kind_of_model(model), timing) {}
  HidBench(std::unique_ptr<simulators::usb::Device> device, const drivers::hid::StationKind& kind,
           drivers::hid::StationTiming timing = {})
      : bus(std::move(device), kind.id),
        sensor(drivers::hid::station_kinds(), drivers::bus::HidPlace{}, timing, 1, std::make_unique<BridgedHid>(bus)) {}

  HidBus bus;
  RecordingSink sink;
  drivers::hid::Sensor sensor;
  int polls = 0;

  /// Polls the sensor whenever it wants to be, for a time.
  void run_for(double duration_s) {
    bus.begin();
    const MonoTime end = bus.clock.now().mono + from_seconds(duration_s);
    int polls_at_once = 0;
    while (bus.clock.now().mono < end) {
      const MonoTime before = bus.clock.now().mono;
      const MonoTime next = sensor.poll(bus.clock, sink);
      ++polls;
      bus.run_to(std::min(next, end));
      polls_at_once = bus.clock.now().mono == before ? polls_at_once + 1 : 0;
      ASSERT_LT(polls_at_once, 500) << "the driver spins";
    }
  }

  std::size_t readings() const { return sink.readings.size(); }
};

}  // namespace yuragi::test
