#include "daemon/commands/send_control.hpp"

#include "daemon/commands/exit.hpp"
#include "daemon/stream/stream_client.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr auto kControlConnectTimeout = std::chrono::seconds(2);
constexpr auto kReplyTimeout = std::chrono::seconds(5);

}  // namespace

wire::ControlReply send_control(const std::string& address, const std::string& client, const wire::Control& control) {
  auto stream = stream::StreamClient::connect(address, kControlConnectTimeout);
  if (!stream) throw ExitError(kExitUnavailable, stream.error().message + ". Is `yuragi run` running?");
  // The daemon has closed the connection: its Hello, which is still to be read, says why.
  if (stream->subscribe({.poses = false, .client = client})) stream->send(control);
  while (true) {
    const auto message = stream->receive(kReplyTimeout);
    if (!message) throw FailureError(stream::connection_lost(address, message.error()));
    if (const auto refusal = stream::refusal_in(*message, address)) throw FailureError(*refusal);
    if (const auto* reply = std::get_if<wire::ControlReply>(&*message)) return *reply;
  }
}

}  // namespace yuragi::daemon::commands
