#pragma once

#include <cstdlib>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/sensor/driver.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/places.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/running_sensor.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::test {

/// The driver `microphone`, its real worker, PortAudio and alsa-lib, on sound cards that a test makes up.
class MicrophoneRig {
 public:
  /// `cards`: definitions of PCMs in alsa-lib's own language.
  explicit MicrophoneRig(const std::string& cards) {
    // PortAudio 19.6.0 aborts where no PCM is called "default".
    std::ofstream(folder_ / "asound.conf") << "pcm.default { type null }\n" << cards;
    setenv("ALSA_CONFIG_PATH", (folder_ / "asound.conf").c_str(), 1);  // NOLINT(concurrency-mt-unsafe): one thread yet
  }

  void open(ParameterValues::Map given) {
    given.try_emplace("worker", built_path("bin/yuragi"));
    sensor_.emplace(driver_named("microphone").open(values_for("microphone", given)));
  }
  /// Ends the driver, as the daemon does.
  void close() {
    sensor_->end();
    wait_until([] { return true; });
    sensor_.reset();
  }

  /// Waits until `holds()`, which looks at the sink; false if it hangs, or does not within a shorter time.
  template <class Condition>
  bool wait_until(Condition&& holds, Nanoseconds at_most = RunningSensor::kHang) {
    return sensor_->take_until(sink, std::forward<Condition>(holds), at_most);
  }

  /// The mean of the next `count` speeds; throws if they do not come.
  double next_speed_m_s(std::size_t count = 4) {
    wait_until([] { return true; });
    const std::size_t before = sink.readings.size();
    if (!wait_until([&] { return sink.readings.size() >= before + count; })) {
      throw std::runtime_error("no readings: " + sink.last_detail());
    }
    double sum = 0.0;
    for (std::size_t i = before; i < before + count; ++i) sum += sink.readings[i].speed_m_s;
    return sum / static_cast<double>(count);
  }

  std::filesystem::path file(const std::string& name) const { return folder_ / name; }

  RecordingSink sink;

 private:
  TemporaryFolder folder_;
  std::optional<RunningSensor> sensor_;
};

/// `yuragi-sim microphone`, told what to do by lines.
class MicrophoneSimulatorProcess {
 public:
  explicit MicrophoneSimulatorProcess(const std::vector<std::string>& options)
      : process_([&] {
          std::vector<std::string> command = {built_path("bin/yuragi-sim"), "microphone"};
          command.insert(command.end(), options.begin(), options.end());
          return command;
        }()) {
    process_.line_after("sounding");
  }

  void suffer(const std::string& fault) {
    process_.type(fault + " 600");
    process_.line_after(fault + " for 600 s");
  }
  void recover() {
    process_.type("clear");
    process_.line_after("no faults");
  }

 private:
  ChildProcess process_;
};

}  // namespace yuragi::test
