#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace yuragi::viewer::app {

/// An action that a key starts.
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

/// A key and what it does. The only list of keys: the window and the help use it.
struct Key {
  int code;  ///< GLFW's number: the key's position on an American keyboard
  Action action;
  int number = 0;  ///< of the camera, from 1
};
std::span<const Key> all_keys();

/// Returns the action of a key; nullopt if it has none.
std::optional<Key> key_of(int code);

/// Returns the label of a key of all_keys(): "F1", "Space", "C".
std::string name_of_key(int code);

/// Returns the description of an action, for a person.
std::string_view text_of(Action action);

/// A line of the help.
struct KeyHelp {
  std::string keys;  ///< "F5, F11"
  std::string_view text;
};
/// Returns a line of the help: one for each action, in the order of all_keys(). `number`: of the line, from 0; nullopt
/// after the last.
std::optional<KeyHelp> key_help(std::size_t number);

}  // namespace yuragi::viewer::app
