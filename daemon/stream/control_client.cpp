#include "daemon/stream/control_client.hpp"

#include "daemon/stream/stream_client.hpp"

namespace yuragi::daemon::stream {
namespace {

constexpr auto kControlConnectTimeout = std::chrono::seconds(2);
constexpr auto kReloadTimeout = std::chrono::seconds(60);

}  // namespace

Result<wire::ControlReply, Failure> ask(const std::string& address, std::string_view client,
                                        const wire::Control& control, Nanoseconds timeout, const Secret& token) {
  auto stream = Client::connect(address, kControlConnectTimeout);
  if (!stream) return Failure{stream.error().message + ". Is `yuragi run` running?", FailureKind::kUnavailable};
  // If this fails, the daemon has closed the connection: its Hello, which can still be read, has the reason.
  if (stream->subscribe({.poses = false, .client = std::string(client), .token = token})) stream->send(control);
  while (true) {
    auto message = stream->receive(timeout);
    if (!message) return connection_lost(address, message.error());
    if (auto refusal = refusal_in(*message, address)) return std::move(*refusal);
    if (auto* reply = std::get_if<wire::ControlReply>(&*message)) return std::move(*reply);
  }
}

Result<wire::ReloadReport, Failure> ask_to_reload(const std::string& address, const std::string& file,
                                                  const Secret& token) {
  auto reply = ask(address, "reload", {.scene = "", .reload = wire::ReloadCommand{file}}, kReloadTimeout, token);
  if (!reply) return reply.error();
  if (reply->reload) return std::move(*reply->reload);
  return Failure{
      "the daemon at " + address + " is of an older version, which cannot read its configuration again: restart it",
      FailureKind::kUnavailable};
}

std::string reload_text(const wire::ReloadReport& report) {
  std::string text;
  for (const std::string& mistake : report.mistakes) text += mistake + "\n";
  for (const std::string& change : report.applied) text += "applied: " + change + "\n";
  for (const std::string& change : report.takes_restart) text += "needs a restart: " + change + "\n";
  if (text.empty()) text = "nothing has changed\n";
  return text;
}

}  // namespace yuragi::daemon::stream
