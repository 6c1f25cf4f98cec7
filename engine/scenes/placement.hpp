#pragma once

#include <span>

#include "engine/pose/skeleton.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi::scenes {

/// Turns directions (or places), given by their parts east and south, by the heading. Thread-safe and realtime-safe
/// like place().
void turn(const Placement& placement, std::span<float> x, std::span<float> z) noexcept;

/// Turns a model that was laid out around the world's origin by its heading, clockwise seen from above, and moves it to
/// its place. Zero heading and displacement change no bit. Thread-safe: different skeletons, yes. Realtime-safe: yes.
void place(const Placement& placement, pose::StrandSkeleton& strands) noexcept;
void place(const Placement& placement, pose::GridSkeleton& grid) noexcept;
void place(const Placement& placement, pose::TreeSkeleton& tree) noexcept;
void place(const Placement& placement, pose::SurfaceSkeleton& surface) noexcept;

}  // namespace yuragi::scenes
