#include "engine/wire/lead/wind_tick.hpp"

#include "engine/base/snapshot.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wire::lead {
namespace {

/// In the place of what an object's snapshot was made of.
constexpr std::uint64_t kMark = 0x7769'6e64'7469'0000U + kWindTickVersion;

/// More than any shaped wind has.
constexpr double kMaxSpeed_m_s = 250.0;

void list_speed(StatePass& pass, wind::Vector& speed) {
  pass.within(speed.u_m_s, -kMaxSpeed_m_s, kMaxSpeed_m_s);
  pass.within(speed.v_m_s, -kMaxSpeed_m_s, kMaxSpeed_m_s);
}

/// All of it: Wind::list_state() leaves out what its maker does not change.
void list_ground(StatePass& pass, wind::ground::Wind& ground) {
  for (wind::Vector* const speed : {&ground.everywhere, &ground.breeze, &ground.advection}) list_speed(pass, *speed);
  wind::ground::WindSlope& slope = ground.slope;
  pass(slope, slope.west_m, slope.north_m);
  // The plane's ends are the limits of a clamp.
  pass.within(slope.east_m, slope.west_m, StatePass::kLargest);
  pass.within(slope.south_m, slope.north_m, StatePass::kLargest);
  pass(ground.gusts);
  pass.within(ground.gusts.gustiness, 0.0, 2.0);  // an exponent
  pass.within(ground.gusts.fronts, 0.0, 10.0);
  pass.within(ground.gain, 0.0, 100.0);
  pass.within(ground.gust_gain, 0.0, 100.0);
}

}  // namespace

void WindTick::list_state(StatePass& pass) {
  pass(epoch, number, utc);
  std::size_t periods_before_it = periods - 1U;
  pass.index(periods_before_it, kMaxTickPeriods);
  periods = static_cast<std::uint32_t>(periods_before_it) + 1;
  pass.index(cue_count, kMaxCues + 1);
  pass(std::span(cues).first(cue_count), wind.state);
  list_ground(pass, wind.ground);
  pass.index(wind.stroke.pen_count, wind::ground::WindStroke::kMaxPens + 1);
  pass(wind.stroke);
}

std::vector<std::uint8_t> encode(const WindTick& tick) {
  WindTick listed = tick;
  std::vector<std::uint8_t> state;
  StatePass pass = StatePass::saving(state, tick.wind.state.time);
  listed.list_state(pass);
  return closed_snapshot(state, kMark);
}

Result<WindTick, Failure> decode_wind_tick(std::span<const std::uint8_t> bytes, MonoTime now) {
  if (bytes.size() > kMaxWindTick_bytes) return state_failure(StatePass::Problem::kLengthDiffers);
  const auto state = opened_snapshot(bytes, kMark);
  if (!state) return state.error();
  // Into a tick of its own, which is dropped if a number is refused: so no pass that checks need come before.
  WindTick tick;
  StatePass pass = StatePass::loading(*state, now);
  tick.list_state(pass);
  if (pass.problem() != StatePass::Problem::kNone) return state_failure(pass.problem());
  if (speed_of(tick.wind.state.wind) > kMaxSpeed_m_s) return state_failure(StatePass::Problem::kOutOfRange);
  return tick;
}

}  // namespace yuragi::wire::lead
