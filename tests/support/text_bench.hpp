#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <poll.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/sensor/sensor.hpp"
#include "simulators/core/played_wind.hpp"
#include "simulators/core/simulator.hpp"
#include "simulators/text/text_wire.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/still_wind.hpp"

namespace yuragi {

/// The real port, whose waits the test shortens: its time is not the machine's.
class ImpatientPort final : public drivers::bus::BytePort {
 public:
  ImpatientPort(std::unique_ptr<drivers::bus::BytePort> port, const Nanoseconds& patience)
      : port_(std::move(port)), patience_(patience) {}

  Result<void, Failure> open() override { return port_->open(); }
  void close() noexcept override { port_->close(); }
  drivers::bus::ByteArrival read(std::span<std::uint8_t> buffer, Nanoseconds timeout) override {
    return port_->read(buffer, std::min(timeout, patience_));
  }
  bool write(std::span<const std::uint8_t> bytes) override { return port_->write(bytes); }
  void interrupt() noexcept override { port_->interrupt(); }

 private:
  std::unique_ptr<drivers::bus::BytePort> port_;
  const Nanoseconds& patience_;
};

/// The real wire, which tells when something is said.
class ObservedWire final : public simulators::text::Wire {
 public:
  ObservedWire(std::unique_ptr<simulators::text::Wire> wire, bool& has_written)
      : wire_(std::move(wire)), has_written_(has_written) {}

  std::span<const simulators::core::FaultKind> known_faults() const override { return wire_->known_faults(); }
  std::vector<int> descriptors() const override { return wire_->descriptors(); }
  std::string read(std::span<const int> ready) override { return wire_->read(ready); }
  void greet_with(const std::string& bytes) override { wire_->greet_with(bytes); }
  void wait_for_clients() override { wire_->wait_for_clients(); }
  void write(std::string_view bytes) override {
    has_written_ = true;
    wire_->write(bytes);
  }
  void refuse(bool is_wanted) override { wire_->refuse(is_wanted); }
  void take_away() override { wire_->take_away(); }
  void bring_back() override { wire_->bring_back(); }
  std::string place() const override { return wire_->place(); }

 private:
  std::unique_ptr<simulators::text::Wire> wire_;
  bool& has_written_;
};

/// A driver and a simulator with a real wire between them, in a time that the test makes: the seconds pass as fast as
/// the machine carries the bytes.
class TextBench {
 public:
  /// What stands between the two: a wire's faults are tried by its `know`.
  std::unique_ptr<simulators::text::Wire> observed(std::unique_ptr<simulators::text::Wire> wire) {
    return std::make_unique<ObservedWire>(std::move(wire), has_written_);
  }
  std::unique_ptr<drivers::bus::BytePort> port(const drivers::bus::BytePortAddress& address) {
    return impatient(drivers::bus::make_byte_port(address));
  }
  std::unique_ptr<drivers::bus::BytePort> impatient(std::unique_ptr<drivers::bus::BytePort> port) {
    return std::make_unique<ImpatientPort>(std::move(port), patience_);
  }

  void put(std::unique_ptr<simulators::core::Simulator> simulator, std::unique_ptr<drivers::sensor::Sensor> sensor) {
    simulator_ = std::move(simulator);
    sensor_ = std::move(sensor);
  }

  /// Lets both live for so long. The readings and refusals of before are forgotten.
  void run(double duration_s, std::optional<simulators::core::FaultKind> fault = {}) {
    sink.readings.clear();
    sink.refusals.clear();
    for (double end_s = time_s_ + duration_s; time_s_ < end_s;) step(fault);
  }
  /// Lets both live until something holds; false if it does not within `limit_s`.
  template <class Condition>
  bool run_until(double limit_s, std::optional<simulators::core::FaultKind> fault, Condition&& holds) {
    for (const double end_s = time_s_ + limit_s; time_s_ < end_s && !holds();) step(fault);
    return holds();
  }

  /// The sensor ends as with the daemon, and the simulator sees what it said last.
  void close_sensor() {
    sensor_->interrupt();
    sensor_.reset();
    serve({});
  }

  ManualClock clock;
  RecordingSink sink;

 private:
  static constexpr double kStep_s = 0.02;

  void step(std::optional<simulators::core::FaultKind> fault) {
    time_s_ += kStep_s;
    clock.advance(from_seconds(kStep_s));

    has_written_ = false;
    serve(fault);

    // What was said is on its way, and arrives in this step also on a machine that has other things to do.
    patience_ = has_written_ ? std::chrono::milliseconds(100) : std::chrono::microseconds(200);
    sensor_->poll(clock, sink);
    patience_ = std::chrono::microseconds(200);
    sensor_->poll(clock, sink);
  }

  void serve(std::optional<simulators::core::FaultKind> fault) {
    std::vector<pollfd> waits;
    for (const int descriptor : simulator_->descriptors()) waits.push_back({descriptor, POLLIN, 0});
    poll(waits.data(), waits.size(), 0);
    std::vector<int> ready;
    for (const pollfd& wait : waits) {
      if (wait.revents != 0) ready.push_back(wait.fd);
    }
    simulator_->serve(ready, time_s_, fault);
  }

  std::unique_ptr<simulators::core::Simulator> simulator_;
  std::unique_ptr<drivers::sensor::Sensor> sensor_;
  Nanoseconds patience_ = std::chrono::milliseconds(1);
  bool has_written_ = false;
  double time_s_ = 0.0;
};

}  // namespace yuragi
