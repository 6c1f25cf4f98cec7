// yuragi-frame-bench: what a picture of the viewer costs, for meadows of 10,000, 100,000 and 1,000,000 blades, a grove
// of 200 trees, each kind of cloth, each species of tree, fur, water, a flame and the garden, drawn without a display
// on what graphics this machine has. It prints a table: the time to the last pixel, the processor time of this thread
// (with its part of the former) and of all threads, which draw where there is no graphics hardware, what is uploaded,
// and the same of each pass, whose time is that of the graphics hardware, or of all threads where there is none, with
// the triangles that it is given: their corners are this thread's work where the processor draws. Poses are made
// before, and so is the moment between two frames of the stream: what that costs this thread is the first of the
// passes, but in no sum. All are medians. Of other programs at work, the processor times feel least.
//
//   yuragi-frame-bench [--size 1280x720] [--pictures 30] [--samples 1] [--quality low] [--step 0] [--software]
//                      [--only 100,000] [--hour 12]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <map>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "tests/pictures/scenes_in_wind.hpp"
#include "tests/support/places.hpp"
#include "viewer/gl/edge_smoother.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/gl/pass_clock.hpp"
#include "viewer/looks/stage.hpp"
#include "viewer/pace/pace_ladder.hpp"
#include "viewer/pace/quality.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::viewer;

struct BenchOptions {
  std::string size = "1280x720";
  int width_px = 1280;
  int height_px = 720;
  int pictures = 30;
  int samples = 1;
  bool is_software = false;
  std::string quality = "auto";
  std::size_t step = 0;
  std::string only;
  double hour = 12.0;
};

struct Row {
  std::string name;
  daemon::settings::Config config;
};

/// As dense as the meadow is by default.
daemon::settings::Config meadow(int across, int deep) {
  return daemon::settings::parse_config(
      fmt::format("[[scene]]\nkind = \"grass\"\nblades_across = {}\nblades_deep = {}\nwidth = {}\ndepth = {}\n", across,
                  deep, 0.07 * across, 0.07 * deep),
      "a meadow");
}

/// A scene and the grass around it.
daemon::settings::Config alone(const char* kind, const char* keys = "") {
  return daemon::settings::parse_config(
      fmt::format("[[scene]]\nkind = \"{}\"\n{}[[scene]]\nkind = \"ground\"\n", kind, keys), kind);
}

