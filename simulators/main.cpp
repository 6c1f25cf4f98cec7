#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include "engine/base/version.hpp"
#include "engine/base/word_suggestion.hpp"
#include "simulators/core/commands.hpp"
#include "simulators/davis/commands.hpp"
#include "simulators/lufft/commands.hpp"
#include "simulators/microphone/commands.hpp"
#include "simulators/modbus/commands.hpp"
#include "simulators/network/commands.hpp"
#include "simulators/text/commands.hpp"
#include "simulators/usb/commands.hpp"

namespace {

// sysexits.h, as the other programs have them.
constexpr int kExitUsage = 64;
constexpr int kExitUnavailable = 69;

int run(int argc, char** argv) {
  CLI::App app{"Simulated wind sensors, with the protocols of real ones and with faults on demand.", "yuragi-sim"};
  app.set_version_flag("--version", yuragi::with_version("yuragi-sim"));
  app.require_subcommand(1);
  yuragi::simulators::microphone::add_microphone_command(app);
  yuragi::simulators::modbus::add_modbus_command(app);
  yuragi::simulators::text::add_nmea_command(app);
  yuragi::simulators::text::add_nmea2000_command(app);
  yuragi::simulators::text::add_signalk_command(app);
  yuragi::simulators::text::add_line_command(app);
  yuragi::simulators::davis::add_davis_command(app);
  yuragi::simulators::davis::add_weatherlink_live_command(app);
  yuragi::simulators::lufft::add_umb_command(app);
  yuragi::simulators::network::add_ecowitt_command(app);
  yuragi::simulators::network::add_ecowitt_push_command(app);
  yuragi::simulators::network::add_osc_command(app);
  yuragi::simulators::network::add_tempest_command(app);
  yuragi::simulators::usb::add_hid_command(app);
  yuragi::simulators::usb::add_usb_command(app);
  yuragi::simulators::core::add_recording_command(app);
  yuragi::simulators::core::add_scenario_command(app);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();  // of the program that was launched (launched_program.hpp)
  } catch (const CLI::ParseError& error) {
    if (const std::string text = yuragi::unexpected_arguments_of(app); error.get_exit_code() != 0 && !text.empty()) {
      std::fprintf(stderr, "yuragi-sim: %s\nRun with --help for more information.\n", text.c_str());
      return kExitUsage;
    }
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "yuragi-sim: %s\n", error.what());
    return kExitUnavailable;
  }
}
