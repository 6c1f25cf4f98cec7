#include "simulators/core/wind_phases.hpp"

#include <algorithm>
#include <utility>

namespace yuragi::simulators::core {
namespace {

class PhasedWind final : public PlayedWind {
 public:
  explicit PhasedWind(const std::vector<WindPhase>& phases) {
    for (const WindPhase& phase : phases) {
      auto wind = phase.recording.empty() ? play_synthetic_wind(phase.synthetic) : play_recorded_wind(phase.recording);
      phases_.push_back({phase.start_s, phase.ramp_s, std::move(wind)});
    }
  }

  PlayedMoment at(double time_s) override {
    while (current_ + 1 < phases_.size() && phases_[current_ + 1].start_s <= time_s) ++current_;
    const Phase& phase = phases_[current_];
    const PlayedMoment moment = phase.at(time_s);
    const double passed_s = time_s - phase.start_s;
    if (current_ == 0 || passed_s >= phase.ramp_s) return moment;

    const PlayedMoment before = phases_[current_ - 1].at(time_s);
    const double passed = passed_s / phase.ramp_s;
    const double share = passed * passed * (3.0 - 2.0 * passed);
    const wind::Vector mixed = (1.0 - share) * wind::wind_from(before.speed_m_s, before.direction_deg) +
                               share * wind::wind_from(moment.speed_m_s, moment.direction_deg);
    return {speed_of(mixed), wind::direction_from_deg(mixed)};
  }

 private:
  struct Phase {
    double start_s;
    double ramp_s;
    std::unique_ptr<PlayedWind> wind;

    PlayedMoment at(double time_s) const { return wind->at(time_s - start_s); }
  };

  std::vector<Phase> phases_;
  std::size_t current_ = 0;
};

}  // namespace

std::unique_ptr<PlayedWind> play_phases(const std::vector<WindPhase>& phases) {
  return std::make_unique<PhasedWind>(phases);
}

}  // namespace yuragi::simulators::core
