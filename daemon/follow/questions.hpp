#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "daemon/follow/fleet.hpp"
#include "daemon/follow/same_picture.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::follow {

/// What a follower asks a leader for, and the replies. All of it comes from a network: whatever is not well-formed is
/// refused. Encoding allocates. Thread-safe.
using Bytes = std::vector<std::uint8_t>;

struct Question {
  enum class About : std::uint8_t {
    kLeader,  ///< who leads, with what: Introduction
    kTicks,   ///< those of an epoch from one number to another: Ticks, as far as they are still there
    kState,   ///< the state of its scenes: StateParts
    kFleet,   ///< the daemons that it has heard: NodeLists
  };
  About about = About::kLeader;
  std::uint64_t epoch = 0, from = 0, to = 0;
};

/// JSON, so that a build with other versions reads it and can name what differs.
struct Introduction {
  std::uint64_t epoch = 0;
  double delay_s = 0.0;
  PictureMakeup makeup;
};

/// Some ticks, each as wire::lead::encode() made it.
struct Ticks {
  std::vector<Bytes> ticks;
};

/// A part of the state of the leader's scenes after the tick `number`.
struct StatePart {
  std::uint64_t epoch = 0, number = 0;
  std::uint64_t made_of = 0;  ///< PictureMakeup::hash()
  std::uint64_t total_bytes = 0, first_byte = 0;
  Bytes bytes;
};

using Reply = std::variant<Introduction, Ticks, StatePart, NodeList>;

/// The most bytes of ticks or of a state in one message; NATS takes 1 MB.
inline constexpr std::size_t kMostInMessage_bytes = 128UL * 1024;
/// The largest state: many times the garden's.
inline constexpr std::size_t kMaxState_bytes = 64U << 20U;

Bytes encode(const Question& question);
Bytes encode(const Introduction& introduction);
Bytes encode(const Ticks& ticks);
Bytes encode(const StatePart& part);
Bytes encode(const NodeList& list);

/// A failure (kBadData) has a clause without a subject.
Result<Question, Failure> decode_question(std::span<const std::uint8_t> bytes);
Result<Reply, Failure> decode_reply(std::span<const std::uint8_t> bytes);

}  // namespace yuragi::daemon::follow
