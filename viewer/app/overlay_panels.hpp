#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/look/look.hpp"
#include "viewer/app/overlay_layout.hpp"
#include "viewer/app/wind_trace.hpp"
#include "viewer/gl/pass_clock.hpp"
#include "viewer/light/daylight.hpp"
#include "viewer/pace/pace_ladder.hpp"
#include "viewer/stream/pose_timeline.hpp"
#include "viewer/stream/stream_connection.hpp"

struct ImGuiSizeCallbackData;

namespace yuragi::viewer::app {

class Panel;

/// What the overlay shows.
struct OverlayFacts {
  wind::State wind;
  stream::Playback playback = stream::Playback::kNothing;
  stream::Status stream;
  const wire::Sensors* sensors = nullptr;  ///< null: none has come yet
  double pictures_per_s = 0.0;
  std::size_t nodes = 0;
  std::span<const wire::SceneModel* const> scenes;
  std::span<const float> opacities;              ///< one a scene
  const light::Sky* sky = nullptr;               ///< null: not known
  look::Quality quality = look::Quality::kHigh;  ///< in which it is drawn
  pace::DrawnPart drawn;                         ///< how much of it
  int refreshes = 1;                             ///< of the display, for each picture
  double heading_deg = 0.0;                      ///< of the camera: up on the compass
  std::string age;                               ///< of the reading, age_text(); empty: none
  std::string camera;                            ///< which it is, for a person; empty: there is but one
  bool has_help = false;                         ///< of all keys
  bool is_paused = false;
  std::string notice;                     ///< what is wrong and what to do, over all else; empty: none
  const WindTrace* wind_trace = nullptr;  ///< null: it is not shown
  const std::vector<gl::PassClock::Pass>* passes = nullptr;  ///< of the last picture; null: they are not shown
  std::span<const float> picture_times_ms;                   ///< of the last pictures, the oldest first
  bool has_texts = true;                                     ///< otherwise nothing of the above is shown
  Panel* panel = nullptr;  ///< with handles that a person can move; null: it is not shown
};

/// The overlay's windows of ImGui, none of which covers another (OverlayLayout). One that is cut takes the mouse, to be
/// scrolled; of the others only the panel of values takes input. Needs ImGui's context; not thread-safe.
class OverlayPanels {
 public:
  /// Loads the font and sets the style for texts of this size. ImGui's font texture has to be made again afterwards.
  static void set_scale(double scale);

  /// Within a frame of ImGui, which knows the size of a panel after two frames of it.
  void draw(const OverlayFacts& facts);

  /// Returns true once the sizes of all panels that are shown are known.
  bool is_laid_out(const OverlayFacts& facts) const;

 private:
  struct Place {
    PanelSize wanted;  // as of the last frame in which it was shown; empty: it has never been
    PanelRect rect;    // of this frame
    int frames = 0;    // in which it was shown, as far as they count: at most kFramesToMeasure
  };
  static constexpr int kFramesToMeasure = 2;

  static void set_size(ImGuiSizeCallbackData* data);
  template <class Content>
  void draw_panel_at(PanelId id, const char* name, const Content& content);

  OverlayLayout layout_;
  OfPanels<Place> places_;
};

}  // namespace yuragi::viewer::app
