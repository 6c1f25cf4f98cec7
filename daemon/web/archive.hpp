#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/http/server.hpp"
#include "daemon/settings/page_file.hpp"
#include "daemon/web/calibration_order.hpp"
#include "daemon/web/page_setup.hpp"

namespace yuragi::daemon::web {

/// What the daemon's files are.
struct ArchiveSettings {
  std::filesystem::path recording = {};      ///< the one that is written, or a series; empty: nothing is recorded
  std::uint64_t least_free_bytes = 0;        ///< a copy must leave so much on the recording's disk
  std::filesystem::path configuration = {};  ///< empty: the built-in one
  std::string stream = {};                   ///< where the daemon's stream listens; empty: as configured
  std::filesystem::path page = {};           ///< what the page has set up; empty: it sets up nothing
  std::vector<settings::SensorConfig> sensors = {};       ///< as the daemon has them open
  TakingOver taking_over = {};                            ///< of what the page has changed
  std::vector<std::string> program = {"/proc/self/exe"};  ///< the program that carries out jobs
};

/// A request about the daemon's files.
struct ArchiveRequest {
  enum class What : std::uint8_t {
    kList,      ///< the recordings
    kDownload,  ///< of a recording that is completed
    kVerify,    ///< a job, as the next three
    kReport,
    kCopy,
    kSupportBundle,
    kJob,        ///< how a job is
    kJobFile,    ///< what a job has made
    kCancelJob,  ///< and how it is then
    kConfiguration,
    kDrivers,      ///< and those of their keys that the page may set
    kSensors,      ///< that the page has set up
    kFindSensors,  ///< a job
    kTrySensor,    ///< a job
    kAddSensor,
    kRemoveSensor,
    kCalibrations,       ///< how each sensor can be calibrated
    kCalibrate,          ///< a job
    kKeepCalibration,    ///< of values that a job has found
    kForgetCalibration,  ///< that the page has made of a sensor of the configuration
    kKept,               ///< values of [look] and of scenes
    kKeep,
    kForgetKept,
    kUndoPage,
  };

  What what = What::kList;
  std::string name = {};             ///< of the recording or the sensor, or the id of the job; hostile
  settings::PageSensor sensor = {};  ///< to try or to add; hostile
  CalibrationOrder calibration = {};
  FoundCalibration found = {};                       ///< to keep; hostile
  std::vector<settings::ParameterEdit> values = {};  ///< to keep; hostile
};

/// The daemon's files for those who may change something: its recordings, its configuration, and jobs about them
/// (Jobs). Each request is answered on a thread of its own, so that a disk that hangs delays no other answer.
/// Thread-safe: no.
class Archive {
 public:
  /// Further requests are refused (503) while so many wait for the disk, or so many files are being sent.
  static constexpr std::size_t kMaxWaiting = 16;
  static constexpr std::size_t kMaxDownloads = 3;

  explicit Archive(ArchiveSettings settings);
  /// Ends the jobs.
  ~Archive();
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  /// Calls `reply` once, at once or on the thread; never after a disk that hangs for ever.
  void answer(ArchiveRequest request, std::function<void(http::Response)> reply);

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;  ///< the thread has it, too
};

}  // namespace yuragi::daemon::web