std::vector<Row> rows() {
  return {{"10,000", meadow(100, 100)},
          {"100,000", meadow(400, 250)},
          {"1,000,000", meadow(1250, 800)},
          {"grove",
           daemon::settings::parse_config(
               "[[scene]]\nkind = \"tree\"\nspecies = \"zelkova\"\ngrove = 200\ngrove_radius = 150.0\n", "a grove")},
          {"flag", alone("flag")},
          {"banner", alone("banner")},
          {"curtain", alone("curtain")},
          {"cherry", alone("tree", "species = \"cherry\"\n")},
          {"zelkova", alone("tree", "species = \"zelkova\"\n")},
          {"poplar", alone("tree", "species = \"poplar\"\n")},
          {"fur", alone("fur")},
          {"ripple", alone("ripple")},
          {"flame", alone("flame")},
          {"garden", daemon::settings::load_config(test::source_path("config/garden.toml"))}};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double processor_time_ms(clockid_t whose) {
  std::timespec time{};
  ::clock_gettime(whose, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

void measure(const Row& row, const BenchOptions& options, looks::Stage& stage, gl::RenderTarget& target) {
  constexpr int kWarmUp = 3;
  constexpr std::size_t kMoments = 4;
  ScenesInWind scenes(row.config);
  scenes.advance(1.0);
  std::vector<stream::PoseMoment> moments;
  for (std::size_t i = 0; i < kMoments; ++i) {
    scenes.advance(1.0 / 60.0);
    moments.push_back(scenes.moment());
  }
  stage.set_scenes(scenes.models());
  meshes::OrbitCamera camera;
  camera.frame(scenes.home(stage, static_cast<double>(options.width_px) / options.height_px, options.hour));

  std::vector<double> times_ms, thread_ms, process_ms, uploads_mb;
  const auto draw = [&](int picture) {
    stage.draw(moments[static_cast<std::size_t>(picture + kWarmUp) % kMoments], camera, target);
  };
  for (int picture = -kWarmUp; picture < options.pictures; ++picture) {
    glFinish();
    const auto begin = std::chrono::steady_clock::now();
    const double thread_begin_ms = processor_time_ms(CLOCK_THREAD_CPUTIME_ID);
    const double process_begin_ms = processor_time_ms(CLOCK_PROCESS_CPUTIME_ID);
    const std::size_t uploaded = gl::uploaded_bytes();
    draw(picture);
    glFinish();
    if (picture < 0) continue;
    times_ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    thread_ms.push_back(processor_time_ms(CLOCK_THREAD_CPUTIME_ID) - thread_begin_ms);
    process_ms.push_back(processor_time_ms(CLOCK_PROCESS_CPUTIME_ID) - process_begin_ms);
    uploads_mb.push_back(1e-6 * static_cast<double>(gl::uploaded_bytes() - uploaded));
  }

  // Pictures of their own for the passes: their clock waits.
  std::optional<gl::EdgeSmoother> smoother;  // as GlRenderer has it
  if (options.quality == "low" && target.samples() == 1) smoother.emplace();
  gl::PassClock clock(gl::is_software_renderer() ? gl::PassClock::By::kProcessor : gl::PassClock::By::kGpu);
  stage.mark_passes_for(&clock);
  struct PassCosts {
    std::vector<double> times_ms, thread_ms, uploads_mb, triangles;
  };
  std::map<std::string, PassCosts> passes;
  std::vector<std::string> pass_names;
  for (int picture = 0; picture < options.pictures; ++picture) {
    draw(picture);
    if (smoother) {
      smoother->draw(target);
      clock.mark("smoothing");
    }
    for (const gl::PassClock::Pass& pass : clock.end()) {
      PassCosts& costs = passes[pass.name];
      if (costs.times_ms.empty()) pass_names.push_back(pass.name);
      costs.times_ms.push_back(pass.time_ms);
      costs.thread_ms.push_back(pass.thread_ms);
      costs.uploads_mb.push_back(1e-6 * static_cast<double>(pass.uploaded_bytes));
      costs.triangles.push_back(static_cast<double>(pass.triangles));
    }
  }
  stage.mark_passes_for(nullptr);

  // What comes before: the moment between two frames of the stream.
  std::vector<double> blends_ms;
  stream::PoseMoment between = moments[0];
  for (int picture = 0; picture < options.pictures; ++picture) {
    const double begin_ms = processor_time_ms(CLOCK_THREAD_CPUTIME_ID);
    blend(moments[0], moments[1], 0.5, between);
    blends_ms.push_back(processor_time_ms(CLOCK_THREAD_CPUTIME_ID) - begin_ms);
  }

  const double time_ms = median(times_ms);
  fmt::print("{:>10} {:>10} {:>9.2f} {:>11.1f} {:>10.2f} {:>6.0f} % {:>11.2f} {:>10.2f}\n", row.name, options.size,
             time_ms, 1e3 / time_ms, median(thread_ms), 100.0 * median(thread_ms) / time_ms, median(process_ms),
             median(uploads_mb));
  fmt::print("{:>31} {:>9} {:>10} {:>10} {:>10}\n", "pass", "ms", "thread ms", "upload MB", "triangles");
  fmt::print("{:>31} {:>9.3f} {:>10.3f}\n", "between two frames", median(blends_ms), median(blends_ms));
  for (const std::string& name : pass_names) {
    const PassCosts& costs = passes[name];
    fmt::print("{:>31} {:>9.3f} {:>10.3f} {:>10.3f} {:>10.0f}\n", name, median(costs.times_ms), median(costs.thread_ms),
               median(costs.uploads_mb), median(costs.triangles));
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    BenchOptions options;
    CLI::App app("What a picture of the viewer costs");
    app.add_option("--size", options.size, "WIDTHxHEIGHT, pixels")->capture_default_str();
    app.add_option("--pictures", options.pictures, "of each row")->check(CLI::Range(1, 100000))->capture_default_str();
    app.add_option("--samples", options.samples, "a pixel")->check(CLI::Range(1, 16))->capture_default_str();
    app.add_option("--quality", options.quality, "of the look")
        ->check(CLI::IsMember(std::vector<std::string>{"auto", "low", "medium", "high"}))
        ->capture_default_str();
    app.add_option("--step", options.step, "how much is drawn: 0 all, or one of Ladder::kParts (viewer/pace)")
        ->check(CLI::Range(std::size_t{0}, pace::Ladder::kParts.size()))
        ->capture_default_str();
    app.add_flag("--software", options.is_software, "by the processor, even where there is graphics hardware");
    const std::vector<Row> all = rows();
    std::vector<std::string> names;
    names.reserve(all.size());
    for (const Row& row : all) names.push_back(row.name);
    app.add_option("--only", options.only, "one row")->check(CLI::IsMember(names));
    app.add_option("--hour", options.hour, "whose camera the garden is seen by")
        ->check(CLI::Range(0.0, 24.0))
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    if (std::sscanf(options.size.c_str(), "%dx%d", &options.width_px, &options.height_px) != 2) return 64;

    const gl::HeadlessContext context({.is_software = options.is_software});
    const look::Look look = look::edited({}, std::vector<std::string>{"quality=" + options.quality}).value();
    const look::Quality quality = pace::quality_for(look.quality, gl::is_software_renderer());
    looks::Stage stage;
    stage.set_quality(quality);
    options.quality = name_of(quality);
    gl::RenderTarget target(options.width_px, options.height_px, options.samples);
    const pace::DrawnPart part = options.step == 0 ? pace::DrawnPart{} : pace::Ladder::kParts[options.step - 1];
    stage.set_blade_share(part.blades);
    stage.set_coarseness(part.coarseness);
    target.set_drawn_side(part.side);
    fmt::print("{}, {} samples a pixel, {}, medians of {} pictures\n",
               reinterpret_cast<const char*>(glGetString(GL_RENDERER)), target.samples(),
               pace::quality_text(quality, part), options.pictures);
    fmt::print("{:>10} {:>10} {:>9} {:>11} {:>10} {:>8} {:>11} {:>10}\n", "blades", "size", "frame ms", "pictures/s",
               "thread ms", "share", "process ms", "upload MB");
    for (const Row& row : all) {
      if (options.only.empty() || options.only == row.name) measure(row, options, stage, target);
    }
    return glGetError() == GL_NO_ERROR ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "yuragi-frame-bench: %s\n", error.what());
    return 70;
  }
}
