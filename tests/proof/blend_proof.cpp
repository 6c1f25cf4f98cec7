// yuragi-blend-proof: the wind that moves the wall is the wind outside. Two recordings of a sonic anemometer are made
// into what slow sensors would have said; the daemon's estimator makes wind of it again, 60 times a second; and that is
// compared with all that the recordings have. Prints tables, and ends with 1 where a bound does not hold.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/tools/plot/plot.hpp"
#include "daemon/tools/plot/plot_script.hpp"
#include "tests/proof/blend_comparison.hpp"

namespace yuragi::proof {
namespace {

/// ctest's word for a test that has not what it needs.
constexpr int kSkipped = 77;
constexpr double kNoiseBound_db = 1.0;
/// An octave in which the tiles have hardly a wave says nothing about them: this part of the noise above kToHz.
constexpr double kMinShare = 0.02;

/// What is asked of a sensor's interval.
struct Bounds {
  double octave_db;
  double least_variance, most_variance;
  double mean_speed;
  double coherence;
};
constexpr Bounds kQuick = {1.5, 0.85, 1.1, 0.01, 0.9};
constexpr Bounds kSlow = {4.0, 0.7, 1.3, 0.03, 0.88};
/// Of what passes along the ground, far from the sensor: octaves over those at the sensor, variance over the record's.
constexpr double kBladeOctave_db = 4.0;
constexpr double kMinBladeVariance = 0.85;
constexpr double kMaxBladeVariance = 1.15;
/// Above kToHz, of a quick sensor: to kFastHz and from there on, over the record with its folding taken out.
constexpr double kFastHz = 2.4;
constexpr double kFast_db = 4.0;
constexpr double kFastest_db = 6.0;
/// How sharp gusts are, of a quick sensor and with gustiness: over the record's. (4.0 to 5.2 of 4.7, what records of
/// steady wind have; where the wind swells and dies away in half an hour, the record itself has 6.)
constexpr double kMinKurtosis = 0.85;
constexpr double kMaxKurtosis = 1.1;
constexpr double kMinFar = 0.6;
constexpr double kMaxFar = 1.4;
/// From this interval on a sensor is slow.
constexpr double kSlow_s = 5.0;

/// Tells what holds and what does not.
class Verdict {
 public:
  void check(bool holds, const std::string& what) {
    fmt::print("  {}  {}\n", holds ? "holds" : "FAILS", what);
    if (!holds) ++failures_;
  }
  int failures() const { return failures_; }

