#include "daemon/state/attention.hpp"

#include <fmt/format.h>

#include "engine/base/count_text.hpp"
#include "engine/wire/sensor_trouble.hpp"

namespace yuragi::daemon::state {
namespace {

constexpr std::string_view kOutOfStep = "the screens of the wall are out of step by more than 5 ms: ";

void add_recorder_attention(std::vector<std::string>& all, const wire::RecorderStatus& recorder) {
  if (recorder.state == wire::RecorderState::kRetrying)
    all.push_back("the recorder cannot write, and tries again: " + recorder.error);
  if (recorder.state == wire::RecorderState::kHanging)
    all.push_back("the disk of the recording does not respond: " + recorder.error);
  if (!recorder.clock_doubt.empty()) all.push_back(recorder.clock_doubt);
  if (recorder.lost > 0)
    all.push_back(fmt::format("the recorder has dropped {} since the start", count_text(recorder.lost, "reading")));
  if (recorder.free_bytes && static_cast<double>(*recorder.free_bytes) < kLittleFreeSpace_bytes) {
    all.push_back(fmt::format("the disk of the recording is nearly full: {:.0f} MB free",
                              1e-6 * static_cast<double>(*recorder.free_bytes)));
  }
}

/// Empty if the animation is on time.
std::string stutter_of(const wire::Sensors& sensors) {
  const auto ticks = static_cast<double>(sensors.recent_ticks);
  const auto skipped = static_cast<double>(sensors.recent_skipped_ticks);
  if (ticks < kMinJudgedTicks || skipped < kMaxSkippedShare * ticks) return {};
  return fmt::format(
      "the animation stutters: {:.1f} % of the ticks of the last 10 minutes were skipped ({} of {}). The machine has "
      "too much to do: end other programs, or make scenes smaller (`yuragi status` shows what each takes)",
      100.0 * skipped / ticks, sensors.recent_skipped_ticks, sensors.recent_ticks);
}

}  // namespace

std::vector<std::string> needs_attention(const wire::Sensors& sensors) {
  std::vector<std::string> all;
  for (const wire::SensorStatus& sensor : sensors.sensors) {
    if (const std::string trouble = trouble_of(sensor); !trouble.empty())
      all.push_back(fmt::format("sensor {} {}", sensor.name, trouble));
  }
  all.insert(all.end(), sensors.troubles.begin(), sensors.troubles.end());
  if (sensors.recorder) add_recorder_attention(all, *sensors.recorder);
  if (const std::string stutter = stutter_of(sensors); !stutter.empty()) all.push_back(stutter);
  if (sensors.by_hand.blackout && !sensors.by_hand.blackout->left_s) {
    all.push_back("the walls are dark by hand until somebody ends it (`yuragi hand release blackout`)");
  }
  if (sensors.io_lateness && sensors.io_lateness->p99_s > kLateIo_s) {
    all.push_back(fmt::format(
        "the thread of sensors and clients is late: 1 % of its steps of the last 10 minutes by more than {:.0f} ms",
        1e3 * sensors.io_lateness->p99_s));
  }
  return all;
}

std::string clock_trouble(const platform::ClockOffset& offset) {
  if (!offset.is_large()) return {};
  return std::string(kOutOfStep) + text_of(offset) + "; `chronyc sources` shows what sets it";
}

std::string clock_trouble_of_viewer(std::string_view viewer, double offset_s) {
  const platform::ClockOffset offset{.offset_s = offset_s, .source = fmt::format("the viewer at {}", viewer)};
  if (!offset.is_large()) return {};
  return std::string(kOutOfStep) + text_of(offset) + "; `chronyc sources` on its machine shows what sets it";
}

}  // namespace yuragi::daemon::state
