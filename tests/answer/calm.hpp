#pragma once

#include <cstdint>

#include "tests/answer/figures.hpp"
#include "tests/answer/scene_table.hpp"

namespace yuragi::answer {

/// How many numbers of the pose differ from the rest pose after two seconds of calm from the start. Nothing of what
/// burns, which is not still.
Figures calm_figures(const SceneTable& table, std::uint64_t seed);

}  // namespace yuragi::answer
