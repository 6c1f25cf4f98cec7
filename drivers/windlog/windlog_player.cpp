#include "drivers/windlog/windlog_player.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "engine/wind/wind_vector.hpp"

namespace yuragi::drivers::windlog {
namespace {

// Later than this (the machine was suspended) it goes on from where it was.
constexpr Nanoseconds kMaxLateness = std::chrono::seconds(1);
// A longer wait counts as endless, because a clock could not hold it. About 30 years.
constexpr double kMaxWait_s = 1e9;
// Stands for "never" after the end; a clock can add this to any time.
constexpr Nanoseconds kAfterTheEnd = std::chrono::hours(24);
// The minimum of readings in a cross-fade, or it would be a step; and its maximum part of the recording.
constexpr int kMinReadingsOfFade = 3;
constexpr int kParts = 3;
// A held reading is repeated no more often than this.
constexpr Nanoseconds kMinHoldInterval = std::chrono::milliseconds(100);

/// A difference of times from `duration_s`, which can be anything.
Nanoseconds wait_of(double duration_s) {
  const std::chrono::duration<double> wait(std::clamp(duration_s, -kMaxWait_s, kMaxWait_s));
  return std::chrono::round<Nanoseconds>(wait);
}

std::chrono::days whole_days(Nanoseconds gap) {
  return std::chrono::duration_cast<std::chrono::days>(gap);
}

/// The whole days of each gap between two sessions, or of what is left of it from a log time on, up to another.
std::chrono::days days_between(std::span<const LoggedSession> sessions, Nanoseconds from, Nanoseconds to) {
  std::chrono::days days{0};
  for (std::size_t next = 1; next < sessions.size() && sessions[next].log_begin <= to; ++next) {
    const Nanoseconds gap_begin = std::max(sessions[next - 1].log_end(), from);
    if (sessions[next].log_begin > gap_begin) days += whole_days(sessions[next].log_begin - gap_begin);
  }
  return days;
}

bool is_same_wind(const wind::Reading& a, const wind::Reading& b) {
  return a.speed_m_s == b.speed_m_s && a.direction_deg == b.direction_deg;
}

/// Returns the seconds after a sign: "+30", "-12.5"; nullopt for a text of another form.
std::optional<double> parse_relative(std::string_view text) {
  if (text.size() < 2 || (text.front() != '+' && text.front() != '-')) return std::nullopt;
  double by_s = 0.0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), by_s);
  if (error != std::errc{} || end != text.data() + text.size() || !(by_s >= 0.0) || by_s > kMaxWait_s) {
    return std::nullopt;
  }
  return text.front() == '-' ? -by_s : by_s;
}

}  // namespace

wind::Reading between(const wind::Reading& from, const wind::Reading& to, double part) {
  wind::Reading reading = to;
  reading.speed_m_s = from.speed_m_s + part * (to.speed_m_s - from.speed_m_s);
  if (from.gust_m_s && to.gust_m_s) reading.gust_m_s = *from.gust_m_s + part * (*to.gust_m_s - *from.gust_m_s);
  if (!from.direction_deg || !to.direction_deg) return reading;
  const wind::Vector old_wind = wind::wind_from(from.speed_m_s, *from.direction_deg);
  const wind::Vector wind = old_wind + part * (wind::wind_from(to.speed_m_s, *to.direction_deg) - old_wind);
  reading.speed_m_s = speed_of(wind);
  // Where two opposite winds cancel out there is no direction; that of the new one is as good.
  if (reading.speed_m_s > 0.0) reading.direction_deg = wind::direction_from_deg(wind);
  return reading;
}

// ---- a playhead: one place of the recording that is played ----

MonoTime Player::Playhead::due(double rate) const {
  return anchor + wait_of(seconds(upcoming->log_time - anchor_log) / rate);
}

Nanoseconds Player::Playhead::place(MonoTime now, double rate) const {
  return anchor_log + wait_of(seconds(now - anchor) * rate);
}

void Player::Playhead::go_to(MonoTime at, Nanoseconds log_time) {
  anchor = at;
  anchor_log = log_time;
  last_log = log_time;
  is_frozen = false;
}

void Player::Playhead::take() {
  current = upcoming->reading;
  last_log = upcoming->log_time;
  upcoming.reset();
}

