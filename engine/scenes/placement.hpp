#pragma once

#include "engine/pose/skeleton.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi {

/// Turns a model that was laid out around the world's origin by its heading, clockwise seen from above, and moves it to
/// where it stands. No heading and no way change no bit. Thread-safe: different skeletons, yes. Realtime-safe: yes.
void place(const ScenePlacement& placement, StrandSkeleton& strands) noexcept;
void place(const ScenePlacement& placement, GridSkeleton& grid) noexcept;
void place(const ScenePlacement& placement, TreeSkeleton& tree) noexcept;
void place(const ScenePlacement& placement, SurfaceSkeleton& surface) noexcept;

}  // namespace yuragi
