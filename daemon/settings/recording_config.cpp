#include "daemon/settings/recording_config.hpp"

#include <cmath>
#include <string>

namespace yuragi::daemon::settings {
namespace {

std::uint64_t bytes_of(double megabytes) {
  constexpr double kMegabyte = 1e6;
  return static_cast<std::uint64_t>(std::llround(megabytes * kMegabyte));
}

}  // namespace

RecordingConfig recording_config_of(const ParameterValues& values) {
  RecordingConfig config{.file = {},
                         .is_daily = values.text("rotate") == kRotationNames[1],
                         .most_file_bytes = bytes_of(values.number("max_file_size")),
                         .keep_days = values.integer("keep_days"),
                         .most_bytes = bytes_of(values.number("max_size")),
                         .least_free_bytes = bytes_of(values.number("min_free"))};
  if (const std::string& file = values.text("file"); !file.empty()) config.file = file;
  return config;
}

}  // namespace yuragi::daemon::settings
