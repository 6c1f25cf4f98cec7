#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string_view>

#include "daemon/stream/transport.hpp"
#include "engine/base/time.hpp"

namespace yuragi {

struct ClientLimits {
  Nanoseconds subscribe_within = std::chrono::seconds(5);
  Nanoseconds stuck_after = std::chrono::seconds(5);
};

/// Why a client has to go, by the clock.
enum class Overdue : std::uint8_t {
  kNeverSubscribed,  ///< connected, and did not say what it wants
  kStuck,            ///< takes nothing of what is being written to it
};
std::string_view name_of(Overdue why);

/// What one client is sent, in which order, and when it has to go: one message in flight; behind it at most one frame
/// and one state of the sensors, each replaced by a newer one, and a bounded number of raw traces, which are not. Pure:
/// it knows no socket, and time is a parameter.
///
/// The socket's side of it: write what to_write() says, tell written() how much of that the socket took, ask again.
/// Thread-safe: no.
class ClientQueue {
 public:
  /// A client that connected at `now` and is to be greeted with `hello`.
  ClientQueue(const ClientLimits& limits, SharedBytes hello, MonoTime now);

  /// The client's wish. What is not null is sent, in this order: scenes, then the newest of the sensors and frames.
  void subscribe(bool poses, bool sensors, SharedBytes scenes, SharedBytes newest_frame, SharedBytes newest_sensors);
  bool is_subscribed() const noexcept { return subscribed_; }

  /// Newest wins: a frame that waits is replaced, the one in flight is finished. Ignored where the client did not ask.
  void offer_frame(SharedBytes frame);
  void offer_sensors(SharedBytes sensors);

  /// An answer to what the client asked: sent before anything newer, and never replaced. False where as many wait as
  /// may: the client asks faster than it reads.
  bool offer_reply(SharedBytes reply);

  /// A raw trace: sent in its order, and never replaced. False where as many wait as may: it is passed over.
  bool offer_trace(SharedBytes trace);

  /// The rest of the message in flight, or else the next message, which is in flight from `now`. Empty: nothing to
  /// send. Valid until written() has told of all of it.
  std::span<const std::uint8_t> to_write(MonoTime now);

  /// The socket took the first `bytes` of to_write(), at `now`.
  void written(std::size_t bytes, MonoTime now);

  /// Does the client have to go?
  std::optional<Overdue> overdue(MonoTime now) const;

  std::uint64_t frames_sent() const noexcept { return frames_sent_; }
  std::uint64_t frames_skipped() const noexcept { return frames_skipped_; }  ///< replaced while they waited

 private:
  ClientLimits limits_;
  MonoTime connected_;
  bool subscribed_ = false;
  bool wants_poses_ = false;
  bool wants_sensors_ = false;

  std::deque<SharedBytes> setup_;  // hello, scenes and replies: sent first, never replaced
  std::deque<SharedBytes> traces_;
  SharedBytes pending_sensors_;
  SharedBytes pending_frame_;

  SharedBytes in_flight_;
  bool in_flight_is_frame_ = false;
  std::size_t in_flight_written_ = 0;
  MonoTime moved_;  // when the message in flight began, or last went on

  std::uint64_t frames_sent_ = 0;
  std::uint64_t frames_skipped_ = 0;
};

}  // namespace yuragi
