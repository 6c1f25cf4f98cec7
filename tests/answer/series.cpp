#include "tests/answer/series.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace yuragi::answer {

double mean(std::span<const float> series) {
  double sum = 0.0;
  for (const float value : series) sum += static_cast<double>(value);
  return series.empty() ? 0.0 : sum / static_cast<double>(series.size());
}

double deviation(std::span<const float> series) {
  if (series.empty()) return 0.0;
  const double middle = mean(series);
  double sum = 0.0;
  for (const float value : series) {
    const double off = static_cast<double>(value) - middle;
    sum += off * off;
  }
  return std::sqrt(sum / static_cast<double>(series.size()));
}

double median(std::vector<double> numbers) {
  if (numbers.empty()) return 0.0;
  std::sort(numbers.begin(), numbers.end());
  const std::size_t half = numbers.size() / 2;
  return numbers.size() % 2 == 1 ? numbers[half] : 0.5 * (numbers[half - 1] + numbers[half]);
}

double mean_of(std::span<const double> numbers) {
  if (numbers.empty()) return 0.0;
  return std::accumulate(numbers.begin(), numbers.end(), 0.0) / static_cast<double>(numbers.size());
}

double deviation_of(std::span<const double> numbers) {
  if (numbers.empty()) return 0.0;
  const double middle = mean_of(numbers);
  double sum = 0.0;
  for (const double value : numbers) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / static_cast<double>(numbers.size()));
}

Series running_mean(std::span<const float> series, std::size_t window) {
  Series means;
  if (window == 0 || series.size() < window) return means;
  double sum = 0.0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    sum += static_cast<double>(series[i]);
    if (i >= window) sum -= static_cast<double>(series[i - window]);
    if (i + 1 >= window) means.push_back(static_cast<float>(sum / static_cast<double>(window)));
  }
  return means;
}

double correlation(std::span<const float> first, std::span<const float> second) {
  const std::size_t count = std::min(first.size(), second.size());
  if (count == 0) return 0.0;
  const double first_mean = mean(first.first(count));
  const double second_mean = mean(second.first(count));
  double both = 0.0;
  double first_square = 0.0;
  double second_square = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double a = static_cast<double>(first[i]) - first_mean;
    const double b = static_cast<double>(second[i]) - second_mean;
    both += a * b;
    first_square += a * a;
    second_square += b * b;
  }
  const double product = first_square * second_square;
  return product > 0.0 ? both / std::sqrt(product) : 0.0;
}

std::vector<double> lagged_correlations(std::span<const float> first, std::span<const float> second, int least,
                                        int most) {
  std::vector<double> found;
  const auto count = static_cast<int>(std::min(first.size(), second.size()));
  for (int lag = least; lag <= most; ++lag) {
    const auto shared = static_cast<std::size_t>(std::max(count - std::abs(lag), 0));
    const auto first_begin = static_cast<std::size_t>(std::clamp(-lag, 0, count));
    const auto second_begin = static_cast<std::size_t>(std::clamp(lag, 0, count));
    found.push_back(correlation(first.subspan(first_begin, shared), second.subspan(second_begin, shared)));
  }
  return found;
}

Lag largest(std::span<const double> correlations, int least, double rate_hz) {
  if (correlations.empty()) return {};
  const auto top = static_cast<std::size_t>(
      std::distance(correlations.begin(), std::max_element(correlations.begin(), correlations.end())));
  double shift = 0.0;
  double height = correlations[top];
  if (top > 0 && top + 1 < correlations.size()) {
    const double before = correlations[top - 1];
    const double after = correlations[top + 1];
    const double curve = before - 2.0 * height + after;
    if (curve < 0.0) {
      shift = 0.5 * (before - after) / curve;
      height -= 0.25 * (before - after) * shift;
    }
  }
  return {(static_cast<double>(least) + static_cast<double>(top) + shift) / rate_hz, height};
}

Lag lag_of(std::span<const float> first, std::span<const float> second, double rate_hz, double least_s, double most_s) {
  const auto least = static_cast<int>(std::floor(least_s * rate_hz));
  const auto most = static_cast<int>(std::ceil(most_s * rate_hz));
  return largest(lagged_correlations(first, second, least, most), least, rate_hz);
}

double vector_deviation(std::span<const std::span<const float>> components) {
  double sum = 0.0;
  for (const std::span<const float> component : components) {
    const double part = deviation(component);
    sum += part * part;
  }
  return std::sqrt(sum);
}

}  // namespace yuragi::answer
