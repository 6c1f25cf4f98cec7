#pragma once

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/sensing/system_clock.hpp"
#include "drivers/sensor/driver.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/places.hpp"
#include "tests/support/recording_sink.hpp"
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
    for (const DriverDescription* driver : driver_table()) {
      if (driver->name == "microphone") sensor_ = driver->open(*ParameterValues::resolve(driver->parameters, given));
    }
    if (!sensor_) throw std::logic_error("no driver named microphone");
  }

  /// Polls until `is_there`; false if that takes longer than anything should.
  template <class Condition>
  bool poll_until(Condition&& is_there, double limit_s = 40.0) {
    const MonoTime deadline = clock_.now().mono + from_seconds(limit_s);
    while (!is_there() && clock_.now().mono < deadline) {
      const MonoTime next = sensor_->poll(clock_, sink);
      // Between attempts there is nothing to poll for; the driver's own reads wait by themselves.
      const Nanoseconds wait = std::min<Nanoseconds>(next - clock_.now().mono, std::chrono::milliseconds(20));
      if (wait > Nanoseconds::zero()) std::this_thread::sleep_for(wait);
    }
    return is_there();
  }

  /// The mean of the next `count` speeds; throws if they do not come.
  double next_speed_m_s(std::size_t count = 4) {
    const std::size_t before = sink.readings.size();
    if (!poll_until([&] { return sink.readings.size() >= before + count; })) {
      throw std::runtime_error("no readings: " + sink.last_detail());
    }
    double sum = 0.0;
    for (std::size_t i = before; i < before + count; ++i) sum += sink.readings[i].speed_m_s;
    return sum / static_cast<double>(count);
  }

  std::filesystem::path file(const std::string& name) const { return folder_ / name; }
  const SystemClock& clock() const { return clock_; }
  Sensor& sensor() { return *sensor_; }

  RecordingSink sink;

 private:
  TemporaryFolder folder_;
  SystemClock clock_;
  std::unique_ptr<Sensor> sensor_;
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
