#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulators/core/played_wind.hpp"
#include "simulators/core/simulator.hpp"

namespace yuragi::simulators::network {

struct TempestOptions {
  std::string host = "127.0.0.1";  ///< the destination: an address, or a broadcast address
  std::uint16_t port = 50222;
  std::string hub = "HB-00013030";
  std::vector<std::string> stations = {"ST-00000512"};  ///< all stations are in the same wind
  double rapid_wind_interval_s = 3.0;                   ///< 0: none, as with an empty battery
  double report_interval_s = 60.0;
  std::uint64_t seed = 1;  ///< of the bytes of the garbage fault
};

/// A hub of WeatherFlow's and its stations (Tempest), as the maker's "Tempest UDP Reference", v171, describes what they
/// send. The hub's clock begins at 1 700 000 000 s.
///
/// Faults: silence (the hub is off), freeze, spike, garbage, partial (the ends of messages are missing), wrong-id (the
/// messages of other stations), unplug (the stations are off: only the hub sends).
class TempestSimulator final : public core::Simulator {
 public:
  /// Throws std::runtime_error for a host that is no address.
  TempestSimulator(const TempestOptions& options, core::MeasuredWind wind);
  ~TempestSimulator() override;

  std::span<const core::FaultKind> known_faults() const override;
  std::vector<int> descriptors() const override { return {}; }
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;
  /// Datagrams so far.
  std::uint64_t sent() const noexcept;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace yuragi::simulators::network
