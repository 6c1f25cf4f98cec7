#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>

#include "daemon/stream/transport.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::stream {

struct ClientLimits {
  Nanoseconds subscribe_within = std::chrono::seconds(5);
  Nanoseconds stuck_after = std::chrono::seconds(5);
  /// Of a client that subscribed to nothing: the longest time between its requests.
  Nanoseconds idle_after = std::chrono::minutes(10);
  std::optional<Nanoseconds> stays_for = std::nullopt;  ///< none: as long as it likes
};

/// The time limit that a client has exceeded.
enum class Overdue : std::uint8_t {
  kNeverSubscribed,  ///< connected, but did not subscribe
  kStuck,            ///< reads nothing of the message being sent
  kIdle,             ///< subscribed to nothing, and requests nothing
  kStayed,           ///< its time in a place for questions is over
};
/// "it subscribed to nothing and requested nothing for 10 min": for the log and for the client.
std::string reason_text(Overdue why, const ClientLimits& limits);

/// A client's subscription.
struct Wanted {
  bool poses = false;
  bool sensors = false;
  bool traces = false;
  bool wind = false;  ///< frames, also without `poses`: then no scenes
};

/// The messages to one client, their order, and its time limits. One message is in flight; behind it wait at most one
/// list of scenes, one frame and one state of the sensors, each replaced by a newer one, and a bounded number of raw
/// traces, which are never replaced. Pure: it has no socket, and time is a parameter.
///
/// The caller writes to_write() to its socket, passes the number of bytes written to written(), and repeats.
/// Thread-safe: no.
class ClientQueue {
 public:
  /// For a client that connected at `now`; `hello` is the first message; null: there is none.
  ClientQueue(const ClientLimits& limits, SharedBytes hello, MonoTime now);

  /// The client subscribes. Sends those that are not null, in this order: scenes, the newest sensors, the newest frame.
  void subscribe(const Wanted& wanted, SharedBytes scenes, SharedBytes newest_frame, SharedBytes newest_sensors,
                 MonoTime now);
  bool is_subscribed() const noexcept { return subscribed_; }

  /// The scenes have changed: `scenes` is sent before the frames that are offered from now on, and the frame that
  /// waits, of the scenes before, is dropped. Scenes that still wait are replaced. Ignored unless poses are subscribed
  /// to.
  void offer_scenes(SharedBytes scenes);
  bool wants_poses() const noexcept { return wanted_.poses; }
  bool wants_frames() const noexcept { return wanted_.poses || wanted_.wind; }

  /// The client sent a request at `now`: it is not idle.
  void requested(MonoTime now) noexcept { asked_ = now; }

  /// After the message in flight only `last` is sent, and nothing that is offered later.
  void dismiss(SharedBytes last);
  bool is_dismissed() const noexcept { return dismissed_; }
  /// Returns true if all has been written to a dismissed client; then it should be disconnected.
  bool is_done() const noexcept { return dismissed_ && setup_.empty() && !in_flight_; }

  /// Replaces a waiting message of the same kind; one in flight is finished. Ignored unless subscribed to.
  void offer_frame(SharedBytes frame);
  void offer_sensors(SharedBytes sensors);

  /// A reply to the client's request: sent before frames and sensors, and never replaced. False if too many wait:
  /// the client sends requests faster than it reads.
  bool offer_reply(SharedBytes reply);

  /// A raw trace: sent in order, never replaced. False if too many wait: it is dropped.
  bool offer_trace(SharedBytes trace);

  /// The rest of the message in flight, or else the next message, which is in flight from `now`. Empty: nothing to
  /// send. Valid until written() has been called for all of it.
  std::span<const std::uint8_t> to_write(MonoTime now);

  /// The socket accepted the first `bytes` of to_write(), at `now`.
  void written(std::size_t bytes, MonoTime now);

  /// The limit that the client has exceeded, if any: it should be disconnected.
  std::optional<Overdue> overdue(MonoTime now) const;

  std::uint64_t frames_sent() const noexcept { return frames_sent_; }
  std::uint64_t frames_skipped() const noexcept { return frames_skipped_; }  ///< replaced while waiting

 private:
  ClientLimits limits_;
  MonoTime connected_;
  MonoTime asked_;  // when it subscribed, or last requested something
  bool subscribed_ = false;
  bool dismissed_ = false;
  Wanted wanted_;

  bool is_greeted_ = false;        // hello, the first of setup_, has been sent or is in flight
  std::deque<SharedBytes> setup_;  // hello and replies: never replaced
  std::deque<SharedBytes> traces_;
  SharedBytes pending_scenes_;
  SharedBytes pending_sensors_;
  SharedBytes pending_frame_;

  SharedBytes in_flight_;
  bool in_flight_is_frame_ = false;
  std::size_t in_flight_written_ = 0;
  MonoTime moved_;  // when the message in flight began, or last progressed

  std::uint64_t frames_sent_ = 0;
  std::uint64_t frames_skipped_ = 0;
};

}  // namespace yuragi::daemon::stream
