#pragma once

#include <cstdint>
#include <filesystem>
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
/// another.) It ends with its first client, or with this. What it shows is in a file.
class VirtualScreen {
 public:
  /// `folder`: of that file; must outlive this.
  explicit VirtualScreen(const std::filesystem::path& folder);
  ~VirtualScreen();
  VirtualScreen(const VirtualScreen&) = delete;
  VirtualScreen& operator=(const VirtualScreen&) = delete;

  /// Our own environment, and DISPLAY.
  std::vector<std::string> environment() const;

  static constexpr std::size_t kWidth_px = 640;
  static constexpr std::size_t kHeight_px = 480;
  /// Blue, green, red and a byte without meaning for each pixel, rows from the top down: the screen at this moment.
  /// Empty where the server has not written its file.
  std::vector<std::uint8_t> pixels() const;

 private:
  pid_t server_ = 0;
  std::string number_;
  std::filesystem::path picture_;
};

}  // namespace yuragi::viewer
