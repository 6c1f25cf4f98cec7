#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::history {

/// Reads a history on a thread of its own, one at a time, at the lowest priority: a recording may be long, and its disk
/// slow or hanging. What was read last is kept for a while.
class Reader {
 public:
  /// Reads the last hours. It owns all that it uses: if the disk hangs, it outlives everything else.
  using Read = std::function<Result<std::string, Failure>(unsigned hours, const std::stop_token& stop)>;
  /// Called once: at once, or on the reader's thread.
  using Reply = std::function<void(Result<std::string, Failure>)>;

  explicit Reader(Read read, Nanoseconds kept_for = std::chrono::minutes(1));
  ~Reader();  ///< ends the reading; one that hangs is left to the end of the process
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// Fails with kUnavailable while another one is being read, and if the reading fails. Thread-safe: yes. Never waits.
  void ask(unsigned hours, const Reply& reply);

 private:
  struct Work;
  std::shared_ptr<Work> work_;  ///< the thread has it, too
};

}  // namespace yuragi::daemon::history
