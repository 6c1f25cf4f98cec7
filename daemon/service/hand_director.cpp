#include "daemon/service/hand_director.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "daemon/settings/duration_text.hpp"

namespace yuragi::daemon::service {
namespace {

/// As the beginning of a sentence.
std::string subject_of(const wire::HandCommand& command) {
  switch (command.part) {
    case wire::HandPart::kReport:
      break;
    case wire::HandPart::kWind:
      return fmt::format("the wind is {:g} m/s from {:g} degrees by hand", command.speed_m_s, command.direction_deg);
    case wire::HandPart::kBlackout:
      return "the walls are dark by hand";
    case wire::HandPart::kCamera:
      return fmt::format("the camera is {} by hand", command.camera);
  }
  return "nothing was changed";
}

std::string end_of(wire::HandPart part) {
  switch (part) {
    case wire::HandPart::kReport:
      break;
    case wire::HandPart::kWind:
      return "the scenes have the real wind again";
    case wire::HandPart::kBlackout:
      return "the walls are lit again, as the opening hours are";
    case wire::HandPart::kCamera:
      return "the camera is that of the time of day again";
  }
  return "nothing was changed";
}

/// False for NaN, too.
bool is_within(double value, double least, double most) {
  return value >= least && value <= most;
}

}  // namespace

HandDirector::HandDirector(settings::ControlPermission allowed, std::vector<std::string> cameras)
    : allowed_(allowed), cameras_(std::move(cameras)) {}

void HandDirector::set_cameras(std::vector<std::string> cameras) {
  cameras_ = std::move(cameras);
  if (camera_ && std::ranges::find(cameras_, camera_->camera) == cameras_.end()) camera_.reset();
}

wire::ControlReply HandDirector::handle(const wire::HandCommand& command, bool is_local, MonoTime now) {
  const auto answer = [&](bool is_done, std::string message) {
    return wire::ControlReply{.done = is_done, .message = std::move(message), .scenes = {}, .by_hand = status(now)};
  };
  if (command.part == wire::HandPart::kReport) return answer(true, "nothing was changed");
  if (const auto why = settings::control_refusal(allowed_, is_local, "nothing can be set by hand")) {
    return answer(false, *why);
  }
  std::optional<Held>& part = held(command.part);
  if (command.is_release) {
    const bool was_set = is_set(std::exchange(part, std::nullopt), now);
    return answer(true, was_set ? end_of(command.part) : "nothing was set by hand");
  }
  if (auto mistake = mistake_in(command)) return answer(false, std::move(*mistake));

  part = Held{.end = std::nullopt,
              .wind = {.speed_m_s = command.speed_m_s, .direction_deg = command.direction_deg},
              .camera = command.camera};
  if (command.for_s) part->end = now + from_seconds(*command.for_s);
  return answer(true, fmt::format("{}, {}", subject_of(command),
                                  command.for_s ? "for " + settings::duration_text(*command.for_s)
                                                : std::string("until somebody ends it")));
}

std::optional<std::string> HandDirector::mistake_in(const wire::HandCommand& command) const {
  const bool is_wind = command.part == wire::HandPart::kWind;
  const double most_s = is_wind ? wire::kMaxHandWind_s : wire::kMaxHandHold_s;
  if (is_wind && !command.for_s) return "a wind by hand needs its time";
  if (command.for_s && !is_within(*command.for_s, kMinHold_s, most_s)) {
    return fmt::format("the time must be from {:g} to {:g} s", kMinHold_s, most_s);
  }
  if (is_wind && !is_within(command.speed_m_s, 0.0, wire::kMaxHandWind_m_s)) {
    return fmt::format("the speed must be from 0 to {:g} m/s", wire::kMaxHandWind_m_s);
  }
  if (is_wind && !is_within(command.direction_deg, 0.0, 360.0)) {
    return "the direction must be from 0 to 360 degrees";
  }
  if (command.part != wire::HandPart::kCamera || std::ranges::find(cameras_, command.camera) != cameras_.end()) {
    return std::nullopt;
  }
  if (cameras_.empty()) return "the configuration has no [[camera]]";
  return fmt::format("there is no camera \"{}\"; there are: {}", command.camera, fmt::join(cameras_, ", "));
}

std::vector<std::string> HandDirector::take_ended(MonoTime now) {
  std::vector<std::string> ended;
  for (const wire::HandPart part : {wire::HandPart::kWind, wire::HandPart::kBlackout, wire::HandPart::kCamera}) {
    if (!held(part) || is_set(held(part), now)) continue;
    held(part).reset();
    ended.push_back(end_of(part));
  }
  return ended;
}

wire::ByHand HandDirector::status(MonoTime now) const {
  wire::ByHand by_hand{.blackout = hold(blackout_, now), .camera = hold(camera_, now)};
  if (const auto wind = hold(wind_, now)) {
    by_hand.wind = wire::HeldWind{.speed_m_s = wind_->wind.speed_m_s,
                                  .direction_deg = wind_->wind.direction_deg,
                                  .left_s = wind->left_s.value_or(0.0)};
  }
  return by_hand;
}

wind::shaping::ByHand HandDirector::shaping(MonoTime now) const {
  wind::shaping::ByHand by_hand{.is_dark = is_set(blackout_, now)};
  if (is_set(wind_, now)) by_hand.wind = wind_->wind;
  return by_hand;
}

std::optional<std::size_t> HandDirector::camera(MonoTime now) const {
  if (!is_set(camera_, now)) return std::nullopt;
  const auto found = std::ranges::find(cameras_, camera_->camera);
  return static_cast<std::size_t>(found - cameras_.begin());
}

bool HandDirector::is_set(const std::optional<Held>& held, MonoTime now) {
  return held && (!held->end || now < *held->end);
}

std::optional<wire::Hold> HandDirector::hold(const std::optional<Held>& held, MonoTime now) {
  if (!is_set(held, now)) return std::nullopt;
  wire::Hold hold;
  if (held->end) hold.left_s = std::min(seconds(*held->end - now), wire::kMaxHandHold_s);
  return hold;
}

std::optional<HandDirector::Held>& HandDirector::held(wire::HandPart part) {
  return part == wire::HandPart::kWind ? wind_ : part == wire::HandPart::kBlackout ? blackout_ : camera_;
}

std::string by_hand_text(const wire::ByHand& by_hand) {
  std::string text;
  const auto add = [&text](const std::string& what, std::optional<double> left_s) {
    text += (text.empty() ? "by hand: " : "; ") + what;
    if (left_s) text += fmt::format(", {} left", settings::duration_text(std::ceil(*left_s)));
  };
  if (const auto& wind = by_hand.wind)
    add(fmt::format("{:g} m/s from {:g} degrees", wind->speed_m_s, wind->direction_deg), wind->left_s);
  if (by_hand.blackout) add("dark", by_hand.blackout->left_s);
  if (by_hand.camera) add("the camera", by_hand.camera->left_s);
  return text;
}

}  // namespace yuragi::daemon::service
