#pragma once

#include <CLI/CLI.hpp>

// Each adds one kind of simulator as a subcommand, from a file of the room that its namespace names. main() reports the
// exceptions of the callbacks.

namespace yuragi::simulators {
void add_recording_command(CLI::App& app);
void add_scenario_command(CLI::App& app);
}  // namespace yuragi::simulators

namespace yuragi::simulators::davis {
void add_davis_command(CLI::App& app);
void add_weatherlink_live_command(CLI::App& app);
}  // namespace yuragi::simulators::davis

namespace yuragi::simulators::lufft {
void add_umb_command(CLI::App& app);
}

namespace yuragi::simulators::microphone {
void add_microphone_command(CLI::App& app);
}

namespace yuragi::simulators::modbus {
void add_modbus_command(CLI::App& app);
}

namespace yuragi::simulators::network {
void add_ecowitt_command(CLI::App& app);
void add_ecowitt_push_command(CLI::App& app);
void add_osc_command(CLI::App& app);
void add_tempest_command(CLI::App& app);
}  // namespace yuragi::simulators::network

namespace yuragi::simulators::text {
void add_line_command(CLI::App& app);
void add_nmea_command(CLI::App& app);
void add_nmea2000_command(CLI::App& app);
void add_signalk_command(CLI::App& app);
}  // namespace yuragi::simulators::text

namespace yuragi::simulators::usb {
void add_hid_command(CLI::App& app);
void add_usb_command(CLI::App& app);
}  // namespace yuragi::simulators::usb
