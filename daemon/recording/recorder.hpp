#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "daemon/recording/file_identity.hpp"
#include "drivers/windlog/windlog_writer.hpp"
#include "engine/base/result.hpp"
#include "engine/base/spsc_ring.hpp"
#include "engine/base/time.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::recording {

struct RecordedSensor {
  std::string name;
  std::string driver;
  std::string options;  ///< TOML
};

/// What a recording says of the run that made it.
struct RecordingInfo {
  Instant started;
  std::string software;       ///< "yuragi 0.1.0"
  std::string configuration;  ///< TOML, as read
  std::vector<RecordedSensor> sensors;
};

struct RecorderStatus {
  std::uint64_t written = 0;  ///< readings committed to the disk
  std::uint64_t lost = 0;     ///< readings that were dropped
  std::string error;          ///< why it cannot write at present; empty while it can
};

/// Writes readings to a recording (.windlog) on a thread of its own, so that a slow disk delays nobody.
///
/// Commits every half second: a crash or a power cut loses no more than that. Where the disk is full or gone it keeps
/// up to kMaxPending readings, retries at growing intervals, and counts the readings that it had to drop; it then
/// reopens the file and continues in a new session. Where the file is moved away or another one takes its name, it
/// completes the one that it wrote and continues in the one of that name. Where the name can no longer be looked up
/// (permissions, a loop of links, a network that is gone) it continues to write to the file that is open. An exception
/// on its thread counts as a failure to write.
class Recorder {
 public:
  /// Called with a sentence when writing begins to fail and when it works again, on the recorder's thread. Must not
  /// throw.
  using Report = std::function<void(std::string_view)>;

  static constexpr Nanoseconds kCommitInterval = std::chrono::milliseconds(500);
  /// How many readings it keeps while it cannot write: over an hour of one sensor at 10 Hz.
  static constexpr std::size_t kMaxPending = 65'536;

  /// Opens or creates the recording and begins its session. Throws FailureError (kCannotCreate) where it cannot.
  Recorder(const std::filesystem::path& file, RecordingInfo info, Report report = {});
  ~Recorder();  ///< closes
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Takes a reading of `info.sensors[sensor]`; false if it is dropped (and counted) because it cannot be recorded (no
  /// such sensor, values that are not finite) or too many wait. To be called by one thread. Realtime-safe: yes;
  /// wait-free.
  bool push(std::size_t sensor, const wind::WindReading& reading) noexcept;

  /// Writes what is pending, closes the file without side files, and waits for that: well under a second on a working
  /// disk. Nothing may be pushed after it; a second call does nothing.
  void close();

  /// Thread-safe: yes. Realtime-safe: no.
  RecorderStatus status() const;

  /// Waits until `is_so` holds for its status; false if it does not within `at_most`. Thread-safe: yes. Realtime-safe:
  /// no.
  bool wait_until(const std::function<bool(const RecorderStatus&)>& is_so, Nanoseconds at_most) const;

 private:
  struct Entry {
    std::size_t sensor = 0;
    wind::WindReading reading;
  };

  void run(const std::stop_token& stop);
  void finish();
  void flush();
  Result<void, Failure> try_to_write();
  Result<void, Failure> write_pending();
  Result<void, Failure> check_name() const;
  Result<void, Failure> open_session(Instant started);
  void set_status(const std::string& error);
  RecorderStatus locked_status() const;

  std::filesystem::path file_;
  RecordingInfo info_;
  Report report_;
  SpscRing<Entry> ring_;
  std::atomic<std::uint64_t> written_{0};
  std::atomic<std::uint64_t> lost_{0};
  mutable std::mutex status_mutex_;
  mutable std::condition_variable status_changed_;
  std::string error_;

  // The recorder's thread alone, once it runs.
  std::vector<Entry> pending_;
  std::optional<drivers::windlog::WindlogWriter> writer_;
  FileIdentity identity_;  ///< of the file that writer_ writes
  std::vector<std::int64_t> sensor_ids_;
  Nanoseconds back_off_{0};
  std::chrono::steady_clock::time_point retry_at_{};

  std::mutex wake_mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it is joined before what it uses is destroyed
};

}  // namespace yuragi::daemon::recording
