#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "daemon/tools/report/report_numbers.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::report {

/// The mean speed of the last 3 s, whose maximum meteorologists call the gust (WMO No. 8, Guide to Instruments, part I,
/// chapter 5). Thread-safe: no.
class ThreeSecondMean {
 public:
  /// For a sensor of this interval; there are no means if it is above kMaxInterval_s.
  explicit ThreeSecondMean(double interval_s) : interval_s_(interval_s) {}

  /// Takes a reading; returns the mean of the 3 s up to it, if there is no gap in them.
  std::optional<double> add(Nanoseconds time, double speed_m_s);

  static constexpr double kMaxInterval_s = 1.5;

 private:
  struct Past {
    Nanoseconds time{0};
    double speed_m_s = 0.0;
  };
  double interval_s_;
  std::deque<Past> past_;
};

/// Turbulence intensity and gust factor of blocks of 10 minutes, counted from log time 0. Thread-safe: no.
class TenMinuteBlocks {
 public:
  static constexpr double kBlock_s = 600.0;

  explicit TenMinuteBlocks(double interval_s) : interval_s_(interval_s) {}

  void add(double time_s, double speed_m_s, const std::optional<double>& three_second_mean_m_s);
  BlockNumbers finish();

 private:
  void close();

  double interval_s_;
  double index_ = -1.0;
  std::size_t count_ = 0;
  double mean_m_s_ = 0.0;
  double squares_m2_s2_ = 0.0;  ///< sum of the squared distances from the mean
  double gust_m_s_ = 0.0;

  std::size_t blocks_ = 0;
  std::size_t gusty_blocks_ = 0;
  double intensity_sum_ = 0.0;
  double factor_sum_ = 0.0;
};

}  // namespace yuragi::daemon::tools::report
