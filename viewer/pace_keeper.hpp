#pragma once

#include <array>
#include <cstddef>

namespace yuragi::viewer {

/// How much of a picture is drawn where the processor draws.
struct DrawnPart {
  float side = 1.0F;        ///< of the pixels of its width and of its height; the rest is filled in between them
  float blades = 1.0F;      ///< of the grass that the quality draws
  float coarseness = 1.0F;  ///< so many times as wide are the pixels that meshes of things and shadows are made for

  friend bool operator==(const DrawnPart&, const DrawnPart&) = default;
};

/// Chooses how much is drawn so that pictures come at an even pace, 30 a second, on a machine of any speed.
///
/// It judges the median of a second's pictures. Where they take too long less is drawn at once; more only where they
/// leave so much time that the next step fits in, and have done so for a while: kPatience_s at first, twice as long
/// after each time that this was too much. So it does not go to and fro, and one slow picture changes nothing. The
/// grass changes slowly, so that no blade comes or goes at once, and so do the meshes.
///
/// Pure: times are parameters. Allocates nothing. Thread-safe: no.
class PaceKeeper {
 public:
  static constexpr double kTarget_s = 1.0 / 30.0;
  static constexpr double kPatience_s = 20.0;
  static constexpr double kMostPatience_s = 3600.0;
  /// From all to little. Each is at least 1 / 1.5 of the work of the one before. With fewer pixels than the last a
  /// meadow looks coarse: a machine that is slower still makes fewer pictures.
  static constexpr std::array<DrawnPart, 5> kSteps{{{.side = 1.0F, .blades = 1.0F, .coarseness = 1.0F},
                                                    {.side = 0.85F, .blades = 0.85F, .coarseness = 1.1F},
                                                    {.side = 0.72F, .blades = 0.70F, .coarseness = 1.2F},
                                                    {.side = 0.60F, .blades = 0.55F, .coarseness = 1.3F},
                                                    {.side = 0.50F, .blades = 0.45F, .coarseness = 1.4F}}};

  /// A picture was made: it took `work_s`, without waiting for the screen, and the one before it began `passed_s`
  /// before it.
  void advance(double passed_s, double work_s);

  DrawnPart drawn() const { return drawn_; }
  std::size_t step() const { return step_; }

 private:
  void judge(double median_s);

  std::array<double, 64> works_s_{};
  std::size_t count_ = 0;
  double judged_over_s_ = 0.0;  // since the last judgement
  double since_change_s_ = 0.0;
  bool has_tried_more_ = false;  // by the last change
  double patience_s_ = kPatience_s;
  std::size_t step_ = 0;
  DrawnPart drawn_;
};

}  // namespace yuragi::viewer
