// The meadow from many places, in calm, a breeze and a storm with gusts; and what a picture of it costs.
//
//   draw_meadow FOLDER [WIDTHxHEIGHT [GRASS_PARAMETER=VALUE,... [PLACE,... [WEATHER,... [QUALITY]]]]]

#include <cstdio>
#include <ctime>
#include <exception>
#include <string>

#include <fmt/format.h>

#include "engine/scenes/scene.hpp"
#include "tests/answer/test_wind.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/looks/stage.hpp"
#include "viewer/picture/picture_file.hpp"

namespace {

using namespace yuragi;

constexpr double kTick_s = 1.0 / 60.0;
constexpr int kSettlingTicks = 900;
constexpr int kTimedPictures = 20;

/// What this thread or the whole process has used of the processors: of use on a machine that others load.
double cpu_ms(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Pictures of one size, each made half as large, in two columns.
class Sheet {
 public:
  Sheet(int width_px, int height_px, std::size_t count)
      : width_px_(width_px / 2),
        height_px_(height_px / 2),
        rgb_(3 * static_cast<std::size_t>(2 * width_px_ * height_px_) * ((count + 1) / 2)) {}

  void add(const std::vector<std::uint8_t>& picture) {
    const int top_px = static_cast<int>(count_ / 2) * height_px_;
    const int left_px = static_cast<int>(count_ % 2) * width_px_;
    ++count_;
    const auto from = [&](int x_px, int y_px, int channel) {
      return int{picture[static_cast<std::size_t>(3 * (y_px * 2 * width_px_ + x_px) + channel)]};
    };
    for (int y_px = 0; y_px < height_px_; ++y_px) {
      for (int x_px = 0; x_px < width_px_; ++x_px) {
        for (int channel = 0; channel < 3; ++channel) {
          const int sum = from(2 * x_px, 2 * y_px, channel) + from(2 * x_px + 1, 2 * y_px, channel) +
                          from(2 * x_px, 2 * y_px + 1, channel) + from(2 * x_px + 1, 2 * y_px + 1, channel);
          rgb_[static_cast<std::size_t>(3 * ((top_px + y_px) * 2 * width_px_ + left_px + x_px) + channel)] =
              static_cast<std::uint8_t>(sum / 4);
        }
      }
    }
  }
  void write(const std::string& file) const {
    viewer::picture::write_picture(file, 2 * width_px_, static_cast<int>(rgb_.size()) / (6 * width_px_), rgb_);
  }

 private:
  int width_px_, height_px_;
  std::vector<std::uint8_t> rgb_;
  std::size_t count_ = 0;
};

struct NamedPlace {
  const char* name;
  viewer::meshes::CameraPlace place;
};

// Target, heading, pitch, distance.
const std::vector<NamedPlace> kPlaces{
    {"near", {{0.5, 0.3, -0.5}, 225.0, 7.0, 3.0}},    {"eye", {{0.0, 0.6, 0.0}, 250.0, 2.0, 8.0}},
    {"ten", {{0.0, 0.0, 0.0}, 200.0, 16.0, 12.0}},    {"forty", {{0.0, 0.0, 0.0}, 300.0, 18.0, 40.0}},
    {"above10", {{0.0, 0.0, 0.0}, 0.0, 88.0, 12.0}},  {"above60", {{0.0, 0.0, 0.0}, 20.0, 88.0, 60.0}},
    {"slope60", {{0.0, 0.0, 0.0}, 130.0, 35.0, 60.0}}};

ParameterValues::Map values_of(const std::string& words) {
  ParameterValues::Map given;
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t end = std::min(words.find(',', at), words.size());
    const std::size_t equals = words.find('=', at);
    const std::string value = words.substr(equals + 1, end - equals - 1);
    if (value.find('.') == std::string::npos) {
      given[words.substr(at, equals - at)] = std::int64_t{std::stoll(value)};
    } else {
      given[words.substr(at, equals - at)] = std::stod(value);
    }
    at = end + 1;
  }
  return given;
}

std::unique_ptr<scenes::Scene> made(std::string_view kind, const ParameterValues::Map& given) {
  for (const scenes::Description* description : scenes::scene_table()) {
    if (description->name != kind) continue;
    return description->make(ParameterValues::resolve(description->parameters, given).value(),
                             {.seed = 1, .gusts = answer::test_gusts()});
  }
  return nullptr;
}

/// Is a name in the list that is word number `at`? In no list everything is.
bool is_asked(const std::vector<std::string>& words, std::size_t at, std::string_view name) {
  return words.size() <= at || words[at].empty() || words[at].find(name) != std::string::npos;
}

int draw_meadow(const std::vector<std::string>& words) {
  if (words.empty()) return 64;
  int width_px = 1280;
  int height_px = 720;
  if (words.size() > 1) std::sscanf(words[1].c_str(), "%dx%d", &width_px, &height_px);
  const ParameterValues::Map given = values_of(words.size() > 2 ? words[2] : std::string());

  const viewer::gl::HeadlessContext context({.has_messages = true});
  viewer::gl::report_gl_errors();
  viewer::looks::Stage stage;
  if (words.size() > 5) stage.set_quality(look::edited({}, std::vector{"quality=" + words[5]}).value().quality);
  viewer::gl::RenderTarget target(width_px, height_px, viewer::gl::is_software_renderer() ? 1 : 4);
  for (const auto& [weather, speed_m_s] : {std::pair{"calm", 0.0}, {"breeze", 4.0}, {"storm", 18.0}}) {
    if (!is_asked(words, 4, weather)) continue;
    std::vector<std::unique_ptr<scenes::Scene>> scenes;
    std::vector<wire::SceneModel> models;
    for (const char* kind : {"grass", "ground"}) {
      std::unique_ptr<scenes::Scene> scene =
          made(kind, kind == std::string_view("grass") ? given : ParameterValues::Map());
      if (scene == nullptr) continue;
      models.push_back({kind, kind, scene->skeleton()});
      scenes.push_back(std::move(scene));
    }
    answer::TestWind wind(answer::test_gusts(), {.speed_m_s = speed_m_s, .direction_deg = 250.0});
    const auto tick = [&] {
      const auto& now = wind.step(kTick_s);
      for (const auto& scene : scenes) scene->tick(now, kTick_s);
    };
    for (int i = 0; i < kSettlingTicks; ++i) tick();
    stage.set_scenes(models);
    viewer::stream::PoseMoment moment = viewer::stream::rest_moment(models);
    std::vector<NamedPlace> places = kPlaces;
    places.push_back({"home", stage.home(static_cast<double>(width_px) / height_px)});
    Sheet sheet(width_px, height_px, places.size());
    for (const auto& [name, place] : places) {
      if (!is_asked(words, 3, name)) continue;
      viewer::meshes::OrbitCamera camera;
      camera.frame(place);
      for (std::size_t i = 0; i < scenes.size(); ++i) moment.poses[i] = scenes[i]->pose();
      stage.draw(moment, camera, target);
      const std::vector<std::uint8_t> picture = target.read_rgb();
      viewer::picture::write_picture(fmt::format("{}/{}-{}.png", words[0], name, weather), width_px, height_px,
                                     picture);
      sheet.add(picture);
      if (speed_m_s != 4.0) continue;
      double sum_ms = 0.0;
      double thread_ms = 0.0;
      for (int i = 0; i < kTimedPictures; ++i) {
        tick();
        for (std::size_t k = 0; k < scenes.size(); ++k) moment.poses[k] = scenes[k]->pose();
        const double before_ms = cpu_ms(CLOCK_PROCESS_CPUTIME_ID);
        const double thread_before_ms = cpu_ms(CLOCK_THREAD_CPUTIME_ID);
        stage.draw(moment, camera, target);
        glFinish();
        sum_ms += cpu_ms(CLOCK_PROCESS_CPUTIME_ID) - before_ms;
        thread_ms += cpu_ms(CLOCK_THREAD_CPUTIME_ID) - thread_before_ms;
      }
      std::printf("%-8s %6.1f ms of processors a picture, %6.1f of them of this thread\n", name,
                  sum_ms / kTimedPictures, thread_ms / kTimedPictures);
      std::fflush(stdout);
    }
    sheet.write(fmt::format("{}/sheet-{}.png", words[0], weather));
  }
  return viewer::gl::gl_error_count() == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return draw_meadow({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "draw_meadow: %s\n", error.what());
    return 70;
  }
}
