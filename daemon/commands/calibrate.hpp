#pragma once

#include <CLI/CLI.hpp>

#include "daemon/tools/calibration/calibration_session.hpp"

namespace yuragi::daemon::commands {

// One of these a file; each adds itself to `yuragi calibrate`.
void add_calibrate_zero(CLI::App& calibrate);
void add_calibrate_north(CLI::App& calibrate);
void add_calibrate_span(CLI::App& calibrate);
void add_calibrate_microphone(CLI::App& calibrate);

/// Adds the options that all of them have; `default_duration` is for the help.
void add_calibration_request(CLI::App& command, tools::calibration::Request& request,
                             const std::string& default_duration);

/// Adds --json, for a program that leads a person: of those that the page offers.
void add_calibration_json(CLI::App& command, tools::calibration::Request& request);

}  // namespace yuragi::daemon::commands
