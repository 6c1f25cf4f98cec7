#pragma once

#include <optional>

#include "daemon/tools/report/recording_survey.hpp"
#include "daemon/tools/report/welch_spectrum.hpp"

namespace yuragi::daemon::tools::report {

/// Resamples readings at irregular times to runs of evenly spaced samples, by linear interpolation. Readings that are
/// evenly spaced already are passed on unchanged. Thread-safe: no.
class EvenSeries {
 public:
  /// `step_s` (above 0) between two samples.
  explicit EvenSeries(double step_s) : step_s_(step_s) {}

  /// Takes a reading and calls `use(sample)` for each sample up to it, `interrupt()` before one that begins a new run.
  template <class Use, class Interrupt>
  void add(double time_s, const EvenSample& reading, Use&& use, Interrupt&& interrupt) {
    if (!has_begun_ || time_s - last_s_ > kBridgedIntervals * step_s_) {
      interrupt();
      begin_s_ = time_s;
      next_ = 0.0;
    } else if (!(time_s > last_s_)) {
      return;
    }
    for (; begin_s_ + next_ * step_s_ <= time_s + kTolerance * step_s_; next_ += 1.0) {
      const double part = next_ == 0.0 ? 1.0 : (begin_s_ + next_ * step_s_ - last_s_) / (time_s - last_s_);
      use(between(last_, reading, part < 1.0 ? part : 1.0));
    }
    has_begun_ = true;
    last_s_ = time_s;
    last_ = reading;
  }

 private:
  /// A reading that is early for its sample by no more than this part of a step is used as it is.
  static constexpr double kTolerance = 1e-3;

  static EvenSample between(const EvenSample& a, const EvenSample& b, double part) {
    if (part == 1.0) return b;
    EvenSample sample;
    sample.speed_m_s = (1.0 - part) * a.speed_m_s + part * b.speed_m_s;
    if (a.wind && b.wind) sample.wind = (1.0 - part) * *a.wind + part * *b.wind;
    return sample;
  }

  double step_s_;
  bool has_begun_ = false;
  double begin_s_ = 0.0;
  double next_ = 0.0;  ///< samples of this run
  double last_s_ = 0.0;
  EvenSample last_;
};

}  // namespace yuragi::daemon::tools::report
