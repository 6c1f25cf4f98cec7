#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::sensing {

/// settings::recorded_unchanged_for_s() of a sensor of a recording, in log time: by its name, or the one with the first
/// reading where it is empty. 0 for "*", all sensors as one, and for what cannot be read. Reads the file.
double recorded_unchanged_for_s(const std::filesystem::path& recording, std::string_view sensor);

/// settings::recorded_value() of the same sensor.
std::optional<drivers::sensor::StatedValue> recorded_value(const std::filesystem::path& recording,
                                                           std::string_view sensor);

/// The configuration, in which each sensor that plays a recording, and the fall-back recording, may be silent for as
/// long as what was recorded might, at the rate at which it is played: the silence of a source that spoke on change
/// only is no gap, live or played. The recorded sensor's driver states what the speeds are. Reads the
/// recordings; what cannot be read yet is left as it is.
settings::Config with_recorded_sources(settings::Config config);

}  // namespace yuragi::daemon::sensing
