#include "daemon/settings/log_config.hpp"

#include <array>
#include <string>
#include <string_view>

namespace yuragi::daemon::settings {
namespace {

constexpr std::array<std::string_view, 4> kLogLevelNames = {"debug", "info", "warning", "error"};

}  // namespace

const Fields<LogConfig>& log_fields() {
  static const Fields<LogConfig> kFields{
      {{.name = "level",
        .default_value = std::string("info"),
        .help = "lines of the log below this are not written; debug also has every attempt to connect to a "
                "sensor, and --verbose sets it",
        .choices = kLogLevelNames},
       &LogConfig::level},
  };
  return kFields;
}

}  // namespace yuragi::daemon::settings
