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
/// Speed and direction are chosen each by itself, since a sentence may have one of them only. The best source (sentence
/// and talker) is taken, and another only when that one has fallen silent: has not given its quantity for three of its
/// own pauses, at least 3 s. A direction in another frame, which differs by the angle between the two, is taken only
/// after ten pauses, at least a minute, and until the better one comes back. A direction that is left out in a calm is
/// not silent.
class WindChoice {
 public:
  /// Talker, sentence and frame of a message.
  struct Source {
    std::string name;
    WindFrame frame = WindFrame::kRelative;
    bool operator==(const Source&) const = default;
  };

  /// The content of a message.
  struct Said {
    bool has_speed = false;
    bool has_direction = false;
    bool is_calm = false;  ///< by its speed: no vane turns in it
  };

  /// On the speed.
  enum class Verdict : std::uint8_t {
    kTake,     ///< this is the wind
    kHold,     ///< this is the wind, unless a better one comes in the same burst
    kPass,     ///< the same measurement as another source's, or none
    kForeign,  ///< not in the configured frame
  };

  /// `frame`: accept only this one; nullopt: the best.
  explicit WindChoice(std::optional<WindFrame> frame) : wanted_(frame) {}

  /// Call for a message of `source`.
  Verdict offer(const Source& source, const Said& said, MonoTime now);
  /// Call when the first burst is over: the held values are the wind.
  void settle() noexcept { is_settled_ = true; }

  /// Returns true if the direction of the last message is the wind's.
  bool takes_direction() const noexcept { return takes_direction_; }
  /// The name of the source of the direction; empty: there was no direction yet.
  const std::string& direction_source() const noexcept { return direction_.source.name; }
  /// Between the last two of its directions; zero before.
  Nanoseconds direction_pause() const noexcept { return direction_.pause; }

  /// The device was opened again: its sources of the speed start again. Its frame of direction stays.
  void restart() noexcept;

 private:
  /// The source of a quantity, and when it last gave it.
  struct Chosen {
    Source source;  ///< without a name: none
    MonoTime last{};
    Nanoseconds pause{};  ///< between the last two

    bool is_any() const noexcept { return !source.name.empty(); }
    void hear(MonoTime now) noexcept;
    bool is_silent(MonoTime now, int pauses, Nanoseconds at_least) const noexcept;
  };

  bool offer_direction(const Source& source, MonoTime now);
  Verdict offer_speed(const Source& source, MonoTime now);

  std::optional<WindFrame> wanted_;
  Chosen speed_;
  Chosen direction_;
  bool takes_direction_ = false;
  bool is_settled_ = false;
};

}  // namespace yuragi::drivers::text
