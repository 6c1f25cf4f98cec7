#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "simulators/core/played_wind.hpp"
#include "simulators/core/simulator.hpp"

namespace yuragi::simulators::network {

struct EcowittOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 45000;     ///< 0 takes a free one
  double interval_s = 16.0;       ///< of the anemometer's radio
  double late_s = 5.0;            ///< the delay of a late reply
  std::string search_host = {};   ///< where it replies to UDP searches for gateways; empty: nowhere
  std::uint16_t search_port = 0;  ///< 0 takes a free one; a real gateway's is 46000
  std::uint64_t seed = 1;         ///< of the bytes of the garbage fault
};

/// A gateway of Fine Offset's with a wind sensor, as the maker's "Data exchange TCP Protocol for GW1000" describes it:
/// it replies only to the request for its current values. It can be searched for.
///
/// Faults: silence, freeze, spike, garbage, split, partial, bad-checksum, wrong-transaction (the reply to another
/// command), late, disconnect, unplug (the anemometer is not heard).
class EcowittSimulator final : public core::Simulator {
 public:
  /// Throws std::runtime_error if the address cannot be listened on.
  EcowittSimulator(const EcowittOptions& options, core::MeasuredWind wind);
  ~EcowittSimulator() override;

  std::uint16_t port() const;
  std::uint16_t search_port() const;

  std::span<const core::FaultKind> known_faults() const override;
  std::vector<int> descriptors() const override;
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace yuragi::simulators::network
