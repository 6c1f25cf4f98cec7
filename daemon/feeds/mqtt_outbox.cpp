#include "daemon/feeds/mqtt_outbox.hpp"

#include <algorithm>
#include <utility>

namespace yuragi::daemon::feeds {

void MqttOutbox::post(MqttPost post) {
  if (post.is_state) {
    const auto before = std::ranges::find(states_, post.topic, &MqttPost::topic);
    if (before == states_.end()) {
      if (!post.payload.empty()) states_.push_back(post);
    } else if (post.payload.empty()) {
      states_.erase(before);
    } else {
      *before = post;
    }
  }
  std::string topic = post.topic;
  if (waiting_.insert_or_assign(topic, std::move(post)).second) order_.push_back(std::move(topic));
}

void MqttOutbox::post_states_again() {
  for (const MqttPost& state : std::vector(states_)) post(state);
}

std::optional<MqttPost> MqttOutbox::take() {
  if (order_.empty()) return std::nullopt;
  const auto first = waiting_.find(order_.front());
  MqttPost post = std::move(first->second);
  waiting_.erase(first);
  order_.pop_front();
  return post;
}

void MqttOutbox::put_back(const MqttPost& post) {
  if (waiting_.try_emplace(post.topic, post).second) order_.push_front(post.topic);
}

}  // namespace yuragi::daemon::feeds
