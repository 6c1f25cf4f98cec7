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
  const wire::Sensors* sensors = nullptr;  ///< null: none received yet
  double pictures_per_s = 0.0;
  std::size_t nodes = 0;
  std::span<const wire::SceneModel* const> scenes;
  std::span<const float> opacities;              ///< one a scene
  const light::Sky* sky = nullptr;               ///< null: not known
  look::Quality quality = look::Quality::kHigh;  ///< quality of the picture
  pace::DrawnPart drawn;                         ///< how much of it
  int refreshes = 1;                             ///< refreshes of the display per picture
  double heading_deg = 0.0;                      ///< of the camera: the compass has it at the top
  std::string age;                               ///< age of the reading, age_text(); empty: unknown
  std::string camera;                            ///< the camera's name, for a person; empty: there is only one camera
  bool has_help = false;                         ///< of all keys
  bool is_paused = false;
  std::string notice;  ///< what is wrong and what to do, drawn over everything else; empty: no notice
  const WindTrace* wind_trace = nullptr;                     ///< null: it is not shown
  const std::vector<gl::PassClock::Pass>* passes = nullptr;  ///< of the last picture; null: not shown
  std::span<const float> picture_times_ms;                   ///< of the last pictures, the oldest first
  bool has_texts = true;                                     ///< if false, all of the above is hidden
  Panel* panel = nullptr;                                    ///< the panel of values, with handles; null: not shown
};

/// The overlay's windows of ImGui, none of which covers another (OverlayLayout). A window that is cut takes mouse
/// input, to be scrolled; otherwise only the panel of values takes input. Needs ImGui's context; not thread-safe.
class OverlayPanels {
 public:
  /// Loads the font and sets the style for texts of this size. ImGui's font texture has to be made again afterwards.
  static void set_scale(double scale);

  /// Within a frame of ImGui, which knows the size of a new panel after two frames.
  void draw(const OverlayFacts& facts);

  /// Returns true once the sizes of all panels that are shown are known.
  bool is_laid_out(const OverlayFacts& facts) const;

 private:
  struct Place {
    PanelSize wanted;  // as of the last frame in which it was shown; empty: never shown
    PanelRect rect;    // of this frame
    int frames = 0;    // number of frames in which it was shown, counted up to kFramesToMeasure
  };
  static constexpr int kFramesToMeasure = 2;

  static void set_size(ImGuiSizeCallbackData* data);
  template <class Content>
  void draw_panel_at(PanelId id, const char* name, const Content& content);

  OverlayLayout layout_;
  OfPanels<Place> places_;
};

}  // namespace yuragi::viewer::app
