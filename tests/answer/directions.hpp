#pragma once

#include <cstdint>

#include "tests/answer/figures.hpp"
#include "tests/answer/scene_table.hpp"

namespace yuragi::answer {

/// The largest angle between downwind and where the scene points, of eight directions of the wind: of short records,
/// the mean direction of the scene against that of the wind, both as vectors. Nothing of a light wind, in which a scene
/// may hang as it likes, and of a table that does not ask for it.
Figures turn_figures(const SceneTable& table, std::size_t beaufort_index, std::uint64_t seed);

}  // namespace yuragi::answer
