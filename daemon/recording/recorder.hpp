#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <thread>
#include <utility>

#include "daemon/recording/clock_synchronization.hpp"
#include "daemon/recording/recorder_status.hpp"
#include "daemon/recording/recorder_worker.hpp"

namespace yuragi::daemon::recording {

/// Writes readings to a recording (.windlog) on a thread of its own, so that a slow disk delays nobody.
///
/// Commits once a second: a crash or a power cut loses no more than that. If the disk is full or gone, it keeps
/// up to kMaxPending readings, retries at growing intervals, and counts the readings that it had to drop; it then
/// reopens the file and continues in a new session. If the file is moved away or another one takes its name, it
/// completes the one that it wrote and continues in the one of that name. If the name can no longer be looked up
/// (permissions, a loop of links, a network that is gone) it continues to write to the file that is open. An exception
/// on its thread counts as a failure to write. A disk that hangs delays only its thread, and is shown in the status.
class Recorder {
 public:
  /// How many readings it keeps while it cannot write: over an hour of one sensor at 10 Hz.
  static constexpr std::size_t kMaxPending = RecorderWorker::kMaxPending;

  /// Opens the recording, or creates it so that others cannot read it (mode 0640), and begins its session; a recording
  /// of an older format is renamed first (set_older_recording_aside). `report` is called on the recorder's thread, in
  /// the constructor, or in close(). If it cannot, it throws FailureError (kCannotCreate) or, depending on `start`,
  /// retries; a damaged or foreign file is never overwritten. If another program records to it (SeriesLock) it retries,
  /// and takes over when that program has ended; readings that the other program recorded are not written again
  /// (RecorderStatus::recorded_elsewhere). `rules`: when a new file is begun, and what is deleted; its `file` is not
  /// looked at. `synchronized_file`: for is_synchronized(). While the date of what is pushed is doubted (ClockJudge)
  /// age deletes nothing, and FILE-clock exists.
  Recorder(const std::filesystem::path& file, Info info, RecorderReport report = {}, const RecorderLimits& limits = {},
           const settings::RecordingConfig& rules = {},
           const std::filesystem::path& synchronized_file = kSynchronizedFile,
           RecorderStart start = RecorderStart::kMustOpen);
  ~Recorder();  ///< closes
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Takes a reading of `info.sensors[sensor]`; false if it is dropped (and counted) because it cannot be recorded (no
  /// such sensor, values that are not finite) or too many wait. Call it from one thread. Realtime-safe: yes;
  /// wait-free.
  bool push(std::size_t sensor, const wind::Reading& reading) noexcept { return worker_->push(sensor, reading); }

  /// Takes what the station of `info.sensors[sensor]` reports besides the wind; false if it is dropped (and counted)
  /// because too much waits. At most one row a sensor and second is written (drivers/windlog/format.hpp). As push()
  /// otherwise.
  bool push(std::size_t sensor, const wind::StationQuantities& quantities) noexcept {
    return worker_->push(sensor, quantities);
  }

  /// What is pushed from now on belongs to a new session, with another configuration; the rules take effect at once.
  /// Nothing is lost by it. `info` has the same sensors in the same order. Call it on the thread that pushes.
  /// Thread-safe: as push(). Realtime-safe: no; waits for no disk.
  void begin_session(Info info, const settings::RecordingConfig& rules) {
    worker_->begin_session(std::move(info), rules);
  }

  /// Writes what is pending, closes the file without side files, and waits for that: well under a second on a working
  /// disk. If the disk does not respond within RecorderLimits::most_at_end, it reports how many readings were not
  /// written, and leaves its thread and the file to the end of the process. Nothing may be pushed after it; a second
  /// call does nothing.
  void close();

  /// Thread-safe: yes. Realtime-safe: no.
  RecorderStatus status() const { return worker_->status(); }

  /// Waits until `is_so` holds for its status; false if it does not within `at_most`. Thread-safe: yes. Realtime-safe:
  /// no.
  bool wait_until(const std::function<bool(const RecorderStatus&)>& is_so, Nanoseconds at_most) const {
    return worker_->wait_until(is_so, at_most);
  }

 private:
  RecorderLimits limits_;
  std::shared_ptr<RecorderWorker> worker_;  ///< held by the thread, too
  std::jthread thread_;
};

}  // namespace yuragi::daemon::recording