/// Leaves the whole days out of the gap before the upcoming reading, or of the gaps between sessions in it.
void Player::Playhead::leave_out_days(bool only_between_sessions) {
  const auto days = whole_days(upcoming->log_time - last_log);
  if (days.count() <= 0) return;
  anchor_log += only_between_sessions ? days_between(cursor.reader().sessions(), last_log, upcoming->log_time) : days;
}

// ---- playing ----

Result<Player, Failure> Player::open(const std::filesystem::path& file, PlayerOptions options, const Instant& now,
                                     const std::stop_token& stop) {
  auto playing = Cursor::open(file, options.playback.sensor, stop);
  if (!playing) return playing.error();
  auto leaving = Cursor::open(file, options.playback.sensor, stop);
  if (!leaving) return leaving.error();
  const auto begin = begin_of_playback(*playing, options.playback.start);
  if (!begin) return begin.error();
  Player player(std::move(options), Playhead{.cursor = std::move(*playing)}, Playhead{.cursor = std::move(*leaving)},
                *begin);
  const Nanoseconds place = player.options_.at_time_of_day ? player.place_of_day(now) : *begin;
  const Nanoseconds lead = player.is_paused_ ? Nanoseconds{0} : wait_of(player.options_.lead_s);
  if (lead > Nanoseconds{0}) player.led_to_ = place;
  const Nanoseconds from = std::max(place - lead, Nanoseconds{0});
  player.playing_.cursor.seek(from);
  player.playing_.go_to(now.mono + wait_of(seconds(lead - (place - from)) / player.rate_), from);
  return player;
}

Player::Player(PlayerOptions options, Playhead playing, Playhead leaving, Nanoseconds begin)
    : options_(std::move(options)),
      playing_(std::move(playing)),
      leaving_(std::move(leaving)),
      rate_(options_.rate),
      is_paused_(options_.is_paused),
      begin_(begin) {}

Result<MonoTime, Failure> Player::play(const Instant& now, const Use& use) {
  if (is_finished_) return now.mono + kAfterTheEnd;
  if (is_paused_) return hold(now, use);
  for (int count = 0;; ++count) {
    const auto has_more = look_ahead(now);
    if (!has_more) return has_more.error();
    if (!*has_more) return now.mono + kAfterTheEnd;
    const MonoTime due = playing_.due(rate_);
    if (is_before_first_reading(now.mono)) return std::min(due, hold_first_reading(now, use));
    if (due > now.mono || count == kMaxReadingsPerPlay) return due;
    if (const Nanoseconds late = now.mono - due; late > kMaxLateness) {
      playing_.anchor += late;
      leaving_.anchor += late;
      fade_begin_ += late;
    } else if (is_at_seam()) {
      if (const auto begun = begin_again(now, due); !begun) return begun.error();
    } else {
      playing_.take();
      publish(due, now, use);
    }
  }
}

/// Reads the upcoming reading, unless it is already there, or the end is reached.
Result<void, Failure> Player::fetch() {
  if (playing_.upcoming) return {};
  auto read = playing_.cursor.next();
  if (!read && led_to_ && playing_.last_log < *led_to_) {
    playing_.cursor.seek(*led_to_);
    read = playing_.cursor.next();
  }
  if (!read) return read.error();
  playing_.upcoming = *read;
  if (playing_.upcoming) playing_.leave_out_days(options_.stays_with_others);
  return {};
}

/// Returns true if there is an upcoming reading. At the end it begins again, or is finished.
Result<bool, Failure> Player::look_ahead(const Instant& now) {
  if (const auto fetched = fetch(); !fetched) return fetched.error();
  if (playing_.upcoming) return true;
  if (options_.playback.loop) {
    const auto begun = begin_again(now, last_out_ ? last_out_->time.mono + usual_interval() : now.mono);
    if (!begun) return begun.error();
  }
  is_finished_ = !playing_.upcoming;
  return !is_finished_;
}

/// Is this part of a lead-in without a reading, where the first one is held? Not if it comes later than usual after the
/// place to which the lead-in goes: the recording is silent there.
bool Player::is_before_first_reading(MonoTime now) const {
  return led_to_ && !playing_.current && playing_.upcoming && playing_.due(rate_) > now &&
         playing_.upcoming->log_time <= *led_to_ + playing_.cursor.interval();
}

