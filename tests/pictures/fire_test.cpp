// What the drawn fire does over time: it rises, sheds flames, and lies in a storm. YURAGI_FIRE_FOLDER=FOLDER also
// saves a strip of twelve pictures a wind.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/look/look.hpp"
#include "tests/pictures/canvas.hpp"
#include "tests/pictures/scenes_in_wind.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/gl/render_target.hpp"
#include "viewer/light/sky_keeper.hpp"
#include "viewer/looks/stage.hpp"

namespace yuragi::viewer {
namespace {

constexpr int kWidth_px = 160;
constexpr int kHeight_px = 128;
constexpr double kRate_hz = 25.0;
constexpr int kPictures = 50;
constexpr double kSettling_s = 6.0;
constexpr std::uint8_t kFlameRed = 120;  // and more, by night, is flame
constexpr int kRim_px = 90;              // the row where the bowl begins

std::size_t index_of(int x, int y) {
  return static_cast<std::size_t>(y) * kWidth_px + static_cast<std::size_t>(x);
}

/// A picture of the flame by night: which pixels are flame, column after column in rows from the top.
struct Silhouette {
  std::vector<bool> is_flame = std::vector<bool>(index_of(0, kHeight_px));
  int saturated = 0;  ///< of its pixels
  int count = 0;
  bool at(int x, int y) const { return is_flame[index_of(x, y)]; }
};

struct FireFilm {
  std::vector<Silhouette> pictures;
  double metres_per_px = 0.0;
};

Silhouette silhouette_of(const std::vector<std::uint8_t>& rgb) {
  Silhouette shape;
  for (std::size_t i = 0; i < index_of(0, kRim_px); ++i) {
    const std::uint8_t red = rgb[3 * i];
    if (red < kFlameRed || rgb[3 * i + 2] + 40 > red) continue;
    shape.is_flame[i] = true;
    ++shape.count;
    shape.saturated += red == 255 ? 1 : 0;
  }
  return shape;
}

FireFilm film_of(double speed_m_s, double sun_height_deg, const char* name) {
  const gl::HeadlessContext context({.is_software = true, .has_messages = true});
  looks::Stage stage;
  stage.set_light(light::light_of(
      look::edited({}, std::vector<std::string>{"sun=fixed", "sun_height=" + std::to_string(sun_height_deg)}).value(),
      0.0));
  stage.set_quality(look::Quality::kLow);
  gl::RenderTarget target(kWidth_px, kHeight_px, 1);
  ScenesInWind scenes("flame", speed_m_s);
  scenes.advance(kSettling_s);
  stage.set_scenes(scenes.models());
  meshes::OrbitCamera camera;
  constexpr double kDistance_m = 2.9;
  camera.frame({.target_m = {0.6, 1.0, 0.2}, .heading_deg = 340.0, .pitch_deg = 2.0, .distance_m = kDistance_m});
  FireFilm film;
  const meshes::View view = meshes::view_of(camera, kWidth_px, kHeight_px);
  film.metres_per_px = kDistance_m * static_cast<double>(view.eye_m.w);
  const char* const folder = std::getenv("YURAGI_FIRE_FOLDER");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  Canvas strip(6 * kWidth_px, 2 * kHeight_px);
  for (int picture = 0; picture < kPictures; ++picture) {
    scenes.advance(1.0 / kRate_hz);
    stage.draw(scenes.moment(), camera, target);
    const std::vector<std::uint8_t> rgb = target.read_rgb();
    film.pictures.push_back(silhouette_of(rgb));
    if (folder != nullptr && picture % 2 == 0 && picture < 24) {
      strip.put(picture / 2 % 6 * kWidth_px, picture / 12 * kHeight_px, kWidth_px, rgb);
    }
  }
  if (folder != nullptr) strip.save(std::filesystem::path(folder) / name);
  return film;
}

/// Each wind is filmed once, by night.
const FireFilm& film_in(double speed_m_s) {
  static std::map<double, FireFilm> films;
  const auto known = films.find(speed_m_s);
  if (known != films.end()) return known->second;
  const std::string name = std::to_string(std::lround(speed_m_s)) + ".png";
  return films.emplace(speed_m_s, film_of(speed_m_s, -15.0, name.c_str())).first->second;
}

/// Pixels of pieces that do not hang together with the lowest one.
int detached_px(const Silhouette& shape) {
  std::vector<int> piece_of(shape.is_flame.size(), -1);
  std::vector<int> sizes;
  std::vector<int> stack;
  for (int begin = kWidth_px * kHeight_px - 1; begin >= 0; --begin) {
    if (!shape.is_flame[static_cast<std::size_t>(begin)] || piece_of[static_cast<std::size_t>(begin)] >= 0) continue;
    const int piece = static_cast<int>(sizes.size());
    sizes.push_back(0);
    stack.push_back(begin);
    piece_of[static_cast<std::size_t>(begin)] = piece;
    while (!stack.empty()) {
      const int at = stack.back();
      stack.pop_back();
      ++sizes.back();
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int x = at % kWidth_px + dx;
          const int y = at / kWidth_px + dy;
          if (x < 0 || x >= kWidth_px || y < 0 || y >= kHeight_px) continue;
          const auto next = index_of(x, y);
          if (!shape.is_flame[next] || piece_of[next] >= 0) continue;
          piece_of[next] = piece;
          stack.push_back(static_cast<int>(next));
        }
      }
    }
  }
  int sum = 0;
  for (std::size_t piece = 1; piece < sizes.size(); ++piece) {
    constexpr int kFewest_px = 10;  // a spark is smaller
    if (sizes[piece] >= kFewest_px) sum += sizes[piece];
  }
  return sum;
}

