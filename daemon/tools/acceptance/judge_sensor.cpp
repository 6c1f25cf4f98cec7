#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>

#include <fmt/format.h>

#include "daemon/sensing/refusal_text.hpp"
#include "daemon/tools/acceptance/acceptance.hpp"
#include "drivers/decode/refusal.hpp"

namespace yuragi::daemon::tools::acceptance {
namespace {

class VerdictBuilder {
 public:
  void fail(std::string why) { add(Outcome::kFailed, std::move(why)); }
  void remark(std::string what) { add(Outcome::kRemark, std::move(what)); }
  SensorVerdict take() { return std::move(verdict_); }

 private:
  void add(Outcome outcome, std::string text) {
    verdict_.outcome = std::max(verdict_.outcome, outcome);
    verdict_.remarks.push_back(std::move(text));
  }
  SensorVerdict verdict_;
};

void judge_readings(VerdictBuilder& verdict, const SensorMeasured& sensor) {
  const wire::SensorStatus& status = sensor.status;
  if (status.simulated) verdict.remark("its readings are synthetic: no device was measured");
  if (status.replayed) verdict.remark("it plays a recording: no device was measured");
  if (!is_believed(status.state))
    verdict.fail(
        fmt::format("its readings are not used at the end: {}: {}", name_of(status.state), status.state_reason));
  // Messages of others, or of this sensor about other things, are not faults: a hub sends its own state between two
  // winds.
  const std::string_view not_mine = name_of(drivers::decode::Refusal::kNotMine);
  const double refused = std::accumulate(
      status.refused.begin(), status.refused.end(), 0.0,
      [&](double sum, const auto& one) { return one.first == not_mine ? sum : sum + static_cast<double>(one.second); });
  if (refused > kMaxRefusedShare * (refused + static_cast<double>(status.readings)))
    verdict.remark("many of its messages were refused: " + sensing::refusal_text(status));
  if (status.reconnects > 0) verdict.remark(fmt::format("it was lost and found again {} times", status.reconnects));
}

void judge_change(VerdictBuilder& verdict, const SensorMeasured& sensor) {
  if (sensor.least_speed_m_s && sensor.least_speed_m_s == sensor.largest_speed_m_s) {
    verdict.remark(fmt::format("it read {:.2f} m/s all the time: check that it turns, or repeat this in wind",
                               *sensor.least_speed_m_s));
  }
}

void judge_way_to_pose(VerdictBuilder& verdict, const SensorMeasured& sensor) {
  if (sensor.frames == 0)
    return verdict.fail("no frame came: the configuration shows no scene, or the machine is too slow");
  if (sensor.moved_frames == 0) verdict.fail("no pose moved");
  if (sensor.largest_live_weight < kMinLiveWeight) {
    verdict.fail(fmt::format("it did not take over the wind of the scenes (its part reached {:.0f} %)",
                             100.0 * sensor.largest_live_weight));
  }
  if (!sensor.median_delay_s) {
    verdict.remark("the delay from a reading to a pose could not be measured: too few readings");
  } else if (*sensor.median_delay_s > kMaxMedianDelay_s) {
    verdict.remark(fmt::format("from a reading to a pose it takes {:.0f} ms", 1e3 * *sensor.median_delay_s));
  }
}

/// False, with the verdict: it had no reading.
bool had_reading(VerdictBuilder& verdict, const SensorMeasured& sensor) {
  if (sensor.first_reading_s) return true;
  const std::string& why = sensor.status.detail.empty() ? sensor.status.state_reason : sensor.status.detail;
  verdict.fail(fmt::format("no reading in {:.0f} s: {}", sensor.measured_s, why));
  return false;
}

}  // namespace

std::string_view name_of(Outcome outcome) {
  constexpr std::array<std::string_view, 3> kNames = {"passed", "remark", "failed"};
  return kNames.at(static_cast<std::size_t>(outcome));
}

SensorVerdict judge(const SensorMeasured& sensor, std::span<const double> mean_speeds_of_others_m_s) {
  VerdictBuilder verdict;
  if (!had_reading(verdict, sensor)) return verdict.take();
  judge_readings(verdict, sensor);
  judge_change(verdict, sensor);
  judge_way_to_pose(verdict, sensor);
  if (sensor.mean_speed_m_s && !mean_speeds_of_others_m_s.empty()) {
    const double others_m_s = std::accumulate(mean_speeds_of_others_m_s.begin(), mean_speeds_of_others_m_s.end(), 0.0) /
                              static_cast<double>(mean_speeds_of_others_m_s.size());
    const double own_m_s = *sensor.mean_speed_m_s;
    const bool is_near = std::abs(own_m_s - others_m_s) <= kAgreementAbove_m_s;
    if (!is_near && (own_m_s > kAgreementFactor * others_m_s || others_m_s > kAgreementFactor * own_m_s)) {
      verdict.remark(
          fmt::format("its mean is {:.1f} m/s, that of the others {:.1f} m/s; they were measured one after "
                      "another",
                      own_m_s, others_m_s));
    }
  }
  return verdict.take();
}

SensorVerdict judge_simulated(const SensorMeasured& sensor, const ExpectedWind& expected) {
  VerdictBuilder verdict;
  if (!had_reading(verdict, sensor)) return verdict.take();
  judge_readings(verdict, sensor);
  judge_way_to_pose(verdict, sensor);
  const auto& speed_m_s = sensor.mean_speed_m_s;
  const auto& direction_deg = sensor.status.direction_deg;
  if (!speed_m_s && !direction_deg) verdict.fail("neither a speed nor a direction came");
  if (speed_m_s && std::abs(*speed_m_s - expected.speed_m_s) > expected.speed_tolerance_m_s) {
    verdict.fail(fmt::format("it read {:.2f} m/s, and after its calibration it should be {:.2f} m/s", *speed_m_s,
                             expected.speed_m_s));
  }
  if (direction_deg &&
      std::abs(std::remainder(*direction_deg - expected.direction_deg, 360.0)) > expected.direction_tolerance_deg) {
    verdict.fail(fmt::format("it read {:.0f} degrees, and after its calibration it should be {:.0f} degrees",
                             *direction_deg, expected.direction_deg));
  }
  return verdict.take();
}

bool is_passed(const NorthCheck& check) {
  return std::abs(std::remainder(check.direction_deg, 360.0)) <= kMaxNorthError_deg;
}

bool is_rehearsal(const Acceptance& acceptance) {
  return acceptance.sensors.empty() && !acceptance.simulated.empty();
}

Outcome outcome_of(const Acceptance& acceptance) {
  Outcome worst = Outcome::kPassed;
  bool is_measured = false;
  for (const SimulatedPart& part : acceptance.simulated) {
    if (!part.measured) continue;
    is_measured = true;
    worst = std::max(worst, part.verdict.outcome);
  }
  for (const SensorVerdict& verdict : acceptance.verdicts) {
    is_measured = true;
    worst = std::max(worst, verdict.outcome);
  }
  if (!is_measured) worst = Outcome::kRemark;
  for (const NorthCheck& check : acceptance.north_checks)
    worst = std::max(worst, is_passed(check) ? Outcome::kPassed : Outcome::kFailed);
  return worst;
}

}  // namespace yuragi::daemon::tools::acceptance