/// Returns when it is due again.
MonoTime Player::hold_first_reading(const Instant& now, const Use& use) {
  const MonoTime due = last_out_ ? last_out_->time.mono + hold_interval() : now.mono;
  if (due > now.mono) return due;
  give(playing_.upcoming->reading, now.mono, now, use);
  return now.mono + hold_interval();
}

/// Has a loop come to where its next round begins, under what is left of this one?
bool Player::is_at_seam() const {
  if (!options_.playback.loop || is_fading(playing_.due(rate_))) return false;
  const Nanoseconds overlap = wait_of(seconds(fade_duration()) * rate_);
  return overlap > Nanoseconds{0} && playing_.upcoming->log_time > playing_.cursor.last() - overlap;
}

Result<void, Failure> Player::begin_again(const Instant& now, MonoTime at) {
  if (auto jumped = jump(at, options_.at_time_of_day ? place_of_day(now) : begin_); !jumped) return jumped;
  // Its first reading comes at once, so that the seam is no longer than any interval.
  playing_.anchor_log = playing_.upcoming->log_time;
  ++rounds_;
  return {};
}

/// Goes on from `target` at a moment, and fades what was playing out.
Result<void, Failure> Player::jump(MonoTime at, Nanoseconds target) {
  led_to_.reset();
  // In the middle of a fade the blended wind of that moment replaces both playheads, and the older one is free.
  const bool was_fading = is_fading(at);
  leaving_.is_frozen = true;
  leaving_.cursor.seek(target);
  const auto first = leaving_.cursor.next();
  if (!first) return first.error();
  leaving_.upcoming = *first;
  if (!leaving_.upcoming) return Failure{"there is no reading after that time", FailureKind::kUsage};

  std::swap(playing_, leaving_);
  playing_.go_to(at, target);
  playing_.leave_out_days(options_.stays_with_others);
  playing_.current.reset();
  if (was_fading) {
    leaving_.is_frozen = true;
    leaving_.current = last_out_;
  }
  fade_begin_ = at;
  fade_ = leaving_.current ? fade_duration() : Nanoseconds{0};
  return {};
}

Nanoseconds Player::fade_duration() const {
  if (options_.seam_s <= 0.0) return Nanoseconds{0};
  const double interval_s = seconds(playing_.cursor.interval()) / rate_;
  const double span_s = seconds(playing_.cursor.last() - begin_) / rate_;
  return wait_of(std::min(std::max(options_.seam_s, kMinReadingsOfFade * interval_s), span_s / kParts));
}

/// Publishes the last reading of the playing playhead, as of a time, blended with that of one that is fading out.
void Player::publish(MonoTime time, const Instant& now, const Use& use) {
  // After a change of the rate: time does not go backward.
  if (last_out_) time = std::max(time, last_out_->time.mono);
  give(blended(time), time, now, use);
}

void Player::give(wind::Reading reading, MonoTime time, const Instant& now, const Use& use) {
  const bool is_waiting = is_paused_ || is_before_first_reading(now.mono);
  reading.time = {time, now.utc - (now.mono - time)};
  reading.is_held = is_waiting && last_out_ && is_same_wind(reading, *last_out_);
  last_out_ = reading;
  use(reading);
}

wind::Reading Player::blended(MonoTime time) {
  if (!is_fading(time)) return *playing_.current;
  const double done = std::max(0.0, seconds(time - fade_begin_) / seconds(fade_));
  const double part = done * done * (3.0 - 2.0 * done);
  follow_leaving(time);
  return between(*leaving_.current, *playing_.current, part);
}

/// Advances the playhead that is fading out to a time; on a read error it repeats its last reading.
void Player::follow_leaving(MonoTime time) {
  if (leaving_.is_frozen || is_paused_) return;
  for (;;) {
    if (!leaving_.upcoming) {
      const auto read = leaving_.cursor.next();
      leaving_.is_frozen = read.has_error();
      if (!read) return;
      leaving_.upcoming = *read;
    }
    if (!leaving_.upcoming || leaving_.due(rate_) > time) return;
    leaving_.take();
  }
}

/// While it is paused: repeats the reading, so that the sensor does not become stale.
Result<MonoTime, Failure> Player::hold(const Instant& now, const Use& use) {
  if (!playing_.current) {
    const auto has_more = look_ahead(now);
    if (!has_more) return has_more.error();
    if (!*has_more) return now.mono + kAfterTheEnd;
    take_while_paused();
  }
  const MonoTime due = has_news_ || !last_out_ ? now.mono : last_out_->time.mono + hold_interval();
  if (due > now.mono) return due;
  has_news_ = false;
  publish(now.mono, now, use);
  return now.mono + hold_interval();
}

