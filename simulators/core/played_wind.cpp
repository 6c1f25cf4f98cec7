#include "simulators/core/played_wind.hpp"

#include <utility>

#include "drivers/windlog/windlog_playback.hpp"

namespace yuragi::simulators::core {
namespace {

constexpr double kSpike_m_s = 55.0;

class SyntheticPlayedWind final : public PlayedWind {
 public:
  explicit SyntheticPlayedWind(const wind::turbulence::SyntheticWindSettings& settings) : wind_(settings) {}

  PlayedMoment at(double time_s) override {
    const wind::Vector wind = wind_.at(time_s);
    return {speed_of(wind), wind::direction_from_deg(wind)};
  }

 private:
  wind::turbulence::SyntheticWind wind_;
};

class RecordedPlayedWind final : public PlayedWind {
 public:
  explicit RecordedPlayedWind(drivers::windlog::Playback playback)
      : playback_(std::move(playback)), next_(playback_.next().value()) {}

  PlayedMoment at(double time_s) override {
    while (next_ && next_->log_time_s <= time_s) {
      const wind::Reading& reading = next_->reading;
      moment_ = {reading.speed_m_s, reading.direction_deg.value_or(moment_.direction_deg)};
      next_ = playback_.next().value();
    }
    return moment_;
  }

 private:
  drivers::windlog::Playback playback_;
  std::optional<drivers::windlog::PlayedReading> next_;
  PlayedMoment moment_;
};

}  // namespace

std::unique_ptr<PlayedWind> play_synthetic_wind(const wind::turbulence::SyntheticWindSettings& settings) {
  return std::make_unique<SyntheticPlayedWind>(settings);
}

std::unique_ptr<PlayedWind> play_recorded_wind(const std::string& file) {
  return std::make_unique<RecordedPlayedWind>(
      drivers::windlog::Playback::open(file, {.start = "", .loop = true, .sensor = ""}).value());
}

PlayedMoment MeasuredWind::at(double time_s, std::optional<FaultKind> fault) {
  PlayedMoment moment = wind_->at(time_s);
  if (fault == FaultKind::kFreeze) return last_;
  last_ = moment;
  if (fault == FaultKind::kSpike) moment.speed_m_s = kSpike_m_s;
  return moment;
}

}  // namespace yuragi::simulators::core
