#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "daemon/settings/config.hpp"

namespace yuragi {

struct ServiceOptions {
  std::optional<std::filesystem::path> record;  ///< write what the sensors say into this recording
  std::optional<double> duration_s;             ///< end after this long
  bool end_with_recordings = false;             ///< end when every sensor is a recording that has come to its end
  bool with_scenes = true;                      ///< without: sensors, recording and their stream only
};

/// The daemon: sensors, wind, animation, stream and recording, put together. This is the one place where drivers and
/// engine meet, and it reads as the way of the data:
///
///   sensors -> SensorHub -> WindShaper -> Latest<DrivingWind> -> AnimationLoop -> Latest<frame> -> TcpStream
///                 `-> Recorder
///
/// Everything but the sensors' threads, the animation's and the recorder's runs on the one I/O thread, which is the
/// caller of run().
class Service {
 public:
  /// Opens what can be opened: sensors, the listening socket, the recording. Throws ConfigError or FailureError.
  Service(const Config& config, const ServiceOptions& options);
  ~Service();

  /// Runs until SIGINT or SIGTERM, or until the options end it. Returns in under a second after that.
  void run();

 private:
  class Io;  // keeps Asio, which is slow to compile, in one file
  std::unique_ptr<Io> io_;
};

}  // namespace yuragi
