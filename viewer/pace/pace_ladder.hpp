#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/look/look.hpp"

namespace yuragi::viewer::pace {

/// How much of a picture is drawn.
struct DrawnPart {
  float side = 1.0F;        ///< share of the pixels of its width and of its height; the rest is interpolated
  float blades = 1.0F;      ///< share of the grass of the quality
  float coarseness = 1.0F;  ///< meshes and shadows are made for pixels this many times as wide

  friend bool operator==(const DrawnPart&, const DrawnPart&) = default;
};

/// One way to draw: the content of a picture, and the rate of pictures.
struct Step {
  look::Quality quality = look::Quality::kHigh;
  DrawnPart part = {};
  int refreshes = 1;  ///< refreshes of the display from one picture to the next

  friend bool operator==(const Step&, const Step&) = default;
};

/// All ways to draw, each less work than the one before. First fewer pictures, at the display's rate or a half, a
/// quarter ... of it, but at least kMinPerSecond; then less detail: the qualities below `wanted` if the viewer chooses
/// (kAuto), and below quality low fewer pixels and blades. A quality chosen by a person does not change, except that
/// low gets fewer pixels, too.
///
/// Allocates nothing. Thread-safe: no.
class Ladder {
 public:
  static constexpr std::size_t kMaxSteps = 12;
  static constexpr double kMinPerSecond = 24.0;
  /// Below quality low. Each is at least 1 / 1.5 of the work of the one before. With fewer pixels than the last one a
  /// meadow looks coarse: an even slower machine makes fewer pictures.
  static constexpr std::array<DrawnPart, 4> kParts{{{.side = 0.85F, .blades = 0.85F, .coarseness = 1.1F},
                                                    {.side = 0.72F, .blades = 0.70F, .coarseness = 1.2F},
                                                    {.side = 0.60F, .blades = 0.55F, .coarseness = 1.3F},
                                                    {.side = 0.50F, .blades = 0.45F, .coarseness = 1.4F}}};

  /// `refresh_s`: from one refresh of the display to the next.
  Ladder(look::Quality wanted, double refresh_s);

  std::size_t size() const { return count_; }
  const Step& operator[](std::size_t i) const { return steps_[i]; }
  /// The time available for a picture.
  double picture_s(std::size_t i) const { return refresh_s_ * static_cast<double>(steps_[i].refreshes); }
  /// How much of the picture a step omits: comparable between ladders of different rates and qualities.
  static std::uint8_t given_up(const Step& step);
  /// The first step that omits at least this much; the last one if none does.
  std::size_t giving_up(std::uint8_t least) const;
  /// The first step with this quality or a lower one and the lowest rate of pictures.
  std::size_t slowest_of(look::Quality quality) const;

  friend bool operator==(const Ladder&, const Ladder&) = default;

 private:
  std::array<Step, kMaxSteps> steps_{};
  std::size_t count_ = 0;
  double refresh_s_;
};

}  // namespace yuragi::viewer::pace
