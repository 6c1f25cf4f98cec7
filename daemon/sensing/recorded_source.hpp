#pragma once

#include <filesystem>
#include <string_view>

#include "daemon/settings/config.hpp"
#include "daemon/settings/recorded_sensor.hpp"

namespace yuragi::daemon::sensing {

/// settings::recorded_source() of a sensor of a recording: by its name, or if that is empty of the one with the first
/// reading. Times are in log time. Empty for "*", all sensors as one, and for what cannot be read. Reads the file.
settings::RecordedSource recorded_source(const std::filesystem::path& recording, std::string_view sensor);

/// The configuration, in which each sensor that plays a recording, and the fall-back recording, may be silent for as
/// long as what was recorded might, at the rate at which it is played: the silence of a source that sends only changes
/// is not a gap, live or played. The recorded sensor's driver states what the speeds are. Reads the
/// recordings; what cannot be read yet is left as it is.
settings::Config with_recorded_sources(settings::Config config);

}  // namespace yuragi::daemon::sensing
