#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "tests/pictures/picture.hpp"
#include "tests/pictures/scenes_in_wind.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/looks/stage.hpp"

namespace yuragi::viewer {

/// Where the golden pictures are.
std::filesystem::path golden_folder();
/// The file of a scene in a weather.
std::string golden_file(std::string_view scene, const Weather& weather);

/// A scene as its golden picture shows it.
struct GoldenMoment {
  std::shared_ptr<const ScenesInWind> scenes;
  std::vector<wire::SceneModel> models;
  stream::PoseMoment poses;
};
GoldenMoment golden_moment(std::string_view scene, const Weather& weather);

/// Draws as the golden pictures are drawn: by the processor, without a display, from where the viewer's camera begins,
/// or by the day's camera of a configuration that has cameras. One at a time.
class GoldenDrawing {
 public:
  static constexpr int kWidth_px = 480;
  static constexpr int kHeight_px = 270;

  /// `versions`: of OpenGL, to be requested in this order.
  explicit GoldenDrawing(int samples = 4, std::span<const gl::Version> versions = gl::kVersionsToAskFor);

  /// Low at first.
  void set_quality(look::Quality quality) { stage_.set_quality(quality); }
  Picture draw(const GoldenMoment& moment);

 private:
  gl::HeadlessContext context_;  // the members below need it
  looks::Stage stage_;
  gl::RenderTarget target_;
};

}  // namespace yuragi::viewer
