#include "viewer/pace_keeper.hpp"

#include <algorithm>

namespace yuragi::viewer {
namespace {

constexpr double kJudge_s = 1.0;
constexpr std::size_t kFewPictures = 5;    // are not judged
constexpr double kLongest_s = 0.5;         // a picture that took longer was held up by something else
constexpr double kTooLong = 1.05;          // of the target
constexpr double kMuchTooLong = 1.6;       // likewise: two steps at once
constexpr double kRoom = 0.62;             // below, the next step fits in
constexpr double kTrial_s = 60.0;          // what lasts so long was not too much
constexpr double kBladesPerSecond = 0.08;  // of all; of the coarseness, as much

}  // namespace

void PaceKeeper::advance(double passed_s, double work_s) {
  passed_s = std::clamp(passed_s, 0.0, kLongest_s);
  since_change_s_ += passed_s;
  judged_over_s_ += passed_s;
  if (count_ < works_s_.size()) works_s_[count_++] = std::clamp(work_s, 0.0, kLongest_s);
  if (judged_over_s_ >= kJudge_s && count_ >= kFewPictures) {
    const auto middle = works_s_.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
    std::nth_element(works_s_.begin(), middle, works_s_.begin() + static_cast<std::ptrdiff_t>(count_));
    judge(*middle);
    judged_over_s_ = 0.0;
    count_ = 0;
  }
  drawn_.side = kSteps[step_].side;
  const auto most = static_cast<float>(kBladesPerSecond * passed_s);
  drawn_.blades += std::clamp(kSteps[step_].blades - drawn_.blades, -most, most);
  drawn_.coarseness += std::clamp(kSteps[step_].coarseness - drawn_.coarseness, -most, most);
}

void PaceKeeper::judge(double median_s) {
  if (has_tried_more_ && since_change_s_ > kTrial_s) {
    has_tried_more_ = false;
    patience_s_ = kPatience_s;
  }
  if (median_s > kTooLong * kTarget_s && step_ + 1 < kSteps.size()) {
    if (has_tried_more_) patience_s_ = std::min(2.0 * patience_s_, kMostPatience_s);
    step_ = std::min(step_ + (median_s > kMuchTooLong * kTarget_s ? 2 : 1), kSteps.size() - 1);
    has_tried_more_ = false;
    since_change_s_ = 0.0;
  } else if (median_s < kRoom * kTarget_s && step_ > 0 && since_change_s_ >= patience_s_) {
    --step_;
    has_tried_more_ = true;
    since_change_s_ = 0.0;
  }
}

}  // namespace yuragi::viewer
