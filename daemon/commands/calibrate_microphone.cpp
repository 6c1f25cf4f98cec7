// `yuragi calibrate microphone`: fits the conversion of sound level to wind speed, beside another anemometer.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "daemon/commands/calibrate.hpp"
#include "daemon/commands/exit.hpp"
#include "drivers/microphone/microphone_calibration.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr double kMicBlock_s = 5.0;
/// The least part of a block's readings that must have a level; otherwise it was mostly calm, where the level is
/// unknown.
constexpr double kMinMeasuredPart = 0.5;

struct MicrophoneOptions {
  tools::calibration::Request request;
  std::vector<double> speeds_m_s;
  std::string points;
};

/// How readings were computed from levels: needed to compute the levels from readings.
struct LevelConversion {
  drivers::decode::microphone::MicCalibration calibration;
  double noise_power = 0.0;  ///< of a fixed noise floor; 0: it was estimated while running
  drivers::decode::microphone::MicFitKind kind = drivers::decode::microphone::MicFitKind::kPowerLaw;

  bool operator==(const LevelConversion&) const = default;
};

LevelConversion level_conversion(const drivers::microphone::MicLevelSettings& settings) {
  LevelConversion conversion{.calibration = settings.calibration};
  if (settings.noise_floor_db) {
    conversion.noise_power = std::pow(10.0, 0.1 * *settings.noise_floor_db);
    conversion.kind = drivers::decode::microphone::MicFitKind::kPowerLawOrCurve;
  } else if (std::holds_alternative<drivers::decode::microphone::MicCurve>(conversion.calibration)) {
    conversion.kind = drivers::decode::microphone::MicFitKind::kCurve;
  }
  return conversion;
}

void refuse_another_band(std::string_view key, double then_hz, double now_hz) {
  if (then_hz == now_hz) return;
  tools::calibration::refuse(
      {fmt::format("the recording was made with {} = {:g} Hz, but the configuration has {:g}: levels of "
                   "different bands cannot be compared",
                   key, then_hz, now_hz)});
}

/// For a recording, the settings that it was made with; else those of the configuration.
LevelConversion level_conversion(const tools::calibration::Session& session,
                                 const tools::calibration::SensorReadings& collected) {
  const drivers::microphone::MicLevelSettings now = drivers::microphone::mic_level_settings_of(session.sensor().values);
  std::vector<LevelConversion> all;
  for (const std::string& text : collected.settings) {
    const auto values = settings::parse_values(text, session.sensor().driver->parameters);
    if (!values) {
      tools::calibration::refuse(
          {"this version does not understand the settings of this microphone in the recording: " +
           values.error().message});
    }
    const drivers::microphone::MicLevelSettings then = drivers::microphone::mic_level_settings_of(*values);
    refuse_another_band("band_low", then.band_low_hz, now.band_low_hz);
    refuse_another_band("band_high", then.band_high_hz, now.band_high_hz);
    all.push_back(level_conversion(then));
  }
  if (all.empty()) return level_conversion(now);
  if (std::ranges::any_of(all, [&all](const LevelConversion& one) { return !(one == all.front()); })) {
    tools::calibration::refuse(
        {"the calibration of the microphone was changed during this recording: choose a time before or after with "
         "--part"});
  }
  return all.front();
}

std::vector<wind::judging::TimedSpeed> levels_of(const tools::calibration::SensorReadings& collected,
                                                 const LevelConversion& conversion) {
  std::vector<wind::judging::TimedSpeed> levels_db;
  for (const tools::calibration::TimedReading& one : collected.readings) {
    const auto level_db = drivers::decode::microphone::mic_level_db(conversion.calibration, one.reading.speed_m_s,
                                                                    conversion.noise_power);
    if (level_db) levels_db.push_back({one.time_s, *level_db});
  }
  return levels_db;
}

