#include "daemon/service/daemon_log.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include <poll.h>
#include <spdlog/async.h>
#include <spdlog/spdlog.h>

#include "daemon/service/fault_log.hpp"
#include "engine/base/contain.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::service {
namespace {

constexpr const char* kPattern = "%Y-%m-%dT%H:%M:%S.%e %^%l%$ %v";

/// Of the whole process, as FaultReporter is. It is never destroyed: the web server's thread may still ask.
struct Faults {
  std::mutex mutex;
  FaultLog log;
};

Faults& faults_of_process() {
  static auto* const faults = new Faults;
  return *faults;
}

void log_fault(std::string_view kind, const char* what) noexcept {
  try {
    Faults& faults = faults_of_process();
    const std::lock_guard lock(faults.mutex);
    const auto now = MonoTime(std::chrono::steady_clock::now().time_since_epoch());
    if (const auto line = faults.log.line_for(kind, what, now)) spdlog::error("{}", *line);
  } catch (...) {
    // There is no memory for the line.
  }
}

}  // namespace

BoundedLogSink::BoundedLogSink(std::FILE* stream)
    : ansicolor_sink(stream, spdlog::color_mode::automatic), stream_(stream) {}

void BoundedLogSink::log(const spdlog::details::log_msg& message) {
  const std::lock_guard lock(writing_);
  is_stuck_ = !takes_a_line();
  take_overruns();
  if (is_stuck_) {
    ++lost_;
    return;
  }
  if (const std::uint64_t lost = std::exchange(lost_, 0); lost > 0) {
    const std::string text = count_text(lost, "line") + " of the log lost: standard error was not read";
    write({message.logger_name, spdlog::level::warn, text});
    is_stuck_ = !takes_a_line();
    if (is_stuck_) {
      ++lost_;
      return;
    }
  }
  write(message);
}

void BoundedLogSink::count_overruns_of(spdlog::details::thread_pool* pool) {
  const std::lock_guard lock(writing_);
  take_overruns();
  pool_ = pool;
  overruns_ = 0;
}

/// Counts what the pool had to drop since the last look.
void BoundedLogSink::take_overruns() {
  if (pool_ == nullptr) return;
  const std::uint64_t overruns = pool_->overrun_counter();
  lost_ += overruns - overruns_;
  overruns_ = overruns;
}

void BoundedLogSink::write(const spdlog::details::log_msg& message) {
  spdlog::details::log_msg cut = message;
  if (cut.payload.size() > kMaxTextBytes) cut.payload = {cut.payload.data(), kMaxTextBytes};
  ansicolor_sink::log(cut);
}

/// A pipe that is ready takes PIPE_BUF bytes without waiting; a file always does.
bool BoundedLogSink::takes_a_line() {
  pollfd stream{.fd = fileno(stream_), .events = POLLOUT, .revents = 0};
  return poll(&stream, 1, is_stuck_ ? 0 : kPatience_ms) == 1 && (stream.revents & (POLLERR | POLLNVAL)) == 0;
}

DaemonLog::DaemonLog(bool verbose)
    : verbose_(verbose),
      sink_(std::make_shared<BoundedLogSink>(stderr)),
      kept_(std::make_shared<spdlog::sinks::ringbuffer_sink_mt>(kMaxKept)) {
  writer_ = std::make_shared<spdlog::details::thread_pool>(kMaxWaiting, 1);
  sink_->count_overruns_of(writer_.get());
  const auto logger = std::make_shared<spdlog::async_logger>("yuragi", spdlog::sinks_init_list{kept_, sink_}, writer_,
                                                             spdlog::async_overflow_policy::overrun_oldest);
  spdlog::set_default_logger(logger);
  spdlog::set_pattern(kPattern);
  spdlog::set_level(verbose ? spdlog::level::debug : spdlog::level::info);
  report_faults_to(&log_fault);
}

void DaemonLog::set_level(settings::LogLevel level) const {
  switch (verbose_ ? settings::LogLevel::kDebug : level) {
    case settings::LogLevel::kDebug:
      return spdlog::set_level(spdlog::level::debug);
    case settings::LogLevel::kInfo:
      return spdlog::set_level(spdlog::level::info);
    case settings::LogLevel::kWarning:
      return spdlog::set_level(spdlog::level::warn);
    case settings::LogLevel::kError:
      return spdlog::set_level(spdlog::level::err);
  }
}

web::LogTail DaemonLog::tail() const {
  return [kept = kept_](std::size_t most) {
    std::vector<web::LogLine> lines;
    for (const auto& message : kept->last_raw(most)) {
      const auto level = spdlog::level::to_string_view(message.level);
      const std::size_t size = std::min(message.payload.size(), BoundedLogSink::kMaxTextBytes);
      lines.push_back({.time_s = std::chrono::duration<double>(message.time.time_since_epoch()).count(),
                       .level = {level.data(), level.size()},
                       .text = {message.payload.data(), size}});
    }
    return lines;
  };
}

web::FaultCounter DaemonLog::fault_counter() {
  return [] {
    Faults& faults = faults_of_process();
    const std::lock_guard lock(faults.mutex);
    return faults.log.counts();
  };
}

DaemonLog::~DaemonLog() {
  report_faults_to(nullptr);
  // The last reference to the logger is released here, after the writer's thread has ended, and not on that thread.
  const auto logger = spdlog::default_logger();
  // Later lines are written by the thread that logs them.
  const auto level = spdlog::get_level();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("yuragi", sink_));
  spdlog::set_level(level);
  sink_->count_overruns_of(nullptr);
  writer_.reset();
}

}  // namespace yuragi::daemon::service
