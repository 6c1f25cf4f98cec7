#include "daemon/settings/recording_config.hpp"

#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace yuragi::daemon::settings {
namespace {

constexpr std::array<std::string_view, 2> kRotationNames = {"never", "day"};

std::uint64_t whole_bytes_of(double megabytes) {
  constexpr double kMegabyte = 1e6;
  return static_cast<std::uint64_t>(std::llround(megabytes * kMegabyte));
}

std::optional<std::filesystem::path> path_unless_empty(const std::string& text) {
  if (text.empty()) return std::nullopt;
  return text;
}

}  // namespace

const Fields<RecordingConfig>& recording_fields() {
  static const Fields<RecordingConfig> kFields{
      {{.name = "file",
        .default_value = std::string(),
        .help = "record every reading into this file (.windlog); empty: record nothing; --record FILE overrides it",
        .change = KeyChange::kTakesRestart},
       &RecordingConfig::file,
       path_unless_empty},
      {{.name = "rotate",
        .default_value = std::string("never"),
        .help = "begin a new file: never, or each day (UTC); completed files lie beside it, each with the moment of "
                "its beginning in its name, and all of them are read as one recording",
        .choices = kRotationNames},
       &RecordingConfig::is_daily,
       [](const std::string& word) { return word == kRotationNames[1]; }},
      {{.name = "max_file_size",
        .unit = "MB",
        .default_value = 0.0,
        .min = 0.0,
        .max = 1e6,
        .help = "begin a new file when this one is larger; 0: never"},
       &RecordingConfig::most_file_bytes,
       whole_bytes_of},
      {{.name = "keep_days",
        .unit = "days",
        .default_value = std::int64_t{0},
        .min = 0,
        .max = 36500,
        .help = "delete completed files that ended longer ago; 0: keep them"},
       &RecordingConfig::keep_days},
      {{.name = "max_size",
        .unit = "MB",
        .default_value = 0.0,
        .min = 0.0,
        .max = 1e9,
        .help = "delete the oldest completed files while all files together are larger; 0: keep them"},
       &RecordingConfig::most_bytes,
       whole_bytes_of},
      {{.name = "min_free",
        .unit = "MB",
        .default_value = 200.0,
        .min = 0.0,
        .max = 1e9,
        .help = "space to leave free on the disk: below it the oldest completed files are deleted, and if that is "
                "not enough nothing is recorded"},
       &RecordingConfig::least_free_bytes,
       whole_bytes_of},
  };
  return kFields;
}

}  // namespace yuragi::daemon::settings