/// Pairs of mean level and mean true speed, block by block.
std::vector<drivers::decode::microphone::MicLevelAndSpeed> pairs_beside(tools::calibration::Session& session,
                                                                        LevelConversion& conversion) {
  const tools::calibration::CollectedReadings collected = session.collect();
  conversion = level_conversion(session, collected[0]);
  const tools::calibration::ReferencePairs beside =
      tools::calibration::pair_with_reference(session, collected, kMicBlock_s);
  std::map<double, std::size_t> all_in_block;
  std::map<double, std::vector<double>> levels_in_block;
  for (const tools::calibration::TimedReading& one : collected[0].readings)
    ++all_in_block[std::floor(one.time_s / beside.block_s)];
  for (const wind::judging::TimedSpeed& one : levels_of(collected[0], conversion)) {
    levels_in_block[std::floor(one.time_s / beside.block_s)].push_back(one.speed_m_s);
  }
  std::map<double, std::vector<double>> truth_in_block;
  for (const wind::judging::TimedSpeed& one : beside.truth) {
    truth_in_block[std::floor(one.time_s / beside.block_s)].push_back(one.speed_m_s);
  }
  const auto mean_of = [](const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  };
  std::vector<drivers::decode::microphone::MicLevelAndSpeed> pairs;
  for (const auto& [block, levels_db] : levels_in_block) {
    const auto truth = truth_in_block.find(block);
    const bool is_measured =
        static_cast<double>(levels_db.size()) >= kMinMeasuredPart * static_cast<double>(all_in_block[block]);
    if (truth != truth_in_block.end() && is_measured) pairs.push_back({mean_of(levels_db), mean_of(truth->second)});
  }
  session.dialog().print(fmt::format("\nCompared with \"{}\": {} pairs of level and speed, means over {:.0f} s.",
                                     session.reference()->name, pairs.size(), beside.block_s));
  return pairs;
}

/// The mean level in a wind of this speed.
drivers::decode::microphone::MicLevelAndSpeed measure_level(tools::calibration::Session& session, double speed_m_s,
                                                            LevelConversion& conversion) {
  const tools::calibration::CollectedReadings collected = session.collect(speed_m_s);
  conversion = level_conversion(session, collected[0]);
  double sum_db = 0.0;
  const std::vector<wind::judging::TimedSpeed> levels_db = levels_of(collected[0], conversion);
  for (const wind::judging::TimedSpeed& one : levels_db) sum_db += one.speed_m_s;
  if (levels_db.empty())
    tools::calibration::refuse({"the microphone receives no wind noise: is it in the wind, and is it switched on?"});
  const double level_db = sum_db / static_cast<double>(levels_db.size());
  session.dialog().print(fmt::format("At {:g} m/s the level is {:.1f} dB, over {}.", speed_m_s, level_db,
                                     count_text(levels_db.size(), "reading")));
  session.report_point({drivers::decode::microphone::mic_speed_m_s(
                            conversion.calibration, std::pow(10.0, 0.1 * level_db), conversion.noise_power),
                        speed_m_s});
  return {level_db, speed_m_s};
}

/// Known winds as report_point() had them: what the microphone read with its present settings, and the true speed.
std::vector<drivers::decode::microphone::MicLevelAndSpeed> levels_at(tools::calibration::Session& session,
                                                                     const std::string& points,
                                                                     const LevelConversion& conversion) {
  std::vector<drivers::decode::microphone::MicLevelAndSpeed> pairs;
  for (const wind::judging::CalibrationPoint& point :
       tools::calibration::value_or_refuse(wind::judging::parse_calibration_curve(points))) {
    const auto level_db =
        drivers::decode::microphone::mic_level_db(conversion.calibration, point.measured_m_s, conversion.noise_power);
    if (!level_db) tools::calibration::refuse({"--points: where the microphone reads 0, its level is not known"});
    session.report_point(point);
    pairs.push_back({*level_db, point.true_m_s});
  }
  return pairs;
}

