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

namespace yuragi::simulators::lufft {

/// The kind of device.
struct UmbStationOptions {
  unsigned device_class = 7;  ///< 7: a weather station, 8: a VENTUS
  unsigned id = 1;
  bool has_fast_channels = true;
  bool measures_more = true;        ///< it also measures temperature, humidity, pressure and rain
  bool refuses_long_query = false;  ///< queries of more than two channels
  bool echoes = false;              ///< the line has one pair of wires: clients receive their own requests
  std::uint64_t garbage_seed = 1;
};

/// A device of Lufft's in its binary UMB protocol, as the maker's manuals describe it (V200A-UMB manual V25, 20.3; WS
/// manual, 6.1 to 6.14): it replies to the commands 23h and 2Fh.
class UmbStation final : public core::Simulator {
 public:
  UmbStation(std::unique_ptr<text::Wire> wire, const UmbStationOptions& options, core::MeasuredWind wind);

  const text::Wire& wire() const noexcept { return *wire_; }

  std::span<const core::FaultKind> known_faults() const override { return known_faults_; }
  std::vector<int> descriptors() const override { return wire_->descriptors(); }
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;

 private:
  void take_requests(double time_s, std::optional<core::FaultKind> fault);
  std::string reply_to(std::string_view command, std::optional<core::FaultKind> fault);
  std::string channel(unsigned number) const;
  std::optional<double> measured(unsigned number) const;
  std::string frame(std::string_view text, std::string_view receiver, std::optional<core::FaultKind> fault) const;
  void send(std::string reply, double time_s, std::optional<core::FaultKind> fault);
  void send_after(double delay_s, const std::string& bytes, double time_s);

  /// Bytes that wait for their moment.
  struct Waiting {
    double time_s;
    std::string bytes;
  };

  std::unique_ptr<text::Wire> wire_;
  UmbStationOptions options_;
  core::MeasuredWind wind_;
  std::mt19937_64 random_;
  std::vector<core::FaultKind> known_faults_;
  std::string received_;
  std::deque<Waiting> waiting_;
  core::PlayedMoment moment_;
  std::uint64_t queries_ = 0;
  std::optional<core::FaultKind> fault_;
};

}  // namespace yuragi::simulators::lufft
