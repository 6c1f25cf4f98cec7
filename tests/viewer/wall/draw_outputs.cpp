// The pictures of viewer/wall/README.md, one for each key of [[output]]: the real viewer on virtual monitors, and what
// they show, half as large. The desktop beside and between the monitors is white. Wants to be root, as Xorg does.
//
//   draw_outputs FOLDER [FILE]...      all, or those of these names

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/viewer/running_viewer.hpp"
#include "tests/viewer/stream_server.hpp"
#include "tests/viewer/test_models.hpp"
#include "tests/viewer/wall/virtual_monitors.hpp"
#include "viewer/picture/picture_file.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::viewer;
using Pixels = ScreenPixels;

constexpr int kWidth_px = 640;  // of DUMMY0 and DUMMY1; DUMMY2 has 800 x 600
constexpr int kHeight_px = 480;
constexpr int kGap_px = 20;  // between two monitors
constexpr double kProjectorGamma = 2.2;
constexpr std::uint32_t kWhite = 0xFFFFFF;

/// What is made of the monitors' pixels.
enum class As : std::uint8_t {
  kMonitors,         ///< as they are
  kBeamsSideBySide,  ///< on a canvas, on which two projectors overlap by a fifth of the picture's width
  kBeamsStacked,     ///< the same, of its height
};

struct Shot {
  const char* file;
  const char* configuration;
  std::vector<std::string> options = {"--test-card"};
  As as = As::kMonitors;
};

/// Two projectors that overlap by a fifth of the picture: parts of 0.6.
constexpr const char* kSideBySide = R"([[output]]
[[output.window]]
monitor = "DUMMY0"
crop = "0 0 0.6 1"
blend_right = 0.2
[[output.window]]
monitor = "DUMMY1"
crop = "0.4 0 0.6 1"
blend_left = 0.2
)";
constexpr const char* kStacked = R"([[output]]
[[output.window]]
monitor = "DUMMY0"
crop = "0 0 1 0.6"
blend_bottom = 0.2
[[output.window]]
monitor = "DUMMY1"
crop = "0 0.4 1 0.6"
blend_top = 0.2
)";
constexpr const char* kGammaTooHigh = R"([[output]]
[[output.window]]
monitor = "DUMMY0"
crop = "0 0 0.6 1"
blend_right = 0.2
gamma = 3.5
[[output.window]]
monitor = "DUMMY1"
crop = "0.4 0 0.6 1"
blend_left = 0.2
gamma = 3.5
)";

std::vector<Shot> all_shots() {
  const std::vector<std::string> scene = {"--camera", "0,6,14", "--look", "time=15:00"};
  std::vector<std::string> with_rate = scene;
  with_rate.insert(with_rate.end(), {"--overlay", "--look", "quality=low"});
  return {
      {.file = "card.jpg", .configuration = "[[output]]\n"},
      {.file = "monitor.jpg",
       .configuration = "[[output]]\nname = \"foyer\"\n[[output]]\nname = \"stage\"\n"
                        "[[output.window]]\nmonitor = \"DUMMY1\"\n",
       .options = {"--test-card", "--output", "stage"}},
      {.file = "size.jpg", .configuration = "[[output]]\nsize = \"120x90\"\n"},
      {.file = "refreshes.jpg", .configuration = "[[output]]\nrefreshes = 4\n", .options = with_rate},
      {.file = "crop.jpg", .configuration = R"([[output]]
[[output.window]]
monitor = "DUMMY0"
crop = "0 0 0.5 1"
[[output.window]]
monitor = "DUMMY1"
crop = "0.5 0 0.5 1"
)"},
      {.file = "crop-three.jpg", .configuration = R"([[output]]
size = "2080x600"
[[output.window]]
monitor = "DUMMY0"
crop = "0 0 0.3077 0.8"
[[output.window]]
monitor = "DUMMY1"
crop = "0.3077 0 0.3077 0.8"
[[output.window]]
monitor = "DUMMY2"
crop = "0.6154 0 0.3846 1"
)"},
      {.file = "rotation.jpg", .configuration = R"([[output]]
[[output.window]]
monitor = "DUMMY0"
rotation = 90
[[output.window]]
monitor = "DUMMY1"
rotation = 180
)"},
      {.file = "corners.jpg", .configuration = R"([[output]]
[[output.window]]
monitor = "DUMMY0"
corners = "0.15 0.05 0.9 0.2 1 0.8 0 1"
)"},
      {.file = "blend-card.jpg", .configuration = kSideBySide},
      {.file = "blend.jpg", .configuration = kSideBySide, .options = scene},
      {.file = "blend-canvas.jpg", .configuration = kSideBySide, .options = scene, .as = As::kBeamsSideBySide},
      {.file = "blend-stacked.jpg", .configuration = kStacked, .options = scene, .as = As::kBeamsStacked},
      {.file = "gamma.jpg", .configuration = kGammaTooHigh, .options = scene, .as = As::kBeamsSideBySide},
      {.file = "screen.jpg",
       .configuration = "[[output]]\nscreen_lower_left = \"-2 0 0\"\nscreen_lower_right = \"2 0 0\"\n"
                        "screen_upper_left = \"-2 3 0\"\neye = \"0 1.5 3\"\n",
       .options = scene},
      {.file = "eye.jpg",
       .configuration = "[[output]]\nscreen_lower_left = \"-2 0 0\"\nscreen_lower_right = \"2 0 0\"\n"
                        "screen_upper_left = \"-2 3 0\"\neye = \"-2 1.5 3\"\n",
       .options = scene},
  };
}

