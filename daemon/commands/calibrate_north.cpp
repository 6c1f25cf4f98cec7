// `yuragi calibrate north`: determines the vane's offset from true north.
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "daemon/commands/calibrate.hpp"
#include "daemon/commands/exit.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr double kMinVaneSpeed_m_s = 1.0;  // below it a vane does not turn
constexpr double kTurnBlock_s = 10.0;

struct NorthOptions {
  tools::calibration::Request request;
  std::optional<double> bearing_deg;
};

/// The offset of the vane, by pointing it at a landmark of known bearing.
double turn_by_landmark(tools::calibration::Session& session, double bearing_deg) {
  const tools::calibration::CollectedReadings collected = session.collect(bearing_deg);
  std::vector<double> indicated_deg;
  for (const tools::calibration::TimedReading& one : collected[0].readings) {
    if (one.reading.direction_deg) indicated_deg.push_back(*one.reading.direction_deg);
  }
  const wind::judging::DirectionMean mean =
      tools::calibration::value_or_refuse(wind::judging::measure_held_vane(indicated_deg));
  session.dialog().print(
      fmt::format("\nThe vane reads {:.1f} deg, standard deviation {:.1f} deg, over {}; the true bearing is {:g}.",
                  mean.mean_deg, mean.spread_deg, count_text(mean.count, "reading"), bearing_deg));
  return bearing_deg - mean.mean_deg;
}

std::vector<wind::judging::TimedDirection> directions_of(const tools::calibration::SensorReadings& collected,
                                                         const wind::judging::Calibration& calibration) {
  std::vector<wind::judging::TimedDirection> directions;
  for (const tools::calibration::TimedReading& one : collected.readings) {
    const wind::Reading reading = calibration.applied_to(one.reading);
    if (reading.direction_deg && reading.speed_m_s >= kMinVaneSpeed_m_s) {
      directions.push_back({one.time_s, *reading.direction_deg});
    }
  }
  return directions;
}

/// The offset, by comparison with another vane in the same wind.
double turn_by_reference(tools::calibration::Session& session) {
  const tools::calibration::CollectedReadings collected = session.collect();
  wind::judging::Calibration without_north = session.calibration();
  without_north.north_offset_deg = 0.0;
  const std::vector<double> turns_deg =
      wind::judging::pair_turns(directions_of(collected[0], without_north),
                                directions_of(collected[1], session.reference()->calibration), kTurnBlock_s);
  const wind::judging::DirectionMean turn = tools::calibration::value_or_refuse(wind::judging::measure_turn(turns_deg));
  session.dialog().print(
      fmt::format("\nThe difference is {:+.1f} deg, standard deviation {:.1f} deg, over {} means of {:g} s.",
                  wind::judging::signed_degrees(turn.mean_deg), turn.spread_deg, turn.count, kTurnBlock_s));
  return turn.mean_deg;
}

void calibrate_north(NorthOptions options) {
  const bool has_reference = !options.request.reference.empty();
  if (has_reference && options.bearing_deg) throw ExitError(kExitUsage, "give --bearing or --reference, not both");
  tools::calibration::Session session(
      options.request, tools::calibration::way_of("north", has_reference ? tools::calibration::Given::kReference
                                                                         : tools::calibration::Given::kBearing));
  if (session.part_count() > 1) throw ExitError(kExitUsage, "--part: give only one");
  if (!has_reference && !options.bearing_deg) {
    if (!session.dialog().has_person()) throw ExitError(kExitUsage, "give --bearing DEG or --reference NAME");
    session.dialog().print(
        "\n"
        "Choose a distant landmark: a tower, a summit. Take its bearing from the sensor from a map (true north: a\n"
        "compass deviates by the declination, and by more near steel).");
    options.bearing_deg = session.dialog().prompt_number("Its bearing, degrees clockwise from north", 0.0, 360.0);
  }

  const double turn_deg = has_reference ? turn_by_reference(session) : turn_by_landmark(session, *options.bearing_deg);
  const double north_offset_deg = tools::calibration::rounded(wind::judging::signed_degrees(turn_deg), 0.1);
  wind::judging::Calibration now = session.calibration();
  wind::judging::Calibration then = now;
  then.north_offset_deg = north_offset_deg;
  tools::calibration::Effect effect{.indicated_unit = "deg", .unit = "deg"};
  for (const double indicated_deg : {0.0, 90.0, 180.0, 270.0}) {
    wind::Reading reading;
    reading.direction_deg = indicated_deg;
    effect.rows.push_back({.indicated = indicated_deg,
                           .now = *now.applied_to(reading).direction_deg,
                           .then = *then.applied_to(reading).direction_deg});
  }
  session.finish({{"calibration", "north_offset", north_offset_deg}}, effect);
}

}  // namespace

void add_calibrate_north(CLI::App& calibrate) {
  CLI::App* command = calibrate.add_subcommand("north", "point the vane to a landmark of known bearing (north_offset)");
  command->footer(
      "Directions are averaged as vectors, so that the mean of 350 and 10 degrees is 0. A vane that moves is refused.\n"
      "--reference compares with another vane in the same wind instead. If nothing turns (a sonic anemometer), sight "
      "along\n"
      "its north mark: the bearing of the mark is north_offset itself.\n"
      "  yuragi calibrate north --config wall.toml --sensor roof --bearing 214\n"
      "  yuragi calibrate north --config wall.toml --sensor roof --reference mast --recording may.windlog");
  auto options = std::make_shared<NorthOptions>();
  add_calibration_request(*command, options->request, "20; with --reference 900");
  add_calibration_json(*command, options->request);
  command->add_option("--bearing", options->bearing_deg, "of the landmark, clockwise from true north")
      ->type_name("DEG")
      ->check(CLI::Range(0.0, 360.0));
  command
      ->add_option("--reference", options->request.reference, "another sensor of the configuration, taken as correct")
      ->type_name("NAME");
  command->callback([options] { calibrate_north(*options); });
}

}  // namespace yuragi::daemon::commands
