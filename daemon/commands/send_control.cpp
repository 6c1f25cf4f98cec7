#include "daemon/commands/send_control.hpp"

#include "daemon/stream/control_client.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr auto kReplyTimeout = std::chrono::seconds(5);

}  // namespace

wire::ControlReply send_control(const std::string& address, const std::string& client, const wire::Control& control) {
  return stream::ask(address, client, control, kReplyTimeout).value();
}

}  // namespace yuragi::daemon::commands
