#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/look/look.hpp"
#include "viewer/gl/pass_clock.hpp"
#include "viewer/light/daylight.hpp"
#include "viewer/pace_keeper.hpp"
#include "viewer/stream/pose_timeline.hpp"
#include "viewer/stream/stream_connection.hpp"
#include "viewer/wind_trace.hpp"
#include "viewer/window.hpp"

namespace yuragi::viewer {

class Panel;

/// What the overlay shows.
struct OverlayFacts {
  wind::WindState wind;
  stream::Playback playback = stream::Playback::kNothing;
  stream::StreamStatus stream;
  const wire::Sensors* sensors = nullptr;  ///< null: none has come yet
  double pictures_per_s = 0.0;
  std::size_t nodes = 0;
  std::span<const wire::SceneModel* const> scenes;
  std::span<const float> opacities;              ///< one a scene
  const light::Sky* sky = nullptr;               ///< null: not known
  look::Quality quality = look::Quality::kHigh;  ///< in which it is drawn
  DrawnPart drawn;                               ///< how much of it
  double heading_deg = 0.0;                      ///< of the camera: up on the compass
  std::string age;                               ///< of the reading, age_text(); empty: none
  std::string camera;                            ///< which it is, for a person; empty: there is but one
  bool has_help = false;                         ///< of all keys
  bool is_paused = false;
  const WindTrace* wind_trace = nullptr;                     ///< null: it is not shown
  const std::vector<gl::PassClock::Pass>* passes = nullptr;  ///< of the last picture; null: they are not shown
  std::span<const float> picture_times_ms;                   ///< of the last pictures, the oldest first
  bool has_texts = true;                                     ///< otherwise nothing of the above is shown
  Panel* panel = nullptr;  ///< with handles that a person can move; null: it is not shown
};

/// How large texts are, compared with those of a picture of 1080 rows: as the monitor says it, but on a monitor of high
/// resolution that says nothing, large enough to be read. `asked`: by a person.
double overlay_scale(double content_scale, const PixelSize& picture, std::optional<double> asked);

/// Small texts over the picture: wind, sensors, stream, which take no input; and the panel of values, which does. One
/// at a time; needs a current context.
class Overlay {
 public:
  /// `window`: null where there is none.
  explicit Overlay(GLFWwindow* window);
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  /// Draws over the framebuffer that is bound, of this size. `scale`: of all texts, overlay_scale().
  void draw(const PixelSize& size, double scale, const OverlayFacts& facts);

  /// Is what a person does with the mouse, or types, meant for the panel?
  bool takes_mouse() const;
  bool takes_keys() const;

 private:
  void set_scale(double scale);

  bool has_window_;
  double scale_ = 0.0;
};

}  // namespace yuragi::viewer
