#include "viewer/picture/camera_keeper.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::viewer::picture {
namespace {

constexpr double kClockFollowing_s = 5.0;  // the time constant with which the daemon's clock is followed
constexpr double kFastestFollowing = 0.1;  // of the time that passes
constexpr double kClockWasSet_s = 5.0;     // more than any frame's delay

std::optional<look::Camera> copy_of(const look::Camera* camera) {
  return camera != nullptr ? std::optional(*camera) : std::nullopt;
}

}  // namespace

void CameraKeeper::set_cameras(const std::vector<look::Camera>& cameras, std::size_t on) {
  const bool is_first = !has_cameras_;
  has_cameras_ = true;
  if (cameras == cameras_ && on == on_) return;
  const std::optional<look::Camera> before = copy_of(wanted());
  cameras_ = cameras;
  on_ = on;
  const std::optional<look::Camera> after = copy_of(wanted());
  if (is_first) {
    now_.camera = after;
    return;
  }
  if (after == before) return;
  const bool is_hours = after && before && after->name != before->name;
  next_fade_s_ = is_hours ? after->fade_s : kFade_s;
}

void CameraKeeper::hear_clock(double utc_s) {
  if (!has_clock_) now_.utc_s = utc_s;
  has_clock_ = true;
  clock_ahead_s_ = utc_s - now_.utc_s;
}

void CameraKeeper::take_by_hand() {
  if (!before_.camera) faded_s_ = fade_s_;  // the hand cannot be in two places
  is_by_hand_ = true;
  now_.camera.reset();
}

void CameraKeeper::show(std::size_t number) {
  if (number < 1 || number > cameras_.size()) return;
  asked_ = cameras_[number - 1].name;
  is_by_hand_ = false;
  next_fade_s_ = kFade_s;
}

void CameraKeeper::next() {
  if (cameras_.empty()) return;
  const look::Camera* const present = wanted();
  const auto found =
      std::ranges::find(cameras_, present != nullptr ? present->name : std::string(), &look::Camera::name);
  const bool is_last = found == cameras_.end() || std::next(found) == cameras_.end();
  asked_ = is_last ? cameras_.front().name : std::next(found)->name;
  is_by_hand_ = false;
  next_fade_s_ = kFade_s;
}

bool CameraKeeper::reset() {
  asked_ = asked_at_first_;
  is_by_hand_ = is_by_hand_at_first_;
  next_fade_s_ = kFade_s;
  return wanted() != nullptr;
}

void CameraKeeper::advance(double dt_s) {
  dt_s = std::max(0.0, dt_s);
  faded_s_ = std::min(fade_s_, faded_s_ + dt_s);
  before_.utc_s += dt_s;
  now_.utc_s += dt_s;
  const bool was_clock_set = std::abs(clock_ahead_s_) > kClockWasSet_s;
  if (!was_clock_set) {
    const double step_s = std::clamp(clock_ahead_s_ * (1.0 - std::exp(-dt_s / kClockFollowing_s)),
                                     -kFastestFollowing * dt_s, kFastestFollowing * dt_s);
    now_.utc_s += step_s;
    clock_ahead_s_ -= step_s;
  }
  if (is_fading()) return;
  const look::Camera* const camera = wanted();
  const bool is_other = camera != nullptr ? now_.camera != *camera : now_.camera.has_value();
  if (!is_other && !was_clock_set) return;
  before_ = now_;
  now_ = {copy_of(camera), now_.utc_s + (was_clock_set ? clock_ahead_s_ : 0.0)};
  if (was_clock_set) clock_ahead_s_ = 0.0;
  const bool is_seen = before_.camera || now_.camera;
  fade_s_ = !is_seen ? 0.0 : is_other ? next_fade_s_ : kFade_s;
  faded_s_ = 0.0;
  next_fade_s_ = kFade_s;
}

double CameraKeeper::share() const {
  if (!is_fading()) return 1.0;
  const double linear = faded_s_ / fade_s_;
  return linear * linear * (3.0 - 2.0 * linear);
}

const look::Camera* CameraKeeper::find(const std::string& name) const {
  const auto found = std::ranges::find(cameras_, name, &look::Camera::name);
  return found == cameras_.end() ? nullptr : &*found;
}

const look::Camera* CameraKeeper::wanted() const {
  if (is_by_hand_ || cameras_.empty()) return nullptr;
  if (const look::Camera* camera = asked_ ? find(*asked_) : nullptr) return camera;
  return &cameras_[std::min(on_, cameras_.size() - 1)];
}

}  // namespace yuragi::viewer::picture
