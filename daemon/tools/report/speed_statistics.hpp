#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "daemon/tools/report/report_numbers.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::tools::report {

/// The distribution of speeds, in classes of 0.1 m/s. Thread-safe: no.
class SpeedHistogram {
 public:
  void add(double speed_m_s);
  std::uint64_t count() const { return count_; }

  /// The speed that `part` (0 to 1) of the readings do not exceed, interpolated linearly within its class. 0 for none.
  double percentile_m_s(double part) const;

  /// Shares of classes made of `fine` of these each, up to the last that is not empty.
  std::vector<double> shares(std::size_t fine) const;

 private:
  static constexpr double kClasses_per_m_s = 10.0;
  static constexpr std::size_t kClasses = static_cast<std::size_t>(wind::kMaxPlausibleSpeed_m_s * kClasses_per_m_s) + 1;
  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(kClasses);
  std::uint64_t count_ = 0;
};

/// Mean, standard deviation and distribution of a sensor's speeds, in all and by hour of the day. Thread-safe: no.
class SpeedStatistics {
 public:
  void add(double speed_m_s, std::size_t hour);

  std::uint64_t count() const { return all_.count(); }
  double mean_m_s() const { return mean_m_s_; }
  double deviation_m_s() const;
  SpeedDistribution distribution() const;
  std::array<HourOfDay, 24> hours() const;

 private:
  SpeedHistogram all_;
  std::array<SpeedHistogram, 24> by_hour_;
  std::array<double, 24> hour_sum_m_s_{};
  double mean_m_s_ = 0.0;
  double squares_m2_s2_ = 0.0;
};

/// Counts for a wind rose, whose classes reach to the strongest wind. Thread-safe: no.
class RoseTally {
 public:
  void add(double speed_m_s, double direction_deg);
  WindRose finish() const;

 private:
  /// Counted in metres per second; the last class has all that is faster.
  static constexpr std::size_t kFineClasses = 120;

  std::uint64_t count_ = 0;
  std::uint64_t calm_ = 0;
  std::array<std::array<std::uint64_t, kFineClasses>, kRoseSectors> counts_{};
  std::size_t strongest_ = 0;  ///< the fine class of the strongest wind
};

}  // namespace yuragi::daemon::tools::report
