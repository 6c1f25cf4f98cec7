#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulators/core/played_wind.hpp"
#include "simulators/core/simulator.hpp"
#include "simulators/text/text_wire.hpp"

namespace yuragi::simulators::text {

/// The messages of a simulated device. Pure: no socket, no file, no clock. Thread-safe: no.
class Device {
 public:
  virtual ~Device() = default;

  /// The faults that it can play itself; freeze and spike are played by MeasuredWind, faults of bytes by the simulator.
  virtual std::span<const core::FaultKind> known_faults() const = 0;

  /// Its messages about one moment, with their line ends.
  virtual std::vector<std::string> send_messages(const core::PlayedMoment& moment,
                                                 std::optional<core::FaultKind> fault) = 0;

  /// Returns the greeting for each new client, with its line end.
  virtual std::string greeting() const { return {}; }

  /// Returns true if a client gets only the greeting until it has sent something.
  virtual bool waits_for_clients() const { return false; }

  /// Takes a line that a client has sent, without its end.
  virtual void hear(std::string_view /*line*/) {}

  /// Returns true if this line, without its end, is a request to the device.
  virtual bool is_request(std::string_view line) const = 0;
};

/// A device that sends text over a wire: unasked, at a rate, or on request.
class Simulator final : public core::Simulator {
 public:
  /// `rate_hz`: how often it sends unasked; 0: only on request. `seed`: of the bytes of the garbage fault.
  Simulator(std::unique_ptr<Device> device, std::unique_ptr<Wire> wire, double rate_hz, core::MeasuredWind wind,
            std::uint64_t seed);

  const Wire& wire() const noexcept { return *wire_; }

  std::span<const core::FaultKind> known_faults() const override { return known_faults_; }
  std::vector<int> descriptors() const override { return wire_->descriptors(); }
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;

 private:
  void receive(std::string_view bytes, double time_s, std::optional<core::FaultKind> fault);
  void send_messages(double time_s, std::optional<core::FaultKind> fault);
  void send(const std::string& message, double time_s, std::optional<core::FaultKind> fault);
  void send_after(double delay_s, const std::string& bytes, double time_s);

  /// Bytes that wait for their moment.
  struct Waiting {
    double time_s;
    std::string bytes;
  };

  std::unique_ptr<Device> device_;
  std::unique_ptr<Wire> wire_;
  double rate_hz_;
  core::MeasuredWind wind_;
  std::mt19937_64 random_;
  std::vector<core::FaultKind> known_faults_;
  double next_s_ = 0.0;
  std::string request_;
  std::deque<Waiting> waiting_;
  core::PlayedMoment moment_;
  std::uint64_t sent_ = 0;
  std::optional<core::FaultKind> fault_;
};

}  // namespace yuragi::simulators::text
