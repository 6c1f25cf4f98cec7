#pragma once

#include <string>
#include <vector>

#include <spawn.h>
#include <sys/types.h>

namespace yuragi::viewer {

/// Starts a program; 0 if that was not possible. `environment` is all that it gets.
pid_t start_program(std::vector<std::string> words, std::vector<std::string> environment,
                    posix_spawn_file_actions_t* actions);

/// Our own environment, but for the screens.
std::vector<std::string> environment_without_screen();

/// A virtual X server, on a display number that it finds free itself. (xvfb-run -a guesses one, and may lose it to
/// another.) It ends with its first client, or with this.
class VirtualScreen {
 public:
  VirtualScreen();
  ~VirtualScreen();
  VirtualScreen(const VirtualScreen&) = delete;
  VirtualScreen& operator=(const VirtualScreen&) = delete;

  /// As DISPLAY has it.
  std::string name() const { return ":" + number_; }
  std::vector<std::string> environment() const;

 private:
  pid_t server_ = 0;
  std::string number_;
};

}  // namespace yuragi::viewer
