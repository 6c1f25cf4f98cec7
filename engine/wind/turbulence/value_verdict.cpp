#include "engine/wind/turbulence/value_verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/wind/turbulence/sampled_turbulence.hpp"
#include "engine/wind/turbulence/von_karman_integrals.hpp"

namespace yuragi::wind::turbulence {
namespace {

constexpr double kMemory_s = 7200.0;
/// It judges after this time.
constexpr double kMinKnown_s = 1800.0;
constexpr double kJudgeEvery_s = 60.0;
constexpr double kLikelihoodRatio = 20.0;
/// Readings are closer than this part of a gust's length.
constexpr double kMaxIntervalOfLength = 1.0 / 3.0;
constexpr double kOtherInterval = 1.2;
/// The prior of the length: deviation of its logarithm; and the number of lengths tried per factor of 2.
constexpr double kLengthDeviation = 0.8;
constexpr int kLengthsToOctave = 3;
constexpr int kOctavesEitherWay = 4;
/// Degrees of freedom of a mean square, relative to its observations: gusts come in bursts (changes of real wind have a
/// kurtosis of 5 to 10, by which a mean square scatters two to four times as much as of normal ones).
constexpr double kFreedom = 0.2;

/// The logarithm of a sum of exponentials, term by term.
class LogSum {
 public:
  void add(double log_term) noexcept {
    const double largest = std::max(largest_, log_term);
    sum_ = sum_ * std::exp(largest_ - largest) + std::exp(log_term - largest);
    largest_ = largest;
  }
  double value() const noexcept { return largest_ + std::log(sum_); }

 private:
  double largest_ = -1e300;
  double sum_ = 0.0;
};

}  // namespace

ValueVerdict::ValueVerdict(double length_m) : length_m_(length_m), squares_(kMemory_s) {
  make_haar_table();
  make_sampled_haar_table();
}

void ValueVerdict::forget(double dt_s) noexcept {
  squares_.forget(dt_s);
  known_s_ += std::max(dt_s, 0.0);
}

void ValueVerdict::begin(double interval_s) noexcept {
  *this = ValueVerdict(length_m_);
  interval_s_ = interval_s;
}

void ValueVerdict::judge(double interval_s, double speed_m_s) noexcept {
  if (!(interval_s > 0.0) || !(speed_m_s > 0.0)) return;
  if (interval_s > kOtherInterval * interval_s_ || interval_s < interval_s_ / kOtherInterval) begin(interval_s);
  if (known_s_ < kMinKnown_s || known_s_ - judged_s_ < kJudgeEvery_s) return;
  judged_s_ = known_s_;
  if (interval_s > kMaxIntervalOfLength * length_m_ / speed_m_s) return;
  const double log_ratio = log_likelihood_ratio(interval_s, speed_m_s);
  if (log_ratio > std::log(kLikelihoodRatio)) verdict_ = ReadingValue::kInstant;
  if (log_ratio < -std::log(kLikelihoodRatio)) verdict_ = ReadingValue::kMean;
}

/// A mean square v of nu degrees of freedom about its expectation m has the likelihood m^(-nu/2) exp(-nu v / (2 m)).
/// The level of the turbulence, which both hypotheses share, is the most likely one for each length.
double ValueVerdict::log_likelihood_ratio(double interval_s, double speed_m_s) const noexcept {
  LogSum instant, mean;
  for (int step = -kOctavesEitherWay * kLengthsToOctave; step <= kOctavesEitherWay * kLengthsToOctave; ++step) {
    const double log_length = std::numbers::ln2 * step / kLengthsToOctave;
    const double interval_over_time_scale = interval_s * speed_m_s / (length_m_ * std::exp(log_length));
    const double log_prior = -0.5 * (log_length / kLengthDeviation) * (log_length / kLengthDeviation);
    const auto log_likelihood = [&](auto shape_of) {
      std::array<double, kScales> shape{}, freedom{};
      double level = 0.0, all = 0.0;
      for (std::size_t scale = 0; scale < kScales; ++scale) {
        freedom[scale] = kFreedom * squares_.observations(scale);
        if (freedom[scale] < 1.0 || !(squares_.mean(scale) > 0.0)) continue;
        shape[scale] = shape_of(scale);
        level += freedom[scale] * squares_.mean(scale) / shape[scale];
        all += freedom[scale];
      }
      if (all == 0.0) return 0.0;
      level /= all;
      double sum = 0.0;
      for (std::size_t scale = 0; scale < kScales; ++scale) {
        if (shape[scale] > 0.0) sum -= 0.5 * freedom[scale] * std::log(level * shape[scale]);
      }
      return sum;  // without all / 2, which both have
    };
    instant.add(log_prior + log_likelihood([&](std::size_t scale) {
                  return von_karman_sampled_haar_variance(scale, interval_over_time_scale);
                }));
    mean.add(log_prior + log_likelihood([&](std::size_t scale) {
               return von_karman_haar_variance(std::ldexp(interval_over_time_scale, static_cast<int>(scale)));
             }));
  }
  return instant.value() - mean.value();
}

}  // namespace yuragi::wind::turbulence
