#include "viewer/pace/pace_ladder.hpp"

#include <algorithm>

namespace yuragi::viewer::pace {
namespace {

constexpr double kSlowestDisplay_s = 1.0 / 20.0;
constexpr double kQuickestDisplay_s = 1.0 / 500.0;
constexpr std::array kQualities{look::Quality::kHigh, look::Quality::kMedium, look::Quality::kLow};

/// 0 is the best of kQualities.
auto rank_of(look::Quality quality) {
  return std::ranges::find(kQualities, quality) - kQualities.begin();
}

}  // namespace

Ladder::Ladder(look::Quality wanted, double refresh_s)
    : refresh_s_(std::clamp(refresh_s, kQuickestDisplay_s, kSlowestDisplay_s)) {
  Step step{.quality = wanted == look::Quality::kAuto ? look::Quality::kHigh : wanted};
  steps_[count_++] = step;
  while (2.0 * step.refreshes * refresh_s_ * kMinPerSecond <= 1.0) {
    step.refreshes *= 2;
    steps_[count_++] = step;
  }
  for (const look::Quality quality : kQualities) {
    if (wanted != look::Quality::kAuto || quality == step.quality) continue;
    step.quality = quality;
    steps_[count_++] = step;
  }
  if (step.quality != look::Quality::kLow) return;
  for (const DrawnPart& part : kParts) {
    step.part = part;
    steps_[count_++] = step;
  }
}

std::uint8_t Ladder::given_up(const Step& step) {
  const auto part = step.part == DrawnPart{} ? 0 : std::ranges::find(kParts, step.part) - kParts.begin() + 1;
  return static_cast<std::uint8_t>(rank_of(step.quality) + part);
}

std::size_t Ladder::giving_up(std::uint8_t least) const {
  std::size_t i = 0;
  while (i + 1 < count_ && given_up(steps_[i]) < least) ++i;
  return i;
}

std::size_t Ladder::slowest_of(look::Quality quality) const {
  std::size_t i = 0;
  while (i + 1 < count_ &&
         (rank_of(steps_[i].quality) < rank_of(quality) || steps_[i].refreshes < steps_[count_ - 1].refreshes))
    ++i;
  return i;
}

}  // namespace yuragi::viewer::pace
