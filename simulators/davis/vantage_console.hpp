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

namespace yuragi::simulators::davis {

/// The kind of console.
struct VantageConsoleOptions {
  double interval_s = 2.5;         ///< from packet to packet
  bool knows_lps = true;           ///< firmware 1.90 or later
  std::uint8_t setup_bits = 0x10;  ///< the rain collector is in bits 4 and 5: 0: 0.01 inch, 1: 0.2 mm, 2: 0.1 mm
  std::uint64_t garbage_seed = 1;
};

/// The console of a Davis station with its data logger, as the maker's manual describes it ("Vantage Pro, Vantage Pro2
/// and Vantage Vue Serial Communication Reference Manual", 2.6.1): asleep until it is woken, and again after two
/// minutes without a command. It knows the commands LOOP, LPS, EEBRD of the setup bits, and TEST.
class VantageConsole final : public core::Simulator {
 public:
  VantageConsole(std::unique_ptr<text::Wire> wire, const VantageConsoleOptions& options, core::MeasuredWind wind);

  const text::Wire& wire() const noexcept { return *wire_; }
  /// Returns how many of the requested packets are not yet sent; 0 when none are being sent.
  int packets_left() const noexcept { return packets_left_; }

  std::span<const core::FaultKind> known_faults() const override { return known_faults_; }
  std::vector<int> descriptors() const override { return wire_->descriptors(); }
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;

 private:
  void receive(std::string_view bytes, double time_s, std::optional<core::FaultKind> fault);
  void obey(const std::string& command, double time_s, std::optional<core::FaultKind> fault);
  bool begin_packets(const std::string& command, double time_s);
  void send_packet(double time_s, std::optional<core::FaultKind> fault);
  std::string packet(bool is_loop2) const;
  void reply(const std::string& bytes, double time_s, std::optional<core::FaultKind> fault);
  void send_after(double delay_s, const std::string& bytes, double time_s);

  /// Bytes that wait for their moment.
  struct Waiting {
    double time_s;
    std::string bytes;
  };

  std::unique_ptr<text::Wire> wire_;
  VantageConsoleOptions options_;
  core::MeasuredWind wind_;
  std::mt19937_64 random_;
  std::vector<core::FaultKind> known_faults_;
  std::string command_;
  std::deque<Waiting> waiting_;
  bool is_awake_ = false;
  double last_command_s_ = 0.0;
  int packets_left_ = 0;
  unsigned packet_kinds_ = 1;  // bit 0: LOOP, bit 1: LOOP2; both: in turn
  bool is_loop2_next_ = false;
  double next_packet_s_ = 0.0;
  core::PlayedMoment moment_;
  std::uint64_t sent_ = 0;
  std::optional<core::FaultKind> fault_;
};

}  // namespace yuragi::simulators::davis
