#include "viewer/app/keys.hpp"

#include <algorithm>
#include <array>
#include <vector>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace yuragi::viewer::app {
namespace {

constexpr std::array kKeys{
    Key{GLFW_KEY_F1, Action::kHelp},        Key{GLFW_KEY_F2, Action::kInfo},
    Key{GLFW_KEY_H, Action::kInfo},         Key{GLFW_KEY_F3, Action::kProfiler},
    Key{GLFW_KEY_F4, Action::kWind},        Key{GLFW_KEY_F5, Action::kFullScreen},
    Key{GLFW_KEY_F11, Action::kFullScreen}, Key{GLFW_KEY_SPACE, Action::kPause},
    Key{GLFW_KEY_1, Action::kCamera, 1},    Key{GLFW_KEY_2, Action::kCamera, 2},
    Key{GLFW_KEY_3, Action::kCamera, 3},    Key{GLFW_KEY_4, Action::kCamera, 4},
    Key{GLFW_KEY_5, Action::kCamera, 5},    Key{GLFW_KEY_6, Action::kCamera, 6},
    Key{GLFW_KEY_7, Action::kCamera, 7},    Key{GLFW_KEY_8, Action::kCamera, 8},
    Key{GLFW_KEY_9, Action::kCamera, 9},    Key{GLFW_KEY_0, Action::kHomeCamera},
    Key{GLFW_KEY_C, Action::kNextCamera},   Key{GLFW_KEY_R, Action::kFirstCamera},
    Key{GLFW_KEY_T, Action::kTurning},      Key{GLFW_KEY_N, Action::kNextScene},
    Key{GLFW_KEY_L, Action::kNextQuality},  Key{GLFW_KEY_P, Action::kPanel},
    Key{GLFW_KEY_ESCAPE, Action::kClose},   Key{GLFW_KEY_Q, Action::kClose},
};

}  // namespace

std::span<const Key> all_keys() {
  return kKeys;
}

std::optional<Key> key_of(int code) {
  const auto found = std::ranges::find(kKeys, code, &Key::code);
  return found == kKeys.end() ? std::nullopt : std::optional(*found);
}

std::string name_of_key(int code) {
  if (code >= GLFW_KEY_F1 && code <= GLFW_KEY_F25) return "F" + std::to_string(code - GLFW_KEY_F1 + 1);
  if (code == GLFW_KEY_SPACE) return "Space";
  if (code == GLFW_KEY_ESCAPE) return "Esc";
  return {static_cast<char>(code)};  // GLFW uses ASCII codes for letters and digits
}

std::string_view text_of(Action action) {
  switch (action) {
    case Action::kHelp:
      return "this help";
    case Action::kInfo:
      return "wind, sensors, scenes and stream";
    case Action::kProfiler:
      return "profiler: what each picture costs";
    case Action::kWind:
      return "the wind of the last minute, and its spectrum";
    case Action::kFullScreen:
      return "full screen; not on a wall";
    case Action::kPause:
      return "pause, and go on with what is live";
    case Action::kHomeCamera:
      return "camera by hand, at its first place";
    case Action::kCamera:
      return "that camera of the daemon's";
    case Action::kNextCamera:
      return "next of the daemon's cameras";
    case Action::kFirstCamera:
      return "the camera of the beginning";
    case Action::kTurning:
      return "turn slowly";
    case Action::kNextScene:
      return "next scene alone; after the last, all";
    case Action::kNextQuality:
      return "next quality: low, medium, high";
    case Action::kPanel:
      return "panel of the daemon's values";
    case Action::kClose:
      return "quit";
  }
  return {};
}

std::optional<KeyHelp> key_help(std::size_t number) {
  std::vector<Action> lines;
  for (const Key& key : kKeys) {
    if (std::ranges::find(lines, key.action) == lines.end()) lines.push_back(key.action);
  }
  if (number >= lines.size()) return std::nullopt;
  KeyHelp help{.keys = {}, .text = text_of(lines[number])};
  for (const Key& key : kKeys) {
    if (key.action == lines[number]) help.keys += (help.keys.empty() ? "" : ", ") + name_of_key(key.code);
  }
  return help;
}

}  // namespace yuragi::viewer::app
