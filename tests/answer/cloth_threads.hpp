#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/pose/skeleton.hpp"
#include "tests/answer/tracks.hpp"

namespace yuragi::answer {

/// What is across a cloth counts from here on: what is slower is the whole cloth, which turns with the wind.
inline constexpr double kAcrossFrom_hz = 0.3;

/// Some threads of a cloth from its fixed edge (way 0) to its free one (way L), and where their joints have been.
class ClothThreads {
 public:
  enum class Joint : std::uint8_t { kFirst, kQuarter, kHalf, kHalfNext, kLate, kLateNext, kTip };
  static constexpr std::size_t kJoints = 7;

  /// `threads` of the grid's columns, spread evenly.
  ClothThreads(const pose::GridSkeleton& grid, std::size_t threads);
  /// These columns.
  ClothThreads(const pose::GridSkeleton& grid, std::vector<std::size_t> columns);

  JointTracks& tracks() { return tracks_; }
  const JointTracks& tracks() const { return tracks_; }

  /// A thread's joint among the tracks.
  std::size_t at(std::size_t thread, Joint joint) const { return thread * kJoints + static_cast<std::size_t>(joint); }

  std::size_t count() const { return columns_.size(); }
  double length_m() const { return length_m_; }

  /// A thread's angle from straight down, from its first joint to its last.
  Series chord_deg(std::size_t thread) const {
    return tracks_.angle_from_down_deg(at(thread, Joint::kFirst), at(thread, Joint::kTip));
  }

  /// How much later the link at 0.9 L slopes aside as the link at 0.5 L does, of what is quicker than kAcrossFrom_hz.
  Lag lag(std::size_t thread, Horizontal aside) const;
  /// How fast a wave goes that takes this long from the one to the other; infinitely for one that takes no time, or
  /// goes back.
  double speed_m_s(Lag lag) const;

  /// The way of the threads' tips from their first joints at a moment.
  Horizontal tip_way(const pose::Kinematics& joints) const;

 private:
  static constexpr double kHalfWay = 0.5;
  static constexpr double kLateWay = 0.9;

  Series slope(std::size_t thread, Joint from, Joint to, Horizontal aside) const;

  std::vector<std::size_t> columns_;
  std::size_t grid_columns_, rows_;
  double length_m_ = 0.0;
  JointTracks tracks_;
};

}  // namespace yuragi::answer
