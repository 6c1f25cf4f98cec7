#pragma once

#include <cstdint>
#include <memory>

#include "engine/base/simd_row.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi {

/// The scene "grass" (everybody else finds it in scene_table()).
extern const SceneDescription kGrassScene;

/// The same on a chosen SIMD row, which is_runnable(): for tests and benchmarks, which compare rows.
std::unique_ptr<Scene> make_grass(const ParameterValues& values, std::uint64_t seed, SimdRow row);

}  // namespace yuragi
