#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "daemon/web/pairings.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::web {

/// Keeps Pairings in a file, so that they outlive the daemon. A thread of its own writes the file whole, readable by
/// its owner only; the caller never waits for the disk. Failures are logged, and cost only the saving. Thread-safe:
/// yes. The destructor writes what was saved last.
class PairingsFile {
 public:
  using Done = std::function<void(const Result<void, Failure>& saved)>;

  /// `file`: empty: nothing is kept.
  explicit PairingsFile(std::filesystem::path file);
  ~PairingsFile();
  PairingsFile(const PairingsFile&) = delete;
  PairingsFile& operator=(const PairingsFile&) = delete;

  /// Returns the pairings of the token with this mark (Access::mark()). There are none if there is no file or it is of
  /// another token. A file that cannot be read is renamed to FILE.damaged.
  Pairings read(const std::string& token_mark) const;

  /// Saves the pairings, and then calls `done`, if it is not empty, on the file's own thread.
  void save(const Pairings& pairings, Done done = {});

 private:
  void work(const std::stop_token& stop);
  Result<void, Failure> write(const std::string& text);

  std::filesystem::path file_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<std::string> text_;  ///< that is not written yet
  std::vector<Done> waiting_;        ///< for it
  std::string failure_;              ///< the last, which is logged once; only on the thread
  std::jthread thread_;
};

}  // namespace yuragi::daemon::web
