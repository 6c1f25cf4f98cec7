#include "daemon/recording/recorder_worker.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

#include "daemon/recording/clock_doubt_file.hpp"
#include "daemon/recording/clock_synchronization.hpp"
#include "daemon/recording/private_file.hpp"
#include "daemon/recording/retention.hpp"
#include "drivers/windlog/iso_time.hpp"
#include "drivers/windlog/older_recording.hpp"
#include "drivers/windlog/recording_files.hpp"
#include "drivers/windlog/recording_parts.hpp"
#include "engine/base/contain.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::recording {
namespace {

// Room for the readings between two commits, at tens of thousands a second.
constexpr std::size_t kRingCapacity = 16'384;
// The other quantities of stations wait in the ring, and as many again after it: minutes of a sensor.
constexpr std::size_t kQuantitiesCapacity = 1024;
/// Parts that began in the same second have the names of the seconds that follow.
constexpr int kMaxPartNames = 1000;

/// 0 if it cannot be known.
std::uint64_t size_of(const std::filesystem::path& file) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  return error ? 0 : bytes;
}

std::string megabytes(std::uint64_t bytes) {
  return std::to_string(bytes / 1'000'000) + " MB";
}

/// The earliest time of the other quantities of stations; precondition: there is at least one.
template <class Entries>
Instant earliest_of(const Entries& entries) {
  return std::ranges::min_element(entries, {}, [](const auto& entry) { return entry.quantities.time.mono; })
      ->quantities.time;
}

/// Records since when something waits for the disk.
class AtTheDisk {
 public:
  using Since = std::optional<std::chrono::steady_clock::time_point>;

  AtTheDisk(std::mutex& mutex, Since& since) : mutex_(mutex), since_(since) {
    const std::lock_guard lock(mutex_);
    since_ = std::chrono::steady_clock::now();
  }
  ~AtTheDisk() {
    const std::lock_guard lock(mutex_);
    since_.reset();
  }
  AtTheDisk(const AtTheDisk&) = delete;
  AtTheDisk& operator=(const AtTheDisk&) = delete;

 private:
  std::mutex& mutex_;
  Since& since_;
};

std::string since_text(UtcTime moment) {
  return " (since " + drivers::windlog::iso_time_text(std::chrono::floor<std::chrono::seconds>(moment)) + ")";
}

}  // namespace

RecorderWorker::RecorderWorker(const std::filesystem::path& file, const settings::RecordingConfig& rules, Info info,
                               RecorderReport report, const RecorderLimits& limits,
                               std::filesystem::path synchronized_file, RecorderStart start)
    : file_(file),
      synchronized_file_(std::move(synchronized_file)),
      rules_(rules),
      sensor_count_(info.sensors.size()),
      info_(std::move(info)),
      limits_(limits),
      ring_(kRingCapacity),
      quantities_ring_(kQuantitiesCapacity),
      report_(std::move(report)) {
  const auto begun = begin_recording(info_.started);
  if (begun) return;
  if (start == RecorderStart::kMustOpen && begun.error().kind != FailureKind::kUnavailable) {
    throw FailureError({"cannot record: " + begun.error().message, FailureKind::kCannotCreate});
  }
  fail(begun.error());
}

/// Takes the lock of the series and opens the recording for the first time.
Result<void, Failure> RecorderWorker::begin_recording(Instant started) {
  if (auto held = hold_lock(); !held) return held;
  if (auto opened = open_session(started); !opened) return opened;
  const auto newest = newest_time();
  if (auto committed = commit(); !committed) return committed;
  clock_.emplace(newest, read_clock_doubt(clock_doubt_file(file_)));
  save_doubt();
  measure_free_space();
  return {};
}

/// Takes the lock of the series, if it is not held or no longer that of the file's name. Fails with kUnavailable while
/// another program has it.
Result<void, Failure> RecorderWorker::hold_lock() {
  if (lock_ && lock_->is_of(file_)) return {};
  lock_.reset();
  auto taken = drivers::windlog::SeriesLock::take(file_);
  if (!taken) {
    was_held_elsewhere_ = was_held_elsewhere_ || taken.error().kind == FailureKind::kUnavailable;
    return taken.error();
  }
  lock_.emplace(std::move(*taken));
  if (!lock_->is_effective() && !std::exchange(has_reported_no_locks_, true)) {
    report(file_.string() + ": this file system has no locks: make sure that no other program records to it");
  }
  return {};
}

