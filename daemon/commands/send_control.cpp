#include "daemon/commands/send_control.hpp"

#include "daemon/settings/own_token.hpp"
#include "daemon/stream/control_client.hpp"

namespace yuragi::daemon::commands {

wire::ControlReply send_control(const std::string& address, const std::string& client, const wire::Control& control,
                                Nanoseconds timeout) {
  const settings::OwnToken own = settings::own_token(address);
  wire::ControlReply reply = stream::ask(address, client, control, timeout, own.token).value();
  if (!reply.done && !own.hint.empty()) reply.message += "; " + own.hint;
  return reply;
}

}  // namespace yuragi::daemon::commands
