#pragma once

#include <optional>

#include "viewer/app/overlay_panels.hpp"
#include "viewer/app/window.hpp"

namespace yuragi::viewer::app {

/// Returns the scale of texts, relative to those of a picture of 1080 rows: the monitor's own; if a monitor of high
/// resolution reports none, one that is large enough to read. `asked`: by a person.
double overlay_scale(double content_scale, const PixelSize& picture, std::optional<double> asked);

/// Small texts over the picture, drawn by OpenGL. One at a time; needs a current context.
class Overlay {
 public:
  /// `window`: null if there is none.
  explicit Overlay(GLFWwindow* window);
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  /// Draws over the framebuffer that is bound, of this size. `scale`: of all texts, overlay_scale().
  void draw(const PixelSize& size, double scale, const OverlayFacts& facts);

  /// Returns true if mouse input or typed text is meant for a panel.
  bool takes_mouse() const;
  bool takes_keys() const;

 private:
  void set_scale(double scale);

  bool has_window_;
  OverlayPanels panels_;
  double scale_ = 0.0;
};

}  // namespace yuragi::viewer::app
