#include "daemon/values/moment_maker.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace yuragi::daemon::values {

MomentMaker::MomentMaker(std::shared_ptr<const wind::turbulence::GustNoise> gusts) : gusts_(std::move(gusts)) {}

void MomentMaker::rename(const Names& names) {
  if (names != *names_) names_ = std::make_shared<const Names>(names);
}

void MomentMaker::set_places(std::span<const Place> places, bool with_real) {
  for (Side* const side : {&shaped_, &real_}) {
    std::vector<Meter> meters(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto before = std::ranges::find(places_, places[i]);
      const auto index = static_cast<std::size_t>(before - places_.begin());
      if (index < side->places.size()) meters[i] = side->places[index];
    }
    side->places = std::move(meters);
  }
  places_.assign(places.begin(), places.end());
  with_real_ = with_real;
  Names names = *names_;
  names.places.clear();
  for (const Place& place : places_) names.places.push_back(place.name);
  rename(names);
}

void MomentMaker::set_sensors(std::vector<std::string> names) {
  Names all = *names_;
  all.sensors = std::move(names);
  rename(all);
}

void MomentMaker::set_scenes(std::vector<std::string> names) {
  Names all = *names_;
  all.scenes = std::move(names);
  rename(all);
}

void MomentMaker::set_health(Health health) {
  if (health != *health_) health_ = std::make_shared<const Health>(std::move(health));
}

std::shared_ptr<const Moment> MomentMaker::make(const Tick& tick, std::vector<SensorValue> sensors,
                                                std::vector<double> opacities) {
  const auto measure = [&tick](Side& side, const wind::State& state, const NormScale& scale) {
    side.middle.add(state.wind, state.live_weight, state.reading_age_s, tick.dt_s, scale);
    return side.middle.readout();
  };
  auto moment = std::make_shared<Moment>();
  time_s_ += tick.dt_s;
  moment->tick = tick_++;
  moment->time_s = time_s_;
  moment->mono = tick.time.mono;
  moment->utc = tick.time.utc;
  moment->source = tick.real.state.source;
  moment->shaped = measure(shaped_, tick.shaped.state, tick.shaped_scale);
  moment->real = measure(real_, tick.real.state, tick.real_scale);
  moment->names = names_;
  moment->health = health_;
  moment->sensors = std::move(sensors);
  moment->opacities = std::move(opacities);
  if (places_.empty()) return moment;
  moment->shaped_places = read_places(shaped_, tick.shaped, tick.dt_s, tick.shaped_scale);
  if (with_real_) moment->real_places = read_places(real_, tick.real, tick.dt_s, tick.real_scale);
  return moment;
}

std::vector<Readout> MomentMaker::read_places(Side& side, const wind::ground::DrivingWind& wind, double dt_s,
                                              const NormScale& scale) const {
  const wind::ground::Wind ground = wind::ground::written_to(side.tapes, wind);
  std::vector<Readout> readouts;
  readouts.reserve(places_.size());
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const wind::Vector at_place = ground.at(*gusts_, places_[i].east_m, places_[i].south_m);
    side.places[i].add(at_place, wind.state.live_weight, wind.state.reading_age_s, dt_s, scale);
    readouts.push_back(side.places[i].readout());
  }
  return readouts;
}

}  // namespace yuragi::daemon::values
