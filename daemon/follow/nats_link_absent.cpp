// The link in a build without NATS: nothing is ever connected, and each published message is counted as lost.
#include <mutex>
#include <utility>

#include "daemon/follow/nats_link.hpp"

namespace yuragi::daemon::follow {

struct NatsLink::Shared {
  mutable std::mutex mutex;
  std::string inbox = "_INBOX.none";
  State state;
};

// NOLINTBEGIN(performance-unnecessary-value-param): the parameters of the other link
NatsLink::NatsLink(NatsSettings /*settings*/, std::vector<std::string> /*subjects*/,
                   std::function<void()> /*on_arrival*/)
    : shared_(std::make_shared<Shared>()) {
  shared_->state.trouble = refusal().value();
}
// NOLINTEND(performance-unnecessary-value-param)

NatsLink::~NatsLink() = default;

std::optional<std::string> NatsLink::refusal() {
  return "this build has no NATS (cmake -D YURAGI_NATS=ON, libnats-dev)";
}

void NatsLink::publish(std::string_view /*subject*/, std::span<const std::uint8_t> /*bytes*/,
                       const std::string& /*reply_to*/) {
  const std::lock_guard lock(shared_->mutex);
  ++shared_->state.lost;
}

const std::string& NatsLink::inbox() const {
  return shared_->inbox;
}

std::vector<NatsMessage> NatsLink::received() {
  return {};
}

void NatsLink::leave_server() {}

NatsLink::State NatsLink::state() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->state;
}

}  // namespace yuragi::daemon::follow
