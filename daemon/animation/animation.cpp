#include "daemon/animation/animation.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <utility>

#include "engine/pose/pose_arrays.hpp"

namespace yuragi::daemon::animation {
namespace {

constexpr double kLiveWeight = 0.5;  // from here on the wind is the sensors' for cameras that follow it

/// Enough places for every sensor, and no more: a tape takes half a megabyte.
std::size_t most_pens(const settings::Config& config) {
  if (config.wind.lead.is_in_company()) return wind::ground::WindStroke::kMaxPens;
  return std::min(wind::ground::WindStroke::kMaxPens, config.sensors.size() + (config.wind.fallback ? 1 : 0));
}

/// The scenes that the daemon begins with: at once as visible as they are to be.
std::unique_ptr<SceneList> first_scenes(const settings::Config& config,
                                        const std::shared_ptr<const wind::turbulence::GustNoise>& gusts) {
  SceneRoster roster{.generation = 0,
                     .seed = config.seed,
                     .settles = config.wind.lead.is_in_company(),
                     .gusts = gusts,
                     .configs = config.scenes,
                     .scenes = {}};
  for (std::size_t i = 0; i < config.scenes.size(); ++i) {
    roster.scenes.push_back(make_staged_scene(config, i, gusts));
    roster.scenes.back()->fade = Fade(config.scenes[i].is_shown);
  }
  auto list = std::make_unique<SceneList>(std::make_shared<const SceneRoster>(std::move(roster)),
                                          std::span<const SceneList::Entry>(), 0);
  list->read_opacities();
  return list;
}

}  // namespace

Animation::Animation(const settings::Config& config, const std::shared_ptr<const wind::turbulence::GustNoise>& gusts)
    : scenes_(first_scenes(config, gusts)),
      pool_(config.animation.threads),
      tapes_(most_pens(config)),
      view_wind_(config.wind.default_direction_deg) {}

void Animation::step(const wind::ground::DrivingWind& wind, double dt_s, std::uint64_t ticks) noexcept {
  if (change_ && !change_->is_over && change_->has_faded_out()) finish_change();
  wind::ground::Wind ground = written_to(tapes_, wind);
  tick_ += ticks;
  ground.tick = tick_;
  view_wind_.advance(dt_s, wind.state.wind, wind.state.live_weight >= kLiveWeight);
  SceneList& list = *scenes_;
  const bool is_shared = pool_.size() > 1 && sharing_.is_shared();
  const auto share = [this, is_shared](const auto& work) {
    if (is_shared) return pool_.run(work);
    work(Part{});
  };
  Nanoseconds all_scenes{0};
  for (std::size_t i = 0; i < list.size(); ++i) list[i].fade.advance(dt_s);
  list.read_opacities();
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list.opacities()[i] == 0.0F) {
      list[i].step_time.clear();
      continue;
    }
    const auto begun = std::chrono::steady_clock::now();
    scenes::Scene& scene = *list[i].scene;
    scene.shift(list[i].wind_gain * ground, dt_s);
    share([&scene](Part part) { scene.sample_part(part); });
    share([&scene, dt_s](Part part) { scene.project_part(part, dt_s); });
    const Nanoseconds duration = std::chrono::steady_clock::now() - begun;
    list[i].step_time.add(duration);
    all_scenes += duration;
  }
  sharing_.took(all_scenes);
  list.settle(dt_s);
}

void Animation::list_state(StatePass& pass) {
  assert(!change_);
  pass(tapes_, view_wind_, tick_);
  for (std::size_t i = 0; i < scenes_->size(); ++i) pass((*scenes_)[i]);
}

bool Animation::save_state(std::vector<std::uint8_t>& state, MonoTime now) {
  if (change_) return false;
  StatePass pass = StatePass::saving(state, now);
  list_state(pass);
  return true;
}

bool Animation::load_state(std::span<const std::uint8_t> state, MonoTime now) {
  if (change_) return false;
  StatePass check = StatePass::checking(state);
  list_state(check);
  if (check.problem() != StatePass::Problem::kNone) return false;
  scenes_->keep_shown();
  StatePass load = StatePass::loading(state, now);
  list_state(load);
  scenes_->read_opacities();
  return true;
}

void Animation::cue(const SceneCue& cue) noexcept {
  const SceneRoster& roster = change_ ? *change_->roster : *scenes_->roster();
  if (cue.scene >= roster.scenes.size()) return;
  if (cue.hide_others) {
    for (const auto& staged : roster.scenes) staged->fade.begin(false, cue.over_s);
  }
  roster.scenes[cue.scene]->fade.begin(cue.shown, cue.over_s);
}

void Animation::begin_change(std::unique_ptr<SceneChange> change) noexcept {
  assert(change && !change_);
  change_ = std::move(change);
  change_->begin_fades();
  if (change_->leaving.empty()) {
    finish_change();
  } else if (change_->both) {
    std::swap(scenes_, change_->both);
  }
}

/// The scenes that are given up stay in the change, to be freed by its taker.
void Animation::finish_change() noexcept {
  std::swap(scenes_, change_->last);
  scenes_->read_opacities();
  change_->is_over = true;
}

std::unique_ptr<SceneChange> Animation::take_finished_change() noexcept {
  if (!change_ || !change_->is_over) return nullptr;
  return std::move(change_);
}

std::size_t Animation::node_count() const {
  std::size_t nodes = 0;
  for (const pose::Skeleton* skeleton : skeletons()) nodes += pose::node_count(*skeleton);
  return nodes;
}

}  // namespace yuragi::daemon::animation
