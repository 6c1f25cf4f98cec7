#include "daemon/sensing/sensor_diagnosis.hpp"

#include <fmt/format.h>

#include "daemon/settings/duration_text.hpp"

namespace yuragi::daemon::sensing {
namespace {

/// Before its second reading a station's interval is unknown; almost all stations send within this.
constexpr double kSecondReadingWithin_s = 120.0;

bool awaits_second_reading(const wind::SourceReport& report) {
  return report.interval_s <= 0.0 && report.age_s <= kSecondReadingWithin_s;
}

std::string connecting_text(const SensorEvidence& evidence) {
  if (evidence.link == wind::LinkState::kConnected) {
    return "the device is connected, but has sent no reading yet: " + std::string(evidence.link_detail);
  }
  return evidence.link_detail.empty() ? "looking for the device" : std::string(evidence.link_detail);
}

/// Appended to the reason of a sensor whose readings arrive.
std::string_view no_wind_text(const SensorEvidence& evidence) {
  if (evidence.makes_wind) return "";
  return "; its speeds are maxima, which are not used as wind. Set the station to send mean or instantaneous wind, or "
         "add another sensor; without one the default wind of [wind] is used";
}

std::string live_text(const SensorEvidence& evidence) {
  std::string text = evidence.report.interval_s > 0.0
                         ? fmt::format("a reading every {}", settings::duration_text(evidence.report.interval_s))
                         : std::string("first reading received");
  if (evidence.report.is_overdue) {
    text += fmt::format("; none for {}, which means that nothing has changed",
                        settings::duration_text(evidence.report.age_s));
  }
  if (evidence.vote == wind::judging::Vote::kDisputed && evidence.others_m_s) {
    text += fmt::format(
        "; but its mean of 5 min is {:.1f} m/s, that of the other sensors {:.1f} m/s. Check each sensor, and correct "
        "[sensor.calibration] of the wrong one",
        evidence.mean_m_s, *evidence.others_m_s);
  } else if (evidence.is_levelled_at_most) {
    text += fmt::format(
        "; it reads {:.2f} times the group or even {}, and is not levelled further. Check its place, and correct "
        "[sensor.calibration]",
        evidence.reads_times_group, evidence.reads_times_group > 1.0 ? "more" : "less");
  }
  return text;
}

std::string stale_text(const SensorEvidence& evidence) {
  std::string silence = "no reading for " + settings::duration_text(evidence.report.age_s);
  if (evidence.report.interval_s <= 0.0) return silence;
  return fmt::format("{}; its usual interval is {}. Is the station switched on, and within range of its sensor?",
                     silence, settings::duration_text(evidence.report.interval_s));
}

std::string frozen_text(const SensorEvidence& evidence) {
  return fmt::format(
      "the same reading, {:.2f} m/s, {} times in {}. Its electronics may hang, or it may be iced: inspect it, and "
      "switch it off and on",
      evidence.report.last ? evidence.report.last->speed_m_s : 0.0, evidence.same_count,
      settings::duration_text(evidence.same_for_s));
}

std::string seized_text(const SensorEvidence& evidence) {
  const std::string others = evidence.others_m_s
                                 ? fmt::format("while the other sensors measure {:.1f} m/s", *evidence.others_m_s)
                                 : "after a windy day";
  return fmt::format("no wind for {}, {}. Check that it turns freely: ice, dirt or a worn bearing may block it",
                     settings::duration_text(evidence.still_for_s), others);
}

std::string implausible_text(const SensorEvidence& evidence) {
  if (evidence.fault == wind::judging::ReadingFault::kImplausible) {
    return fmt::format(
        "{:.0f} % of its last readings were spikes or out of range. Check its cable, its power supply, its unit, and "
        "sources of interference",
        100.0 * evidence.bad_share);
  }
  if (!evidence.others_m_s) return "it was outvoted by the other sensors, which are all silent now";
  return fmt::format(
      "its mean of 5 min is {:.1f} m/s, that of the other sensors {:.1f} m/s. Check its unit, its calibration and its "
      "surroundings; `compare = false` in [sensor.judge] disables this comparison",
      evidence.mean_m_s, *evidence.others_m_s);
}

std::string_view text_of(DirectionStandIn stand_in) {
  switch (stand_in) {
    case DirectionStandIn::kOtherSensor:
      return "the direction of another sensor is used";
    case DirectionStandIn::kLast:
      return "the last one is kept";
    case DirectionStandIn::kConfigured:
      break;
  }
  return "the default of the configuration is used";
}

}  // namespace

std::string missing_text(wind::judging::Quantity quantity, std::optional<double> age_s, DirectionStandIn stand_in) {
  const std::string since = age_s ? "none for " + settings::duration_text(*age_s) : "none has come yet";
  if (quantity == wind::judging::Quantity::kGust) return since + "; gusts are taken from the speeds. Check the station";
  return fmt::format("{}; {}. Check the vane, its cable and its address", since, text_of(stand_in));
}

wind::judging::SensorState state_of(const SensorEvidence& evidence) {
  const bool is_connected = evidence.link == wind::LinkState::kConnected;
  const bool makes_no_sense = evidence.fault == wind::judging::ReadingFault::kImplausible;
  switch (evidence.report.health) {
    case wind::SourceHealth::kSilent:
      if (evidence.link == wind::LinkState::kFinished) return wind::judging::SensorState::kDisconnected;
      return is_connected && makes_no_sense ? wind::judging::SensorState::kImplausible
                                            : wind::judging::SensorState::kConnecting;
    case wind::SourceHealth::kStale:
      if (!is_connected) return wind::judging::SensorState::kDisconnected;
      if (makes_no_sense) return wind::judging::SensorState::kImplausible;
      if (!awaits_second_reading(evidence.report)) return wind::judging::SensorState::kStale;
      break;
    case wind::SourceHealth::kLive:
      // Nothing explains the silence of a disconnected device.
      if (evidence.report.is_overdue && !is_connected) return wind::judging::SensorState::kDisconnected;
      break;
  }
  if (evidence.fault == wind::judging::ReadingFault::kFrozen) return wind::judging::SensorState::kFrozen;
  if (evidence.fault == wind::judging::ReadingFault::kSeized) return wind::judging::SensorState::kSeized;
  if (makes_no_sense || evidence.vote == wind::judging::Vote::kOutvoted)
    return wind::judging::SensorState::kImplausible;
  if (evidence.is_replay) return wind::judging::SensorState::kReplayed;
  const bool is_simulated = evidence.report.last && evidence.report.last->quality == wind::ReadingQuality::kSimulated;
  return is_simulated ? wind::judging::SensorState::kSimulated : wind::judging::SensorState::kLive;
}

std::string reason_of(wind::judging::SensorState state, const SensorEvidence& evidence) {
  switch (state) {
    case wind::judging::SensorState::kConnecting:
      return connecting_text(evidence);
    case wind::judging::SensorState::kLive:
      return live_text(evidence).append(no_wind_text(evidence));
    case wind::judging::SensorState::kStale:
      return stale_text(evidence);
    case wind::judging::SensorState::kFrozen:
      return frozen_text(evidence);
    case wind::judging::SensorState::kSeized:
      return seized_text(evidence);
    case wind::judging::SensorState::kImplausible:
      return implausible_text(evidence);
    case wind::judging::SensorState::kDisconnected:
      return evidence.link_detail.empty() ? "the device was disconnected" : std::string(evidence.link_detail);
    case wind::judging::SensorState::kSimulated:
      return std::string("synthetic values, not measured").append(no_wind_text(evidence));
    case wind::judging::SensorState::kReplayed:
      return std::string("a recording, not the present wind").append(no_wind_text(evidence));
  }
  return {};
}

}  // namespace yuragi::daemon::sensing
