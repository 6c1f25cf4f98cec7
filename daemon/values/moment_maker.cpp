#include "daemon/values/moment_maker.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/base/simd_row.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::values {
namespace {

/// Is it the same at all places?
bool is_of_all_places(Quantity quantity) {
  return quantity == Quantity::kLive || quantity == Quantity::kAge;
}

/// Does it depend on the wind before this tick?
bool needs_the_past(Quantity quantity) {
  return quantity == Quantity::kDirection || quantity == Quantity::kMean || quantity == Quantity::kGust ||
         quantity == Quantity::kPeak || quantity == Quantity::kGustNorm;
}

/// One of the others.
double present_value(Quantity quantity, wind::Vector wind, const NormScale& scale) {
  switch (quantity) {
    case Quantity::kU:
      return wind.u_m_s;
    case Quantity::kV:
      return wind.v_m_s;
    case Quantity::kNorm:
      return scale.norm_of(wind::speed_of(wind));
    default:
      return wind::speed_of(wind);
  }
}

}  // namespace

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

MomentMaker::Pixels MomentMaker::make_pixels(const Grid& grid) const {
  constexpr double kFinest_m = 0.5;
  std::vector<float> east_m, south_m;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Grid::Point point = grid.at(i);
    east_m.push_back(static_cast<float>(point.east_m));
    south_m.push_back(static_cast<float>(point.south_m));
  }
  return {.grid = grid,
          .wind = std::make_unique<scenes::WindGrid>(gusts_, east_m, south_m, best_simd_row(),
                                                     std::max(kFinest_m, grid.spacing_m), grid.columns),
          .east_m_s = std::vector<float>(grid.size()),
          .south_m_s = std::vector<float>(grid.size()),
          .meters = std::vector<Meter>(needs_the_past(grid.quantity) ? grid.size() : 0)};
}

void MomentMaker::set_grids(std::span<const Grid> grids) {
  std::vector<Pixels> next;
  for (const Grid& grid : grids) {
    const auto before = std::ranges::find(grids_, grid, &Pixels::grid);
    if (before != grids_.end()) {
      next.push_back(std::move(*before));
      continue;
    }
    next.push_back(make_pixels(grid));
  }
  grids_ = std::move(next);
  Names names = *names_;
  names.grids.assign(grids.begin(), grids.end());
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
  moment->openness = tick.openness;
  if (places_.empty() && grids_.empty()) return moment;
  wind::ground::Wind shaped = wind::ground::written_to(shaped_.tapes, tick.shaped);
  shaped.tick = moment->tick;
  moment->shaped_places = read_places(shaped_, shaped, tick.shaped.state, tick.dt_s, tick.shaped_scale);
  moment->grids.reserve(grids_.size());
  for (Pixels& pixels : grids_) moment->grids.push_back(read_grid(pixels, shaped, moment->shaped, tick));
  if (!with_real_) return moment;
  const wind::ground::Wind real = wind::ground::written_to(real_.tapes, tick.real);
  moment->real_places = read_places(real_, real, tick.real.state, tick.dt_s, tick.real_scale);
  return moment;
}

std::vector<Readout> MomentMaker::read_places(Side& side, const wind::ground::Wind& ground, const wind::State& state,
                                              double dt_s, const NormScale& scale) const {
  std::vector<Readout> readouts;
  readouts.reserve(places_.size());
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const wind::Vector at_place = ground.at(*gusts_, places_[i].east_m, places_[i].south_m);
    side.places[i].add(at_place, state.live_weight, state.reading_age_s, dt_s, scale);
    readouts.push_back(side.places[i].readout());
  }
  return readouts;
}

std::vector<double> MomentMaker::read_grid(Pixels& pixels, const wind::ground::Wind& ground, const Readout& middle,
                                           const Tick& tick) {
  const wind::State& state = tick.shaped.state;
  const Quantity quantity = pixels.grid.quantity;
  if (is_of_all_places(quantity)) return std::vector<double>(pixels.grid.size(), middle[quantity]);
  pixels.wind->step(ground, tick.dt_s);
  pixels.wind->sample(0, pixels.east_m_s, pixels.south_m_s);
  std::vector<double> values;
  values.reserve(pixels.grid.size());
  for (std::size_t i = 0; i < pixels.grid.size(); ++i) {
    const wind::Vector wind{static_cast<double>(pixels.east_m_s[i]), -static_cast<double>(pixels.south_m_s[i])};
    if (pixels.meters.empty()) {
      values.push_back(present_value(quantity, wind, tick.shaped_scale));
      continue;
    }
    pixels.meters[i].add(wind, state.live_weight, state.reading_age_s, tick.dt_s, tick.shaped_scale);
    values.push_back(pixels.meters[i].readout()[quantity]);
  }
  return values;
}

}  // namespace yuragi::daemon::values
