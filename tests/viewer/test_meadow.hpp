#pragma once

#include "engine/wire/wire.hpp"
#include "tests/viewer/stream_server.hpp"

namespace yuragi::viewer {

/// A meadow made for looking at: side x side blades of ten links on a square of so many metres, upright with a small
/// curl.
pose::Skeleton test_meadow(std::size_t side, double size_m);

/// Every blade bent by `lean_rad` toward the wind's way, and `sway_rad` more where a travelling wave is.
pose::Pose test_pose(const pose::Skeleton& meadow, double time_s, double lean_rad, double sway_rad, double toward_deg);

/// A server of that meadow: greets with Hello and Scenes.
wire::Bytes greeting_for(const pose::Skeleton& meadow);

/// A frame of it, as bytes; the wind blows from the other side of toward_deg.
wire::Bytes frame_of(const pose::Skeleton& meadow, const pose::Pose& pose, std::uint64_t sequence, double time_s,
                     double toward_deg, wire::FrameEncoder& encoder);

}  // namespace yuragi::viewer