/// Omits pending readings that another program, which held the lock until now, has recorded, so that no span is in the
/// recording twice. Readings newer than its last commit are written.
Result<void, Failure> RecorderWorker::leave_what_is_recorded() {
  if (auto opened = open_file(); !opened) return opened;
  auto recorded = writer_->last_time();
  writer_.reset();
  const auto parts = drivers::windlog::completed_parts(file_);
  if (recorded && !*recorded && !parts.empty()) {  // it ended after completing a file and before beginning the next
    auto part = drivers::windlog::Writer::open(parts.back().file);
    if (!part) return part.error();
    recorded = part->last_time();
  }
  if (!recorded) return recorded.error();
  if (*recorded) leave_to_other(**recorded);
  return {};
}

/// Drops readings until that time, because another program records them.
void RecorderWorker::leave_to_other(UtcTime until) {
  const std::size_t left = std::erase_if(pending_, [until](const Entry& entry) {
    return entry.sensor != kNextSession && entry.reading.time.utc <= until;
  });
  recorded_elsewhere_.fetch_add(left, std::memory_order_relaxed);
  std::erase_if(pending_quantities_,
                [until](const QuantitiesEntry& entry) { return entry.quantities.time.utc <= until; });
}

bool RecorderWorker::push(std::size_t sensor, const wind::Reading& reading) noexcept {
  push_marks();
  const bool taken =
      sensor < sensor_count_ && drivers::windlog::is_recordable(reading) && ring_.push({sensor, reading});
  (taken ? pushed_ : lost_).fetch_add(1, std::memory_order_relaxed);
  return taken;
}

bool RecorderWorker::push(std::size_t sensor, const wind::StationQuantities& quantities) noexcept {
  const bool taken = sensor < sensor_count_ && quantities_ring_.push({sensor, quantities});
  if (!taken) lost_quantities_.fetch_add(1, std::memory_order_relaxed);
  return taken;
}

void RecorderWorker::begin_session(Info info, const settings::RecordingConfig& rules) {
  {
    const std::lock_guard lock(sessions_mutex_);
    next_sessions_.push_back(std::move(info));
    next_rules_ = rules;
  }
  ++marks_due_;
  push_marks();
}

/// If the ring is full, they follow with the next reading that is taken: dropped readings belong to no session.
void RecorderWorker::push_marks() noexcept {
  while (marks_due_ > 0 && ring_.push({kNextSession, {}})) --marks_due_;
}

/// The next reading belongs to the next session.
void RecorderWorker::take_next_session() {
  const std::lock_guard lock(sessions_mutex_);
  info_ = std::move(next_sessions_.front());
  next_sessions_.pop_front();
  is_session_due_ = true;
}

/// At once, not with the session: readings may wait because of the present rules.
void RecorderWorker::take_rules() {
  const std::lock_guard lock(sessions_mutex_);
  if (next_rules_) rules_ = *std::exchange(next_rules_, std::nullopt);
}

RecorderStatus RecorderWorker::status() const {
  const std::lock_guard lock(status_mutex_);
  return locked_status();
}

RecorderStatus RecorderWorker::locked_status() const {
  RecorderStatus status{.state = error_.empty() ? RecorderState::kWriting : RecorderState::kRetrying,
                        .written = written_.load(std::memory_order_relaxed),
                        .waiting = 0,
                        .lost = lost_.load(std::memory_order_relaxed) + given_up_.load(std::memory_order_relaxed),
                        .recorded_elsewhere = recorded_elsewhere_.load(std::memory_order_relaxed),
                        .error = error_.empty() ? error_ : error_ + since_text(failing_since_),
                        .free_bytes = free_bytes_,
                        .clock_doubt = clock_doubt_};
  const std::uint64_t done = status.written + status.recorded_elsewhere + given_up_.load(std::memory_order_relaxed);
  status.waiting = std::max(pushed_.load(std::memory_order_relaxed), done) - done;
  if (writing_since_ && std::chrono::steady_clock::now() - *writing_since_ >= limits_.hang_after) {
    status.state = RecorderState::kHanging;
    status.error = file_.string() + ": the disk does not respond";
  }
  return status;
}

