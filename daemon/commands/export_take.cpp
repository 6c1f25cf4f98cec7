// `yuragi export -o TAKE.glb`: the motion of a scene for 3D programs.
#include "daemon/commands/export_take.hpp"

#include <cmath>
#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/commands/exit.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/tools/offline/lockstep_replay.hpp"
#include "daemon/tools/take/take_recorder.hpp"
#include "engine/base/count_text.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::commands {
namespace {

/// The number of joints that 3D programs open without effort.
constexpr std::size_t kUsualJoints = 12'000;

std::string scene_of(const TakeOptions& options, const wire::Scenes& scenes) {
  std::string names;
  std::string only;
  for (const wire::SceneModel& scene : scenes.scenes) {
    if (scene.name == options.scene) return scene.name;
    names += names.empty() ? scene.name : ", " + scene.name;
    if (scene.kind != "ground") only += only.empty() ? scene.name : "\n";
  }
  if (!options.scene.empty())
    throw ExitError(kExitUsage, fmt::format("--scene: there is no '{}'; there are: {}", options.scene, names));
  if (only.empty() || only.find('\n') != std::string::npos)
    throw ExitError(kExitUsage, "--scene is missing; there are: " + names);
  return only;
}

/// Takes the ticks that come at the pictures' moments.
class TakeMaker {
 public:
  explicit TakeMaker(const TakeOptions& options) : options_(options) {}

  void take(double log_time_s, const animation::Animation& animation) {
    if (!recorder_) begin(animation);
    // A tick is taken that is nearer to the moment than the next one would be.
    if (log_time_s + 1e-9 < static_cast<double>(recorder_->frames()) / options_.fps) return;
    tools::take::checked_size(recorder_->joints(), static_cast<double>(recorder_->frames() + 1)).value();
    recorder_->add(*animation.poses()[scene_]);
  }
  const tools::take::Recorder& recorder() const {
    if (!recorder_) throw ExitError(kExitDataError, "the recording has no reading from that time on");
    return *recorder_;
  }
  const std::string& scene() const { return name_; }
  std::size_t every() const { return every_; }

 private:
  void begin(const animation::Animation& animation) {
    const wire::Scenes scenes = animation.describe();
    name_ = scene_of(options_, scenes);
    while (scenes.scenes[scene_].name != name_) ++scene_;
    const pose::Skeleton& skeleton = *animation.skeletons()[scene_];
    const auto least = tools::take::every_within(skeleton, tools::take::kMaxJoints);
    if (!least) {
      throw ExitError(kExitUsage,
                      fmt::format("{} has more joints than the {} that a glTF file can have: make it coarser", name_,
                                  tools::take::kMaxJoints));
    }
    const auto usual = tools::take::every_within(skeleton, kUsualJoints);
    every_ = options_.every ? *options_.every : usual.value_or(*least);
    if (every_ < *least)
      throw ExitError(kExitUsage, fmt::format("--every: must be at least {} here: a glTF file can have {} joints",
                                              *least, tools::take::kMaxJoints));
    recorder_ = std::make_unique<tools::take::Recorder>(skeleton, name_, every_, options_.fps);
    if (options_.duration_s) {
      tools::take::checked_size(recorder_->joints(), std::floor(*options_.duration_s * options_.fps)).value();
    }
  }

  const TakeOptions& options_;
  std::unique_ptr<tools::take::Recorder> recorder_;
  std::string name_;
  std::size_t scene_ = 0;
  std::size_t every_ = 1;
};

}  // namespace

void TakeOptions::add_to(CLI::App& command) {
  constexpr const char* kGroup = "Options of a take (.glb)";
  command.add_option("--config,-c", config_file, "the configuration with the scene; default: one meadow")
      ->type_name("FILE")
      ->group(kGroup);
  command.add_option("--scene", scene, "the scene; not needed if there is only one")->type_name("NAME")->group(kGroup);
  command.add_option("--fps", fps, "pictures a second (default 30)")->check(CLI::Range(1.0, 240.0))->group(kGroup);
  command.add_option("--duration", duration_s, "how long: 20 (seconds), 5min; default: to the end")
      ->type_name("TIME")
      ->transform(duration_in_seconds())
      ->check(CLI::PositiveNumber)
      ->group(kGroup);
  command
      .add_option("--every", every,
                  "only each so-manyth blade, hair, twig, leaf, row and column; default: so that there are at most "
                  "12,000 joints")
      ->type_name("K")
      ->check(CLI::PositiveNumber)
      ->group(kGroup);
}

void export_take(const TakeOptions& options, const std::filesystem::path& recording, const std::string& start,
                 const std::filesystem::path& output, bool force) {
  const settings::Config config = configuration_of(options.config_file);
  platform::OutputFile file(output, force);
  TakeMaker maker(options);
  const bool is_watched = isatty(STDERR_FILENO) != 0;
  const auto progress = [&](double log_time_s) {
    if (!is_watched) return;
    options.duration_s ? fmt::print(stderr, "\r{:.0f} of {:.0f} s", log_time_s, *options.duration_s)
                       : fmt::print(stderr, "\r{:.0f} s", log_time_s);
  };
  tools::offline::replay_in_lockstep(
      config, recording, {.playback = {.start = start}}, options.duration_s.value_or(0.0), progress,
      [&maker](const tools::offline::ReplayTick& tick) { maker.take(tick.log_time_s, tick.animation); })
      .value();
  if (is_watched) fmt::print(stderr, "\r\x1b[K");
  const tools::take::Recorder& take = maker.recorder();
  std::ofstream out(file.working_path(), std::ios::binary);
  if (const auto written = take.write_glb(out); !written)
    throw ExitError(kExitCannotCreate, output.string() + ": " + written.error().message);
  out.close();
  file.commit().value();
  fmt::print(stderr, "{}: {} of {}, {:.1f} s, {}{}\n", output.string(), count_text(take.frames(), "picture"),
             maker.scene(), static_cast<double>(take.frames()) / options.fps, count_text(take.joints(), "joint"),
             maker.every() > 1 ? fmt::format(", every {}", maker.every()) : "");
}

}  // namespace yuragi::daemon::commands
