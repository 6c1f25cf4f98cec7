#include "daemon/state/attention.hpp"

#include <fmt/format.h>

#include "engine/base/count_text.hpp"

namespace yuragi::daemon::state {
namespace {

void add_recorder_attention(std::vector<std::string>& all, const wire::RecorderStatus& recorder) {
  if (recorder.state == wire::RecorderState::kRetrying)
    all.push_back("the recorder cannot write, and tries again: " + recorder.error);
  if (recorder.state == wire::RecorderState::kHanging)
    all.push_back("the disk of the recording does not answer: " + recorder.error);
  if (!recorder.clock_doubt.empty()) all.push_back(recorder.clock_doubt);
  if (recorder.lost > 0)
    all.push_back(fmt::format("the recorder has dropped {} since the start", count_text(recorder.lost, "reading")));
  if (recorder.free_bytes && static_cast<double>(*recorder.free_bytes) < kLittleFreeSpace_bytes) {
    all.push_back(fmt::format("the disk of the recording is nearly full: {:.0f} MB free",
                              1e-6 * static_cast<double>(*recorder.free_bytes)));
  }
}

}  // namespace

std::vector<std::string> needs_attention(const wire::Sensors& sensors) {
  std::vector<std::string> all;
  for (const wire::SensorStatus& sensor : sensors.sensors) {
    if (is_believed(sensor.state)) continue;
    const std::string& why = sensor.state_reason.empty() ? sensor.detail : sensor.state_reason;
    all.push_back(fmt::format("sensor {} is {}{}{}", sensor.name, name_of(sensor.state), why.empty() ? "" : ": ", why));
  }
  if (sensors.recorder) add_recorder_attention(all, *sensors.recorder);
  if (sensors.tick_lateness && sensors.tick_lateness->p99_s > kLateTicks_s) {
    all.push_back(fmt::format("the animation is late: 1 % of its ticks by more than {:.0f} ms ({} skipped)",
                              1e3 * sensors.tick_lateness->p99_s, sensors.late_ticks));
  }
  if (sensors.io_lateness && sensors.io_lateness->p99_s > kLateIo_s) {
    all.push_back(fmt::format("the thread of sensors and clients is late: 1 % of its steps by more than {:.0f} ms",
                              1e3 * sensors.io_lateness->p99_s));
  }
  return all;
}

}  // namespace yuragi::daemon::state
