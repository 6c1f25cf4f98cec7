#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi::output {

/// More than any wall has.
inline constexpr std::size_t kMaxOutputs = 32;
inline constexpr std::size_t kMaxWindows = 16;
inline constexpr int kMaxSide_px = 16384;
inline constexpr double kMinDelay_s = 0.02;
inline constexpr double kMaxDelay_s = 1.0;

/// A place in a picture or on a monitor, as parts of its width and height: x to the right, y down.
struct Place {
  double x = 0.0;
  double y = 0.0;
  friend bool operator==(const Place&, const Place&) = default;
};

/// A part of a picture.
struct Crop {
  double x = 0.0;  ///< of its upper left corner
  double y = 0.0;
  double width = 1.0;
  double height = 1.0;
  friend bool operator==(const Crop&, const Crop&) = default;
};

/// Upper left, upper right, lower right, lower left.
using Corners = std::array<Place, 4>;
inline constexpr Corners kWholeMonitor{{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}};

/// Widths at the four sides, as parts of the whole picture's width and height.
struct Sides {
  double left = 0.0;
  double right = 0.0;
  double top = 0.0;
  double bottom = 0.0;
  friend bool operator==(const Sides&, const Sides&) = default;
};

/// A monitor, and the part of the picture that fills it.
struct Window {
  std::string monitor = {};  ///< its name, or its number from 0; empty: the primary one
  Crop crop = {};
  int rotation_deg = 0;             ///< 0, 90, 180 or 270: clockwise, of the picture on the monitor
  Corners corners = kWholeMonitor;  ///< of the crop, on the monitor as a viewer sees it, that is, rotated
  Sides blend = {};                 ///< where the crop fades into that of the next projector
  double gamma = 2.2;               ///< of the projector, for the blend
  friend bool operator==(const Window&, const Window&) = default;
};

/// A place in the room, in meters; any axes that are at right angles.
using RoomPlace = std::array<double, 3>;

/// A screen that acts as a window for an eye at a fixed place.
struct Screen {
  RoomPlace lower_left_m = {};
  RoomPlace lower_right_m = {};
  RoomPlace upper_left_m = {};
  RoomPlace eye_m = {};
  friend bool operator==(const Screen&, const Screen&) = default;
};

struct Size {
  int width_px = 0;
  int height_px = 0;
  friend bool operator==(const Size&, const Size&) = default;
};

/// One picture, and the windows that show it.
struct Output {
  std::string name = "wall";
  std::optional<Size> size = std::nullopt;  ///< of the picture; nullopt: the resolution of its windows
  int refreshes = 1;                        ///< refreshes of the display per picture
  /// From a moment's UTC to its picture; nullopt: as little as the network allows.
  std::optional<double> delay_s = std::nullopt;
  std::optional<Screen> screen = std::nullopt;
  std::vector<Window> windows = {};  ///< at least one
  friend bool operator==(const Output&, const Output&) = default;
};

/// An [[output]] with its values by key, of output_parameters() and window_parameters().
struct Table {
  ParameterValues values = {};
  std::vector<ParameterValues> windows = {};
  Output output = {};
};

/// The keys of an [[output]], without its name.
std::span<const Parameter> output_parameters();
/// The keys of an [[output.window]].
std::span<const Parameter> window_parameters();

/// From values of the tables above, without windows.
Result<Output, ParameterError> output_of(std::string name, const ParameterValues& values);
Result<Window, ParameterError> window_of(const ParameterValues& values);

}  // namespace yuragi::output
