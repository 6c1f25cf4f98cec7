#pragma once

#include <filesystem>
#include <string_view>

#include "daemon/settings/config.hpp"
#include "daemon/settings/recorded_sensor.hpp"

namespace yuragi::daemon::sensing {

/// settings::recorded_source() of a sensor of a recording: by its name; if that is empty, of the one with the first
/// reading. Times are in log time. Empty for "*", all sensors as one, and if the recording cannot be read. Reads the
/// file.
settings::RecordedSource recorded_source(const std::filesystem::path& recording, std::string_view sensor);

/// The configuration, in which each sensor that plays a recording, and the fall-back recording, can be silent for as
/// long as the recorded sensor could, at the rate of the playback: the silence of a source that sends only changes is
/// not a gap, live or played. The recorded sensor's driver states what the speeds are. Reads the recordings; sensors
/// whose recording cannot be read yet are unchanged.
settings::Config with_recorded_sources(settings::Config config);

}  // namespace yuragi::daemon::sensing