double light(std::uint32_t color, unsigned shift) {
  return std::pow((color >> shift & 0xFFU) / 255.0, kProjectorGamma);
}

/// The light of two monitors' pictures on a canvas: the second begins so far from the first.
Pixels added(const Pixels& seen, int right_px, int down_px) {
  Pixels canvas{.width_px = kWidth_px + right_px, .height_px = kHeight_px + down_px, .rows = {}};
  const auto beam = [&seen](int x, int y, int from_x) {
    const bool is_inside = x >= 0 && x < kWidth_px && y >= 0 && y < kHeight_px;
    return is_inside ? seen.at(from_x + x, y) : 0U;
  };
  for (int y = 0; y < canvas.height_px; ++y) {
    for (int x = 0; x < canvas.width_px; ++x) {
      const std::uint32_t first = beam(x, y, 0);
      const std::uint32_t second = beam(x - right_px, y - down_px, kWidth_px + kGap_px);
      std::uint32_t color = 0;
      for (const unsigned shift : {16U, 8U, 0U}) {
        const double sum = std::min(1.0, light(first, shift) + light(second, shift));
        color |= static_cast<std::uint32_t>(std::lround(255.0 * std::pow(sum, 1.0 / kProjectorGamma))) << shift;
      }
      canvas.rows.push_back(color);
    }
  }
  return canvas;
}

Pixels canvas_of(const Pixels& seen, As as) {
  // Each projector throws 0.6 of the picture, and the second begins at 0.4.
  if (as == As::kBeamsSideBySide) return added(seen, kWidth_px * 4 / 6, 0);
  if (as == As::kBeamsStacked) return added(seen, 0, kHeight_px * 4 / 6);
  return seen;
}

/// Each pixel the mean of four.
void write_half(const std::filesystem::path& file, const Pixels& pixels) {
  const int width_px = pixels.width_px / 2;
  const int height_px = pixels.height_px / 2;
  std::vector<std::uint8_t> rgb;
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      for (const unsigned shift : {16U, 8U, 0U}) {
        std::uint32_t sum = 2;
        for (const int i : {0, 1, 2, 3}) sum += pixels.at(2 * x + i % 2, 2 * y + i / 2) >> shift & 0xFFU;
        rgb.push_back(static_cast<std::uint8_t>(sum / 4));
      }
    }
  }
  picture::write_picture(file, width_px, height_px, rgb);
}

