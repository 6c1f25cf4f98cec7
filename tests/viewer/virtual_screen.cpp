#include "tests/viewer/virtual_screen.hpp"

#include <array>
#include <csignal>
#include <fstream>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace yuragi::viewer {

pid_t start_program(std::vector<std::string> words, std::vector<std::string> environment,
                    posix_spawn_file_actions_t* actions) {
  const auto pointers = [](std::vector<std::string>& texts) {
    std::vector<char*> made;
    made.reserve(texts.size() + 1);
    for (std::string& text : texts) made.push_back(text.data());
    made.push_back(nullptr);
    return made;
  };
  pid_t child = 0;
  const int failed =
      posix_spawnp(&child, words[0].c_str(), actions, nullptr, pointers(words).data(), pointers(environment).data());
  return failed == 0 ? child : 0;
}

std::vector<std::string> environment_without_screen() {
  std::vector<std::string> environment;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    if (!text.starts_with("DISPLAY=") && !text.starts_with("WAYLAND_DISPLAY=")) environment.push_back(text);
  }
  return environment;
}

VirtualScreen::VirtualScreen(const std::filesystem::path& folder) : picture_(folder / "Xvfb_screen0") {
  constexpr int kNumberFd = 9;
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], kNumberFd);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  server_ =
      start_program({"Xvfb", "-displayfd", std::to_string(kNumberFd), "-terminate", "-nolisten", "tcp", "-screen", "0",
                     std::to_string(kWidth_px) + "x" + std::to_string(kHeight_px) + "x24", "-fbdir", folder.string()},
                    environment_without_screen(), &actions);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);

  // It says its number when it is ready, and a line's end.
  char letter = 0;
  while (::read(ends[0], &letter, 1) == 1 && letter != '\n') number_ += letter;
  ::close(ends[0]);
}

VirtualScreen::~VirtualScreen() {
  if (server_ == 0) return;
  ::kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
}

std::vector<std::string> VirtualScreen::environment() const {
  std::vector<std::string> environment = environment_without_screen();
  environment.push_back("DISPLAY=:" + number_);
  return environment;
}

std::vector<std::uint8_t> VirtualScreen::pixels() const {
  // An XWD file (X11/XWDFile.h): its pixels are the last of it.
  constexpr std::size_t kBytes = 4 * kWidth_px * kHeight_px;
  std::ifstream file(picture_, std::ios::binary | std::ios::ate);
  const std::streamoff end = file.tellg();
  if (!file || end < static_cast<std::streamoff>(kBytes)) return {};
  std::vector<std::uint8_t> pixels(kBytes);
  file.seekg(end - static_cast<std::streamoff>(kBytes));
  file.read(reinterpret_cast<char*>(pixels.data()), static_cast<std::streamsize>(kBytes));
  return file ? pixels : std::vector<std::uint8_t>{};
}

}  // namespace yuragi::viewer
