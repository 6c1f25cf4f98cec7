#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "drivers/decode/microphone/mic_block.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::microphone {

// The frames that `yuragi mic-worker` writes to its pipe. All numbers little-endian, real ones IEEE 754.
//
//   bytes  meaning of a frame
//     4    "YMIC"
//     1    version, 1
//     1    kind: 1 hello, 2 block, 3 trouble
//     2    0
//     4    size of the payload, at most kMicMaxPayload
//     4    checksum of the payload (FNV-1a, 32 bits)
//   size   payload
//
//   hello    f64 rate_hz, u8 channels, u8 bands, u16 high_bins, u16 bins[bands], text device
//   block    u64 end_sample, i64 end_mono_ns, u32 lost_samples, u32 invalid_samples,
//            u16 segments, u8 channels, u8 bands,
//            for each channel: f32 high, f32 total, f32 clipped, f32 peak, f32 power[bands]
//            for each pair (mic_pair): f32 real, f32 imaginary for each band
//   trouble  text: what is wrong and what to do

inline constexpr std::size_t kMicMaxPayload = 4096;

/// Why the worker has no sound, for people.
struct MicTrouble {
  std::string message;

  bool operator==(const MicTrouble&) const = default;
};

using MicFrame = std::variant<MicHello, MicBlock, MicTrouble>;

/// A frame as bytes. A text is cut to the maximum size.
std::vector<std::uint8_t> encode_mic_frame(const MicHello& hello);
/// `hello` determines the size of the block.
std::vector<std::uint8_t> encode_mic_frame(const MicBlock& block, const MicHello& hello);
std::vector<std::uint8_t> encode_mic_frame(const MicTrouble& trouble);

/// Finds frames among bytes, however these were split on their way. Bounded; every byte may be hostile.
///
/// A block is accepted only after a hello that it agrees with. Its numbers are finite, powers are not
/// negative, and parts lie between 0 and 1. Thread-safe: no.
class MicFrameReader {
 public:
  struct Item {
    Result<MicFrame, Refusal> frame;
    std::vector<std::uint8_t> bytes;  ///< the whole frame; empty if none was found
  };

  void push(std::span<const std::uint8_t> bytes);

  /// Returns the next frame, or why it is not one: kMalformed (not the protocol: skipped up to the next mark),
  /// kBadChecksum, kNotMine (a block before any hello, or of another shape), kTooShort (a payload that ends too early),
  /// kInvalid (an impossible number). Nullopt: more bytes are needed.
  std::optional<Item> next();

  /// Forgets everything, for a new worker.
  void clear();

  /// Bytes of incomplete frames; after next() has returned nothing, at most one frame.
  std::size_t waiting_bytes() const noexcept { return waiting_.size(); }

 private:
  Result<MicFrame, Refusal> decode(std::uint8_t kind, std::span<const std::uint8_t> payload);

  std::deque<std::uint8_t> waiting_;
  std::optional<MicHello> hello_;
};

}  // namespace yuragi::drivers::decode::microphone