/// Is a picture to be seen, neither the desktop nor black?
bool has_picture(const Pixels& pixels) {
  const auto count = std::ranges::count_if(pixels.rows, [](auto color) { return color != kWhite && color != 0; });
  return 5 * count > static_cast<std::ptrdiff_t>(pixels.rows.size());
}

/// The mean difference of two pictures' colors, 0 to 255.
double difference(const Pixels& a, const Pixels& b) {
  if (a.rows.size() != b.rows.size() || a.rows.empty()) return 255.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    for (const unsigned shift : {16U, 8U, 0U}) {
      sum += std::abs(static_cast<int>(a.rows[i] >> shift & 0xFFU) - static_cast<int>(b.rows[i] >> shift & 0xFFU));
    }
  }
  return sum / 3.0 / static_cast<double>(a.rows.size());
}

/// What the monitors show once it has stood still for some seconds: the light has come up, and the rate is measured.
Pixels settled(const VirtualMonitors& monitors, RunningViewer& viewer) {
  constexpr int kStill = 12;
  constexpr double kMinChange = 0.3;
  Pixels before;
  int still = 0;
  for (int i = 0; i < 240; ++i) {
    Pixels now = monitors.pixels();
    still = has_picture(now) && difference(now, before) < kMinChange ? still + 1 : 0;
    if (still == kStill) return now;
    before = std::move(now);
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
  }
  throw std::runtime_error("no picture: " + viewer.said());
}

/// False where it fails.
bool arrange(const VirtualMonitors& monitors, bool has_third) {
  const std::string second = std::to_string(kWidth_px + kGap_px) + "x0";
  const std::string third = std::to_string(2 * (kWidth_px + kGap_px)) + "x0";
  return monitors.arrange({"--output", "DUMMY0", "--mode", "640x480", "--pos", "0x0", "--primary"}) &&
         monitors.arrange({"--output", "DUMMY1", "--mode", "640x480", "--pos", second}) &&
         (has_third ? monitors.arrange({"--output", "DUMMY2", "--mode", "800x600", "--pos", third})
                    : monitors.arrange({"--output", "DUMMY2", "--off"}));
}

void draw_outputs(const std::filesystem::path& folder, const std::vector<std::string>& wanted) {
  const std::filesystem::path own = folder / ".draw_outputs";
  std::filesystem::create_directories(own);
  const VirtualMonitors monitors(own);
  if (!monitors.is_there()) throw std::runtime_error("Xorg does not start: see " + (own / "xorg.log").string());
  if (!monitors.arrange({"--addmode", "DUMMY1", "640x480"}) || !monitors.arrange({"--addmode", "DUMMY2", "800x600"})) {
    throw std::runtime_error("xrandr fails");
  }

  const std::vector<wire::SceneModel> garden = test_garden();
  const std::vector<float> opacities(garden.size(), 1.0F);
  wire::FrameEncoder encoder;
  const StreamServer server(greeting_for(garden) + frame_of(garden, opacities, 0.1, 0.5, 1, encoder));

  for (const Shot& shot : all_shots()) {
    if (!wanted.empty() && std::ranges::find(wanted, shot.file) == wanted.end()) continue;
    const std::string configuration = shot.configuration;
    if (!arrange(monitors, configuration.find("DUMMY2") != std::string::npos)) {
      throw std::runtime_error("xrandr fails");
    }
    std::ofstream(own / "wall.toml") << configuration;
    std::vector<std::string> options = {"--config", own / "wall.toml", "--connect",
                                        "127.0.0.1:" + std::to_string(server.port())};
    options.insert(options.end(), shot.options.begin(), shot.options.end());
    RunningViewer viewer(options, monitors.environment(), own / "said.txt");
    write_half(folder / shot.file, canvas_of(settled(monitors, viewer), shot.as));
    if (viewer.end() != 0) throw std::runtime_error(viewer.said());
    std::printf("%s\n", (folder / shot.file).c_str());
  }
  std::filesystem::remove_all(own);
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) {
    std::fprintf(stderr, "usage: draw_outputs FOLDER [FILE]...\n");
    return EXIT_FAILURE;
  }
  try {
    draw_outputs(words[1], {words + 2, words + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "draw_outputs: %s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