 private:
  int failures_ = 0;
};

double furthest(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

double furthest_apart(const std::vector<double>& some, const std::vector<double>& others) {
  double largest = 0.0;
  for (std::size_t i = 0; i < some.size(); ++i) largest = std::max(largest, std::abs(some[i] - others[i]));
  return largest;
}

std::string name_of(Band band) {
  return fmt::format("{:.3g} - {:.3g}", band.from_hz, band.to_hz);
}

/// The table, as Markdown.
void print_table(const SonicRecord& record, const BlendComparison& blend) {
  fmt::print("\n### Record {}, a sensor of {:g} s, gustiness {:g}, {} seeds\n\n", record.name, blend.interval_s,
             blend.gustiness, blend.seeds);
  fmt::print("Record: {:.0f} to {:.0f} s, mean speed {:.2f} m/s, variance (u + v) {:.2f} m^2/s^2\n\n", blend.from_s,
             blend.to_s, blend.record.mean_speed_m_s, blend.record.variance_m2_s2);
  const auto& blades = blend.blades;
  fmt::print("Increments over {:g} s: kurtosis {:.2f}, of the record {:.2f}; beyond 4 sigma {:.2e}, {:.2e}\n\n",
             kIncrement_s, blend.increments.kurtosis, blend.record_increments.kurtosis, blend.increments.far_part,
             blend.record_increments.far_part);
  fmt::print(
      "| | readings alone | wind | to the record unfolded | blade 1 | blade 2 | blade 3 | noise to its model |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  fmt::print("| variance / record | | {:.3f} | | {:.3f} | {:.3f} | {:.3f} | |\n", blend.signal.variance,
             blades[0].variance, blades[1].variance, blades[2].variance);
  fmt::print("| mean speed / record | | {:.4f} | | {:.4f} | {:.4f} | {:.4f} | |\n", blend.signal.mean_speed,
             blades[0].mean_speed, blades[1].mean_speed, blades[2].mean_speed);
  for (std::size_t i = 0; i < blend.octaves.size(); ++i) {
    fmt::print("| {} Hz | {:+.1f} dB | {:+.2f} dB | | {:+.2f} dB | {:+.2f} dB | {:+.2f} dB | |\n",
               name_of(blend.octaves[i]), blend.sensor_octaves[i], blend.signal.octaves[i], blades[0].octaves[i],
               blades[1].octaves[i], blades[2].octaves[i]);
  }
  for (std::size_t i = 0; i < blend.above.size(); ++i) {
    fmt::print("| {} Hz | | {:+.2f} dB | {:+.2f} dB | {:+.2f} dB | {:+.2f} dB | {:+.2f} dB | {:+.2f} dB |\n",
               name_of(blend.above[i]), blend.signal.above[i], blend.unfolded_above[i], blades[0].above[i],
               blades[1].above[i], blades[2].above[i], blend.synthetic_above[i]);
  }
  fmt::print("\n");
}

bool is_within(double value, double least, double most) {
  return value >= least && value <= most;
}

/// What is quicker than any reading of a quick sensor: too little of it and gusts are soft.
void judge_fast(const BlendComparison& blend, Verdict& verdict) {
  for (std::size_t i = 0; i < blend.above.size(); ++i) {
    const double bound_db = blend.above[i].to_hz <= kFastHz * 1.001 ? kFast_db : kFastest_db;
    verdict.check(std::abs(blend.unfolded_above[i]) <= bound_db,
                  fmt::format("octave {} Hz within {:g} dB of the record with its folding taken out: {:+.2f}",
                              name_of(blend.above[i]), bound_db, blend.unfolded_above[i]));
  }
  if (blend.gustiness == 0.0) return;
  const double kurtosis = blend.increments.kurtosis / blend.record_increments.kurtosis;
  verdict.check(is_within(kurtosis, kMinKurtosis, kMaxKurtosis),
                fmt::format("kurtosis of increments over {:g} s {:g} to {:g} of the record's: {:.2f} ({:.2f}, {:.2f})",
                            kIncrement_s, kMinKurtosis, kMaxKurtosis, kurtosis, blend.increments.kurtosis,
                            blend.record_increments.kurtosis));
  const double far = blend.increments.far_part / blend.record_increments.far_part;
  verdict.check(is_within(far, kMinFar, kMaxFar),
                fmt::format("increments beyond 4 sigma {:g} to {:g} times as frequent as in the record: {:.2f}",
                            kMinFar, kMaxFar, far));
}

void judge(const BlendComparison& blend, Verdict& verdict) {
  const Bounds& bounds = blend.interval_s < kSlow_s ? kQuick : kSlow;
  verdict.check(furthest(blend.signal.octaves) <= bounds.octave_db,
                fmt::format("octaves from {:g} to {:g} Hz within {:g} dB: {:.2f}", kFromHz, kToHz, bounds.octave_db,
                            furthest(blend.signal.octaves)));
  verdict.check(is_within(blend.signal.variance, bounds.least_variance, bounds.most_variance),
                fmt::format("variance {:g} to {:g} of the record's: {:.3f}", bounds.least_variance,
                            bounds.most_variance, blend.signal.variance));
  verdict.check(std::abs(blend.signal.mean_speed - 1.0) <= bounds.mean_speed,
                fmt::format("mean speed within {:g} %: {:+.2f}", 100.0 * bounds.mean_speed,
                            100.0 * (blend.signal.mean_speed - 1.0)));
  verdict.check(
      blend.coherence > bounds.coherence,
      fmt::format("coherence with the sensor from {:g} to {:.3g} Hz above {:g}: {:.3f} (least of a bin {:.3f})",
                  kFromHz, blend.coherent_to_hz, bounds.coherence, blend.coherence, blend.least_coherence));
  double all = 0.0;
  for (const double power : blend.model_above) all += power;
  for (std::size_t i = 0; i < blend.above.size(); ++i) {
    if (blend.model_above[i] < kMinShare * all) continue;
    verdict.check(std::abs(blend.synthetic_above[i]) <= kNoiseBound_db,
                  fmt::format("noise at {} Hz within {:g} dB of its model: {:+.2f}", name_of(blend.above[i]),
                              kNoiseBound_db, blend.synthetic_above[i]));
  }
  if (blend.interval_s < kSlow_s) judge_fast(blend, verdict);
  for (std::size_t i = 0; i < kBlades.size(); ++i) {
    const PlaceComparison& blade = blend.blades[i];
    const double octaves_db = furthest_apart(blade.octaves, blend.signal.octaves);
    verdict.check(octaves_db <= kBladeOctave_db && is_within(blade.variance, kMinBladeVariance, kMaxBladeVariance),
                  fmt::format("blade {} ({:g} m east, {:g} m south): octaves within {:g} dB of the sensor's place: "
                              "{:.2f}; variance {:g} to {:g} of the record's: {:.3f}",
                              i + 1, kBlades[i].east_m, kBlades[i].south_m, kBladeOctave_db, octaves_db,
                              kMinBladeVariance, kMaxBladeVariance, blade.variance));
  }
}

/// A spectrum thinned to a few points a decade, each the mean of its bins.
daemon::tools::plot::Curve curve_of(const std::string& title, const std::vector<double>& density, double step_hz,
                                    double from_hz) {
  daemon::tools::plot::Curve curve{.title = title, .x = {}, .y = {}};
  constexpr double kRatio = 1.12;
  double low_hz = from_hz;
  while (low_hz < kTopHz) {
    const Band band{low_hz, low_hz * kRatio};
    low_hz = band.to_hz;
    const double bins = std::ceil(band.to_hz / step_hz) - std::ceil(band.from_hz / step_hz);
    const double power = power_in(density, step_hz, band);
    if (bins < 1.0 || power <= 0.0) continue;
    curve.x.push_back(std::sqrt(band.from_hz * band.to_hz));
    curve.y.push_back(power / (bins * step_hz));
  }
  return curve;
}

daemon::tools::plot::Panel panel_of(const SonicRecord& record, const BlendComparison& blend) {
  const double from_hz = 1.0 / 1080.0;
  daemon::tools::plot::Panel panel{.title = fmt::format("record {}, a sensor of {:g} s, mean of {} seeds", record.name,
                                                        blend.interval_s, blend.seeds),
                                   .x_label = "frequency, Hz",
                                   .y_label = "S, m^2/s^2/Hz (u + v)",
                                   .is_x_log = true,
                                   .is_y_log = true,
                                   .curves = {}};
  panel.curves.push_back(curve_of("record, 10 Hz", blend.record_density, blend.step_hz, from_hz));
  // What is held has no power at the multiples of its rate: its deepest notches would set the scale.
  daemon::tools::plot::Curve sensor = curve_of("readings alone", blend.sensor_density, blend.step_hz, from_hz);
  for (double& value : sensor.y) value = value < 1e-3 ? std::nan("") : value;
  panel.curves.push_back(std::move(sensor));
  panel.curves.push_back(curve_of("wind of yuragi", blend.signal.density, blend.step_hz, from_hz));
  panel.curves.push_back(curve_of("at a blade 65 m away", blend.blades[2].density, blend.step_hz, from_hz));
  panel.curves.push_back(curve_of("model of its noise", blend.model_density, blend.step_hz, kToHz));
  return panel;
}

struct Options {
  std::vector<int> records = {0, 1};
  std::vector<double> intervals_s = {1.0, 14.0};
  double gustiness = 0.0;
  int seeds = 32;
  std::string plot;
};

int prove(const Options& options) {
  if (!options.plot.empty()) daemon::tools::plot::check_plot_name(options.plot).value();
  const std::shared_ptr<const wind::turbulence::GustNoise> noise =
      daemon::sensing::make_gust_noise(daemon::settings::default_config());
  Verdict verdict;
  std::vector<daemon::tools::plot::Panel> panels;
  for (const int number : options.records) {
    const std::optional<SonicRecord> record = load_sonic(number);
    if (!record) {
      fmt::print("skipped: ../shared/data/sonic, the recordings that this compares with, is not here\n");
      return kSkipped;
    }
    for (const double interval_s : options.intervals_s) {
      const BlendComparison blend = compare_blend(*record, interval_s, options.gustiness, options.seeds, noise);
      print_table(*record, blend);
      judge(blend, verdict);
      panels.push_back(panel_of(*record, blend));
      std::fflush(stdout);
    }
  }
  if (!options.plot.empty()) daemon::tools::plot::draw_plot(options.plot, panels).value();
  fmt::print("\n{}\n",
             verdict.failures() == 0 ? "everything holds" : fmt::format("{} do not hold", verdict.failures()));
  return verdict.failures() == 0 ? 0 : 1;
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Compares the blended wind with the recordings that it was made from");
  app.footer(
      "Example: yuragi-blend-proof --record 1 --interval 14 --plot blend.png\n"
      "Ends with 1 where a bound does not hold, and with 77 where ../shared/data/sonic is not there.");
  app.add_option("--record", options.records, "which recordings: 0 (13:30), 1 (14:00)")->check(CLI::Range(0, 1));
  app.add_option("--interval", options.intervals_s, "how often the sensors speak, s")->check(CLI::Range(0.1, 60.0));
  app.add_option("--gustiness", options.gustiness, "as [wind] gustiness has it")
      ->check(CLI::Range(0.0, 0.6))
      ->capture_default_str();
  app.add_option("--seeds", options.seeds, "how many winds of noise")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--plot", options.plot, "draws the spectra")->type_name("FILE.png|svg");
  CLI11_PARSE(app, argc, argv);
  return prove(options);
}

}  // namespace
}  // namespace yuragi::proof

int main(int argc, char** argv) {
  try {
    return yuragi::proof::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "yuragi-blend-proof: %s\n", error.what());
    return 1;
  }
}
