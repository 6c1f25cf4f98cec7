#pragma once

#include <pose_generated.h>

#include "engine/wind/wind_state.hpp"

// For the .cpp files of this folder only: what flatc makes of pose.fbs.

namespace yuragi::wire {

namespace fb = yuragi::stream;

inline fb::Wind to_schema(const wind::WindState& state) {
  return fb::Wind(static_cast<float>(state.wind.u_m_s), static_cast<float>(state.wind.v_m_s),
                  static_cast<float>(state.live_weight), static_cast<float>(state.reading_age_s),
                  static_cast<fb::WindSource>(state.source));
}

inline fb::WindPlace place_to_schema(const wind::WindState& state) {
  return fb::WindPlace(static_cast<float>(state.upwind_m), static_cast<float>(state.to_middle_s),
                       state.is_place_configured);
}

}  // namespace yuragi::wire
