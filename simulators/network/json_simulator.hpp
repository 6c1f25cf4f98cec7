#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "simulators/core/played_wind.hpp"
#include "simulators/core/simulator.hpp"

namespace yuragi::simulators::network {

struct JsonOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 8080;  ///< 0: a free one
  std::string speed_at = "/wind/speed";
  std::string direction_at{};  ///< empty: none
  std::string gust_at{};       ///< empty: none
  std::string time_at{};       ///< empty: none
  std::string unit = "m/s";    ///< m/s, km/h, kn, mph or ft/s
  double interval_s = 1.0;     ///< from one observation to the next
  double late_s = 12.0;        ///< delay of a reply under the fault late
  std::uint64_t seed = 1;      ///< of the bytes of the fault garbage
};

/// A web server whose answer to every GET is the wind as JSON, by HTTP/1.1 (RFC 9112), with an ETag for each
/// observation (RFC 9110, 8.8.3): who knows it already gets status 304. Values stand where JSON pointers (RFC 6901)
/// name a place.
///
/// Faults: silence, freeze (the same observation, with its time), spike, garbage (bytes that are not HTTP), split,
/// partial (the connection ends within the reply), wrong-id (another server's web page), late, exception (HTTP 503),
/// disconnect, unplug (null for every value of the anemometer).
class JsonSimulator final : public core::Simulator {
 public:
  /// Throws std::runtime_error for a host that is no numeric address, a place that cannot be listened at, and pointers
  /// that cannot stand in one JSON text.
  JsonSimulator(const JsonOptions& options, core::MeasuredWind wind);
  ~JsonSimulator() override;

  std::uint16_t port() const;

  std::span<const core::FaultKind> known_faults() const override;
  std::vector<int> descriptors() const override;
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace yuragi::simulators::network