/// Through the slowest and the fastest of the known winds.
drivers::decode::microphone::MicCalibration calibration_by_winds(
    tools::calibration::Session& session, const LevelConversion& conversion,
    std::vector<drivers::decode::microphone::MicLevelAndSpeed>& pairs) {
  if (conversion.kind == drivers::decode::microphone::MicFitKind::kCurve) {
    tools::calibration::refuse(
        {"a curve cannot be fitted to two winds, and this microphone uses a curve: set its curve to \"\", or set its "
         "noise_floor"});
  }
  std::ranges::sort(pairs, {}, &drivers::decode::microphone::MicLevelAndSpeed::speed_m_s);
  const drivers::decode::microphone::MicPowerLaw law = tools::calibration::value_or_refuse(
      drivers::decode::microphone::mic_power_law_through(pairs.front(), pairs.back(), conversion.noise_power));
  session.dialog().print(fmt::format("Fitted a power law through the winds of {:g} and {:g} m/s.",
                                     pairs.front().speed_m_s, pairs.back().speed_m_s));
  return law;
}

drivers::decode::microphone::MicCalibration calibration_beside(
    tools::calibration::Session& session, LevelConversion& conversion,
    std::vector<drivers::decode::microphone::MicLevelAndSpeed>& pairs) {
  pairs = pairs_beside(session, conversion);
  const drivers::decode::microphone::MicFit fit = tools::calibration::value_or_refuse(
      drivers::decode::microphone::fit_mic_calibration(pairs, conversion.noise_power, conversion.kind));
  session.dialog().print(fmt::format(
      "Fitted a {}: mean error {:.2f} m/s on pairs that were not used for the fit.",
      std::holds_alternative<drivers::decode::microphone::MicCurve>(fit.calibration) ? "curve" : "power law",
      fit.mean_error_m_s));
  if (conversion.kind == drivers::decode::microphone::MicFitKind::kPowerLaw) {
    session.dialog().print("(Only a power law was tried: a curve needs a known noise_floor.)");
  }
  return fit.calibration;
}

/// The speeds at some levels with the present and the new calibration.
tools::calibration::Effect level_effect(const tools::calibration::Session& session,
                                        const drivers::decode::microphone::MicCalibration& then, double noise_power,
                                        const std::vector<drivers::decode::microphone::MicLevelAndSpeed>& pairs) {
  const drivers::decode::microphone::MicCalibration now =
      drivers::microphone::mic_level_settings_of(session.sensor().values).calibration;
  wind::judging::Calibration after = session.calibration();
  after.height_factor = 1.0;
  const auto [softest, loudest] =
      std::ranges::minmax(pairs, {}, &drivers::decode::microphone::MicLevelAndSpeed::level_db);
  tools::calibration::Effect effect{.indicated_unit = "dB", .unit = "m/s"};
  for (int step = 0; step <= 3; ++step) {
    const double level_db = softest.level_db + (loudest.level_db - softest.level_db) * step / 3.0;
    const double power = std::pow(10.0, 0.1 * level_db);
    wind::Reading reading;
    reading.speed_m_s = drivers::decode::microphone::mic_speed_m_s(now, power, noise_power);
    effect.rows.push_back({.indicated = level_db,
                           .now = after.applied_to(reading).speed_m_s,
                           .then = drivers::decode::microphone::mic_speed_m_s(then, power, noise_power)});
  }
  return effect;
}

