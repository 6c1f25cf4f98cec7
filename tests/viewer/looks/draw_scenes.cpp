// Pictures of every scene of the engine, alone: calm, in a breeze, in a storm; without a daemon.
//
//   draw_scenes [--look=KEY=VALUE...] [--camera=HEADING,PITCH,DISTANCE[,X,Y,Z]] [--weather=NAME] [--wind=M_S] FOLDER
//               [WIDTHxHEIGHT [KIND[,PARAMETER=VALUE...]...]]
//
// --camera: degrees and metres, around the scene's middle or that place; --weather: that one alone; --wind: this speed
// alone.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "engine/look/look.hpp"
#include "engine/scenes/scene.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/looks/stage.hpp"
#include "viewer/picture/picture_file.hpp"

namespace {

using namespace yuragi;

constexpr double kTick_s = 1.0 / 60.0;
constexpr int kSettlingTicks = 1500;
constexpr double kWindFrom_deg = 250.0;
constexpr double kDay_s = 1790208000.0;  // 2026-09-24: day and night are equally long

struct Weather {
  const char* name;
  double speed_m_s;
};

/// "tree,species=poplar" taken apart.
std::unique_ptr<scenes::Scene> made(const std::string& words) {
  const std::string kind = words.substr(0, words.find(','));
  ParameterValues::Map given;
  for (std::size_t at = kind.size(); at < words.size();) {
    const std::size_t end = std::min(words.find(',', at + 1), words.size());
    const std::string word = words.substr(at + 1, end - at - 1);
    const std::size_t equals = std::min(word.find('='), word.size() - 1);
    const std::string value = word.substr(equals + 1);
    char* rest = nullptr;
    const double number = std::strtod(value.c_str(), &rest);
    if (*rest == '\0' && value.find('.') == std::string::npos) {
      given[word.substr(0, equals)] = static_cast<std::int64_t>(number);
    } else if (*rest == '\0') {
      given[word.substr(0, equals)] = number;
    } else {
      given[word.substr(0, equals)] = value;
    }
    at = end;
  }
  for (const scenes::Description* description : scenes::scene_table()) {
    if (description->name != kind) continue;
    return description->make(ParameterValues::resolve(description->parameters, given).value(), {});
  }
  throw std::runtime_error("there is no scene of the kind " + kind);
}

/// The camera's place where the command line says one, otherwise `home`.
viewer::meshes::CameraPlace camera_place(const std::string& wanted, viewer::meshes::CameraPlace home) {
  std::sscanf(wanted.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf", &home.heading_deg, &home.pitch_deg, &home.distance_m,
              &home.target_m.x, &home.target_m.y, &home.target_m.z);
  return home;
}

/// Draws what the command line asks for. Returns the exit code.
int draw_scenes(std::vector<std::string> words) {
  std::vector<std::string> edits;
  std::string wanted_camera;
  std::string wanted_weather;
  std::vector<Weather> weathers{{"calm", 0.0}, {"breeze", 4.0}, {"storm", 18.0}};
  while (!words.empty() && words.front().starts_with("--")) {
    const std::string value = words.front().substr(std::min(words.front().find('='), words.front().size() - 1) + 1);
    if (words.front().starts_with("--look=")) {
      edits.push_back(value);
    } else if (words.front().starts_with("--camera=")) {
      wanted_camera = value;
    } else if (words.front().starts_with("--weather=")) {
      wanted_weather = value;
    } else if (words.front().starts_with("--wind=")) {
      weathers = {{"wind", std::strtod(value.c_str(), nullptr)}};
    } else {
      return 64;
    }
    words.erase(words.begin());
  }

  if (words.empty()) return 64;
  int width_px = 960;
  int height_px = 540;
  if (words.size() > 1) std::sscanf(words[1].c_str(), "%dx%d", &width_px, &height_px);
  std::vector<std::string> kinds(words.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(2, words.size())),
                                 words.end());
  if (kinds.empty()) {
    for (const scenes::Description* description : scenes::scene_table()) kinds.emplace_back(description->name);
  }

  const viewer::gl::HeadlessContext context({.has_messages = true});
  viewer::gl::report_gl_errors();
  viewer::looks::Stage stage;
  const look::Look look = look::edited({}, edits).value();
  stage.set_light(viewer::light::light_of(look, kDay_s));
  stage.set_quality(look.quality);
  stage.set_blade_share(static_cast<float>(look.density));
  viewer::gl::RenderTarget target(width_px, height_px, 4);
  for (const std::string& kind : kinds) {
    for (const auto& [name, speed_m_s] : weathers) {
      if (!wanted_weather.empty() && wanted_weather != name) continue;
      const std::unique_ptr<scenes::Scene> scene = made(kind);
      const std::vector<wire::SceneModel> models{{kind, kind.substr(0, kind.find(',')), scene->skeleton()}};
      for (int i = 0; i < kSettlingTicks; ++i) scene->tick(wind::wind_from(speed_m_s, kWindFrom_deg), kTick_s);
      stage.set_scenes(models);
      viewer::meshes::OrbitCamera camera;
      viewer::meshes::CameraPlace place = stage.home(static_cast<double>(width_px) / height_px);
      if (!wanted_camera.empty()) {
        const viewer::meshes::Bounds box = stage.bounds();
        place.target_m = 0.5 * (glm::dvec3(box.low_m) + glm::dvec3(box.high_m));
      }
      camera.frame(camera_place(wanted_camera, place));
      viewer::stream::PoseMoment moment = viewer::stream::rest_moment(models);
      moment.poses[0] = scene->pose();
      moment.time_s = kSettlingTicks * kTick_s;
      moment.wind.wind = wind::wind_from(speed_m_s, kWindFrom_deg);
      stage.draw(moment, camera, target);
      viewer::picture::write_picture(fmt::format("{}/{}-{}.png", words[0], kind, name), width_px, height_px,
                                     target.read_rgb());
    }
  }
  return viewer::gl::gl_error_count() == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return draw_scenes({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "draw_scenes: %s\n", error.what());
    return 70;
  }
}