void Player::take_while_paused() {
  playing_.anchor_log = playing_.upcoming->log_time;
  playing_.take();
  has_news_ = true;
}

Nanoseconds Player::usual_interval() const {
  return std::max(wait_of(seconds(playing_.cursor.interval()) / rate_), Nanoseconds{std::chrono::microseconds(1)});
}

Nanoseconds Player::hold_interval() const {
  return std::max(usual_interval(), kMinHoldInterval);
}

Nanoseconds Player::place_of_day(const Instant& now) {
  const Nanoseconds wanted = time_of_day(now.utc, options_.offset_here);
  const auto sessions = playing_.cursor.reader().sessions();
  const auto place = find_time_of_day(sessions, begin_, wanted, options_.recorded_offset);
  return place && *place <= playing_.cursor.last() ? *place : begin_;
}

// ---- orders ----

/// Anchors both playheads where they are now: the rate is about to change.
void Player::settle(MonoTime now) {
  for (Playhead* playhead : {&playing_, &leaving_}) {
    if (!is_paused_) playhead->anchor_log = playhead->place(now, rate_);
    playhead->anchor = now;
  }
}

void Player::pause(const Instant& now) {
  settle(now.mono);
  is_paused_ = true;
}

void Player::resume(const Instant& now) {
  settle(now.mono);
  is_paused_ = false;
}

void Player::set_rate(const Instant& now, double rate) {
  settle(now.mono);
  rate_ = rate;
}

Result<void, Failure> Player::step(const Instant& now, std::uint64_t count) {
  if (is_finished_) return Failure{"is at its end; seek to another place first", FailureKind::kUsage};
  if (count > kMaxSteps) {
    return Failure{"can move at most " + std::to_string(kMaxSteps) + " readings; use seek to move further",
                   FailureKind::kUsage};
  }
  pause(now);
  for (std::uint64_t moved = 0; moved < count; ++moved) {
    if (auto fetched = fetch(); !fetched) return fetched;
    if (!playing_.upcoming && options_.playback.loop) {
      if (auto begun = begin_again(now, now.mono); !begun) return begun;
    }
    if (!playing_.upcoming && moved == 0) return Failure{"is at its last reading", FailureKind::kUsage};
    if (!playing_.upcoming) return {};
    take_while_paused();
  }
  return {};
}

Result<void, Failure> Player::seek(const Instant& now, std::string_view place) {
  Nanoseconds target{0};
  if (const auto by_s = parse_relative(place)) {
    target = std::max(Nanoseconds{0}, position(now.mono).log_time + wait_of(*by_s));
  } else {
    const auto moment = parse_log_moment(place);
    if (!moment) return moment.error();
    const auto found = playing_.cursor.find(*moment);
    if (!found) return found.error();
    target = found->value_or(Nanoseconds::max());
  }
  if (target > playing_.cursor.last()) {
    return Failure{std::string(place) + " is after its last reading, which is at " +
                       std::to_string(seconds(playing_.cursor.last())) + " s",
                   FailureKind::kUsage};
  }
  settle(now.mono);
  if (auto jumped = jump(now.mono, target); !jumped) return jumped;
  is_finished_ = false;
  if (is_paused_) take_while_paused();
  return {};
}

PlayerPosition Player::position(MonoTime now) const {
  const Nanoseconds last = playing_.cursor.last();
  Nanoseconds place = is_paused_ ? playing_.anchor_log : playing_.place(now, rate_);
  const Nanoseconds held_for =
      place - (playing_.current || !playing_.upcoming ? playing_.last_log : playing_.upcoming->log_time);
  if (is_finished_) place = last;
  return {.log_time = std::clamp(place, Nanoseconds{0}, last),
          .length = last,
          .recorded = playing_.current    ? playing_.current->time.utc
                      : playing_.upcoming ? playing_.upcoming->reading.time.utc
                                          : UtcTime{},
          .held_for = held_for,
          .rate = rate_,
          .is_paused = is_paused_,
          .is_finished = is_finished_,
          .loops = options_.playback.loop,
          .rounds = rounds_};
}

}  // namespace yuragi::drivers::windlog
