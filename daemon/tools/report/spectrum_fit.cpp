// Fits to a spectrum: its slope, its octaves, and von Karman's three parameters.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "daemon/tools/report/welch_spectrum.hpp"
#include "engine/wind/turbulence/von_karman_integrals.hpp"

namespace yuragi::daemon::tools::report {
namespace {

/// The slope is fitted to the decade below two fifths of the Nyquist frequency: above it aliasing adds power, and
/// averaging by the sensor removes some.
constexpr double kSlopeEnds_nyquist = 0.4;
constexpr double kSlopeDecade = 10.0;
constexpr std::size_t kMinLines = 4;

/// The fit uses the octaves that detrending and window do not affect, up to half of the Nyquist frequency.
constexpr double kFitBegins_lines = 3.0;
constexpr double kFitEnds_nyquist = 0.5;
constexpr std::size_t kMinOctaves = 3;
constexpr int kTimeScaleSteps = 600;

std::optional<PowerLawFit> fit_power_law(const SpectrumNumbers& spectrum) {
  const double nyquist_hz = 0.5 / spectrum.step_s;
  PowerLawFit fit;
  fit.to_hz = kSlopeEnds_nyquist * nyquist_hz;
  fit.from_hz = fit.to_hz / kSlopeDecade;

  double count = 0.0, sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
  for (std::size_t k = 1; k < spectrum.density_m2_s2_hz.size(); ++k) {
    const double f = spectrum.frequency_hz(k);
    const double density = spectrum.density_m2_s2_hz[k];
    if (f < fit.from_hz || f > fit.to_hz || !(density > 0.0)) continue;
    const double x = std::log(f);
    const double y = std::log(density);
    count += 1.0;
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  const double spread = count * sum_xx - sum_x * sum_x;
  if (count < kMinLines || !(spread > 0.0)) return std::nullopt;
  fit.beta = -(count * sum_xy - sum_x * sum_y) / spread;
  fit.log_level = (sum_y + fit.beta * sum_x) / count;
  return fit;
}

/// The lines of an octave, and where the first begins and the last ends.
struct OctaveLines {
  double from_hz = 0.0, to_hz = 0.0;
  double variance_m2_s2 = 0.0;
  std::size_t count = 0;
};

OctaveLines lines_of(const SpectrumNumbers& spectrum, double from_hz, double to_hz) {
  const double line_hz = spectrum.frequency_hz(1);
  OctaveLines lines;
  for (std::size_t k = 1; k < spectrum.density_m2_s2_hz.size(); ++k) {
    const double f = spectrum.frequency_hz(k);
    if (f < from_hz || f >= to_hz) continue;
    if (lines.count++ == 0) lines.from_hz = f - 0.5 * line_hz;
    lines.to_hz = f + 0.5 * line_hz;
    lines.variance_m2_s2 += spectrum.density_m2_s2_hz[k] * line_hz;
  }
  return lines;
}

/// Octaves from a power of two to the next (1/8, 1/4, 1/2, 1, 2 Hz), so that those of two recordings compare.
std::vector<OctaveLines> add_octaves(SpectrumNumbers& spectrum) {
  const double line_hz = spectrum.frequency_hz(1);
  const double nyquist_hz = 0.5 / spectrum.step_s;
  std::vector<OctaveLines> all;
  for (double from_hz = std::exp2(std::ceil(std::log2(1.5 * line_hz))); 2.0 * from_hz <= nyquist_hz; from_hz *= 2.0) {
    const OctaveLines lines = lines_of(spectrum, from_hz, 2.0 * from_hz);
    if (lines.count == 0) continue;
    const bool is_in_fit = from_hz >= kFitBegins_lines * line_hz && 2.0 * from_hz <= kFitEnds_nyquist * nyquist_hz &&
                           lines.variance_m2_s2 > 0.0;
    spectrum.octaves.push_back({.from_hz = from_hz,
                                .to_hz = 2.0 * from_hz,
                                .variance_m2_s2 = lines.variance_m2_s2,
                                .fitted_m2_s2 = {},
                                .is_in_fit = is_in_fit});
    all.push_back(lines);
  }
  return all;
}

void fit_von_karman(SpectrumNumbers& spectrum, const std::vector<OctaveLines>& lines, double speed_m_s) {
  const auto count = static_cast<std::size_t>(
      std::ranges::count_if(spectrum.octaves, [](const auto& band) { return band.is_in_fit; }));
  if (count < kMinOctaves || !(speed_m_s > 0.0)) return;

  // For each time scale the best level, in closed form; then the best time scale. From scales whose bend
  // lies above all octaves to those whose bend lies below.
  const double shortest_s = 0.02 * spectrum.step_s;
  const double longest_s = 20.0 * static_cast<double>(spectrum.segment_readings) * spectrum.step_s;
  double best_cost = std::numeric_limits<double>::infinity();
  int best_step = 0;
  VonKarmanFit best;
  for (int step = 0; step <= kTimeScaleSteps; ++step) {
    const double time_scale_s =
        shortest_s * std::pow(longest_s / shortest_s, static_cast<double>(step) / kTimeScaleSteps);
    double sum = 0.0;
    double sum_of_squares = 0.0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (!spectrum.octaves[i].is_in_fit) continue;
      const double ratio = std::log(lines[i].variance_m2_s2 /
                                    wind::turbulence::von_karman_share(lines[i].from_hz, lines[i].to_hz, time_scale_s));
      sum += ratio;
      sum_of_squares += ratio * ratio;
    }
    const double level = sum / static_cast<double>(count);
    const double cost = sum_of_squares / static_cast<double>(count) - level * level;
    if (cost >= best_cost) continue;
    best_cost = cost;
    best_step = step;
    best.intensity = std::exp(0.5 * level) / speed_m_s;
    best.time_scale_s = time_scale_s;
  }

  best.speed_m_s = speed_m_s;
  best.rms_db = 10.0 / std::log(10.0) * std::sqrt(std::max(best_cost, 0.0));
  bool has_begun = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    OctaveBand& band = spectrum.octaves[i];
    band.fitted_m2_s2 = best.sigma_m_s() * best.sigma_m_s() *
                        wind::turbulence::von_karman_share(lines[i].from_hz, lines[i].to_hz, best.time_scale_s);
    if (!band.is_in_fit) continue;
    if (!has_begun) best.from_hz = band.from_hz;
    has_begun = true;
    best.to_hz = band.to_hz;
  }
  // The bend is where f S is largest, at 0.146 / T (von Karman); outside the octaves nothing fixes it.
  const double bend_hz = 0.146 / best.time_scale_s;
  const bool is_bend_seen =
      best_step > 0 && best_step < kTimeScaleSteps && bend_hz >= best.from_hz && bend_hz <= best.to_hz;
  if (is_bend_seen) best.length_m = best.time_scale_s * speed_m_s;
  spectrum.von_karman = best;
}

}  // namespace

void fit_spectrum(SpectrumNumbers& spectrum, double mean_square_speed_m2_s2) {
  spectrum.power_law = fit_power_law(spectrum);
  const std::vector<OctaveLines> lines = add_octaves(spectrum);
  fit_von_karman(spectrum, lines, std::sqrt(mean_square_speed_m2_s2));
}

}  // namespace yuragi::daemon::tools::report
