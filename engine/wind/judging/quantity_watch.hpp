#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/base/time.hpp"

namespace yuragi::wind::judging {

/// The quantities of a reading besides its speed. The stream (pose.fbs) has the same in the same order.
enum class Quantity : std::uint8_t { kDirection, kGust };
inline constexpr std::array<std::string_view, 2> kQuantityNames = {"direction", "gust"};

constexpr std::string_view name_of(Quantity quantity) {
  const auto number = static_cast<std::size_t>(quantity);
  return number < kQuantityNames.size() ? kQuantityNames[number] : "?";
}

/// Watches whether a sensor still delivers one quantity.
///
/// A quantity is missing if the sensor has delivered it, or its profile promises it, and now readings come without it:
/// for a minute of wind, and for 14 times as many readings as usually come between two with it (if they come at random,
/// the chance of so long a run is one in a million: exp(-14)). Readings in a calm do not count: many stations send no
/// direction then. The usual number is a mean of the last deliveries, in which a run counts as at most 20 times the
/// usual, so that a fault of hours does not become usual. Thread-safe: no. Realtime-safe: yes.
class QuantityWatch {
 public:
  /// `is_promised`: it is missing even if it was never delivered.
  explicit QuantityWatch(bool is_promised = false) noexcept : is_expected_(is_promised) {}

  /// Takes a reading, in the order of their times. `has_it`: it came with the quantity.
  void take(MonoTime time, double speed_m_s, bool has_it) noexcept;

  /// Returns false if it was neither delivered nor promised: then nothing is known of it.
  bool is_expected() const noexcept { return is_expected_; }
  bool is_missing() const noexcept {
    return is_expected_ && missing_readings_ >= patience() && missing_for_s_ >= kLeast_s;
  }

  /// When it was delivered last; nullopt: never.
  std::optional<MonoTime> last() const noexcept { return last_; }

 private:
  static constexpr double kCalm_m_s = 1.0;
  static constexpr double kLeast_s = 60.0;
  static constexpr double kMaxStep_s = 60.0;  ///< limit of the time between two readings
  static constexpr double kMinReadings = 5.0;
  static constexpr double kRuns = 14.0;
  static constexpr double kMaxRuns = 20.0;
  static constexpr double kMemory = 0.05;

  double patience() const noexcept { return kRuns * usual_run_ > kMinReadings ? kRuns * usual_run_ : kMinReadings; }

  bool is_expected_;
  std::optional<MonoTime> last_;
  std::optional<MonoTime> last_reading_;
  double usual_run_ = 0.0;  ///< readings in wind without it between two with it: a mean of the last 20 runs
  double runs_ = 0.0;       ///< number of runs in the mean, up to its memory
  double missing_readings_ = 0.0;
  double missing_for_s_ = 0.0;
};

}  // namespace yuragi::wind::judging
