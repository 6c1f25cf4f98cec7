#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/bus/byte_port.hpp"
#include "drivers/decode/microphone/mic_estimator.hpp"
#include "drivers/decode/microphone/mic_frame.hpp"
#include "drivers/sensor/found_device.hpp"
#include "drivers/sensor/reopening_sensor.hpp"

namespace yuragi::drivers::microphone {

struct Settings {
  decode::microphone::MicEstimatorOptions estimator{};
  bool is_calibrated = false;  ///< if not, every reading is uncertain
  /// For the worker's first frame: sound systems start slowly. After each start that took too long it is doubled, up to
  /// eight times this.
  Nanoseconds start_timeout = std::chrono::seconds(15);
  Nanoseconds sound_timeout = std::chrono::seconds(3);  ///< from block to block, of which there are four a second
};

/// Wind by microphone. The sound library runs in another process, the worker, whose frames come through `port`; this is
/// its watchdog: a worker that ends, sends no valid frame in time, or reports a failure is killed and started again,
/// without limit. One reading per block, with the time of the middle of the window that it is the mean of.
class Sensor final : public sensor::ReopeningSensor {
 public:
  Sensor(Settings settings, std::uint32_t seed, std::unique_ptr<bus::BytePort> port);

  void interrupt() noexcept override { port_->interrupt(); }

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override;
  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override;
  void close() noexcept override;

 private:
  void take(const decode::microphone::MicFrameReader::Item& item, const sensor::Clock& clock, sensor::Sink& sink);
  void take(const decode::microphone::MicHello& hello);
  void take(const decode::microphone::MicBlock& block, const Instant& now, sensor::Sink& sink);
  void publish(const decode::microphone::MicEstimate& estimate, const decode::microphone::MicBlock& block,
               const Instant& now, sensor::Sink& sink);
  std::string detail(const decode::microphone::MicEstimate& estimate) const;

  Settings settings_;
  std::unique_ptr<bus::BytePort> port_;
  decode::microphone::MicFrameReader reader_;
  std::optional<decode::microphone::MicHello> hello_;
  std::optional<decode::microphone::MicEstimator> estimator_;
  std::string trouble_;  ///< the worker's last message
  int patience_ = 1;     ///< times settings_.start_timeout
  Nanoseconds start_timeout_{};
  MonoTime deadline_{};
  std::array<std::uint8_t, 8192> buffer_{};
};

/// The `yuragi` program for the worker: this program if it is one, otherwise the one beside it or in the PATH.
std::string microphone_worker_program();

/// The inputs that the worker lists, and obstacles to the use of those that the system has. Waits for at most ten
/// seconds.
std::vector<sensor::FoundDevice> find_microphones(const std::string& worker);

}  // namespace yuragi::drivers::microphone
