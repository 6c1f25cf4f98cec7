#include "engine/wind/blend/pen_places.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/portable.hpp"
#include "engine/wind/ground/wind_stroke.hpp"

namespace yuragi::wind::blend {

PenPlaces::PenPlaces(std::span<const SourceSettings> sources) : pens_(sources.size()) {
  const bool has_absolute = std::ranges::any_of(sources, [](const auto& source) { return !source.is_relative; });
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (!has_absolute || !sources[i].is_relative) pens_[i] = pen_for(sources[i]);
  }
}

std::size_t PenPlaces::pen_for(const SourceSettings& source) {
  constexpr double kSamePlace_m = 0.5;
  const auto distance_m = [&source](const Place& place) {
    return place.is_edge ? 0.0 : math::length(place.east_m - source.east_m, place.south_m - source.south_m);
  };
  const auto is_same = [&](const Place& place) {
    return source.has_place ? !place.is_edge && distance_m(place) < kSamePlace_m : place.is_edge;
  };
  const auto same = std::ranges::find_if(places_, is_same);
  if (same != places_.end()) return static_cast<std::size_t>(same - places_.begin());
  if (places_.size() == ground::WindStroke::kMaxPens) {
    return static_cast<std::size_t>(std::ranges::min_element(places_, {}, distance_m) - places_.begin());
  }
  places_.push_back(
      source.has_place
          ? Place{.is_edge = false, .east_m = source.east_m, .south_m = source.south_m, .lead_m = source.lead_m}
          : Place{});
  return places_.size() - 1;
}

}  // namespace yuragi::wind::blend
