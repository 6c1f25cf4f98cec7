#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace yuragi::simulators {

/// A program that runs beside this one, and does not outlive it. Thread-safe: no.
class ChildProgram {
 public:
  /// Which of our descriptors are its standard input, output and error; -1: an empty input, or our own output.
  struct Streams {
    int input = -1;
    int output = -1;
    int error = -1;
  };

  /// Starts it: the program, looked for as a shell does, and its arguments. Throws std::system_error.
  ChildProgram(const std::vector<std::string>& command, const Streams& streams);
  /// Ends it, if it still runs: by SIGTERM first, and kills it after two seconds.
  ~ChildProgram();
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  /// Readable when it has ended.
  int descriptor() const noexcept { return descriptor_; }

  /// As a shell reports it: 128 plus the number of a signal, 127 for a program that was not found. Empty: it still
  /// runs.
  std::optional<int> exit_code();

  /// Asks it to end, by SIGTERM.
  void terminate();

 private:
  pid_t process_ = -1;
  int descriptor_ = -1;
  std::optional<int> exit_code_;
};

}  // namespace yuragi::simulators
