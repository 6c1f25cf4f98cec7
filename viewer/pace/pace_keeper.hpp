#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "viewer/pace/pace_ladder.hpp"

namespace yuragi::viewer::pace {

/// Chooses how much is drawn (Ladder) by how long pictures take, so that they come at an even pace on a machine of
/// any speed.
///
/// It judges the median of the pictures of kJudge_s, so that one slow picture changes nothing. If they take too long,
/// it goes down at once to the first step in which they are expected to fit; if they would have fit into the step above
/// for kSpare_s, it goes one up. A step of the picture is expected to save 30 %, until it has been measured; so a step
/// that was too expensive is tried again only when the machine has become faster, and one that saves nothing is undone:
/// the machine is late for another reason. The first second is not judged, because drivers are still preparing. There
/// are at most two changes in an hour, but as many as it needs in the first kSettling_s, when the machine's speed is
/// not known, and after settle(). The grass and the meshes change slowly, so that no blade appears or disappears
/// suddenly.
///
/// Pure: times are parameters. Allocates nothing. Thread-safe: no.
class Keeper {
 public:
  static constexpr double kJudge_s = 3.0;
  static constexpr double kSpare_s = 60.0;
  static constexpr double kSettling_s = 60.0;
  static constexpr double kHour_s = 3600.0;

  /// Starts at this step.
  Keeper(const Ladder& ladder, std::size_t first);

  /// Replaces the ladder: continues at the step most like the present one. Does nothing if it is the same.
  void set_ladder(const Ladder& ladder);
  /// Call when the size or kind of the picture has changed: forgets the measurements.
  void settle();

  /// Another part of the same wall omits this much (Ladder::given_up): no more is drawn here. The cost of its own
  /// pictures is unknown meanwhile.
  void hold(std::uint8_t given_up) { held_ = given_up; }
  /// Returns true if it draws less than this machine could, because of another part of the wall.
  bool is_held() const { return drawn_step() != step_; }
  /// What it would omit by itself.
  std::uint8_t given_up() const { return Ladder::given_up(ladder_[step_]); }

  /// A picture was made, and the one before it began `passed_s` before it. `work_s`: how long it took, without waiting
  /// for the display; null if it was not measured, or is not representative, because shaders were compiled.
  void advance(double passed_s, std::optional<double> work_s);

  const Step& step() const { return ladder_[drawn_step()]; }
  /// The step's, or an intermediate one during the transition.
  DrawnPart drawn() const { return drawn_; }
  /// The time available for a picture.
  double picture_s() const { return ladder_.picture_s(drawn_step()); }
  /// The median that it has judged last; 0 before.
  double median_s() const { return median_s_; }

 private:
  std::size_t drawn_step() const { return held_ == 0 ? step_ : std::max(step_, ladder_.giving_up(held_)); }
  double median_of_works_s();
  void judge();
  void learn();
  std::size_t least_late() const;
  bool may_change() const;
  void go_to(std::size_t step);
  double expected_s(std::size_t step) const;
  bool is_picture_step(std::size_t step) const;

  Ladder ladder_;
  std::size_t step_;                 ///< that suits this machine
  std::size_t worthwhile_step_ = 0;  ///< the last step that saved something, or whose pictures were in time
  std::uint8_t held_ = 0;
  DrawnPart drawn_;
  std::array<double, Ladder::kMaxSteps> saves_{};  ///< work of each step relative to the step before

  std::array<double, 128> works_s_{};  ///< since the last judgement
  std::size_t count_ = 0;
  double median_s_ = 0.0;
  double judged_over_s_ = 0.0;
  double spare_s_ = 0.0;  ///< how long pictures would have fit into the step above
  double settling_s_ = kSettling_s;
  double warming_s_ = 0.0;
  std::array<double, 2> since_changes_s_{kHour_s, kHour_s};  ///< the last one first

  struct Change {
    std::size_t from;
    double median_s;
  };
  std::optional<Change> change_;  ///< from which nothing has been learned yet
};

}  // namespace yuragi::viewer::pace
