// `yuragi calibrate span`: fits gain and offset, or a curve, to known winds.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "daemon/commands/calibrate.hpp"
#include "daemon/commands/exit.hpp"
#include "drivers/sensor/speed_unit.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr double kSpanBlock_s = 10.0;
constexpr double kMaxUnsteadiness = 0.3;  // standard deviation over mean of a steady wind

struct SpanOptions {
  tools::calibration::Request request;
  std::vector<double> speeds_m_s;
  std::string points;
  bool wants_curve = false;
};

/// The indicated speed in a wind of this true speed.
wind::judging::CalibrationPoint measure_known_speed(tools::calibration::Session& session, double speed_m_s) {
  const tools::calibration::CollectedReadings collected = session.collect(speed_m_s);
  const std::vector<double> indicated_m_s =
      tools::calibration::indicated_speeds_m_s(collected[0], session.calibration());
  if (indicated_m_s.empty()) tools::calibration::refuse({"that part of the recording has no readings: check --part"});
  const auto count = static_cast<double>(indicated_m_s.size());
  double mean_m_s = 0.0;
  for (const double indicated : indicated_m_s) mean_m_s += indicated / count;
  double variance = 0.0;
  for (const double indicated : indicated_m_s) variance += (indicated - mean_m_s) * (indicated - mean_m_s) / count;
  session.dialog().print(fmt::format("At {:g} m/s the sensor reads {:.3f} m/s, standard deviation {:.3f} m/s, over {}.",
                                     speed_m_s, mean_m_s, std::sqrt(variance),
                                     count_text(indicated_m_s.size(), "reading")));
  if (std::sqrt(variance) > kMaxUnsteadiness * mean_m_s && mean_m_s > 0.0) {
    tools::calibration::refuse(
        {fmt::format("that wind is not steady: its standard deviation is {:.0f} %, allowed: up to {:.0f} %",
                     100.0 * std::sqrt(variance) / mean_m_s, 100.0 * kMaxUnsteadiness)});
  }
  const wind::judging::CalibrationPoint point{mean_m_s, speed_m_s};
  session.report_point(point);
  return point;
}

/// The pairs of indicated and true speed, from the options.
std::vector<wind::judging::CalibrationPoint> known_pairs(tools::calibration::Session& session,
                                                         const SpanOptions& options) {
  if (!options.points.empty()) {
    auto points = tools::calibration::value_or_refuse(wind::judging::parse_calibration_curve(options.points));
    for (const wind::judging::CalibrationPoint& point : points) session.report_point(point);
    return points;
  }
  std::vector<wind::judging::CalibrationPoint> pairs;
  if (session.reference() == nullptr) {
    for (const double speed_m_s : options.speeds_m_s) pairs.push_back(measure_known_speed(session, speed_m_s));
    return pairs;
  }
  const tools::calibration::CollectedReadings collected = session.collect();
  const tools::calibration::ReferencePairs beside =
      tools::calibration::pair_with_reference(session, collected, kSpanBlock_s);
  session.dialog().print(fmt::format("\nCompared with \"{}\": {} pairs of means over {:.0f} s.",
                                     session.reference()->name, beside.pairs.size(), beside.block_s));
  return beside.pairs;
}

/// Hints at a wrong unit, if the gain is close to a conversion factor.
void hint_at_unit(const tools::calibration::Session& session, tools::calibration::Dialog& dialog, double gain) {
  if (session.calibration().unit_m_s != 1.0) return;
  for (const std::string_view unit : drivers::sensor::kSpeedUnitNames) {
    const double metres_per_second = drivers::sensor::metres_per_second_in(unit);
    if (metres_per_second == 1.0 || std::abs(gain / metres_per_second - 1.0) > 0.05) continue;
    dialog.print(
        fmt::format("A gain of {:.3f} is typical of numbers in {}: if the sensor reports that unit, set unit = \"{}\" "
                    "(of the driver, or in [sensor.calibration]) and start again.",
                    gain, unit, unit));
    return;
  }
}

std::string curve_text(const std::vector<wind::judging::CalibrationPoint>& curve) {
  std::string text;
  for (const wind::judging::CalibrationPoint& point : curve) {
    text += fmt::format("{}{:.3f}:{:.3f}", text.empty() ? "" : " ", point.measured_m_s, point.true_m_s);
  }
  return text;
}

void check_options(const SpanOptions& options) {
  const int ways = (options.request.reference.empty() ? 0 : 1) + (options.speeds_m_s.empty() ? 0 : 1) +
                   (options.points.empty() ? 0 : 1);
  if (ways != 1) {
    throw ExitError(kExitUsage, "the known wind is missing: give --speed, --reference or --points");
  }
  const bool is_recorded = !options.request.recording.empty();
  const std::size_t stretches = std::max<std::size_t>(1, options.speeds_m_s.size());
  if (is_recorded &&
      (options.request.parts.size() > stretches || (stretches > 1 && options.request.parts.size() != stretches))) {
    throw ExitError(kExitUsage, "give as many --part as --speed, in the same order");
  }
  if (options.wants_curve && !options.speeds_m_s.empty()) {
    throw ExitError(kExitUsage, "--curve needs --reference or --points");
  }
}