bool RecorderWorker::wait_until(const std::function<bool(const RecorderStatus&)>& is_so, Nanoseconds at_most) const {
  std::unique_lock lock(status_mutex_);
  return status_changed_.wait_for(lock, at_most, [&] { return is_so(locked_status()); });
}

bool RecorderWorker::wait_for_end(Nanoseconds at_most) const {
  std::unique_lock lock(status_mutex_);
  return status_changed_.wait_for(lock, at_most, [this] { return has_ended_; });
}

void RecorderWorker::report(std::string_view sentence) {
  const std::lock_guard lock(report_mutex_);
  if (report_) report_(sentence);
}

void RecorderWorker::report_at_last(std::string_view sentence) {
  const std::lock_guard lock(report_mutex_);
  if (report_) std::exchange(report_, {})(sentence);
}

void RecorderWorker::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::unique_lock lock(wake_mutex_);
    wake_.wait_for(lock, stop, limits_.commit_every, [] { return false; });
    lock.unlock();
    contain("writing the recording", [this] { flush(); });
  }
  contain("ending the recording", [this] { finish(); });
  {
    const std::lock_guard lock(status_mutex_);
    has_ended_ = true;
  }
  status_changed_.notify_all();
}

/// A last attempt, without a pause: for the pending readings, then for the rest of the ring. Nothing is pushed any
/// more.
void RecorderWorker::finish() {
  retry_at_ = {};
  flush();
  flush();
  if (writer_) {
    const AtTheDisk at_the_disk(status_mutex_, writing_since_);
    const auto closed = writer_->close();
    if (!closed) set_status(closed.error().message);
  }
  if (clock_ && clock_->doubt()) write_clock_doubt(clock_doubt_file(file_), clock_->doubt());
  give_up_pending();
  lock_.reset();
}

/// Counts what was not written by the end.
void RecorderWorker::give_up_pending() {
  ring_.drain([this](const Entry& entry) { pending_.push_back(entry); });
  quantities_ring_.drain([this](const QuantitiesEntry& entry) { pending_quantities_.push_back(entry); });
  if (!lock_ && was_held_elsewhere_) leave_to_other(UtcTime::max());
  const auto given_up = static_cast<std::size_t>(
      std::ranges::count_if(pending_, [](const Entry& entry) { return entry.sensor != kNextSession; }));
  given_up_.fetch_add(given_up, std::memory_order_relaxed);
  if (given_up > 0) report("ended with " + count_text(given_up, "reading") + " that could not be written");
  const std::uint64_t lost = lost_quantities_.load(std::memory_order_relaxed) + pending_quantities_.size();
  if (lost > 0) report(count_text(lost, "message") + " of stations, besides the wind, could not be recorded");
}

/// Writes what was pushed to the disk; while that fails, keeps it for the next attempt.
void RecorderWorker::flush() {
  take_rules();
  Entry entry;
  while (pending_.size() < kMaxPending && ring_.pop(entry)) pending_.push_back(entry);
  QuantitiesEntry quantities;
  while (pending_quantities_.size() < kQuantitiesCapacity && quantities_ring_.pop(quantities)) {
    pending_quantities_.push_back(quantities);
  }
  const bool is_idle = lock_ && pending_.empty() && pending_quantities_.empty();
  if (is_idle || std::chrono::steady_clock::now() < retry_at_) return;

  const AtTheDisk at_the_disk(status_mutex_, writing_since_);
  if (const auto done = try_to_write(); !done) {
    writer_.reset();  // its commits are complete in its file, wherever that was moved
    return fail(done.error());
  }
  back_off_.reset();
  set_status("");
}

/// Shows why nothing can be written, and waits before the next attempt.
void RecorderWorker::fail(const Failure& failure) {
  retry_at_ = std::chrono::steady_clock::now() + back_off_.next();
  set_status(failure.message);
}

std::optional<std::uint64_t> RecorderWorker::measure_free_space() {
  std::error_code error;
  const std::filesystem::path folder = file_.has_parent_path() ? file_.parent_path() : ".";
  const auto space = std::filesystem::space(folder, error);
  const std::lock_guard lock(status_mutex_);
  free_bytes_.reset();
  if (!error) free_bytes_ = space.available;
  return free_bytes_;
}