/// How far the search for the flame's motion goes, between pictures that are kApart from each other.
constexpr int kApart = 2;
constexpr int kMaxUp_px = 12;    // 3.0 m/s
constexpr int kMaxAside_px = 8;  // 2.0 m/s

/// Of what is higher above the bowl than that: intersection over union with a later picture, if this one is moved
/// upward and to the right first.
double overlap(const Silhouette& now, const Silhouette& later, int up_px, int right_px) {
  int both = 0;
  int any = 0;
  for (int y = 0; y < kRim_px - kMaxUp_px; ++y) {
    for (int x = kMaxAside_px; x < kWidth_px - kMaxAside_px; ++x) {
      const bool was = now.at(x - right_px, y + up_px);
      const bool is = later.at(x, y);
      both += was && is ? 1 : 0;
      any += was || is ? 1 : 0;
    }
  }
  return any == 0 ? 1.0 : static_cast<double>(both) / any;
}

/// Its mean over a film.
double overlap(const FireFilm& film, std::size_t apart, int up_px, int right_px) {
  double sum = 0.0;
  for (std::size_t i = apart; i < film.pictures.size(); ++i) {
    sum += overlap(film.pictures[i - apart], film.pictures[i], up_px, right_px);
  }
  return sum / static_cast<double>(film.pictures.size() - apart);
}

struct Figures {
  double detached_share = 0.0;                               ///< of the pictures that have a piece that flies
  double overlap = 0.0;                                      ///< of a picture and the next, mean
  double overlap_apart = 0.0;                                ///< of pictures kApart
  double best_overlap = 0.0, up_m_s = 0.0, aside_m_s = 0.0;  ///< of those, if moved so
  double length_over_height = 0.0;
  double saturated_share = 0.0;
};

Figures figures_in(double speed_m_s) {
  const FireFilm& film = film_in(speed_m_s);
  Figures figures;
  const auto count = static_cast<double>(film.pictures.size());
  double saturated = 0.0;
  double pixels = 0.0;
  for (const Silhouette& shape : film.pictures) {
    figures.detached_share += detached_px(shape) > 0 ? 1.0 / count : 0.0;
    saturated += shape.saturated;
    pixels += shape.count;
    int left = kWidth_px, right = -1, top = kHeight_px, low = -1;
    for (int y = 0; y < kHeight_px; ++y) {
      for (int x = 0; x < kWidth_px; ++x) {
        if (!shape.at(x, y)) continue;
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        low = std::max(low, y);
      }
    }
    if (right >= 0) figures.length_over_height += static_cast<double>(right - left + 1) / (low - top + 1) / count;
  }
  figures.saturated_share = saturated / std::max(pixels, 1.0);
  figures.overlap = overlap(film, 1, 0, 0);
  figures.overlap_apart = overlap(film, kApart, 0, 0);
  const double m_s_per_px = film.metres_per_px * kRate_hz / kApart;
  for (int up_px = 0; up_px <= kMaxUp_px; ++up_px) {
    for (int right_px = -kMaxAside_px; right_px <= kMaxAside_px; ++right_px) {
      const double moved = overlap(film, kApart, up_px, right_px);
      if (moved <= figures.best_overlap) continue;
      figures.best_overlap = moved;
      figures.up_m_s = up_px * m_s_per_px;
      figures.aside_m_s = right_px * m_s_per_px;
    }
  }
  std::printf(
      "%4.1f m/s: detached %.2f, overlap %.3f, of pictures %.2f s apart %.3f (best %.3f at %.2f m/s up, "
      "%.2f aside), length/height %.2f, saturated %.2f, pixels %.0f (%.3f m)\n",
      speed_m_s, figures.detached_share, figures.overlap, kApart / kRate_hz, figures.overlap_apart,
      figures.best_overlap, figures.up_m_s, figures.aside_m_s, figures.length_over_height, figures.saturated_share,
      pixels / count, film.metres_per_px);
  return figures;
}

// One test, since each film takes seconds.
TEST(FirePicture, StandsInCalmShedsFlamesInABreezeAndLiesInAStorm) {
  const Figures calm = figures_in(0.5);
  const Figures breeze = figures_in(4.0);
  const Figures storm = figures_in(16.0);

  // In four stretches of the same wind, and in 2.5 to 5 m/s, 0.36 to 0.54.
  EXPECT_GE(breeze.detached_share, 0.35);
  EXPECT_LE(calm.length_over_height, 0.7);
  EXPECT_GE(storm.length_over_height, 2.5);
  for (const Figures& figures : {calm, breeze}) {
    // It rises with its gas, and does not only flicker.
    EXPECT_GE(figures.overlap, 0.55);
    EXPECT_LE(figures.overlap, 0.86);
    EXPECT_LE(figures.overlap_apart, 0.74);
    EXPECT_LE(figures.up_m_s, 2.9);
  }
  EXPECT_GE(calm.up_m_s, 0.9);
  EXPECT_GE(std::hypot(breeze.up_m_s, breeze.aside_m_s), 0.75) << "along the flame, which leans";
  EXPECT_GE(breeze.aside_m_s, 0.2) << "it goes to the lee, which is to the right";
  for (const Figures& figures : {calm, breeze, storm}) EXPECT_LE(figures.saturated_share, 0.40);
}

}  // namespace
}  // namespace yuragi::viewer
