#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "simulators/core/played_wind.hpp"
#include "simulators/core/simulator.hpp"

namespace yuragi::simulators::network {

/// The protocol in which a gateway pushes.
enum class PushProtocol : std::uint8_t {
  kEcowitt,       ///< POST, PASSKEY
  kWunderground,  ///< GET, ID and PASSWORD
  kAmbient,       ///< GET, PASSKEY
  kWsLink,        ///< GET, wsid and wspw; metres per second
};

struct EcowittPushOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 8090;
  PushProtocol protocol = PushProtocol::kEcowitt;
  std::string path;                                          ///< empty: the usual one of the protocol
  std::string station = "34271334ED1FADA6D8B988B14267E55D";  ///< PASSKEY, ID or wsid
  double interval_s = 16.0;
  std::uint64_t seed = 1;  ///< of the bytes of the garbage fault
};

/// A gateway of Fine Offset's with a wind sensor and a "customized" upload, which pushes its values by HTTP/1.1, a
/// connection for each.
///
/// Faults: silence, freeze, spike, garbage (bytes that are no HTTP), split, partial (the connection ends within the
/// request), wrong-id (another station's), disconnect (the connection is reset within the request), unplug (the
/// anemometer is not heard: -9999 by Wunderground, else no such values).
class EcowittPushSimulator final : public core::Simulator {
 public:
  /// Throws std::runtime_error for a host that is no numeric address.
  EcowittPushSimulator(const EcowittPushOptions& options, core::MeasuredWind wind);
  ~EcowittPushSimulator() override;

  std::span<const core::FaultKind> known_faults() const override;
  std::vector<int> descriptors() const override;
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;

  std::uint64_t pushed() const noexcept;            ///< how many pushes have been begun
  const std::string& last_answer() const noexcept;  ///< the first line of the last reply; empty: no reply yet

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace yuragi::simulators::network
