#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/wire/wire.hpp"

namespace yuragi::wire {

/// Thins scenes and their frames out, for clients with little bandwidth: only the requested scenes, every n-th strand,
/// and every n-th column and row of a cloth or a surface.
///
/// The result is consistent. Strands on which a kept one grows are kept. Edges of a cloth and an open surface are kept,
/// and of each ring of a closed one at least three points. Strands on a grid remain on one if `every` divides its
/// columns; otherwise they are on none. Leaves that were turned by blocks are each turned with the link that they grow
/// from. The numbers of a frame are copied, not rounded again. A Thinning of the wind alone leaves no scene. Pure.
/// Thread-safe: yes.
class Thinner {
 public:
  Thinner(const Scenes& scenes, const Thinning& thinning);

  const Scenes& scenes() const noexcept { return scenes_; }

  /// `message`: FrameEncoder's output for the scenes of the constructor. The same for scenes(); both with their size
  /// prefix. A pose of another size is omitted, like that of a hidden scene.
  Bytes frame(std::span<const std::uint8_t> message) const;

 private:
  /// The kept values of a scene's arrays, in the message's order, without padding.
  struct Kept {
    std::size_t scene = 0;                            ///< its number among all
    std::vector<std::vector<std::uint32_t>> of = {};  ///< one list a level of a tree; otherwise one
    std::vector<std::size_t> count_before = {};       ///< the numbers before, list by list
    std::vector<std::uint32_t> rows = {};             ///< of a surface
    std::size_t rows_before = 0;
    std::uint32_t columns = 0;  ///< of a cloth, afterwards
  };
  struct FrameMaker;

  Kept thin(pose::StrandSkeleton& strands, std::size_t every) const;
  Kept thin(pose::GridSkeleton& grid, std::size_t every) const;
  Kept thin(pose::TreeSkeleton& tree, std::size_t every) const;
  Kept thin(pose::SurfaceSkeleton& surface, std::size_t every) const;

  Scenes scenes_;
  std::vector<Kept> kept_;
};

/// The names of the scenes in `message`, which encode() made of a Scenes, with its size prefix; printable, in the same
/// order. Reads no skeleton.
std::vector<std::string> scene_names(std::span<const std::uint8_t> message);

}  // namespace yuragi::wire
