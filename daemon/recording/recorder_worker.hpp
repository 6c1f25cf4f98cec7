#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/recording/clock_judge.hpp"
#include "daemon/recording/recorder_status.hpp"
#include "daemon/settings/recording_config.hpp"
#include "drivers/windlog/file_identity.hpp"
#include "drivers/windlog/series_lock.hpp"
#include "drivers/windlog/windlog_writer.hpp"
#include "engine/base/result.hpp"
#include "engine/base/spsc_ring.hpp"
#include "engine/base/time.hpp"
#include "engine/platform/backoff.hpp"
#include "engine/wind/station_quantities.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::recording {

struct RecordedSensor {
  std::string name;
  std::string driver;
  std::string options;  ///< TOML
};

/// Information about the run, for the recording.
struct Info {
  Instant started;
  std::string software;       ///< "yuragi 0.1.0"
  std::string configuration;  ///< TOML, as read
  std::vector<RecordedSensor> sensors;
};

/// Called with a sentence when writing begins to fail and when it works again, when an older recording was renamed, and
/// when a doubt of the clock begins and ends. Must not throw.
using RecorderReport = std::function<void(std::string_view)>;

/// The time limits of a Recorder.
struct RecorderLimits {
  Nanoseconds commit_every = std::chrono::seconds(1);
  Nanoseconds hang_after = std::chrono::seconds(5);   ///< a disk that has not responded for this long hangs
  Nanoseconds most_at_end = std::chrono::seconds(5);  ///< close() waits no longer
};

/// The work of a Recorder's thread: takes readings from a ring, writes them to the recording, and begins a new file and
/// deletes old ones by the rules. If the disk hangs, only this thread hangs: the other functions do not wait for the
/// disk, except for the constructor.
class RecorderWorker {
 public:
  static constexpr std::size_t kMaxPending = 65'536;
  static constexpr int kCommitsPerCheckpoint = 60;
  static constexpr Nanoseconds kSaveDoubtEvery = std::chrono::minutes(1);

  /// As Recorder::Recorder().
  RecorderWorker(const std::filesystem::path& file, const settings::RecordingConfig& rules, Info info,
                 RecorderReport report, const RecorderLimits& limits, std::filesystem::path synchronized_file,
                 RecorderStart start);

  /// Writes until `stop` is requested, then the rest, and closes the file.
  void run(const std::stop_token& stop);

  /// As Recorder::push(). Realtime-safe: yes; wait-free.
  bool push(std::size_t sensor, const wind::Reading& reading) noexcept;
  bool push(std::size_t sensor, const wind::StationQuantities& quantities) noexcept;

  /// As Recorder::begin_session().
  void begin_session(Info info, const settings::RecordingConfig& rules);

  /// Thread-safe: yes. Realtime-safe: no.
  RecorderStatus status() const;
  bool wait_until(const std::function<bool(const RecorderStatus&)>& is_so, Nanoseconds at_most) const;
  /// Waits until run() has come to its end; false if it does not within `at_most`.
  bool wait_for_end(Nanoseconds at_most) const;
  /// Reports `sentence` as the last one; nothing more is reported.
  void report_at_last(std::string_view sentence);

 private:
  /// A reading; or, with kNextSession in place of a sensor, the place between two where the next session begins.
  struct Entry {
    std::size_t sensor = 0;
    wind::Reading reading;
  };
  struct QuantitiesEntry {
    std::size_t sensor = 0;
    wind::StationQuantities quantities;
  };
  static constexpr std::size_t kNextSession = ~std::size_t{0};
  using SteadyTime = std::chrono::steady_clock::time_point;