Result<void, Failure> RecorderWorker::try_to_write() {
  try {
    if (auto held = hold_lock(); !held) {
      const bool is_full = pending_.size() >= kMaxPending || pending_quantities_.size() >= kQuantitiesCapacity;
      if (is_full && held.error().kind == FailureKind::kUnavailable) leave_to_other(UtcTime::max());
      return held;
    }
    return write_pending();
  } catch (const std::exception& error) {
    return Failure{file_.string() + ": " + error.what()};
  }
}

/// Writes session by session, and keeps what could not be written.
Result<void, Failure> RecorderWorker::write_pending() {
  if (was_held_elsewhere_ && !(pending_.empty() && pending_quantities_.empty())) {
    if (auto left = leave_what_is_recorded(); !left) return left;
  }
  was_held_elsewhere_ = false;
  while (!pending_.empty()) {
    const auto mark = std::ranges::find(pending_, kNextSession, &Entry::sensor);
    if (mark == pending_.begin()) {
      take_next_session();
      pending_.erase(mark);
      continue;
    }
    const auto count = static_cast<std::size_t>(mark - pending_.begin());
    if (auto written = write_readings(count); !written) return written;
    pending_.erase(pending_.begin(), mark);
    written_.fetch_add(count, std::memory_order_relaxed);
  }
  return write_quantities();
}

/// Writes what stations reported besides the wind, if no readings took it with them.
Result<void, Failure> RecorderWorker::write_quantities() {
  if (pending_quantities_.empty()) return {};
  const Instant first = earliest_of(pending_quantities_);
  if (auto prepared = prepare_file(first, first); !prepared) return prepared;
  if (auto appended = append_quantities(MonoTime::max()); !appended) return appended;
  if (auto committed = commit(); !committed) return committed;
  pending_quantities_.clear();
  return learn_begin();
}

/// Appends what stations reported before a time; it stays pending until it is committed. Quantities that the file
/// cannot hold are counted; readings are not affected.
Result<void, Failure> RecorderWorker::append_quantities(MonoTime before) {
  for (auto entry = pending_quantities_.begin(); entry != pending_quantities_.end();) {
    if (entry->quantities.time.mono >= before) {
      ++entry;
      continue;
    }
    const auto is_added = writer_->append(sensor_ids_[entry->sensor], entry->quantities);
    if (!is_added) return is_added.error();
    if (*is_added) {
      ++entry;
    } else {
      lost_quantities_.fetch_add(1, std::memory_order_relaxed);
      entry = pending_quantities_.erase(entry);
    }
  }
  return {};
}

void RecorderWorker::forget_quantities(MonoTime before) {
  std::erase_if(pending_quantities_,
                [before](const QuantitiesEntry& entry) { return entry.quantities.time.mono < before; });
}

/// Writes the first readings that are pending, which are of one session.
Result<void, Failure> RecorderWorker::write_readings(std::size_t count) {
  // Of several sensors the first reading need not be the earliest.
  const auto earliest =
      std::ranges::min_element(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(count), {},
                               [](const Entry& entry) { return entry.reading.time.mono; });
  if (auto prepared = prepare_file(pending_.front().reading.time, earliest->reading.time); !prepared) return prepared;
  for (const Entry& entry : std::span(pending_).first(count)) {
    if (auto appended = writer_->append(sensor_ids_[entry.sensor], entry.reading); !appended) return appended;
  }
  if (auto appended = append_quantities(MonoTime::max()); !appended) return appended;
  if (auto committed = commit(); !committed) return committed;
  pending_quantities_.clear();
  return learn_begin();
}

Result<void, Failure> RecorderWorker::learn_begin() {
  if (began_) return {};
  const auto began = writer_->began();
  if (!began) return began.error();
  began_ = *began;
  return {};
}

