#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/base/time.hpp"

namespace yuragi {

/// What an angle in a message is measured from, as far as it matters for a device that stands still. Best first.
enum class WindFrame : std::uint8_t {
  kNorth,     ///< north itself
  kRelative,  ///< the device's own north mark
  kTrue,      ///< the same mark, with the device's own motion taken out
};

/// Which of the messages of one device say its wind. A device with several sentences says one wind in each of them, in
/// one burst; taking all would publish it several times over, each time turned differently.
///
/// One source, the best there is, is taken, and another only when that one has fallen silent. Directions come in one
/// frame for ever, the best that was ever heard: in another they would be wrong by whatever lies between the two.
class WindChoice {
 public:
  /// Who says it, in which sentence, in which frame.
  struct Source {
    std::string name;
    WindFrame frame = WindFrame::kRelative;
    bool operator==(const Source&) const = default;
  };

  enum class Verdict : std::uint8_t {
    kTake,     ///< this is the wind
    kHold,     ///< this is the wind, unless a better one comes in the same burst
    kPass,     ///< another one says it already
    kForeign,  ///< not in the frame that is asked for
  };

  /// `frame`: take this one only; nothing: the best.
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

}  // namespace yuragi
