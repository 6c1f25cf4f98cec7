#include "viewer/pace/pace_keeper.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::viewer::pace {
namespace {

constexpr double kJudgeSoon_s = 1.0;  // while settling, if pictures take far too long
constexpr double kFarTooLong = 1.5;
constexpr std::size_t kFewPictures = 5;    // this few are judged only if there are no more in kJudge_s
constexpr double kLongest_s = 2.0;         // a picture that took longer was delayed by something else
constexpr double kTooLong = 1.05;          // of the available time
constexpr double kExpected = 0.7;          // work of the next step relative to the one before, until it is measured
constexpr double kMaxSaved = 0.3;          // limits of a credible measurement
constexpr double kSavesNothing = 0.95;     // of the work before, or more: no saving
constexpr double kWarming_s = 1.0;         // drivers prepare shaders at first use, which makes the first pictures slow
constexpr double kBladesPerSecond = 0.08;  // of all blades; the coarseness changes at the same rate

}  // namespace

Keeper::Keeper(const Ladder& ladder, std::size_t first)
    : ladder_(ladder), step_(std::min(first, ladder.size() - 1)), drawn_(ladder[step_].part) {
  settle();
}

void Keeper::set_ladder(const Ladder& ladder) {
  if (ladder == ladder_) return;
  const Step before = ladder_[step_];
  ladder_ = ladder;
  // The same step, or the first one with no more detail; with the same rate if possible.
  step_ = ladder_.slowest_of(before.quality);
  while (step_ + 1 < ladder_.size() && ladder_[step_].quality == before.quality &&
         ladder_[step_].part.side > before.part.side)
    ++step_;
  while (step_ > 0 && before.refreshes == 1 && !is_picture_step(step_)) --step_;
  settle();
}

void Keeper::settle() {
  settling_s_ = kSettling_s;
  warming_s_ = kWarming_s;
  saves_.fill(kExpected);
  change_.reset();
  worthwhile_step_ = step_;
  count_ = 0;
  judged_over_s_ = 0.0;
  spare_s_ = 0.0;
}

void Keeper::advance(double passed_s, std::optional<double> work_s) {
  passed_s = std::clamp(passed_s, 0.0, kLongest_s);
  settling_s_ = std::max(settling_s_ - passed_s, 0.0);
  warming_s_ = std::max(warming_s_ - passed_s, 0.0);
  for (double& since_s : since_changes_s_) since_s = std::min(since_s + passed_s, kHour_s);
  if (is_held()) {
    count_ = 0;
    judged_over_s_ = 0.0;
  } else if (warming_s_ == 0.0 && drawn_ == step().part) {  // during the transition a picture is more work
    judged_over_s_ += passed_s;
    if (work_s && count_ < works_s_.size()) works_s_[count_++] = std::clamp(*work_s, 0.0, kLongest_s);
  }
  const bool is_soon = settling_s_ > 0.0 && judged_over_s_ >= kJudgeSoon_s && count_ >= kFewPictures &&
                       median_of_works_s() > kFarTooLong * picture_s();
  if (is_soon || (judged_over_s_ >= kJudge_s && count_ > 0)) judge();

  drawn_.side = step().part.side;
  const auto most = static_cast<float>(kBladesPerSecond * passed_s);
  drawn_.blades += std::clamp(step().part.blades - drawn_.blades, -most, most);
  drawn_.coarseness += std::clamp(step().part.coarseness - drawn_.coarseness, -most, most);
}

double Keeper::median_of_works_s() {
  const auto middle = works_s_.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
  std::nth_element(works_s_.begin(), middle, works_s_.begin() + static_cast<std::ptrdiff_t>(count_));
  return *middle;
}

void Keeper::judge() {
  median_s_ = median_of_works_s();
  learn();
  const double over_s = judged_over_s_;
  judged_over_s_ = 0.0;
  count_ = 0;

  if (median_s_ > kTooLong * picture_s()) {
    spare_s_ = 0.0;
    if (const std::size_t to = least_late(); to != step_ && may_change()) go_to(to);
    return;
  }
  const bool has_room = step_ > 0 && expected_s(step_ - 1) <= ladder_.picture_s(step_ - 1);
  spare_s_ = has_room ? spare_s_ + over_s : 0.0;
  if (spare_s_ >= kSpare_s && may_change()) go_to(step_ - 1);
}

/// Learns what the last step has saved, or cost. Several steps at once get equal parts.
void Keeper::learn() {
  if (median_s_ <= kTooLong * picture_s()) worthwhile_step_ = step_;
  if (!change_) return;
  const auto [low, high] = std::minmax(change_->from, step_);
  const double ratio = step_ > change_->from ? median_s_ / change_->median_s : change_->median_s / median_s_;
  double pictures = 0.0;
  for (std::size_t i = low + 1; i <= high; ++i) pictures += is_picture_step(i) ? 1.0 : 0.0;
  for (std::size_t i = low + 1; i <= high; ++i) {
    if (is_picture_step(i)) saves_[i] = std::clamp(std::pow(ratio, 1.0 / pictures), kMaxSaved, 1.0);
  }
  if (step_ < change_->from || ratio < kSavesNothing) worthwhile_step_ = step_;
  change_.reset();
}

/// The first step that is expected to be in time; if there is none, the first that is least late. Steps that saved
/// nothing are undone.
std::size_t Keeper::least_late() const {
  const auto late = [&](std::size_t step) { return expected_s(step) / ladder_.picture_s(step); };
  std::size_t best = std::min(worthwhile_step_, step_);
  for (std::size_t i = best; i < ladder_.size() && late(best) > 1.0; ++i) {
    if (late(i) < kSavesNothing * late(best)) best = i;
  }
  return best;
}

bool Keeper::may_change() const {
  return settling_s_ > 0.0 || since_changes_s_[1] >= kHour_s;
}

void Keeper::go_to(std::size_t step) {
  change_ = Change{step_, std::max(median_s_, 1e-6)};
  step_ = step;
  spare_s_ = 0.0;
  if (settling_s_ == 0.0) since_changes_s_ = {0.0, since_changes_s_[0]};
}

/// The expected duration of a picture in another step. If only the available time differs, the duration is the same,
/// but some of it should stay free.
double Keeper::expected_s(std::size_t step) const {
  double expected_s = median_s_;
  for (std::size_t i = step_ + 1; i <= step; ++i) {
    if (is_picture_step(i)) expected_s *= saves_[i];
  }
  for (std::size_t i = step_; i > step; --i) expected_s /= is_picture_step(i) ? saves_[i] : kExpected;
  return expected_s;
}

/// Returns true if this step changes the picture, compared with the one before.
bool Keeper::is_picture_step(std::size_t step) const {
  return step > 0 && ladder_[step].refreshes == ladder_[step - 1].refreshes;
}

}  // namespace yuragi::viewer::pace
