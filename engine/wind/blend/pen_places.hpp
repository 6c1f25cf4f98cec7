#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/wind/blend/blend_settings.hpp"

namespace yuragi::wind::blend {

/// The places where measured wind is written: one for all sensors without a configured position (the windward edge of
/// the scenes), and one for each configured position. Sensors closer together than half a metre share one; beyond
/// WindStroke::kMaxPens places further ones share the nearest. Relative sources are at the place of the first absolute
/// one. Allocates at construction only. Thread-safe: reading, yes.
class PenPlaces {
 public:
  explicit PenPlaces(std::span<const SourceSettings> sources);

  struct Place {
    bool is_edge = true;
    double east_m = 0.0, south_m = 0.0;  ///< from the middle of the scenes
    double lead_m = 0.0;                 ///< the pen is this far upwind of it
  };
  /// 0 if there are no sources.
  std::size_t count() const noexcept { return places_.size(); }
  const Place& place(std::size_t pen) const noexcept { return places_[pen]; }
  std::size_t pen_of(std::size_t source) const noexcept { return pens_[source]; }
  std::size_t sources_at(std::size_t pen) const noexcept {
    return static_cast<std::size_t>(std::ranges::count(pens_, pen));
  }

 private:
  std::size_t pen_for(const SourceSettings& source);

  std::vector<Place> places_;
  std::vector<std::size_t> pens_;  ///< of each source
};

}  // namespace yuragi::wind::blend
