#include "tests/viewer/started_program.hpp"

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

}  // namespace yuragi::viewer
