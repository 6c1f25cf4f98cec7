#include "tests/pictures/golden_pictures.hpp"

#include "tests/support/places.hpp"

namespace yuragi::viewer {
namespace {

constexpr double kSettling_s = 12.0;

}  // namespace

std::filesystem::path golden_folder() {
  return test::source_path("tests/pictures/golden");
}

std::string golden_file(std::string_view scene, const Weather& weather) {
  return std::string(scene) + "-" + std::string(weather.name) + ".jpg";
}

GoldenMoment golden_moment(std::string_view scene, const Weather& weather) {
  const auto scenes = std::make_shared<ScenesInWind>(scene, weather.speed_m_s);
  scenes->advance(kSettling_s);
  return {scenes, scenes->models(), scenes->moment()};
}

GoldenDrawing::GoldenDrawing(int samples, std::span<const gl::Version> versions)
    : context_({.is_software = true, .has_messages = true, .versions = versions}),
      target_(kWidth_px, kHeight_px, samples) {
  gl::report_gl_errors();
}

Picture GoldenDrawing::draw(const GoldenMoment& moment) {
  stage_.set_scenes(moment.models);
  meshes::OrbitCamera camera;
  camera.frame(moment.scenes->home(stage_, static_cast<double>(kWidth_px) / kHeight_px));
  stage_.draw(moment.poses, camera, target_);
  return {kWidth_px, kHeight_px, target_.read_rgb()};
}

}  // namespace yuragi::viewer