/// Prepares the file for entries from `first` on: completes one, opens one, begins the session that is due at
/// `earliest`. Earlier quantities of stations are written to the old session, because a session cannot hold entries
/// from before its beginning.
Result<void, Failure> RecorderWorker::prepare_file(Instant first, Instant earliest) {
  if (!clock_) {
    if (auto begun = begin_recording(begin_of_pending(first)); !begun) return begun;
  }
  judge_clock(first);
  if (auto made = make_room(first.utc); !made) return made;
  if (writer_) {
    if (auto kept = check_name(); !kept) return kept;
    const bool is_due = began_ && is_complete(rules_, *began_, size_of(file_), first.utc);
    if (is_due || is_session_due_) {
      const MonoTime begin = is_due ? first.mono : earliest.mono;
      if (auto appended = append_quantities(begin); !appended) return appended;
      if (auto committed = writer_->commit(); !committed) return committed;
      forget_quantities(begin);
    }
    if (is_due) {
      if (auto completed = complete_file(first.utc); !completed) return completed;
      if (auto made = make_room(first.utc); !made) return made;
      return open_session(first);
    }
    return is_session_due_ ? begin_session_at(earliest) : Result<void, Failure>{};
  }
  return open_session(begin_of_pending(first));
}

/// `first`, or the earlier time of what stations reported before it.
Instant RecorderWorker::begin_of_pending(Instant first) const {
  const bool have_said = !pending_quantities_.empty();
  const Instant said = have_said ? earliest_of(pending_quantities_) : first;
  return said.mono < first.mono ? said : first;
}

/// Commits; initially and then once a minute also moves the commits into the file itself, so that a copy of it alone is
/// a recording.
Result<void, Failure> RecorderWorker::commit() {
  if (auto committed = writer_->commit(); !committed) return committed;
  if (commits_++ % kCommitsPerCheckpoint != 0) return {};
  return writer_->checkpoint();
}

/// Closes the file and renames it to the name of a completed part.
Result<void, Failure> RecorderWorker::complete_file(UtcTime now) {
  if (auto closed = writer_->close(); !closed) return closed;
  writer_.reset();
  UtcTime begin = *began_;
  // Parts are read in the order of their names: one from a wrong date ahead goes before those that follow it.
  const auto parts = drivers::windlog::completed_parts(file_);
  if (parts.empty() || parts.back().begin < now) begin = std::min(begin, now);
  for (int tries = 0; tries < kMaxPartNames; ++tries) {
    if (drivers::windlog::is_free_name(drivers::windlog::part_name(file_, begin))) break;
    begin += std::chrono::seconds(1);
  }
  const std::filesystem::path part = drivers::windlog::part_name(file_, begin);
  // If another program reads it, its newest readings may still lie beside it.
  const std::error_code error = drivers::windlog::rename_recording(file_, part);
  if (error) return Failure{file_.string() + ": cannot be renamed to " + part.string() + ": " + error.message()};
  may_delete_by_age_ = kMaxDeletedByAge;
  return {};
}

/// The newest time that the recording held before the present session; nullopt if it held nothing.
std::optional<UtcTime> RecorderWorker::newest_time() const {
  if (writer_ && writer_->last_before_session()) return writer_->last_before_session();
  const auto parts = drivers::windlog::completed_parts(file_);
  if (parts.empty()) return std::nullopt;
  return parts.back().begin;
}

void RecorderWorker::judge_clock(Instant now) {
  clock_->look(now, is_synchronized(synchronized_file_, now.utc));
  save_doubt();
}

/// Reports a doubt of the clock that has begun or ended, and saves it then and once a minute. If that fails the disk
/// takes no readings, either.
void RecorderWorker::save_doubt() {
  const auto& doubt = clock_->doubt();
  {
    const std::lock_guard lock(status_mutex_);
    clock_doubt_ = doubt;
  }
  const bool has_changed =
      doubt.has_value() != saved_doubt_.has_value() || (doubt && doubt->since != saved_doubt_->since);
  if (has_changed) report(doubt ? text_of(*doubt) : "the clock is trusted again");
  if (!has_changed && (!doubt || doubt->running - saved_doubt_->running < kSaveDoubtEvery)) return;
  write_clock_doubt(clock_doubt_file(file_), doubt);
  saved_doubt_ = doubt;
}

