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

struct WeatherLinkLiveOptions {
  double interval_s = 2.5;               ///< from broadcast to broadcast
  std::uint16_t broadcast_port = 22222;  ///< the port that it reports for them
  std::uint64_t garbage_seed = 1;
};

/// A WeatherLink Live with one station, transmitter 1, as the maker's "WeatherLink Live Local API" describes it: a
/// server of HTTP, which returns current conditions and starts broadcasts on request; these end by themselves.
class WeatherLinkLive final : public core::Simulator {
 public:
  WeatherLinkLive(std::unique_ptr<text::Wire> http, std::unique_ptr<text::Wire> broadcasts,
                  const WeatherLinkLiveOptions& options, core::MeasuredWind wind);

  const text::Wire& http() const noexcept { return *http_; }
  /// The number of requests for broadcasts.
  int broadcast_requests() const noexcept { return broadcast_requests_; }
  /// The time after the start at which its broadcasts end.
  double broadcasts_until_s() const noexcept { return broadcasts_until_s_; }

  std::span<const core::FaultKind> known_faults() const override { return known_faults_; }
  std::vector<int> descriptors() const override { return http_->descriptors(); }
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;

 private:
  void obey(std::string_view request, double time_s, std::optional<core::FaultKind> fault);
  void broadcast(double time_s, std::optional<core::FaultKind> fault);
  std::string conditions(bool is_broadcast) const;
  void reply(int status, const std::string& body, double time_s, std::optional<core::FaultKind> fault);
  std::string garbage();

  /// Bytes that wait for their moment.
  struct Waiting {
    double time_s;
    std::string bytes;
  };

  std::unique_ptr<text::Wire> http_;
  std::unique_ptr<text::Wire> broadcasts_;
  WeatherLinkLiveOptions options_;
  core::MeasuredWind wind_;
  std::mt19937_64 random_;
  std::vector<core::FaultKind> known_faults_;
  std::string received_;
  std::deque<Waiting> waiting_;
  double broadcasts_until_s_ = 0.0;
  double next_broadcast_s_ = 0.0;
  int broadcast_requests_ = 0;
  core::PlayedMoment moment_;
  std::uint64_t sent_ = 0;
  std::optional<core::FaultKind> fault_;
};

}  // namespace yuragi::simulators::davis
