#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <mutex>

#include <spdlog/sinks/ansicolor_sink.h>
#include <spdlog/sinks/ringbuffer_sink.h>

#include "daemon/settings/log_config.hpp"
#include "daemon/web/fault_counts.hpp"
#include "daemon/web/log_line.hpp"

namespace spdlog::details {
class thread_pool;
}

namespace yuragi::daemon::service {

/// Writes lines of the log to a stream (standard error), and never waits long for its reader: a line that the stream
/// does not take within kPatience, or at once if the previous one was not taken either, is dropped and counted. The
/// next line that is taken is preceded by one with the number of lost lines. Long lines are cut. Thread-safe: as
/// spdlog's sinks are.
class BoundedLogSink final : public spdlog::sinks::ansicolor_sink<spdlog::details::console_mutex> {
 public:
  static constexpr int kPatience_ms = 200;
  /// The number of bytes that a pipe takes at once if it takes any (POSIX: PIPE_BUF is 512 at least, 4096 on Linux),
  /// minus the prefix of the text.
  static constexpr std::size_t kMaxTextBytes = 3800;

  explicit BoundedLogSink(std::FILE* stream);

  void log(const spdlog::details::log_msg& message) override;

  /// Counts the lines that this pool had to drop, too; nullptr: no more. The pool must live until another is set. It is
  /// not shared: its last owner may not be its own thread, which cannot wait for itself to end.
  void count_overruns_of(spdlog::details::thread_pool* pool);

 private:
  void take_overruns();
  bool takes_a_line();
  void write(const spdlog::details::log_msg& message);

  std::FILE* stream_;
  std::mutex writing_;
  bool is_stuck_ = false;
  spdlog::details::thread_pool* pool_ = nullptr;
  std::uint64_t overruns_ = 0;  ///< of the pool, as of the last look
  std::uint64_t lost_ = 0;
};

/// The log of a command that is the daemon or a client of it, on standard error while this object lives. Lines are
/// written by a thread of its own: a terminal that is stopped, or a pipe that nobody reads, delays nobody. At most
/// kMaxWaiting lines wait; further ones replace the oldest and are counted. It logs contained exceptions
/// (engine/base/contain.hpp), too, as FaultLog does.
class DaemonLog {
 public:
  static constexpr std::size_t kMaxWaiting = 1024;

  /// `verbose`: debug messages, too.
  explicit DaemonLog(bool verbose);

  /// Writes lines of this level and above from now on; with `verbose` all.
  void set_level(settings::LogLevel level) const;

  /// Gives the last lines, at most kMaxKept, also those that nobody read. Thread-safe; may outlive this object.
  web::LogTail tail() const;
  static constexpr std::size_t kMaxKept = 500;

  /// Gives the number of contained exceptions by their kind. Thread-safe; may outlive this object.
  static web::FaultCounter fault_counter();

  ~DaemonLog();  ///< writes the waiting lines, as far as they are taken
  DaemonLog(const DaemonLog&) = delete;
  DaemonLog& operator=(const DaemonLog&) = delete;

 private:
  bool verbose_;
  std::shared_ptr<BoundedLogSink> sink_;
  std::shared_ptr<spdlog::sinks::ringbuffer_sink_mt> kept_;
  std::shared_ptr<spdlog::details::thread_pool> writer_;
};

}  // namespace yuragi::daemon::service
