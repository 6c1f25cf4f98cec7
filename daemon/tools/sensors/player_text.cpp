#include "daemon/tools/sensors/player_text.hpp"

#include <chrono>
#include <cmath>

#include <fmt/chrono.h>

namespace yuragi::daemon::tools::sensors {
namespace {

/// "1:02:03.4"
std::string clock_text(double time_s) {
  const auto tenths = static_cast<std::int64_t>(std::floor(time_s * 10.0 + 1e-6));
  const std::int64_t whole_s = tenths / 10;
  return fmt::format("{}:{:02}:{:02}.{}", whole_s / 3600, whole_s / 60 % 60, whole_s % 60, tenths % 10);
}

}  // namespace

std::string player_text(const wire::PlayerState& player) {
  if (!player.is_open) return fmt::format("{}: {} cannot be read at present\n", player.sensor, player.file);
  const char* doing = player.is_finished ? "finished" : player.is_paused ? "paused" : "playing";
  const std::time_t recorded =
      std::chrono::floor<std::chrono::seconds>(std::chrono::nanoseconds(player.recorded_utc_ns)).count();
  std::string text = fmt::format("{}: {} at {} of {}, rate {:g}", player.sensor, doing, clock_text(player.position_s),
                                 clock_text(player.length_s), player.rate);
  if (player.loops) text += fmt::format(", looping: round {}", player.rounds + 1);
  return text + fmt::format(", recorded {:%Y-%m-%dT%H:%M:%S}Z, {}\n", fmt::gmtime(recorded), player.file);
}

}  // namespace yuragi::daemon::tools::sensors