/// Deletes files according to the rules. Fails if there is still less free space than required.
Result<void, Failure> RecorderWorker::make_room(UtcTime now) {
  const settings::RecordingConfig rules = with_room_to_grow(rules_);
  auto free_bytes = measure_free_space();
  const bool is_enough_free = !free_bytes || *free_bytes >= rules.least_free_bytes;
  if (is_enough_free && rules.keep_days == 0 && rules.most_bytes == 0) return {};

  std::vector<KeptPart> parts;
  for (const auto& part : drivers::windlog::completed_parts(file_)) {
    parts.push_back({part.file, part.begin, size_of(part.file)});
  }
  for (const auto& part : parts_to_delete(rules, parts, size_of(file_), free_bytes.value_or(rules.least_free_bytes),
                                          now, clock_->doubt() ? 0 : may_delete_by_age_)) {
    if (!drivers::windlog::remove_recording(part.file)) continue;
    report("deleted " + part.file.string() + ": keep_days, max_size or min_free of [recording]");
    if (part.is_by_age) --may_delete_by_age_;
  }
  if (!parts.empty()) free_bytes = measure_free_space();
  if (!free_bytes || *free_bytes >= rules.least_free_bytes) return {};
  return Failure{file_.string() + ": " + megabytes(*free_bytes) + " are free on the disk, less than the " +
                 megabytes(rules_.least_free_bytes) + " of [recording] min_free and for its growth; free some space"};
}

/// Fails if the name belongs to another file or to none. SQLite does not report that.
Result<void, Failure> RecorderWorker::check_name() const {
  const auto named = drivers::windlog::identity_of(file_);
  if (named && *named != identity_) return Failure{file_.string() + ": was replaced by another file"};
  if (!named &&
      (named.error() == std::errc::no_such_file_or_directory || named.error() == std::errc::not_a_directory)) {
    return Failure{file_.string() + ": was removed or moved"};
  }
  return {};
}

Result<void, Failure> RecorderWorker::open_file() {
  if (auto held = hold_lock(); !held) return held;  // a link that was renamed refers to another file by now
  drivers::windlog::finish_rename_to_part(file_);
  const auto aside = drivers::windlog::set_older_recording_aside(file_);
  if (!aside) return aside.error();
  if (*aside) report(file_.string() + " has an older format; it is kept as " + (*aside)->string());
  create_private_file(file_);
  auto opened = drivers::windlog::Writer::open(file_);
  if (!opened) return opened.error();
  const auto identity = drivers::windlog::identity_of(file_);
  if (!identity) return Failure{file_.string() + ": " + identity.error().message()};
  identity_ = *identity;
  writer_.emplace(std::move(*opened));
  commits_ = 0;
  return {};
}

Result<void, Failure> RecorderWorker::open_session(Instant started) {
  if (auto opened = open_file(); !opened) return opened;
  if (auto begun = begin_session_at(started); !begun) return begun;
  const bool is_continued = writer_->last_before_session().has_value();
  const auto began = writer_->began();
  if (!began) return began.error();
  began_ = *began;
  const auto parts = drivers::windlog::completed_parts(file_);
  if (parts.empty() || is_continued) return {};
  return writer_->set_previous_part(parts.back().begin);
}

/// Begins a session in the file that is open.
Result<void, Failure> RecorderWorker::begin_session_at(Instant started) {
  if (auto begun = writer_->begin_session({started, info_.software, info_.configuration}); !begun) return begun;
  sensor_ids_.clear();
  for (const RecordedSensor& sensor : info_.sensors) {
    const auto id = writer_->add_sensor(sensor.name, sensor.driver, sensor.options);
    if (!id) return id.error();
    sensor_ids_.push_back(*id);
  }
  is_session_due_ = false;
  return {};
}

/// Sets the reason why nothing can be written (empty: writing works), reports a change once, and wakes those who wait
/// for a status.
void RecorderWorker::set_status(const std::string& error) {
  bool changed = false;
  {
    const std::lock_guard lock(status_mutex_);
    changed = error_.empty() != error.empty();
    if (error_.empty()) failing_since_ = UtcTime(std::chrono::system_clock::now());
    error_ = error;
  }
  status_changed_.notify_all();
  if (!changed) return;
  if (!error.empty()) {
    report("interrupted, trying again: " + error);
  } else {
    const RecorderStatus now = status();
    report("resumed; " + count_text(now.lost, "reading") + " lost" +
           (now.recorded_elsewhere > 0 ? ", " + std::to_string(now.recorded_elsewhere) + " recorded by another process"
                                       : ""));
  }
}

}  // namespace yuragi::daemon::recording
