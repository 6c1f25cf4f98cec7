#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::service {

struct ServiceOptions {
  std::optional<std::filesystem::path> record;  ///< record the readings into this file
  std::optional<double> duration_s;             ///< end after this long
  bool end_with_recordings = false;             ///< end when every sensor is a recording that has ended
  bool with_scenes = true;                      ///< false: sensors, recording and their stream only
};

/// The daemon: joins sensors, wind, animation, stream and recording. The data flow:
///
///   sensors -> SensorHub -> WindShaper -> Latest<DrivingWind> -> AnimationLoop -> Latest<frame> -> TcpStream
///                 `-> Recorder
///
/// Everything but the sensors' threads, the animation's and the recorder's runs on the one I/O thread, which is the
/// caller of run().
class Service {
 public:
  /// Opens the sensors, the listening socket and the recording. Throws ConfigError or FailureError.
  Service(const settings::Config& config, const ServiceOptions& options);
  ~Service();

  /// Runs until SIGINT or SIGTERM, or until the options end it. Returns in under a second after that.
  void run();

 private:
  class Io;  // keeps Asio, which is slow to compile, in one file
  std::unique_ptr<Io> io_;
};

}  // namespace yuragi::daemon::service