/// Indicated speeds at which the effect is shown: some within the measured range, and one of a storm.
std::vector<double> shown_speeds(const std::vector<wind::judging::CalibrationPoint>& pairs) {
  const auto [low, high] = std::ranges::minmax(pairs, {}, &wind::judging::CalibrationPoint::measured_m_s);
  if (pairs.size() == 1) return {0.5 * low.measured_m_s, low.measured_m_s, 2.0 * low.measured_m_s};
  return {low.measured_m_s, 0.5 * (low.measured_m_s + high.measured_m_s), high.measured_m_s, 15.0};
}

void calibrate_span(const SpanOptions& options) {
  check_options(options);
  tools::calibration::Session session(
      options.request,
      tools::calibration::way_of("span", options.request.reference.empty() ? tools::calibration::Given::kSpeed
                                                                           : tools::calibration::Given::kReference));
  const std::vector<wind::judging::CalibrationPoint> pairs = known_pairs(session, options);

  std::vector<settings::ConfigChange> wanted;
  if (options.wants_curve) {
    std::vector<wind::judging::CalibrationPoint> curve = pairs;
    if (options.points.empty()) {
      wind::judging::CurveFit fit = tools::calibration::value_or_refuse(wind::judging::fit_curve(pairs));
      session.dialog().print(fmt::format("Fitted a curve of {} points: R^2 = {:.4f}, residual {:.3f} m/s.",
                                         fit.curve.size(), fit.r_squared, fit.residual_m_s));
      curve = std::move(fit.curve);
    }
    wanted = {
        {"calibration", "gain", 1.0}, {"calibration", "offset", 0.0}, {"calibration", "curve", curve_text(curve)}};
  } else {
    const bool is_single = pairs.size() == 1 && options.speeds_m_s.size() == 1;
    const wind::judging::LineFit fit = tools::calibration::value_or_refuse(
        is_single ? wind::judging::fit_line_from_zero(wind::judging::zero_point_m_s(session.calibration()), pairs[0])
                  : wind::judging::fit_line(pairs));
    session.dialog().print(
        fit.count <= 2 ? fmt::format("Fitted a line through {}.", is_single ? "its zero and this wind" : "both winds")
                       : fmt::format("Fitted a line through {} pairs with wind: R^2 = {:.4f}, residual {:.3f} m/s.",
                                     fit.count, fit.r_squared, fit.residual_m_s));
    hint_at_unit(session, session.dialog(), fit.gain);
    wanted = {{"calibration", "gain", tools::calibration::rounded(fit.gain, 0.0001)},
              {"calibration", "offset", tools::calibration::rounded(fit.offset_m_s, 0.001)},
              {"calibration", "curve", std::string()}};
  }
  session.finish(wanted, session.speed_effect(wanted, shown_speeds(pairs)));
}

}  // namespace

void add_calibrate_span(CLI::App& calibrate) {
  CLI::App* command = calibrate.add_subcommand("span", "known winds: gain and offset, or a curve");
  command->footer(
      "With a reference sensor (--reference, another one of the configuration): means over 10 s or more are paired, "
      "and a\n"
      "line is fitted by least squares. With known winds (--speed): one changes the gain, two or more give gain and "
      "offset.\n"
      "From a certificate (--points): pairs of reading and true speed. --curve makes a curve of bins of 1 m/s, or of "
      "the\n"
      "points, for a sensor that is not linear.\n"
      "Refused: less than 2 m/s between the slowest and the fastest, R^2 below 0.8, and gains outside 0.2 to 5.\n"
      "  yuragi calibrate span --config wall.toml --sensor roof --speed 3 --speed 12\n"
      "  yuragi calibrate span --config wall.toml --sensor roof --reference handheld --for 1200\n"
      "  yuragi calibrate span --config wall.toml --sensor roof --points \"4.1:4.0 9.8:10.1 15.2:16.0\"\n"
      "  yuragi calibrate span --config wall.toml --sensor roof --speed 3 --speed 12 --recording tunnel.windlog\n"
      "      --part 10,70 --part 90,150");
  auto options = std::make_shared<SpanOptions>();
  add_calibration_request(*command, options->request, "60; with --reference 900");
  add_calibration_json(*command, options->request);
  command->add_option("--speed", options->speeds_m_s, "a known wind speed; can be repeated")
      ->type_name("M_S")
      ->check(CLI::Range(0.1, 100.0))
      ->expected(1)
      ->take_all();
  command
      ->add_option("--reference", options->request.reference, "another sensor of the configuration, taken as correct")
      ->type_name("NAME");
  command->add_option("--points", options->points, "reading:true in m/s, rising, from a certificate")
      ->type_name("\"SAID:TRUE ...\"");
  command->add_flag("--curve", options->wants_curve, "fit a curve instead of a line");
  command->callback([options] { calibrate_span(*options); });
}

}  // namespace yuragi::daemon::commands
