#include "daemon/sensing/sensor_jury.hpp"

#include <algorithm>

namespace yuragi::daemon::sensing {
namespace {

wind::judging::ReadingJudge judge_of(const JuryRules& rules) {
  return wind::judging::ReadingJudge(rules.judge.value_or(wind::judging::JudgeSettings{}));
}

}  // namespace

JuryRules jury_rules_of(const settings::SensorConfig& sensor) {
  return {
      .judge = sensor.judge,
      .is_compared = sensor.judge && sensor.is_compared && !sensor.blend.is_relative && makes_wind(sensor.blend.value),
      .unchanged_for_s = sensor.blend.unchanged_for_s};
}

SensorJury::SensorJury(const std::vector<JuryRules>& sensors, double stale_intervals, bool is_levelling)
    : stale_intervals_(stale_intervals),
      vote_(sensors.size()),
      is_levelling_(is_levelling),
      gains_(sensors.size()),
      group_(sensors.size()) {
  for (const JuryRules& rules : sensors) {
    members_.push_back(
        {.rules = rules, .judge = judge_of(rules), .record = wind::blend::SourceRecord(rules.unchanged_for_s)});
  }
}

SensorJury::Verdict SensorJury::hear(std::size_t sensor, const wind::Reading& reading) noexcept {
  Member& member = members_[sensor];
  if (!wind::is_plausible(reading)) {
    count_impossible(sensor, 1);
    return Verdict::kDropped;
  }
  if (member.record.has_reading() && reading.time.mono < member.record.last()->time.mono) return Verdict::kDropped;
  if (reading.is_held) {
    member.record.hold(reading.time);
    return Verdict::kBelieved;
  }
  const bool repeats = member.record.has_reading() && wind::has_same_values(reading, *member.record.last());
  if (!member.record.take(reading) && repeats) {
    // A repeated message has been judged.
    return member.is_last_believed ? Verdict::kBelieved : Verdict::kDoubted;
  }
  // The estimator recognizes a repeated reading by its bits.
  if (!repeats) member.gain = is_levelled(sensor) ? gains_.gain(sensor) : 1.0;

  // Simulated readings are not judged: they may be constant.
  const bool is_judged = member.rules.judge && reading.quality != wind::ReadingQuality::kSimulated;
  const bool makes_sense = !is_judged || member.judge.judge(reading, vote_.others_m_s(sensor));
  if (makes_sense) vote_.accept(sensor, reading.time.mono, reading.speed_m_s);
  member.is_last_believed = makes_sense && vote_.vote_on(sensor) != wind::judging::Vote::kOutvoted;
  return member.is_last_believed ? Verdict::kBelieved : Verdict::kDoubted;
}

wind::Reading SensorJury::levelled(std::size_t sensor, wind::Reading reading) const noexcept {
  const double gain = members_[sensor].gain;
  if (gain == 1.0) return reading;
  reading.speed_m_s = std::min(gain * reading.speed_m_s, wind::kMaxPlausibleSpeed_m_s);
  if (reading.gust_m_s) reading.gust_m_s = std::min(gain * *reading.gust_m_s, wind::kMaxPlausibleSpeed_m_s);
  return reading;
}

void SensorJury::count_impossible(std::size_t sensor, std::uint64_t readings) noexcept {
  Member& member = members_[sensor];
  if (member.rules.judge) member.judge.count_impossible(readings);
}

void SensorJury::compare(MonoTime now) noexcept {
  for (std::size_t sensor = 0; sensor < members_.size(); ++sensor) {
    const Member& member = members_[sensor];
    const wind::SourceReport report = member.record.report(now, stale_intervals_);
    const bool is_measured = report.last && report.last->quality != wind::ReadingQuality::kSimulated;
    const bool is_well =
        report.health == wind::SourceHealth::kLive && member.judge.fault() <= wind::judging::ReadingFault::kSpike;
    vote_.set_comparable(sensor, member.rules.is_compared && is_measured && is_well);
  }
  vote_.advance(now);
  if (!is_levelling_) return;
  for (std::size_t sensor = 0; sensor < members_.size(); ++sensor) {
    const bool is_in = vote_.agrees(sensor) && vote_.vote_on(sensor) == wind::judging::Vote::kNone;
    group_[sensor] = {.is_in = is_in, .mean_m_s = vote_.mean_m_s(sensor)};
  }
  gains_.advance(now, group_);
}

bool SensorJury::restore_gains(std::span<const wind::judging::GroupGains::Learnt> learnt) {
  if (!is_levelling_) return true;  // there is nothing that it could be wrong for
  if (learnt.size() != members_.size()) return false;
  std::vector<wind::judging::GroupGains::Learnt> compared(learnt.begin(), learnt.end());
  for (std::size_t sensor = 0; sensor < members_.size(); ++sensor) {
    if (!members_[sensor].rules.is_compared) compared[sensor] = {};
  }
  return gains_.restore(compared);
}

double SensorJury::reads_times_group(std::size_t sensor) const noexcept {
  return is_levelled(sensor) ? gains_.reads_times_group(sensor) : 1.0;
}

void SensorJury::change(std::size_t sensor, const JuryRules& rules) {
  Member& member = members_[sensor];
  // A judge that has not judged has nothing to keep.
  if (member.rules.judge && rules.judge) member.judge.change(*rules.judge);
  if (member.rules.judge.has_value() != rules.judge.has_value()) member.judge = judge_of(rules);
  member.rules = rules;
}

void SensorJury::recalibrate(std::size_t sensor,
                             const std::optional<std::pair<wind::Reading, wind::Reading>>& last) noexcept {
  if (last) members_[sensor].judge.recalibrate(last->first, last->second);
  vote_.forget_mean(sensor);
  gains_.relearn(sensor);
}

}  // namespace yuragi::daemon::sensing
