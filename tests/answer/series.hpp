#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace yuragi::answer {

// Figures of series of samples at equal steps of time. Sums are in double precision.

using Series = std::vector<float>;

double mean(std::span<const float> series);

/// Standard deviation about the mean.
double deviation(std::span<const float> series);

/// Of any numbers; the mean of the middle two of an even count. 0 of none.
double median(std::vector<double> numbers);
double mean_of(std::span<const double> numbers);
double deviation_of(std::span<const double> numbers);

/// Each sample replaced by the mean of the `window` samples about it; fewer by `window` - 1, since the ends are left
/// out.
Series running_mean(std::span<const float> series, std::size_t window);

/// Correlation coefficient of two series, as long as the shorter one; 0 where one of them is constant.
double correlation(std::span<const float> first, std::span<const float> second);

/// When one series says what the other said before.
struct Lag {
  double seconds = 0.0;      ///< above 0: the second follows the first
  double correlation = 0.0;  ///< then
};

/// The lag between -most and most at which the second series is most like the first; a parabola through the largest
/// correlation and its neighbours says it between two samples.
Lag lag_of(std::span<const float> first, std::span<const float> second, double rate_hz, double least_s, double most_s);

/// The correlations of which lag_of() seeks the largest, for lags of `least` to `most` samples.
std::vector<double> lagged_correlations(std::span<const float> first, std::span<const float> second, int least,
                                        int most);
Lag largest(std::span<const double> correlations, int least, double rate_hz);

/// The root of the sum of the variances of several components.
double vector_deviation(std::span<const std::span<const float>> components);

}  // namespace yuragi::answer
