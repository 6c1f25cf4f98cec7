#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "engine/pose/skeleton.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi::scenes {

/// A body of flame consists of nested shells, with these parts of its width, from the outermost inward.
inline constexpr std::array<double, 3> kFlameShells = {1.0, 0.65, 0.35};

/// Parameters of a flame's body.
struct FlameBodySpec {
  bool is_panel = false;     ///< a flat upright panel with a picture of the flame, instead of its own shape
  std::size_t columns = 96;  ///< points across the panel; for a body, around all of its shells together
  std::size_t rows = 96;
  double height_m = 1.2;  ///< of the flame
  double width_m = 0.5;   ///< of its thickest part
  double foot_m = 0.0;    ///< how high over the ground its foot is
};

/// The surface of a flame, and its operators' data for each point or row.
///
/// A panel stands along the scene's east and faces its south, with the flame in its middle. A body is closed around its
/// axis, round, pointed at the foot and at the top, and thickest at a third of its height; its rows move. Rows go from
/// the foot up; columns from west to east, or around from the east by the south, shell by shell.
struct FlameBody {
  pose::SurfaceSkeleton surface;
  bool is_panel = false;
  std::vector<float> east_m, south_m, up_m;  ///< each point at rest, from the foot's middle, before placement
  std::vector<float> radius_m;               ///< distance of each point from the axis; empty for a panel
  std::vector<float> moved_m;                ///< the share of the noise that moves it: less near the foot
  std::vector<float> along;                  ///< for each row, from the foot (0) to the flame's top (1)
  double largest_radius_m = 0.0;
  double panel_east = 1.0, panel_south = 0.0;  ///< unit vector along the panel, in the world
};

/// Lays a flame out over the world's origin, and places it. Allocates; may throw std::bad_alloc.
/// Thread-safe: yes. Realtime-safe: no.
FlameBody make_flame_body(const FlameBodySpec& spec, const Placement& placement);

}  // namespace yuragi::scenes
