#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "daemon/follow/node_history.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::follow {

/// The stream of JetStream that stores the history of a channel: "yuragi_wind" of "wind". Dots and all else that a name
/// of a stream cannot hold become "_".
std::string history_stream_of(const std::string& channel);
/// The subject of the history: what a daemon publishes there is stored.
std::string history_subject_of(const std::string& channel);

/// A request to JetStream: a subject, and JSON. Whoever sends it expects the reply at its inbox.
struct StreamRequest {
  std::string subject;
  std::vector<std::uint8_t> bytes;
};

/// Makes the stream: 25 hours, 64 MiB, so many replicas.
StreamRequest make_stream(const std::string& channel, int replicas);
/// Has all of the history sent to `inbox`, with the number of its messages as reply. `rate_bit_s`: the most that is
/// sent; 0: no limit.
StreamRequest read_stream(const std::string& channel, const std::string& inbox, std::uint64_t rate_bit_s);

/// A reply of JetStream.
struct StreamReply {
  enum class Kind : std::uint8_t {
    kStored,  ///< a message of the history is stored, or not
    kMade,    ///< of make_stream()
    kReads,   ///< of read_stream()
  };
  Kind kind = Kind::kStored;
  std::uint64_t error = 0;     ///< JetStream's number (err_code, or its code); 0: success
  std::string trouble = {};    ///< the description of the error
  std::string reader = {};     ///< of kReads: what JetStream calls it
  std::uint64_t messages = 0;  ///< of kReads: how many will come

  bool is_success() const noexcept { return error == 0; }
};

/// A failure (kBadData) has a clause without a subject. A reply of another kind is refused.
Result<StreamReply, Failure> decode_stream_reply(std::span<const std::uint8_t> bytes);

/// A leader's part of the history: makes the stream, reads it once, and ends the reading. Without JetStream nobody
/// replies: then it asks again, once a minute at last. Pure; belongs to one thread.
class HistoryStream {
 public:
  static constexpr std::chrono::seconds kMinWait{2}, kMaxWait{60};
  /// Reading is over if no message comes for this long.
  static constexpr std::chrono::seconds kMaxSilence{10};
  /// The most that a leader reads, so that its ticks have room beside it.
  static constexpr std::uint64_t kMaxRate_bit_s = 8'000'000;

  using Send = std::function<void(const StreamRequest& request)>;

  HistoryStream(std::string channel, Send send) : channel_(std::move(channel)), send_(std::move(send)) {}

  /// Begins anew: this daemon leads from now on. Replies come to `inbox`.
  void begin(std::string inbox, MonoTime now);
  /// Call it about once a second while this daemon leads and is connected.
  void advance(MonoTime now);
  /// Takes a reply to a request of this class.
  void take_reply(const StreamReply& reply, MonoTime now);
  /// A message of the history has come.
  void note_message(MonoTime now);

 private:
  enum class Step : std::uint8_t { kNone, kMakes, kAsksToRead, kReads };
  void go_on(Step step, MonoTime now);
  void end_reading();

  const std::string channel_;
  Send send_;
  std::string inbox_, reader_, trouble_;
  Step step_ = Step::kNone;
  int replicas_ = 0;
  MonoTime next_{}, heard_{};
  Nanoseconds wait_{};
  std::uint64_t come_ = 0, expected_ = 0;
};

}  // namespace yuragi::daemon::follow
