#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "engine/pose/skeleton.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi::scenes {

/// A body of flame is nested shells, of these parts of its width, from the outermost inward.
inline constexpr std::array<double, 3> kFlameShells = {1.0, 0.65, 0.35};

/// Parameters of a flame's body.
struct FlameBodySpec {
  bool is_panel = false;     ///< a flat upright panel for a picture of the flame, and not its own shape
  std::size_t columns = 96;  ///< points across the panel; of a body, around all of its shells together
  std::size_t rows = 96;
  double height_m = 1.2;  ///< of the flame
  double width_m = 0.5;   ///< of its thickest part
  double foot_m = 0.0;    ///< how high over the ground its foot is
};

/// The surface that a flame is shown on, and its operators' data for each point or row.
///
/// A panel stands along the scene's east and faces its south, with the flame in its middle. A body is closed around its
/// axis, round, pointed at the foot and at the top, and thickest at a third of its height; its rows move. Rows go from
/// the foot up; columns from west to east, or around from the east by the south, shell by shell.
struct FlameBody {
  pose::SurfaceSkeleton surface;
  bool is_panel = false;
  std::vector<float> east_m, south_m, up_m;  ///< of each point at rest, from the foot's middle, before it is placed
  std::vector<float> radius_m;               ///< of each point from the axis; of a panel none
  std::vector<float> moved_m;                ///< how much of it the noise moves: less near the foot
  std::vector<float> along;                  ///< of each row, from the foot (0) to the flame's top (1)
  double largest_radius_m = 0.0;
  double panel_east = 1.0, panel_south = 0.0;  ///< unit vector along the panel, in the world
};

/// Lays a flame out over the world's origin, and places it. Allocates; may throw std::bad_alloc.
/// Thread-safe: yes. Realtime-safe: no.
FlameBody make_flame_body(const FlameBodySpec& spec, const Placement& placement);

}  // namespace yuragi::scenes
