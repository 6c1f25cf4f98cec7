#pragma once

#include <cstddef>
#include <vector>

#include "engine/pose/skeleton.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi {

/// What a flame's body is like.
struct FlameBodySpec {
  bool is_panel = false;  ///< a flat upright panel for a picture of the flame, and not its own shape
  std::size_t columns = 96;
  std::size_t rows = 96;
  double height_m = 1.2;      ///< of the flame
  double width_m = 0.5;       ///< of its thickest part
  double largest_lean = 1.0;  ///< its tangent: the panel is wide enough for it
};

/// The surface that a flame is shown on, and what its operators need to know of each point or row.
///
/// A panel stands along the scene's east and faces its south, with the flame in its middle. A body is closed around its
/// axis, round, pointed at the foot and at the top, and thickest at a third of its height. Rows go from the foot up;
/// columns from west to east, or around from the east by the south.
struct FlameBody {
  SurfaceSkeleton surface;
  bool is_panel = false;
  double around_m = 1.0;                ///< after how much of across_m the body closes; of a panel: its noise's period
  std::vector<float> across_m, up_m;    ///< of each point, along the surface: from the middle or around; from the foot
  std::vector<float> radius_m;          ///< of each point from the axis; of a panel none
  std::vector<float> along;             ///< of each row, from the foot (0) to the flame's top (1)
  std::vector<float> lever_m;           ///< of each row: how far a lean of tangent 1 moves it
  std::vector<float> per_half_width_m;  ///< of each row of a panel: 1 / half the flame's width there
  float per_height_m = 1.0F;            ///< 1 / the flame's height
  double largest_radius_m = 0.0;
  double largest_lever_m = 0.0;
  double panel_east = 1.0, panel_south = 0.0;  ///< unit vector along the panel, in the world
};

/// Lays a flame out on the ground around the world's origin, and places it. Allocates; may throw std::bad_alloc.
/// Thread-safe: yes. Realtime-safe: no.
FlameBody make_flame_body(const FlameBodySpec& spec, const ScenePlacement& placement);

}  // namespace yuragi
