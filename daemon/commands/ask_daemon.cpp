#include "daemon/commands/ask_daemon.hpp"

#include <algorithm>
#include <chrono>

#include "daemon/settings/own_token.hpp"
#include "daemon/stream/control_client.hpp"
#include "daemon/stream/stream_client.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr auto kAskConnectTimeout = std::chrono::seconds(2);
constexpr auto kAskTimeout = std::chrono::seconds(5);

/// Takes the daemon's messages until all requested ones were received.
class StatusCollector {
 public:
  explicit StatusCollector(const std::string& address) { status_.address = address; }

  void take(wire::Message& message) {
    if (const auto* hello = std::get_if<wire::Hello>(&message)) {
      status_.software = hello->software;
      status_.tick_rate_hz = hello->tick_rate_hz;
    } else if (auto* sensors = std::get_if<wire::Sensors>(&message)) {
      status_.sensors = std::move(*sensors);
      has_sensors_ = true;
    } else if (auto* reply = std::get_if<wire::ControlReply>(&message)) {
      // They come in the order of the questions: scenes, players.
      if (replies_ == 0) status_.scenes = std::move(reply->scenes);
      if (replies_ == 1) status_.players = std::move(reply->players);
      ++replies_;
    }
  }

  bool has_all() const { return has_sensors_ && replies_ >= 2; }
  bool has_answered() const { return has_sensors_; }

  tools::sensors::DaemonStatus& status() { return status_; }

 private:
  tools::sensors::DaemonStatus status_;
  bool has_sensors_ = false;
  int replies_ = 0;
};

}  // namespace

Result<tools::sensors::DaemonStatus, Failure> ask_daemon(const std::string& address, const std::string& client) {
  auto stream = stream::Client::connect(address, kAskConnectTimeout);
  if (!stream) return Failure{stream.error().message + ". Is `yuragi run` running?", FailureKind::kUnavailable};
  // If the daemon has closed the connection, its Hello, which can still be read, has the reason.
  if (stream->subscribe(
          {.poses = false, .sensors = true, .client = client, .token = settings::own_token(address).token})) {
    stream->send(wire::Control{});
    stream->send(wire::Control{.scene = "", .player = wire::PlayerCommand{}});
  }
  StatusCollector collector(address);
  const auto deadline = std::chrono::steady_clock::now() + kAskTimeout;
  while (!collector.has_all()) {
    const auto left = deadline - std::chrono::steady_clock::now();
    auto message = stream->receive(std::max<Nanoseconds>(left, Nanoseconds{0}));
    if (!message) {
      if (message.error() == stream::End::kTimeout && collector.has_answered()) break;
      return stream::connection_lost(address, message.error());
    }
    if (const auto refusal = stream::refusal_in(*message, address)) return *refusal;
    collector.take(*message);
    if (left < Nanoseconds{0} && collector.has_answered()) break;
  }
  return std::move(collector.status());
}

wire::ControlReply send_control(const std::string& address, const std::string& client, const wire::Control& control,
                                Nanoseconds timeout) {
  const settings::OwnToken own = settings::own_token(address);
  wire::ControlReply reply = stream::ask(address, client, control, timeout, own.token).value();
  if (!reply.done && !own.hint.empty()) reply.message += "; " + own.hint;
  return reply;
}

}  // namespace yuragi::daemon::commands
