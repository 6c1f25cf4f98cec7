#include "daemon/animation/scene_exchange.hpp"

#include <utility>

namespace yuragi::daemon::animation {

SceneExchange::SceneExchange(const Animation& animation, Loop& loop, SceneDirector& director)
    : loop_(loop), director_(director), present_(animation.roster()) {}

bool SceneExchange::begin(std::unique_ptr<SceneChange>& change) {
  auto roster = change->roster;
  auto messages = change->messages;
  if (!loop_.begin_change(change)) return false;
  director_.follow(*roster);
  present_ = std::move(roster);
  messages_.insert(messages_.end(), messages.begin(), messages.end());
  return true;
}

std::shared_ptr<const wire::Bytes> SceneExchange::new_scenes(std::uint64_t generation) {
  std::shared_ptr<const wire::Bytes> newest;
  while (!messages_.empty() && messages_.front().generation <= generation) {
    newest = std::move(messages_.front().bytes);
    messages_.erase(messages_.begin());
  }
  return newest;
}

}  // namespace yuragi::daemon::animation
