#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/base/time.hpp"

namespace yuragi::drivers::text {

/// What an angle in a message is measured from, as far as it matters for a device that stands still. Best first.
enum class WindFrame : std::uint8_t {
  kNorth,     ///< north itself
  kRelative,  ///< the device's own north mark
  kTrue,      ///< the same mark, with the device's own motion taken out
};

/// Selects which of a device's messages to publish. A device with several sentences repeats one measurement in each of
/// them, in one burst; taking all would publish it several times, in different frames.
///
/// The best source (sentence and talker) is taken, and another only when that one has fallen silent. Directions are in
/// one frame throughout, the best one received so far: in another they would differ by the angle between the two.
class WindChoice {
 public:
  /// Talker, sentence and frame of a message.
  struct Source {
    std::string name;
    WindFrame frame = WindFrame::kRelative;
    bool operator==(const Source&) const = default;
  };

  enum class Verdict : std::uint8_t {
    kTake,     ///< this is the wind
    kHold,     ///< this is the wind, unless a better one comes in the same burst
    kPass,     ///< the same measurement as another source's
    kForeign,  ///< not in the configured frame
  };

  /// `frame`: accept only this one; nothing: the best.
  explicit WindChoice(std::optional<WindFrame> frame) : wanted_(frame) {}

  /// A message of `source` has come.
  Verdict offer(const Source& source, MonoTime now);
  /// The first burst is over: what was held is the wind.
  void settle() noexcept { is_settled_ = true; }
  /// Is the direction of what was just taken in the one frame?
  bool has_direction() const noexcept { return current_ && current_->frame == best_frame_; }
  /// The device was opened again: its sources begin anew. Its frame stays.
  void restart() noexcept;

 private:
  std::optional<WindFrame> wanted_;
  std::optional<Source> current_;
  std::optional<WindFrame> best_frame_;
  bool is_settled_ = false;
  MonoTime last_{};
  Nanoseconds pause_{};  // between the last two of the current source
};

}  // namespace yuragi::drivers::text
