#pragma once

#include <cstdint>
#include <vector>

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {

/// An off-screen framebuffer, which needs no visible window: several samples a pixel, resolved into one; with depth and
/// stencil. Needs a current context. Throws std::runtime_error if the driver cannot make it.
class RenderTarget {
 public:
  /// As many samples as asked for, or as the driver has; see samples().
  RenderTarget(int width_px, int height_px, int samples);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  int samples() const { return samples_; }

  /// From the next begin() on only this part (0 to 1] of the width and of the height is drawn, and resolve()
  /// interpolates the pixels. Not with several samples a pixel: then it stays 1.
  void set_drawn_side(float part);
  int drawn_width_px() const { return drawn_width_px_; }
  int drawn_height_px() const { return drawn_height_px_; }

  /// From now on draws into the samples.
  void begin();
  /// Resolves the samples to pixels. Later drawing (the overlay) goes over these.
  void resolve();
  /// From now on reads and draws the pixels that resolve() has made.
  void bind_resolved() const;
  /// Copies the pixels to the window's framebuffer.
  void show(int window_width_px, int window_height_px);
  /// The pixels, 3 bytes each, rows from the top down.
  std::vector<std::uint8_t> read_rgb();

 private:
  int width_px_;
  int height_px_;
  int samples_;
  int drawn_width_px_;
  int drawn_height_px_;
  Framebuffer sampled_;
  Renderbuffer sampled_color_;
  Renderbuffer sampled_depth_;
  Framebuffer resolved_;
  Renderbuffer resolved_color_;
};

}  // namespace yuragi::viewer::gl
