#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::tools::acceptance {

/// What was measured of one sensor that alone made the wind.
struct SensorMeasured {
  wire::SensorStatus status{};              ///< at the end
  double measured_s = 0.0;                  ///< since its first reading, or in all if it had none
  std::optional<double> first_reading_s{};  ///< after it was opened
  std::optional<double> least_speed_m_s{};  ///< of the readings that were seen, two a second
  std::optional<double> mean_speed_m_s{};
  std::optional<double> largest_speed_m_s{};
  std::uint64_t delays = 0;                ///< readings whose way to a pose was timed
  std::optional<double> median_delay_s{};  ///< from a reading's time stamp to the frame in the client's hand
  std::optional<double> longest_delay_s{};
  std::uint64_t frames = 0;
  std::uint64_t moved_frames = 0;    ///< whose poses are others than in the frame before
  double largest_live_weight = 0.0;  ///< the sensor's part of the wind of the frames, 0 to 1
};

enum class Outcome : std::uint8_t { kPassed, kRemark, kFailed };
std::string_view name_of(Outcome outcome);

struct SensorVerdict {
  Outcome outcome = Outcome::kPassed;
  std::vector<std::string> remarks;  ///< deviations, and missing proofs
};

// Limits of the verdicts.
inline constexpr double kMaxMedianDelay_s = 0.2;    ///< more is seen as lagging behind the wind
inline constexpr double kMaxRefusedShare = 0.05;    ///< of the messages from the device
inline constexpr double kMinLiveWeight = 0.5;       ///< of the sensor in the wind that moved the scenes
inline constexpr double kAgreementFactor = 2.0;     ///< between mean speeds of sensors of one site
inline constexpr double kAgreementAbove_m_s = 1.0;  ///< differences up to this are none

/// The verdict of a sensor by itself, and by the mean speeds of the others (empty: it is alone, or was not compared).
/// Pure.
SensorVerdict judge(const SensorMeasured& sensor, std::span<const double> mean_speeds_of_others_m_s);

/// What the calibrated readings of a simulated sensor are to be.
struct ExpectedWind {
  double speed_m_s = 0.0;
  double speed_tolerance_m_s = 0.0;  ///< from the resolution of the device's messages
  double direction_deg = 0.0;        ///< for a sensor that measures it
  double direction_tolerance_deg = 0.0;
};

/// The verdict of a sensor that was simulated with a constant wind: as that of a real one, and its readings are those
/// expected. A speed or direction that never came is not compared, but one of them must. Pure.
SensorVerdict judge_simulated(const SensorMeasured& sensor, const ExpectedWind& expected);

/// The part of a hand-over in which a sensor's device is simulated.
struct SimulatedPart {
  std::string name;
  std::string driver;
  std::optional<SensorMeasured> measured{};  ///< none: it was not simulated
  SensorVerdict verdict{};                   ///< of what was measured
  std::string why_not{};                     ///< it was not simulated: why
};

/// What a technician was asked for with --ask: how far from north the vane read while it was held there.
struct NorthCheck {
  std::string sensor;
  double direction_deg = 0.0;
};
inline constexpr double kMaxNorthError_deg = 15.0;
bool is_passed(const NorthCheck& check);

/// The hand-over of an installation.
struct Acceptance {
  std::string site;
  std::string configuration;  ///< its file
  std::string software;       ///< "yuragi 0.2.0"
  std::string system;         ///< "Debian GNU/Linux 12 (bookworm), Linux 6.1.0-26-amd64 x86_64"
  UtcTime begun{};
  double duration_s = 0.0;                 ///< of the measurement of each sensor
  std::vector<SimulatedPart> simulated{};  ///< one for each sensor; empty: the real ones only
  std::vector<SensorMeasured> sensors;     ///< the real ones; empty: the simulated ones only
  std::vector<SensorVerdict> verdicts;     ///< one for each real one
  std::vector<NorthCheck> north_checks{};
};

/// Returns true if only simulated devices were measured: that proves configuration and software, but is not a
/// hand-over.
bool is_rehearsal(const Acceptance& acceptance);

/// The gravest of all verdicts and checks; what was not simulated has none. A remark if nothing was measured.
Outcome outcome_of(const Acceptance& acceptance);

/// A table for a terminal, with remarks below each sensor.
std::string acceptance_text(const Acceptance& acceptance);
nlohmann::ordered_json acceptance_json(const Acceptance& acceptance);

/// A page to print and to sign: HTML, self-contained.
std::string acceptance_page(const Acceptance& acceptance);

}  // namespace yuragi::daemon::tools::acceptance
