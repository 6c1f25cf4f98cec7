// `yuragi calibrate zero`: determines the offset of the speed in still air.
#include <memory>

#include <fmt/format.h>

#include "daemon/commands/calibrate.hpp"
#include "daemon/commands/exit.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::commands {
namespace {

void calibrate_zero(const tools::calibration::Request& request) {
  tools::calibration::Session session(request, tools::calibration::way_of("zero", tools::calibration::Given::kNothing));
  if (session.part_count() > 1) throw ExitError(kExitUsage, "--part: give only one");
  const tools::calibration::CollectedReadings collected = session.collect();
  const wind::judging::Calibration calibration = session.calibration();
  const wind::judging::StillAir air = tools::calibration::value_or_refuse(
      wind::judging::measure_still_air(tools::calibration::indicated_speeds_m_s(collected[0], calibration)));
  session.dialog().print(
      fmt::format("\nIn still air the sensor reads {:.3f} m/s, standard deviation {:.3f} m/s, over {}.", air.mean_m_s,
                  air.noise_m_s, count_text(air.count, "reading")));
  if (air.mean_m_s == 0.0) {
    session.dialog().print("The sensor reads 0 in still air already: nothing to write.");
    return;
  }
  const double offset_m_s =
      tools::calibration::rounded(wind::judging::offset_for_zero_m_s(calibration, air.mean_m_s), 0.001);
  const std::vector<settings::ConfigChange> wanted = {{"calibration", "offset", offset_m_s}};
  session.finish(wanted, session.speed_effect(wanted, std::vector{air.mean_m_s, 2.0, 5.0, 10.0}));
}

}  // namespace

void add_calibrate_zero(CLI::App& calibrate) {
  CLI::App* command = calibrate.add_subcommand("zero", "still air: the reading in still air becomes 0 (offset)");
  command->footer(
      "Refused if the air moves. A cup anemometer reads 0 when it stands still and needs no zero; a sonic, a hot wire "
      "or a\n"
      "4-20 mA input may read some tenths.\n"
      "  yuragi calibrate zero --config wall.toml --sensor roof --for 60\n"
      "  yuragi calibrate zero --config wall.toml --sensor roof --recording night.windlog --part 120,300 --dry-run");
  auto request = std::make_shared<tools::calibration::Request>();
  add_calibration_request(*command, *request, "30");
  add_calibration_json(*command, *request);
  command->callback([request] { calibrate_zero(*request); });
}

}  // namespace yuragi::daemon::commands
