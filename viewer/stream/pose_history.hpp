#pragma once

#include <cstddef>
#include <vector>

#include "viewer/stream/pose_moment.hpp"

namespace yuragi::viewer::stream {

/// The last few seconds of received poses, in the order of the sender's time.
///
/// Memory is bounded: at most kMaxMoments, and fewer if they are large (kMaxBytes, but at least kMinMoments). Once it
/// is full nothing is allocated: a new moment swaps its buffers with those of the oldest. Thread-safe: no.
class PoseHistory {
 public:
  static constexpr std::size_t kMaxMoments = 256;  ///< four seconds at 60 Hz
  static constexpr std::size_t kMinMoments = 16;
  static constexpr std::size_t kMaxBytes = 64u << 20;

  /// Drops all moments, and prepares for poses of the layout of `layout`.
  void reset(const PoseMoment& layout);

  /// Drops the moments and keeps their buffers.
  void clear() { first_ = count_ = 0; }

  /// Takes a moment later than newest(). Its poses are swapped with those of the oldest place.
  void push(PoseMoment& moment);

  bool is_empty() const { return count_ == 0; }
  std::size_t size() const { return count_; }
  std::size_t capacity() const { return moments_.size(); }
  const PoseMoment& newest() const { return at(count_ - 1); }
  const PoseMoment& oldest() const { return at(0); }

  /// The moment at time_s, interpolated; before the oldest and after the newest, those. Not while it is empty.
  void sample(double time_s, PoseMoment& out) const;

 private:
  const PoseMoment& at(std::size_t age_order) const { return moments_[(first_ + age_order) % moments_.size()]; }

  std::vector<PoseMoment> moments_;  // a ring
  std::size_t first_ = 0;            // of the oldest
  std::size_t count_ = 0;
};

}  // namespace yuragi::viewer::stream
