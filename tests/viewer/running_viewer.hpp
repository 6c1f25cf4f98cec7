#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace yuragi::viewer {

/// The real viewer, which runs until it ends by itself or this does. Throws nothing; a program that does not start ends
/// with -1.
class RunningViewer {
 public:
  /// `says`: the file that its standard error goes to.
  RunningViewer(std::vector<std::string> options, const std::vector<std::string>& environment,
                std::filesystem::path says);
  ~RunningViewer();
  RunningViewer(const RunningViewer&) = delete;
  RunningViewer& operator=(const RunningViewer&) = delete;

  /// The exit code of a program that ends by itself; -1 where a signal ended it.
  int wait();
  /// The same, of one that is asked to end (SIGTERM).
  int end();
  /// All of its standard error up to now.
  std::string said() const;

 private:
  std::filesystem::path says_;
  pid_t child_ = 0;
};

/// Waits for a condition; a program that hangs makes it false.
bool comes_true(const std::function<bool()>& condition);

}  // namespace yuragi::viewer
