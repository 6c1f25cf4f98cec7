#include "daemon/commands/ask_daemon.hpp"

#include <fmt/core.h>

#include "daemon/settings/exit.hpp"
#include "daemon/stream/stream_client.hpp"

namespace yuragi {
namespace {

constexpr auto kControlConnectTimeout = std::chrono::seconds(2);
constexpr auto kReplyTimeout = std::chrono::seconds(5);

}  // namespace

wire::ControlReply ask_daemon(const std::string& address, const std::string& client, const wire::Control& control) {
  auto stream = StreamClient::connect(address, kControlConnectTimeout);
  if (!stream) throw ExitError(kExitUnavailable, stream.error().message + ". Is `yuragi run` running?");
  if (!stream->subscribe({.poses = false, .client = client}) || !stream->send(control))
    throw ExitError(kExitUnavailable, fmt::format("the daemon at {} does not listen", address));
  while (true) {
    const auto message = stream->receive(kReplyTimeout);
    if (!message) {
      throw ExitError(kExitUnavailable,
                      fmt::format("no answer from the daemon at {} ({})", address, name_of(message.error())));
    }
    if (const auto* hello = std::get_if<wire::Hello>(&*message); hello != nullptr && hello->refused) {
      throw ExitError(kExitUnavailable, fmt::format("the daemon at {} lets nobody in: {}", address, *hello->refused));
    }
    if (const auto* reply = std::get_if<wire::ControlReply>(&*message)) return *reply;
  }
}

}  // namespace yuragi
