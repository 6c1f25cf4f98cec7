#include "viewer/web/wall.hpp"

#include <utility>
#include <variant>

#include "engine/wire/wire.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/pace/quality.hpp"

namespace yuragi::viewer::web {
namespace {

constexpr double kRefresh_s = 1.0 / 60.0;  // browsers do not state it; at a higher rate some refreshes have no picture
constexpr double kEarly = 0.25;            // of a refresh: a picture is not put off for so little
constexpr int kSamples = 4;

int samples_for(bool is_software) {
  return is_software ? 1 : kSamples;
}

pace::Keeper keeper_for(bool is_software) {
  const pace::Ladder ladder(look::Quality::kAuto, kRefresh_s);
  return {ladder, is_software ? ladder.slowest_of(pace::quality_for(look::Quality::kAuto, is_software)) : 0};
}

}  // namespace

Wall::Wall(picture::ViewerOptions options, bool is_software, bool has_sky)
    : options_(std::move(options)),
      renderer_(nullptr, options_.width_px, options_.height_px, samples_for(is_software)),
      director_(options_, renderer_, "the daemon"),
      pace_(keeper_for(is_software)) {
  renderer_.set_own_quality(pace_.step().quality);
  if (!has_sky) renderer_.stage().leave_sky_out();
}

std::optional<std::string> Wall::take(std::span<const std::uint8_t> message, double now_s) {
  auto decoded = wire::decode(message);
  if (!decoded) {
    if (decoded.error() == wire::Error::kUnknown) return std::nullopt;  // of a newer daemon
    return std::string(wire::name_of(decoded.error()));
  }
  if (auto* frame = std::get_if<wire::Frame>(&*decoded)) {
    utc_s_ = 1e-9 * static_cast<double>(frame->info.utc_ns);
    timeline_.accept(*frame, now_s);
  } else if (const auto* hello = std::get_if<wire::Hello>(&*decoded)) {
    if (hello->wind_from_deg) director_.set_wind_from(*hello->wind_from_deg);
  } else if (auto* scenes = std::get_if<wire::Scenes>(&*decoded)) {
    timeline_.set_scenes(std::move(*scenes));
  } else if (const auto* sensors = std::get_if<wire::Sensors>(&*decoded)) {
    has_status_ = true;
    director_.take_status(*sensors);
  }
  return std::nullopt;
}

void Wall::advance(double now_s) {
  const double passed_s = now_s - std::exchange(advanced_s_, now_s).value_or(now_s);
  moment_ = &timeline_.advance(now_s);
  if (auto scenes = timeline_.take_new_scenes()) {
    director_.set_scenes(std::move(*scenes));
    pace_.settle();
  }
  director_.advance(passed_s, utc_s_, moment_->wind.wind);
}

bool Wall::is_drawing(double now_s) {
  if (!drawing_) return false;
  if (glClientWaitSync(*drawing_, 0, 0) == GL_TIMEOUT_EXPIRED) return true;
  glDeleteSync(*std::exchange(drawing_, std::nullopt));
  if (is_usual_) work_s_ = now_s - *begun_s_;
  return false;
}

bool Wall::draw(double now_s, int width_px, int height_px) {
  if (is_drawing(now_s)) return false;
  const double interval_s = kRefresh_s * static_cast<double>(pace_.step().refreshes);
  if (begun_s_ && now_s - *begun_s_ < interval_s - kEarly * kRefresh_s) return false;

  advance(now_s);
  // The light comes with the first status.
  if (timeline_.playback() == stream::Playback::kNothing || !has_status_) return false;
  const double passed_s = now_s - std::exchange(begun_s_, now_s).value_or(now_s);
  pace_.set_ladder(pace::Ladder(renderer_.wanted_quality(), kRefresh_s));
  if (renderer_.target().width_px() != width_px || renderer_.target().height_px() != height_px) pace_.settle();
  pace_.advance(passed_s, std::exchange(work_s_, std::nullopt));
  renderer_.set_own_quality(pace_.step().quality);
  renderer_.resize(width_px, height_px);
  renderer_.set_drawn(pace_.drawn());

  const std::size_t compiled = gl::compiled_shaders();
  director_.draw(*moment_);
  renderer_.target().show(width_px, height_px);
  is_usual_ = compiled == gl::compiled_shaders();
  drawing_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  ++pictures_;
  return true;
}

std::string Wall::pace_text() const {
  pace::Step step = pace_.step();
  step.quality = renderer_.quality();
  return pace::quality_text(step.quality, step.part, step.refreshes);
}

}  // namespace yuragi::viewer::web
