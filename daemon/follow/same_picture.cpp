#include "daemon/follow/same_picture.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "engine/base/snapshot.hpp"
#include "engine/base/version.hpp"
#include "engine/math/philox.hpp"

namespace yuragi::daemon::follow {
namespace {

std::uint64_t hash_of(const settings::SceneConfig& scene) {
  return math::stream_id(std::string(scene.kind->name) + "\n" + settings::to_toml(scene.values));
}

const std::uint64_t* find(const PictureMakeup& makeup, const std::string& scene) {
  for (const auto& [name, hash] : makeup.scenes) {
    if (name == scene) return &hash;
  }
  return nullptr;
}

}  // namespace

std::uint64_t PictureMakeup::hash() const {
  std::string all = fmt::format("{} {} {}", motion, rate_hz, wind);
  for (const auto& [name, hash] : scenes) all += fmt::format(" {}", hash);
  return math::stream_id(all);
}

PictureMakeup makeup_of(const settings::Config& config) {
  PictureMakeup makeup{.software = with_version("yuragi"),
                       .motion = kMotionVersion,
                       .rate_hz = config.animation.rate_hz,
                       .wind = math::stream_id(fmt::format("{} {}", config.seed, config.wind.is_evolving)),
                       .scenes = {}};
  for (const settings::SceneConfig& scene : config.scenes) makeup.scenes.emplace_back(scene.name, hash_of(scene));
  return makeup;
}

std::vector<std::string> wind_differences(const PictureMakeup& leaders, const PictureMakeup& own) {
  std::vector<std::string> differences;
  if (leaders.motion != own.motion) {
    differences.push_back(fmt::format("it has version {} of the motion ({}), this one version {} ({})", leaders.motion,
                                      leaders.software, own.motion, own.software));
  }
  if (leaders.rate_hz != own.rate_hz) {
    differences.push_back(
        fmt::format("its [animation] rate is {:g} Hz, this one's {:g} Hz", leaders.rate_hz, own.rate_hz));
  }
  if (leaders.wind != own.wind) differences.emplace_back("its seed or its [wind] evolving is another one");
  return differences;
}

std::vector<std::string> scene_differences(const PictureMakeup& leaders, const PictureMakeup& own) {
  std::vector<std::string> differences;
  for (const auto& [name, hash] : own.scenes) {
    const std::uint64_t* const there = find(leaders, name);
    if (there == nullptr) {
      differences.push_back("scene " + name + " is only here");
    } else if (*there != hash) {
      differences.push_back("scene " + name + " is another one there");
    }
  }
  for (const auto& [name, hash] : leaders.scenes) {
    if (find(own, name) == nullptr) differences.push_back("scene " + name + " is only there");
  }
  if (differences.empty() && leaders.scenes != own.scenes)
    differences.emplace_back("the scenes have another order there");
  return differences;
}

}  // namespace yuragi::daemon::follow
