#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "daemon/settings/config.hpp"
#include "daemon/web/fault_counts.hpp"
#include "daemon/web/log_line.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::service {

struct Options {
  std::optional<std::filesystem::path> record;  ///< record the readings into this file
  std::optional<double> duration_s;             ///< end after this long
  bool end_with_recordings = false;             ///< end when every sensor is a recording that has ended
  bool with_scenes = true;                      ///< false: sensors, recording and their stream only
  /// Opening hours by the clock of the recordings that play, from this moment on; nullopt: by this machine's clock.
  std::optional<UtcTime> recorded_from{};
  /// Only if every sensor plays a recording: before the first frame wind and scenes are advanced through this time
  /// before the start of the recordings, as fast as possible.
  double lead_s = 0.0;

  /// The file of the configuration, and how it is read again on SIGHUP or for a client: on another thread, which may
  /// outlive the service and everything else; throws ConfigError. Empty: there is no file.
  std::filesystem::path config_file = {};
  std::function<settings::Config()> read_config = {};
  /// ReloadParts::rehearse; on that thread, too.
  std::function<std::vector<std::string>(const settings::Config& running, const settings::Config& next)> rehearse = {};
  /// Called with [log] level when it has changed.
  std::function<void(settings::LogLevel)> set_log_level = {};
  /// The daemon ends for a restart that the page asks for: run() returns true. false: the page may not ask for one.
  bool can_be_restarted = false;
  /// The last lines of the log. Thread-safe. Empty: there is none.
  web::LogTail log_tail = {};
  /// How many exceptions were contained. Empty: they are not counted.
  web::FaultCounter fault_counter = {};
};

/// The daemon: joins sensors, wind, animation, stream and recording. The data flow:
///
///   sensors -> SensorHub -> WindShaper -> Latest<DrivingWind> -> animation::Loop -> Latest<frame> -> TcpStream
///                 `-> Recorder
///
/// Everything except the threads of sensors, animation and recorder runs on the one I/O thread, which is the
/// caller of run().
class Service {
 public:
  /// Opens the listening socket, the sensors and, last of all, the recording: a start that fails does not change it.
  /// Throws ConfigError or FailureError. SIGINT and SIGTERM keep their default action until run(); a SIGHUP that was
  /// held back (hold_back_hangups()) waits for it.
  Service(const settings::Config& config, const Options& options);
  ~Service();

  /// Runs until SIGINT, SIGTERM, a terminal that is closed, or until the options end it; SIGHUP reads the configuration
  /// again (Reload). Returns in under a second after that. Throws std::runtime_error, with the recording closed, if
  /// the animation has failed by an error of this program. Returns true if it is to be started again, as
  /// Options::can_be_restarted allows.
  bool run();

 private:
  class Io;  // keeps Asio, which is slow to compile, in one file
  std::unique_ptr<Io> io_;
};

}  // namespace yuragi::daemon::service
