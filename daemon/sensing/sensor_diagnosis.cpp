#include "daemon/sensing/sensor_diagnosis.hpp"

#include <fmt/format.h>

#include "daemon/settings/duration_text.hpp"

namespace yuragi {
namespace {

std::string connecting_text(const SensorEvidence& evidence) {
  if (evidence.link == LinkState::kConnected) {
    return "its device is there, but has not said a reading yet: " + std::string(evidence.link_detail);
  }
  return evidence.link_detail.empty() ? "looking for its device" : std::string(evidence.link_detail);
}

std::string live_text(const SensorEvidence& evidence) {
  std::string text = evidence.said.interval_s > 0.0
                         ? fmt::format("a reading every {}", duration_text(evidence.said.interval_s))
                         : std::string("its first reading has come");
  if (evidence.vote == Vote::kDisputed && evidence.others_m_s) {
    text += fmt::format(
        "; but it says {:.1f} m/s where the others say {:.1f} (means of 5 min), and nobody can tell who is right: look "
        "at each, and set [sensor.calibration] of the one that is wrong",
        evidence.mean_m_s, *evidence.others_m_s);
  }
  return text;
}

std::string stale_text(const SensorEvidence& evidence) {
  const std::string silence = "no reading for " + duration_text(evidence.said.age_s);
  if (evidence.said.interval_s <= 0.0) return silence;
  return fmt::format("{}; it used to speak every {}. Is the station on, and in reach of its sensor?", silence,
                     duration_text(evidence.said.interval_s));
}

std::string frozen_text(const SensorEvidence& evidence) {
  return fmt::format(
      "the same {:.2f} m/s {} times in {}. Its electronics hang, or ice holds it: look at it, and switch it off and on",
      evidence.said.last ? evidence.said.last->speed_m_s : 0.0, evidence.same_count,
      duration_text(evidence.same_for_s));
}

std::string seized_text(const SensorEvidence& evidence) {
  const std::string others =
      evidence.others_m_s ? fmt::format("while the others say {:.1f} m/s", *evidence.others_m_s) : "after a windy day";
  return fmt::format("no wind for {}, {}. See whether it turns freely: ice, dirt or a worn bearing holds it",
                     duration_text(evidence.still_for_s), others);
}

std::string implausible_text(const SensorEvidence& evidence) {
  if (evidence.fault == ReadingFault::kImplausible) {
    return fmt::format(
        "{:.0f} % of its last readings jumped about or were out of range. Check its cable, its supply, its unit, and "
        "what disturbs it",
        100.0 * evidence.bad_share);
  }
  if (!evidence.others_m_s) return "the other sensors denied what it says, and none of them speaks now";
  return fmt::format(
      "{:.1f} m/s where the others say {:.1f} (means of 5 min). Check its unit, its calibration and what stands around "
      "it; `compare = false` in [sensor.judge] lets it be",
      evidence.mean_m_s, *evidence.others_m_s);
}

}  // namespace

SensorState state_of(const SensorEvidence& evidence) {
  const bool is_connected = evidence.link == LinkState::kConnected;
  const bool makes_no_sense = evidence.fault == ReadingFault::kImplausible;
  switch (evidence.said.health) {
    case SourceHealth::kSilent:
      if (evidence.link == LinkState::kFinished) return SensorState::kDisconnected;
      return is_connected && makes_no_sense ? SensorState::kImplausible : SensorState::kConnecting;
    case SourceHealth::kStale:
      if (!is_connected) return SensorState::kDisconnected;
      return makes_no_sense ? SensorState::kImplausible : SensorState::kStale;
    case SourceHealth::kLive:
      break;
  }
  if (evidence.fault == ReadingFault::kFrozen) return SensorState::kFrozen;
  if (evidence.fault == ReadingFault::kSeized) return SensorState::kSeized;
  if (makes_no_sense || evidence.vote == Vote::kOutvoted) return SensorState::kImplausible;
  if (evidence.is_replay) return SensorState::kReplayed;
  const bool is_simulated = evidence.said.last && evidence.said.last->quality == ReadingQuality::kSimulated;
  return is_simulated ? SensorState::kSimulated : SensorState::kLive;
}

std::string reason_of(SensorState state, const SensorEvidence& evidence) {
  switch (state) {
    case SensorState::kConnecting:
      return connecting_text(evidence);
    case SensorState::kLive:
      return live_text(evidence);
    case SensorState::kStale:
      return stale_text(evidence);
    case SensorState::kFrozen:
      return frozen_text(evidence);
    case SensorState::kSeized:
      return seized_text(evidence);
    case SensorState::kImplausible:
      return implausible_text(evidence);
    case SensorState::kDisconnected:
      return evidence.link_detail.empty() ? "its device has gone" : std::string(evidence.link_detail);
    case SensorState::kSimulated:
      return "a simulation: made up, not measured";
    case SensorState::kReplayed:
      return "a recording: not the wind of now";
  }
  return {};
}

}  // namespace yuragi
