#pragma once

#include <optional>

#include "daemon/tools/report/report_numbers.hpp"
#include "engine/wind/blend/site_teacher.hpp"

namespace yuragi {

/// What a recording of a quick sensor teaches about its site's gusts, as the daemon would learn it. Thread-safe: no.
class SiteLesson {
 public:
  /// `prior`: of the slow source that is to be corrected. `interval_s`: the sensor's.
  SiteLesson(const TurbulencePrior& prior, double interval_s);

  /// The next believed reading; `wind`: with the last direction that was told, if any was.
  void add(double time_s, double speed_m_s, const std::optional<WindVector>& wind);

  /// Nothing where the sensor was too slow, or never there for long enough.
  std::optional<SiteNumbers> numbers() const;

 private:
  double interval_s_;
  double length_m_;
  WindTurbulence quick_;
  SiteTeacher teacher_;
  SiteSpectrum site_;
  std::optional<double> last_s_;
  double heard_s_ = 0.0;
  WindVector mean_{};
  double speed_m_s_ = 0.0;
};

}  // namespace yuragi
