#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace yuragi::viewer::app {

/// What a person asks for with a key.
enum class Action : unsigned char {
  kHelp,
  kInfo,
  kProfiler,
  kWind,
  kFullScreen,
  kPause,
  kHomeCamera,
  kCamera,
  kNextCamera,
  kFirstCamera,
  kTurning,
  kNextScene,
  kNextQuality,
  kPanel,
  kClose,
};

/// A key and what it does. The one list of them: the window looks keys up in it, and the help writes it.
struct Key {
  int code;  ///< as GLFW numbers it: by its place on an American keyboard
  Action action;
  int number = 0;  ///< of the camera, from 1
};
std::span<const Key> all_keys();

/// What a key does; nothing where it does nothing.
std::optional<Key> key_of(int code);

/// What is written on a key of all_keys(): "F1", "Space", "C".
std::string name_of_key(int code);

/// What an action is, for a person.
std::string_view text_of(Action action);

/// A line of the help.
struct KeyHelp {
  std::string keys;  ///< "F5, F11"
  std::string_view text;
};
/// The lines of the help: one for each action, in the order of all_keys(). `number`: of the line, from 0; nothing
/// behind the last.
std::optional<KeyHelp> key_help(std::size_t number);

}  // namespace yuragi::viewer::app
