#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace yuragi::platform {

/// How a program has ended.
struct ChildEnd {
  int exit_code = 0;
  int signal = 0;  ///< signal that killed it; 0: none

  bool is_good() const noexcept { return exit_code == 0 && signal == 0; }
  /// The exit code as a shell reports it: 128 plus the number of a signal.
  int shell_code() const noexcept { return signal == 0 ? exit_code : 128 + signal; }
};

/// "has failed with exit code 1", "was killed by signal 9 (Killed)".
std::string text_of(const ChildEnd& end);

/// Another program, which does not outlive the thread that starts it, nor this object. It inherits no blocked or
/// ignored signal, and no open files except its standard ones. Thread-safe: no; poll() of descriptor() is.
class ChildProcess {
 public:
  struct Setup {
    /// The program, found by PATH if it names no folder, and its arguments.
    std::vector<std::string> command;
    // The descriptors for its standard input, output and error; -1: an empty input, our own output and error.
    int input = -1;
    int output = -1;
    int error = -1;
    /// Its environment, "NAME=VALUE"; nullopt: ours.
    std::optional<std::vector<std::string>> environment = {};
    /// Makes a process group for it and its children: Ctrl-C at our terminal does not reach them.
    bool has_own_group = false;
    /// At this object's end it gets SIGTERM, and is killed after this time; 0: killed at once.
    int patience_ms = 0;
  };

  /// Starts it. Throws std::system_error, whose code is the reason.
  explicit ChildProcess(const Setup& setup);
  /// Ends it, if it still runs. If the kernel does not end it within 0.4 s, it is abandoned.
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Readable when it has ended.
  int descriptor() const noexcept { return descriptor_; }

  /// How it ended, after waiting for at most `most_ms`; nullopt: it still runs.
  std::optional<ChildEnd> end(int most_ms = 0);

  /// Waits until it has ended.
  ChildEnd wait();

  /// Sends it a signal, if it still runs; if it has its own group, also to its children.
  void signal(int number) noexcept;

 private:
  void let_go() noexcept;
  bool reap(int options);

  pid_t process_ = -1;  ///< -1: it has been waited for
  int descriptor_ = -1;
  bool has_own_group_ = false;
  int patience_ms_ = 0;
  ChildEnd end_{};
};

}  // namespace yuragi::platform
