// Contact sheets, to look at: of each scene a page for each light, calm to storm from left to right and one framing
// under the other, and a strip of 12 pictures over time in a breeze. tests/pictures/sheet calls this.
//
//   draw_sheets FOLDER [--scene NAME]... [--light NAME]...

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "tests/pictures/canvas.hpp"
#include "tests/pictures/scenes_in_wind.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/light/sky_keeper.hpp"
#include "viewer/looks/stage.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::viewer;

constexpr int kSamples = 4;
constexpr int kGap_px = 8;
constexpr double kSettling_s = 20.0;

/// From air that hardly moves to a storm.
constexpr std::array kSheetWinds{Weather{"calm", 0.5}, Weather{"breeze", 4.0}, Weather{"fresh", 9.0},
                                 Weather{"storm", 16.0}};
constexpr std::array kStripWinds{kSheetWinds[1], kSheetWinds[3]};

/// The lights that pages are made in: the one that there is without [look], and times of the day by the sun, at the
/// equinox, two days before a full moon.
struct PageLight {
  std::string_view name;
  std::optional<double> solar_time_h;
};
constexpr std::array kLights{PageLight{"evening", {}}, PageLight{"dawn", 6.2}, PageLight{"noon", 12.0},
                             PageLight{"dusk", 18.1}, PageLight{"night", 23.0}};
constexpr double kDay_s = 1790208000.0;  // 2026-09-24
constexpr double kEvening_h = 17.0;      // for the cameras of a configuration that has some

light::Light light_of(const PageLight& page) {
  if (!page.solar_time_h) return light::light_of({}, kDay_s);
  return light::light_of({.sun = look::SunChoice::kTime, .solar_time_h = page.solar_time_h}, kDay_s);
}

struct Framing {
  const char* name;
  int width_px, height_px;
  meshes::CameraPlace (*place)(const looks::Stage& stage, double aspect);  // null: where the viewer begins
};

meshes::CameraPlace near(const looks::Stage& stage, double aspect) {
  meshes::CameraPlace place = stage.home(aspect);
  place.distance_m *= 0.35;
  return place;
}
meshes::CameraPlace around_middle(const looks::Stage& stage, double pitch_deg, double distance_m) {
  const meshes::Bounds bounds = stage.bounds();
  return {.target_m = glm::dvec3((bounds.low_m + bounds.high_m) / 2.0F),
          .heading_deg = stage.home(1.0).heading_deg,
          .pitch_deg = pitch_deg,
          .distance_m = distance_m};
}
meshes::CameraPlace far(const looks::Stage& stage, double /*aspect*/) {
  return around_middle(stage, 8.0, 40.0);
}
meshes::CameraPlace above(const looks::Stage& stage, double /*aspect*/) {
  const meshes::Bounds bounds = stage.bounds();
  return around_middle(stage, 80.0, 2.0 + 1.6 * static_cast<double>(glm::length(bounds.high_m - bounds.low_m)));
}

constexpr std::array kFramings{Framing{"wide", 640, 360, nullptr},  Framing{"portrait", 202, 360, nullptr},
                               Framing{"32:9", 640, 180, nullptr},  Framing{"near", 640, 360, near},
                               Framing{"far, 40 m", 640, 360, far}, Framing{"above", 640, 360, above}};

std::vector<std::uint8_t> draw(looks::Stage& stage, const ScenesInWind& scenes, const PageLight& light,
                               const Framing& framing) {
  gl::RenderTarget target(framing.width_px, framing.height_px, kSamples);
  meshes::OrbitCamera camera;
  const double aspect = static_cast<double>(framing.width_px) / framing.height_px;
  camera.frame(framing.place != nullptr ? framing.place(stage, aspect)
                                        : scenes.home(stage, aspect, light.solar_time_h.value_or(kEvening_h)));
  stage.draw(scenes.moment(), camera, target);
  return target.read_rgb();
}

