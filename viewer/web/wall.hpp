#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "viewer/pace/pace_keeper.hpp"
#include "viewer/picture/gl_renderer.hpp"
#include "viewer/picture/picture_director.hpp"
#include "viewer/picture/viewer_options.hpp"
#include "viewer/stream/scene_timeline.hpp"

namespace yuragi::viewer::web {

/// What a page shows, without a window or a connection of its own: the page hands in messages and asks for pictures.
/// Needs a current context, whose framebuffer 0 is the page's canvas. Times are seconds of one clock that only
/// advances. Thread-safe: no; a page has one thread.
class Wall {
 public:
  /// `options`: scene, camera and look, as on the command line; a width and a height that the first picture can have.
  /// `is_software`: the processor draws. `has_sky`: false leaves the sky out (Stage::leave_sky_out()).
  Wall(picture::ViewerOptions options, bool is_software, bool has_sky);
  Wall(const Wall&) = delete;
  Wall& operator=(const Wall&) = delete;

  /// Takes a message of the stream, without its size, that has just arrived. Returns what is wrong with it, for a
  /// person: then the connection is of no use; nullopt if nothing is. Throws ViewerExit if the first scenes or cameras
  /// do not include those of the options.
  std::optional<std::string> take(std::span<const std::uint8_t> message, double now_s);

  /// Draws a picture of this size into framebuffer 0, if there is something to show, the one before it is complete, and
  /// its time has come. Returns true if it has drawn.
  bool draw(double now_s, int width_px, int height_px);
  /// Returns true while the card is still drawing the last picture. Without waiting; the sooner it is asked after the
  /// picture is complete, the better the pace is known.
  bool is_drawing(double now_s);

  /// Pictures drawn so far.
  std::uint64_t pictures() const { return pictures_; }
  /// How the last one was drawn, for a person: "quality high".
  std::string pace_text() const;

 private:
  void advance(double now_s);

  const picture::ViewerOptions options_;
  picture::GlRenderer renderer_;
  picture::Director director_;
  stream::SceneTimeline timeline_;
  const stream::PoseMoment* moment_ = nullptr;  // of timeline_
  pace::Keeper pace_;
  bool has_status_ = false;
  double utc_s_ = 0.0;  // the daemon's clock: of the newest frame
  std::optional<double> advanced_s_;
  std::uint64_t pictures_ = 0;

  // Of the last picture.
  std::optional<double> begun_s_;
  std::optional<GLsync> drawing_;  // until it is complete
  std::optional<double> work_s_;   // then, if it was a usual one
  bool is_usual_ = false;          // no shader was compiled for it
};

}  // namespace yuragi::viewer::web