void calibrate_microphone(const MicrophoneOptions& options) {
  const std::size_t speeds = options.speeds_m_s.size();
  const bool has_reference = !options.request.reference.empty();
  const bool has_points = !options.points.empty();
  const bool is_one_of_two = speeds == 1 && options.request.as_json;  // a program gives both as --points
  if (int{has_reference} + int{speeds > 0} + int{has_points} != 1 || (speeds > 0 && speeds != 2 && !is_one_of_two)) {
    throw ExitError(kExitUsage, "the known wind is missing: give --reference, --speed twice, or --points");
  }
  const std::size_t parts = options.request.parts.size();
  if (!options.request.recording.empty() && (has_reference ? parts > 1 : parts != 2)) {
    throw ExitError(kExitUsage, "--part: give one with --reference, or one for each --speed, in the same order");
  }
  tools::calibration::Session session(
      options.request, tools::calibration::way_of("microphone", has_reference ? tools::calibration::Given::kReference
                                                                              : tools::calibration::Given::kSpeed));

  LevelConversion conversion;
  std::vector<drivers::decode::microphone::MicLevelAndSpeed> pairs;
  if (has_points) {
    conversion = level_conversion(drivers::microphone::mic_level_settings_of(session.sensor().values));
    pairs = levels_at(session, options.points, conversion);
  }
  for (const double speed_m_s : options.speeds_m_s) pairs.push_back(measure_level(session, speed_m_s, conversion));
  if (is_one_of_two) {
    session.dialog().print("Now measure a second wind, twice as fast or half as fast.");
    return;
  }
  const drivers::decode::microphone::MicCalibration found =
      has_reference ? calibration_beside(session, conversion, pairs) : calibration_by_winds(session, conversion, pairs);

  // The whole calibration is now in the driver's own parameters: [sensor.calibration] must not apply it twice.
  std::vector<settings::ConfigChange> wanted;
  for (const auto& [key, value] : drivers::microphone::parameters_of(found)) wanted.push_back({"", key, value});
  wanted.push_back({"calibration", "unit", std::string("m/s")});
  wanted.push_back({"calibration", "gain", 1.0});
  wanted.push_back({"calibration", "offset", 0.0});
  wanted.push_back({"calibration", "curve", std::string()});
  session.finish(wanted, level_effect(session, found, conversion.noise_power, pairs));
}

}  // namespace

void add_calibrate_microphone(CLI::App& calibrate) {
  CLI::App* command = calibrate.add_subcommand("microphone", "a bare microphone, next to another anemometer");
  command->footer(
      "Finds gain and exponent, or a curve, of the microphone's entry, from pairs of level and speed (means over 5 s "
      "or\n"
      "more): whichever is better on pairs that were not used for the fit. Needs at least 8 pairs that span 1 m/s and\n"
      "3 dB. A fit to half an hour of light wind is poor in a storm, so record varied wind. With --speed twice: a "
      "power law\n"
      "through two known winds; with --points: through the slowest and the fastest of winds that were measured "
      "before.\n"
      "[sensor.calibration] of the microphone becomes neutral, except for its height and north.\n"
      "A running daemon computes its readings with the settings that it was started with: with --unchanged they are\n"
      "taken from it, otherwise it must be stopped. The new values count when it is started again.\n"
      "--json: also a single --speed, whose point is then one of --points.\n"
      "  yuragi calibrate microphone --config wall.toml --sensor mic --reference roof --for 3600\n"
      "  yuragi calibrate microphone --config wall.toml --sensor mic --reference roof --recording may.windlog\n"
      "  yuragi calibrate microphone --config wall.toml --sensor mic --speed 3 --speed 9");
  auto options = std::make_shared<MicrophoneOptions>();
  add_calibration_request(*command, options->request, "60; with --reference 900");
  add_calibration_json(*command, options->request);
  command->add_flag("--unchanged", options->request.daemon_has_these_settings,
                    "the running daemon has the settings of this microphone that the file has");
  command
      ->add_option("--reference", options->request.reference, "another sensor of the configuration, taken as correct")
      ->type_name("NAME");
  command->add_option("--speed", options->speeds_m_s, "a known wind speed; give it twice")
      ->type_name("M_S")
      ->check(CLI::Range(0.1, 100.0))
      ->expected(1)
      ->take_all();
  command
      ->add_option("--points", options->points,
                   "reading:true in m/s, rising; readings with the microphone's present settings")
      ->type_name("\"SAID:TRUE ...\"");
  command->callback([options] { calibrate_microphone(*options); });
}

}  // namespace yuragi::daemon::commands
