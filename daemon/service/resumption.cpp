#include "daemon/service/resumption.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <spdlog/spdlog.h>

#include "daemon/animation/motion_made_of.hpp"
#include "engine/base/snapshot.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::service {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxMotion_bytes = 1UL << 30;
constexpr auto kOwner = fs::perms::owner_read | fs::perms::owner_write;

}  // namespace

bool Resumption::load(const settings::Config& config, Motion motion, MonoTime now) const {
  std::error_code error;
  const auto written = fs::last_write_time(file_, error);
  if (file_.empty() || error) return false;
  const auto age = fs::file_time_type::clock::now() - written;
  const auto snapshot = platform::read_whole(file_, kMaxMotion_bytes);
  if (!fs::remove(file_, error)) {
    spdlog::warn("resume: {} cannot be removed ({}): the scenes begin at rest", file_.string(), error.message());
    return false;
  }
  // A clock that was set meanwhile makes it old.
  if (age < -kMaxAge || age > kMaxAge) return false;
  const auto refuse = [this](const std::string& why) {
    spdlog::info("resume: {} {}: the scenes begin at rest", file_.string(), why);
    return false;
  };
  if (!snapshot) return refuse(snapshot.error().message);
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(snapshot->data()), snapshot->size());
  auto loaded = load_snapshot(motion, animation::motion_made_of(config, config.sensors.size()), bytes, now);
  // The estimator has the recording of last resort behind all sensors: it would take the place of an added one.
  for (std::size_t fewer = config.sensors.size(); !loaded && !config.wind.fallback && --fewer > 0;) {
    if (auto before = load_snapshot(motion, animation::motion_made_of(config, fewer), bytes, now))
      loaded = std::move(before);
  }
  if (!loaded) return refuse(loaded.error().message);
  spdlog::info("resume: the scenes go on as they were {:.1f} s ago", std::chrono::duration<double>(age).count());
  return true;
}

void Resumption::save(const settings::Config& config, Motion motion) const {
  if (file_.empty() || motion.animation.is_changing()) return;
  try {
    const std::vector<std::uint8_t> snapshot =
        save_snapshot(motion, animation::motion_made_of(config, config.sensors.size()), motion.hub.wind().time);
    const std::string_view text(reinterpret_cast<const char*>(snapshot.data()), snapshot.size());
    if (const auto saved = platform::write_whole(file_, text, kOwner); !saved)
      spdlog::warn("resume: the motion is not saved: {}", saved.error().message);
  } catch (const std::exception& problem) {
    spdlog::warn("resume: the motion is not saved: {}", problem.what());
  }
}

}  // namespace yuragi::daemon::service
