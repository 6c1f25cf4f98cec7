#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sys/types.h>

namespace yuragi::viewer {

/// Another program at one end of a pipe. It says on our standard error what it has to say, and does not hear Ctrl-C:
/// whoever started it ends it. It is killed with this object; where this program is killed, its pipe breaks.
class ChildProcess {
 public:
  /// Which of the child's own files the pipe is.
  enum class Pipe : std::uint8_t { kStandardInput, kStandardOutput };

  /// `command`: the program, found by PATH where it names no folder, and its arguments. Throws std::system_error where
  /// it cannot be started.
  ChildProcess(const std::vector<std::string>& command, Pipe pipe);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Our end of the pipe.
  int fd() const { return fd_; }
  void close_pipe();

  /// Closes the pipe and waits until the child has ended; not where it reads on for ever, or writes.
  struct End {
    int exit_code = 0;
    int signal = 0;  ///< that killed it; 0: none
    bool is_good() const { return exit_code == 0 && signal == 0; }
  };
  End wait();

  /// "has failed (exit code 1)", "was killed by a signal (9, Killed)".
  static std::string text_of(const End& end);

 private:
  pid_t pid_ = 0;  // 0: it has been waited for
  int fd_ = -1;
};

}  // namespace yuragi::viewer
