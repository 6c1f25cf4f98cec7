#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/platform/child_process.hpp"

namespace yuragi::viewer::film {

/// Another program at one end of a pipe. It writes to our standard error, and does not receive Ctrl-C: its starter ends
/// it. The destructor kills it.
class PipedChild {
 public:
  /// The child's own file that is the pipe.
  enum class Pipe : std::uint8_t { kStandardInput, kStandardOutput };

  /// `command`: the program, found in PATH if it names no folder, and its arguments. Throws std::system_error if it
  /// cannot be started.
  PipedChild(const std::vector<std::string>& command, Pipe pipe);
  ~PipedChild();
  PipedChild(const PipedChild&) = delete;
  PipedChild& operator=(const PipedChild&) = delete;

  /// Our end of the pipe.
  int fd() const { return ours_; }
  void close_pipe();

  /// Closes the pipe and waits until the child has ended; does not wait for a child that reads for ever, or writes.
  platform::ChildEnd wait();

 private:
  /// Makes the pipe, starts the child with its end, and closes that end here.
  platform::ChildProcess start(const std::vector<std::string>& command, Pipe pipe);

  int ours_ = -1;
  platform::ChildProcess child_;
};

}  // namespace yuragi::viewer::film
