#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "drivers/windlog/time_of_day.hpp"
#include "drivers/windlog/windlog_cursor.hpp"
#include "drivers/windlog/windlog_playback.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::windlog {

struct PlayerOptions {
  PlaybackOptions playback = {};
  double rate = 1.0;       ///< seconds of the recording in one second; above 0
  double seam_s = 5.0;     ///< how long a jump (a loop's seam, a seek) takes; 0: no cross-fade
  bool is_paused = false;  ///< stand at the first reading until resume() or step()
  /// Begin this many seconds of the recording earlier than asked, so that the scenes have settled in its wind by then.
  /// Not if `is_paused`. Before the recording's beginning, or in a silence, the first reading is held. What cannot be
  /// read of this part is left out.
  double lead_s = 0.0;
  bool at_time_of_day = false;  ///< begin, and begin again, at the place whose recorded local time is the time now
  /// Leave days out of gaps between sessions alone, where all sensors are silent, so that several players of one
  /// recording, each of one sensor, stay together.
  bool stays_with_others = false;
  UtcOffset recorded_offset = machine_utc_offset;  ///< of the place where it was recorded
  UtcOffset offset_here = machine_utc_offset;
};

/// Where a player is.
struct PlayerPosition {
  Nanoseconds log_time{0};  ///< since the recording's first reading
  Nanoseconds length{0};    ///< the log time of the last reading that it plays
  UtcTime recorded{};       ///< when the reading that holds was recorded
  Nanoseconds held_for{0};  ///< from then to this place; below 0 before the first reading
  double rate = 1.0;
  bool is_paused = false;
  bool is_finished = false;  ///< at the end, and it does not loop
  bool loops = false;
  std::uint64_t rounds = 0;  ///< how often it began again
};

/// Plays a recording (.windlog) against a clock that the caller reads: pause, step, seek, rate, loop.
///
/// Each reading comes out with the time at which it was due on the caller's clock, and that time never goes backward,
/// with any order. A jump (a seek, or the seam of a loop) is a cross-fade of `seam_s`: the readings of the old place
/// and of the new one are blended as vectors, so that there is no step; for that a loop begins again `seam_s` before
/// its end. While it is paused it repeats its reading, marked as held, at its usual interval: the wind holds, and the
/// sensor does not become stale. If the recording has a gap, so has the replay; of a gap of days the whole days are
/// left out, so that the time of day goes on as it was.
///
/// A Failure has the reason why the file cannot be read, or does not contain what is requested; an order that fails
/// changes nothing, and play() tries the same place again. Thread-safe: no. Realtime-safe: no; it reads a file.
class Player {
 public:
  using Use = std::function<void(const wind::Reading&)>;

  /// The most readings that one play() gives, at any rate.
  static constexpr int kMaxReadingsPerPlay = 4096;
  static constexpr std::uint64_t kMaxSteps = 1'000'000;

  /// Opens the recording; `now` is when its first moment is due, or the beginning of `lead_s`. `stop`: a request of it
  /// ends any call, however large the recording is, within milliseconds with a failure.
  static Result<Player, Failure> open(const std::filesystem::path& file, PlayerOptions options, const Instant& now,
                                      const std::stop_token& stop = {});

  /// Passes on the readings that are due by now, oldest first; returns when the next one is due. `now` must not go
  /// back. After a halt of more than a second it continues from where it was, and does not play what it missed.
  Result<MonoTime, Failure> play(const Instant& now, const Use& use);

  void pause(const Instant& now);
  void resume(const Instant& now);
  /// Pauses, and moves `count` readings on (at most kMaxSteps), of which the last is handed on by the next play(). At
  /// the end of a recording that does not loop it stays at the last reading.
  Result<void, Failure> step(const Instant& now, std::uint64_t count);
  /// Goes on from a place: seconds from the beginning ("90"), so much further or back ("+30", "-30"), or a moment
  /// (ISO 8601).
  Result<void, Failure> seek(const Instant& now, std::string_view place);
  void set_rate(const Instant& now, double rate);

  PlayerPosition position(MonoTime now) const;
  bool is_paused() const noexcept { return is_paused_; }
  bool is_finished() const noexcept { return is_finished_; }

 private:
  /// One place of the recording that is played. During a jump there are two.
  struct Playhead {
    Cursor cursor;
    std::optional<LoggedReading> upcoming = {};
    std::optional<wind::Reading> current = {};
    MonoTime anchor{};  ///< when `anchor_log` is, or was, due
    Nanoseconds anchor_log{0};
    Nanoseconds last_log{0};  ///< of `current`, or where it began
    bool is_frozen = false;   ///< repeats its last reading

    MonoTime due(double rate) const;
    Nanoseconds place(MonoTime now, double rate) const;
    void go_to(MonoTime at, Nanoseconds log_time);
    void take();
    void leave_out_days(bool only_between_sessions);
  };

  Player(PlayerOptions options, Playhead playing, Playhead leaving, Nanoseconds begin);
  Result<void, Failure> fetch();
  Result<bool, Failure> look_ahead(const Instant& now);
  bool is_before_first_reading(MonoTime now) const;
  MonoTime hold_first_reading(const Instant& now, const Use& use);
  bool is_at_seam() const;
  Result<void, Failure> begin_again(const Instant& now, MonoTime at);
  Result<void, Failure> jump(MonoTime at, Nanoseconds target);
  void settle(MonoTime now);
  Result<MonoTime, Failure> hold(const Instant& now, const Use& use);
  void publish(MonoTime time, const Instant& now, const Use& use);
  void give(wind::Reading reading, MonoTime time, const Instant& now, const Use& use);
  wind::Reading blended(MonoTime time);
  void follow_leaving(MonoTime time);
  void take_while_paused();
  Nanoseconds fade_duration() const;
  bool is_fading(MonoTime time) const { return time < fade_begin_ + fade_; }
  Nanoseconds usual_interval() const;
  Nanoseconds hold_interval() const;
  Nanoseconds place_of_day(const Instant& now);

  PlayerOptions options_;
  Playhead playing_, leaving_;
  double rate_;
  bool is_paused_;
  bool is_finished_ = false;
  bool has_news_ = false;  ///< a reading to publish while paused
  std::uint64_t rounds_ = 0;
  Nanoseconds begin_{0};
  std::optional<Nanoseconds> led_to_;  ///< the place to which a lead-in goes, until a jump
  MonoTime fade_begin_{};
  Nanoseconds fade_{0};
  std::optional<wind::Reading> last_out_;
};

/// The wind between two readings, `part` (0 to 1) of the way from `from` to `to`: as vectors if both have a direction,
/// else by speed. Everything else is of `to`.
wind::Reading between(const wind::Reading& from, const wind::Reading& to, double part);

}  // namespace yuragi::drivers::windlog