/// Draws the pages of a scene, one a light.
void draw_pages(looks::Stage& stage, std::string_view scene, std::span<const PageLight> lights,
                const std::filesystem::path& folder) {
  constexpr int kColumn_px = 640 + kGap_px;
  int height_px = kGap_px;
  for (const Framing& framing : kFramings) height_px += framing.height_px + Canvas::kTextHeight_px + kGap_px;
  std::vector<Canvas> pages(lights.size(), Canvas(static_cast<int>(kSheetWinds.size()) * kColumn_px, height_px));

  int left_px = 0;
  for (const Weather& weather : kSheetWinds) {
    ScenesInWind scenes(scene, weather.speed_m_s);
    scenes.advance(kSettling_s);
    stage.set_scenes(scenes.models());
    for (std::size_t light = 0; light < lights.size(); ++light) {
      stage.set_light(light_of(lights[light]));
      int top_px = 0;
      for (const Framing& framing : kFramings) {
        pages[light].write_text(left_px + kGap_px, top_px + kGap_px,
                                fmt::format("{}, {} {:g} m/s, {}, {}", scene, weather.name, weather.speed_m_s,
                                            lights[light].name, framing.name));
        top_px += Canvas::kTextHeight_px + kGap_px;
        pages[light].put(left_px, top_px, framing.width_px, draw(stage, scenes, lights[light], framing));
        top_px += framing.height_px;
      }
    }
    left_px += kColumn_px;
  }
  for (std::size_t light = 0; light < lights.size(); ++light) {
    pages[light].save(folder / fmt::format("{}-{}.png", scene, lights[light].name));
  }
}

/// Draws what a scene does in a wind, from left to right and downward.
void draw_strip(looks::Stage& stage, std::string_view scene, const Weather& weather,
                const std::filesystem::path& folder) {
  constexpr int kPictures = 12;
  constexpr int kColumns = 4;
  constexpr double kStep_s = 1.0 / 12.0;
  constexpr Framing kFraming{"strip", 480, 270, nullptr};
  constexpr int kRow_px = kFraming.height_px + Canvas::kTextHeight_px + kGap_px;

  Canvas strip(kColumns * (kFraming.width_px + kGap_px), kPictures / kColumns * kRow_px + kGap_px);
  ScenesInWind scenes(scene, weather.speed_m_s);
  scenes.advance(kSettling_s);
  stage.set_scenes(scenes.models());
  stage.set_light(light_of(kLights.front()));
  for (int i = 0; i < kPictures; ++i) {
    const int left_px = i % kColumns * (kFraming.width_px + kGap_px);
    const int top_px = i / kColumns * kRow_px;
    strip.write_text(left_px + kGap_px, top_px + kGap_px,
                     fmt::format("{}, {} {:g} m/s, {:.2f} s", scene, weather.name, weather.speed_m_s, i * kStep_s));
    strip.put(left_px, top_px + Canvas::kTextHeight_px + kGap_px, kFraming.width_px,
              draw(stage, scenes, kLights.front(), kFraming));
    scenes.advance(kStep_s);
  }
  strip.save(folder / fmt::format("{}-{}-strip.png", scene, weather.name));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    std::filesystem::path folder;
    std::vector<std::string> names{picture_scenes().begin(), picture_scenes().end()};
    CLI::App app("Contact sheets of the scenes");
    app.add_option("folder", folder)->required()->check(CLI::ExistingDirectory);
    app.add_option("--scene", names, "only this; can be given again")->check(CLI::IsMember(names));
    std::vector<std::string> light_names(kLights.size());
    std::ranges::transform(kLights, light_names.begin(), &PageLight::name);
    app.add_option("--light", light_names, "only in this; can be given again")->check(CLI::IsMember(light_names));
    CLI11_PARSE(app, argc, argv);

    std::vector<PageLight> lights;
    std::ranges::copy_if(kLights, std::back_inserter(lights), [&](const PageLight& light) {
      return std::ranges::find(light_names, light.name) != light_names.end();
    });

    const gl::HeadlessContext context({.has_messages = true});
    gl::report_gl_errors();
    looks::Stage stage;
    for (const std::string& name : names) {
      std::printf("%s\n", name.c_str());
      std::fflush(stdout);
      draw_pages(stage, name, lights, folder);
      for (const Weather& weather : kStripWinds) draw_strip(stage, name, weather, folder);
    }
    return gl::gl_error_count() == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "draw_sheets: %s\n", error.what());
    return 70;
  }
}
