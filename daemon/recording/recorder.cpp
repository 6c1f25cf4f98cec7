#include "daemon/recording/recorder.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <system_error>
#include <utility>

#include "engine/base/count_text.hpp"

namespace yuragi::daemon::recording {
namespace {

// Room for the readings between two commits, at tens of thousands a second.
constexpr std::size_t kRingCapacity = 16'384;
constexpr Nanoseconds kFirstBackOff = std::chrono::milliseconds(500);
constexpr Nanoseconds kMaxBackOff = std::chrono::seconds(10);

}  // namespace

Recorder::Recorder(const std::filesystem::path& file, RecordingInfo info, Report report)
    : file_(file), info_(std::move(info)), report_(std::move(report)), ring_(kRingCapacity) {
  auto opened = open_session(info_.started);
  if (opened) opened = writer_->commit();
  if (!opened) throw FailureError({"cannot record: " + opened.error().message, FailureKind::kCannotCreate});
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

Recorder::~Recorder() {
  close();
}

void Recorder::close() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
}

bool Recorder::push(std::size_t sensor, const wind::WindReading& reading) noexcept {
  const bool taken =
      sensor < info_.sensors.size() && drivers::windlog::is_recordable(reading) && ring_.push({sensor, reading});
  if (!taken) lost_.fetch_add(1, std::memory_order_relaxed);
  return taken;
}

RecorderStatus Recorder::status() const {
  const std::lock_guard lock(status_mutex_);
  return locked_status();
}

RecorderStatus Recorder::locked_status() const {
  return {written_.load(std::memory_order_relaxed), lost_.load(std::memory_order_relaxed), error_};
}

bool Recorder::wait_until(const std::function<bool(const RecorderStatus&)>& is_so, Nanoseconds at_most) const {
  std::unique_lock lock(status_mutex_);
  return status_changed_.wait_for(lock, at_most, [&] { return is_so(locked_status()); });
}

void Recorder::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::unique_lock lock(wake_mutex_);
    wake_.wait_for(lock, stop, kCommitInterval, [] { return false; });
    lock.unlock();
    flush();
  }
  finish();
}

/// A last attempt, without a pause: for what is pending, then for what is left in the ring. Nothing is pushed any more.
void Recorder::finish() {
  retry_at_ = {};
  flush();
  flush();
  if (writer_) {
    const auto closed = writer_->close();
    if (!closed) set_status(closed.error().message);
  }
  std::size_t given_up = pending_.size();
  given_up += ring_.drain([](const Entry&) {});
  lost_.fetch_add(given_up, std::memory_order_relaxed);
  if (given_up > 0 && report_) {
    report_("ended with " + count_text(given_up, "reading") + " that could not be written");
  }
}

/// Writes what was pushed to the disk; while that fails, keeps it for the next attempt.
void Recorder::flush() {
  Entry entry;
  while (pending_.size() < kMaxPending && ring_.pop(entry)) pending_.push_back(entry);
  if (pending_.empty() || std::chrono::steady_clock::now() < retry_at_) return;

  if (const auto done = try_to_write(); !done) {
    writer_.reset();  // what it committed is complete in its file, wherever that has been moved
    back_off_ = std::clamp(2 * back_off_, kFirstBackOff, kMaxBackOff);
    retry_at_ = std::chrono::steady_clock::now() + back_off_;
    set_status(done.error().message);
    return;
  }
  written_.fetch_add(pending_.size(), std::memory_order_relaxed);
  pending_.clear();
  back_off_ = Nanoseconds{0};
  set_status("");
}

Result<void, Failure> Recorder::try_to_write() {
  try {
    return write_pending();
  } catch (const std::exception& error) {
    return Failure{file_.string() + ": " + error.what()};
  }
}

Result<void, Failure> Recorder::write_pending() {
  if (writer_) {
    if (auto kept = check_name(); !kept) return kept;
  } else {
    if (auto opened = open_session(pending_.front().reading.time); !opened) return opened;
  }
  for (const Entry& entry : pending_) {
    if (auto appended = writer_->append(sensor_ids_[entry.sensor], entry.reading); !appended) return appended;
  }
  return writer_->commit();
}

/// Fails where the name has come to belong to another file or to none. SQLite does not report that.
Result<void, Failure> Recorder::check_name() const {
  const auto named = identity_of(file_);
  if (named && *named != identity_) return Failure{file_.string() + ": was replaced by another file"};
  if (!named &&
      (named.error() == std::errc::no_such_file_or_directory || named.error() == std::errc::not_a_directory)) {
    return Failure{file_.string() + ": was removed or moved"};
  }
  return {};
}

Result<void, Failure> Recorder::open_session(Instant started) {
  auto opened = drivers::windlog::WindlogWriter::open(file_);
  if (!opened) return opened.error();
  const auto identity = identity_of(file_);
  if (!identity) return Failure{file_.string() + ": " + identity.error().message()};
  identity_ = *identity;
  writer_.emplace(std::move(*opened));
  if (auto begun = writer_->begin_session({started, info_.software, info_.configuration}); !begun) return begun;
  sensor_ids_.clear();
  for (const RecordedSensor& sensor : info_.sensors) {
    const auto id = writer_->add_sensor(sensor.name, sensor.driver, sensor.options);
    if (!id) return id.error();
    sensor_ids_.push_back(*id);
  }
  return {};
}

/// Sets why nothing can be written (empty: it can), reports a change once, and wakes those who wait for a status.
void Recorder::set_status(const std::string& error) {
  bool changed = false;
  {
    const std::lock_guard lock(status_mutex_);
    changed = error_.empty() != error.empty();
    error_ = error;
  }
  status_changed_.notify_all();
  if (!changed || !report_) return;
  if (!error.empty()) {
    report_("interrupted, trying again: " + error);
  } else {
    report_("resumed; " + count_text(lost_.load(std::memory_order_relaxed), "reading") + " lost");
  }
}

}  // namespace yuragi::daemon::recording
