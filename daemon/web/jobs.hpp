#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/web/niced_child.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"
#include "engine/platform/descriptor.hpp"

namespace yuragi::daemon::web {

/// A command of this program that is carried out for a client.
struct JobOrder {
  std::string kind = {};                  ///< "verify"
  std::string recording = {};             ///< its name; empty: it is about none
  std::vector<std::string> command = {};  ///< without the file that it writes
  std::string input = {};                 ///< what it reads
  Niceness niceness = Niceness::kLowest;
  bool shows_progress = false;        ///< Job::printed is what it has printed so far
  std::string result = {};            ///< the name of that file, which is appended to `command`; empty: what it prints
  std::string content_type = {};      ///< of that file
  std::filesystem::path folder = {};  ///< where it is made, and removed with all that is in it; empty: a temporary one
  bool is_finding_good = false;       ///< exit code 1 is a finding, no failure
  Nanoseconds time = std::chrono::minutes(30);  ///< it is ended after this time
};

/// A file that a job has made. It has no name any more: it vanishes with the descriptor.
struct JobFile {
  std::shared_ptr<const platform::Descriptor> file = {};
  std::uint64_t bytes = 0;
  std::string name = {}, content_type = {};
};

struct Job {
  enum class State : std::uint8_t { kRunning, kDone, kFailed };

  std::string id = {}, kind = {}, recording = {};
  State state = State::kRunning;
  std::string message = {};          ///< why it failed
  std::string printed = {};          ///< its result, if it writes no file; also of a failure, if it shows progress
  std::optional<JobFile> file = {};  ///< its result
  Nanoseconds run_for{0};
};

/// Carries out one order at a time, as a niced child process that ends with the daemon, and keeps what
/// came of the last ones. Thread-safe: yes. Nothing waits for the child but a thread of its own.
class Jobs {
 public:
  /// So many are kept, and for so long after their ends.
  static constexpr std::size_t kMaxKept = 4;
  static constexpr auto kKeptFor = std::chrono::minutes(10);

  Jobs();
  ~Jobs();  ///< end()
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  /// Begins it, and returns its id. Fails with kUnavailable while another one runs.
  Result<std::string, Failure> start(JobOrder order);

  /// Ends it if it runs: it then fails, soon. Returns false if it is not known.
  bool cancel(const std::string& id);

  /// Returns nullopt if it is not known, or not any more.
  std::optional<Job> find(const std::string& id) const;

  /// Kills the child, and waits until its folder is removed; a thread that a disk holds is left to the end of the
  /// process.
  void end();

  /// Drops what is older than kKeptFor. Call it from time to time: what is kept takes room on the disk.
  void forget_old();

 private:
  struct Work;
  std::shared_ptr<Work> work_;  ///< the thread has it, too
};

}  // namespace yuragi::daemon::web
