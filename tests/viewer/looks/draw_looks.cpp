// Draws models of the tests, calm and in a storm, without a daemon: to look at what has been changed.
//
//   draw_looks FOLDER [WIDTHxHEIGHT [KIND...]]      KIND as in test_models.hpp, or "garden"

#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "tests/viewer/test_models.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/looks/stage.hpp"
#include "viewer/picture/picture_file.hpp"

int main(int argc, char** argv) {
  using namespace yuragi;
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty()) return 64;
  int width_px = 960;
  int height_px = 540;
  if (words.size() > 1) std::sscanf(words[1].c_str(), "%dx%d", &width_px, &height_px);
  std::vector<std::string> kinds(words.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(2, words.size())),
                                 words.end());
  if (kinds.empty()) {
    kinds = {"grass", "fur", "curtain", "flag", "banner", "tree", "ripple", "flame", "flame panel", "garden"};
  }

  const viewer::gl::HeadlessContext context({.has_messages = true});
  viewer::gl::report_gl_errors();
  viewer::looks::Stage stage;
  viewer::gl::RenderTarget target(width_px, height_px, 4);
  for (const std::string& kind : kinds) {
    const auto models = kind == "garden" ? viewer::test_garden() : std::vector{viewer::test_model(kind)};
    stage.set_scenes(models);
    viewer::meshes::OrbitCamera camera;
    camera.frame(stage.home(static_cast<double>(width_px) / height_px));
    for (const double strength : {0.0, 0.4, 1.0}) {
      viewer::stream::PoseMoment moment = viewer::stream::rest_moment(models);
      moment.time_s = 10.0 * strength;
      for (std::size_t i = 0; i < models.size(); ++i) moment.poses[i] = viewer::test_pose(models[i], 2.0, strength);
      stage.draw(moment, camera, target);
      viewer::picture::write_picture(fmt::format("{}/{}-{:.0f}.png", words[0], kind, 10 * strength), width_px,
                                     height_px, target.read_rgb());
    }
  }
  return viewer::gl::gl_error_count() == 0 ? 0 : 1;
}