  void finish();
  void give_up_pending();
  void flush();
  Result<void, Failure> try_to_write();
  Result<void, Failure> write_pending();
  Result<void, Failure> write_readings(std::size_t count);
  Result<void, Failure> write_quantities();
  Result<void, Failure> append_quantities(MonoTime before);
  void forget_quantities(MonoTime before);
  Result<void, Failure> learn_begin();
  Result<void, Failure> hold_lock();
  Result<void, Failure> leave_what_is_recorded();
  void leave_to_other(UtcTime until);
  Result<void, Failure> begin_recording(Instant started);
  Instant begin_of_pending(Instant first) const;
  Result<void, Failure> prepare_file(Instant first, Instant earliest);
  Result<void, Failure> begin_session_at(Instant started);
  void take_next_session();
  void take_rules();
  void push_marks() noexcept;
  Result<void, Failure> commit();
  Result<void, Failure> check_name() const;
  Result<void, Failure> open_file();
  Result<void, Failure> open_session(Instant started);
  Result<void, Failure> complete_file(UtcTime now);
  Result<void, Failure> make_room(UtcTime now);
  std::optional<UtcTime> newest_time() const;
  void judge_clock(Instant now);
  void save_doubt();
  std::optional<std::uint64_t> measure_free_space();
  void report(std::string_view sentence);
  void fail(const Failure& failure);
  void set_status(const std::string& error);
  RecorderStatus locked_status() const;

  std::filesystem::path file_;
  std::filesystem::path synchronized_file_;
  settings::RecordingConfig rules_;
  std::size_t sensor_count_;  ///< of every session; it never changes, so that push() may look at it
  Info info_;
  RecorderLimits limits_;
  SpscRing<Entry> ring_;
  SpscRing<QuantitiesEntry> quantities_ring_;
  std::atomic<std::uint64_t> pushed_{0};
  std::atomic<std::uint64_t> written_{0};
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::uint64_t> lost_quantities_{0};
  std::atomic<std::uint64_t> given_up_{0};            ///< of those that were pushed, the lost ones
  std::atomic<std::uint64_t> recorded_elsewhere_{0};  ///< of those that were pushed, the ones left to another program

  std::size_t marks_due_ = 0;  ///< of the thread that pushes: sessions whose place is not in the ring yet
  std::mutex sessions_mutex_;
  std::deque<Info> next_sessions_;
  std::optional<settings::RecordingConfig> next_rules_;

  std::mutex report_mutex_;
  RecorderReport report_;

  mutable std::mutex status_mutex_;
  mutable std::condition_variable status_changed_;
  std::string error_;
  UtcTime failing_since_{};  ///< while error_ is not empty
  std::optional<std::uint64_t> free_bytes_;
  std::optional<ClockDoubt> clock_doubt_;
  std::optional<SteadyTime> writing_since_;  ///< while it is at the disk
  bool has_ended_ = false;

  // The recorder's thread alone, once it runs.
  std::vector<Entry> pending_;
  std::vector<QuantitiesEntry> pending_quantities_;
  std::optional<drivers::windlog::SeriesLock> lock_;  ///< held while anything is opened, written or renamed
  bool was_held_elsewhere_ = false;  ///< the lock, so that pending readings can already be in the recording
  bool has_reported_no_locks_ = false;
  std::optional<drivers::windlog::Writer> writer_;
  drivers::windlog::FileIdentity identity_;  ///< of the file that writer_ writes
  std::optional<UtcTime> began_;             ///< that file's first session, once it has readings or quantities
  std::vector<std::int64_t> sensor_ids_;
  bool is_session_due_ = false;            ///< the next reading begins one
  int commits_ = 0;                        ///< since the file was opened
  std::optional<ClockJudge> clock_;        ///< from when the recording was first opened
  std::optional<ClockDoubt> saved_doubt_;  ///< as it is on the disk
  std::size_t may_delete_by_age_ = 0;      ///< until the next file is completed
  platform::Backoff back_off_{std::chrono::milliseconds(500), std::chrono::seconds(10), 1};
  SteadyTime retry_at_{};

  std::mutex wake_mutex_;
  std::condition_variable_any wake_;
};

}  // namespace yuragi::daemon::recording
