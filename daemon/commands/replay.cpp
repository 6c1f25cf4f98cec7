// `yuragi replay`: runs the daemon with a recording as its sensor, or replays it in lock-step as fast as possible.
#include <cstdlib>
#include <memory>
#include <optional>

#include <fmt/core.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/commands/slow_notice.hpp"
#include "daemon/sensing/recorded_installation.hpp"
#include "daemon/service/daemon_log.hpp"
#include "daemon/service/service.hpp"
#include "daemon/settings/standard_output.hpp"
#include "daemon/tools/offline/lockstep_replay.hpp"
#include "daemon/tools/offline/replay_stream.hpp"
#include "drivers/windlog/windlog_playback.hpp"
#include "drivers/windlog/windlog_reader.hpp"

namespace yuragi::daemon::commands {
namespace {

struct ReplayOptions {
  RunOptions run;
  std::filesystem::path file;
  std::string rate = "1";
  drivers::windlog::PlaybackOptions playback;
  double seam_s = drivers::windlog::PlayerOptions{}.seam_s;
  bool at_time_of_day = false;
  std::string utc_offset;
  bool is_paused = false;
  bool as_recorded = false;
  bool is_to_stdout = false;
  std::filesystem::path states_folder;
};

/// The scenes have already moved in the wind for this long when a client first sees them.
constexpr double kLead_s = 15.0;
constexpr double kMinRate = 0.01;
constexpr double kMaxRate = 1000.0;

/// The summary of --rate max is of the recording alone, from its first tick on.
double lead_of(const ReplayOptions& options) {
  return options.is_to_stdout ? kLead_s : 0.0;
}

/// A recording that begins paused plays nothing before its first reading.
double live_lead_of(const ReplayOptions& options) {
  return options.is_paused ? 0.0 : kLead_s;
}

double parse_rate(const std::string& text) {
  char* end = nullptr;
  const double rate = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0' || !(rate >= kMinRate && rate <= kMaxRate)) {
    throw ExitError(kExitUsage, fmt::format("--rate: is \"{}\"; allowed: a number from {} to {}, or max", text,
                                            kMinRate, kMaxRate));
  }
  return rate;
}

/// The one sensor of a replay: the windlog driver on this file.
settings::SensorConfig replay_sensor(const ReplayOptions& options, double rate) {
  const drivers::sensor::DriverDescription& windlog = drivers::sensor::recording_driver();
  const ParameterValues::Map given{{"file", options.file.string()},    {"rate", rate},
                                   {"loop", options.playback.loop},    {"start", options.playback.start},
                                   {"seam", options.seam_s},           {"same_time_of_day", options.at_time_of_day},
                                   {"utc_offset", options.utc_offset}, {"paused", options.is_paused},
                                   {"sensor", options.playback.sensor}};
  auto values = ParameterValues::resolve(windlog.parameters, given);
  if (!values) throw ExitError(kExitUsage, values.error().name + ": " + values.error().message);
  return settings::default_sensor(options.file.stem().string(), windlog, *values);
}

/// The whole installation, from the recording. Logs the differences from the recorded one.
sensing::RecordedInstallation installation_of(const ReplayOptions& options, double rate) {
  if (options.run.config_file) {
    throw ExitError(kExitUsage, "--as-recorded uses the recording's own configuration: remove --config");
  }
  if (options.playback.loop || options.at_time_of_day || !options.playback.sensor.empty()) {
    throw ExitError(kExitUsage,
                    "--as-recorded replays all sensors once, by the recorded clock: remove --loop, "
                    "--same-time-of-day and --sensor");
  }
  sensing::RecordedInstallation installation =
      sensing::recorded_installation(
          options.file,
          {.playback = options.playback, .rate = rate, .seam_s = options.seam_s, .is_paused = options.is_paused})
          .value();
  for (const std::string& remark : installation.remarks) spdlog::warn("as recorded: {}", remark);
  if (options.run.address) {
    installation.config = settings::listening_at(std::move(installation.config), *options.run.address);
  }
  return installation;
}

tools::offline::LockstepResult replay_in_lockstep(const ReplayOptions& options, const settings::Config& config,
                                                  const std::function<void(double)>& progress,
                                                  const tools::offline::UseTick& use) {
  return tools::offline::replay_in_lockstep(
             config, options.file, {.playback = options.playback, .seam_s = options.seam_s, .lead_s = lead_of(options)},
             options.run.duration_s.value_or(0.0), progress, use, options.states_folder)
      .value();
}

tools::offline::LockstepResult replay_in_lockstep(const ReplayOptions& options,
                                                  const sensing::RecordedInstallation& installation,
                                                  const std::function<void(double)>& progress,
                                                  const tools::offline::UseTick& use) {
  return tools::offline::replay_in_lockstep(installation, lead_of(options), options.run.duration_s.value_or(0.0),
                                            progress, use)
      .value();
}

/// Waits for its reader; when there is none any more, SIGPIPE ends this program.
void write_to_stdout(const ReplayOptions& options) {
  if (isatty(STDOUT_FILENO) != 0) {
    throw ExitError(kExitUsage, "--to-stdout writes messages for a program: send them through a pipe or into a file");
  }
  const auto stream_to_stdout = [&options](const settings::Config& config, const auto& source) {
    tools::offline::ReplayStream stream(config, [](std::span<const std::uint8_t> bytes) {
      settings::write_at_once({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    });
    replay_in_lockstep(options, source, {}, [&stream](const tools::offline::ReplayTick& tick) { stream.write(tick); });
  };
  if (options.as_recorded) {
    const sensing::RecordedInstallation installation = installation_of(options, 1.0);
    return stream_to_stdout(installation.config, installation);
  }
  const settings::Config config = options.run.config();
  stream_to_stdout(config, config);
}

void replay_at_full_speed(const ReplayOptions& options) {
  if (options.playback.loop && !options.run.duration_s) {
    throw ExitError(kExitUsage,
                    "--rate max with --loop would never end; add --duration TIME (in time of the recording)");
  }
  if (options.at_time_of_day || options.is_paused) {
    throw ExitError(kExitUsage, "--rate max has no clock: remove --same-time-of-day and --paused");
  }
  if (options.is_to_stdout) return write_to_stdout(options);
  const bool is_watched = isatty(STDERR_FILENO) != 0;
  const auto progress = [is_watched](double log_time_s) {
    if (is_watched) fmt::print(stderr, "\rreplayed {:.0f} s", log_time_s);
  };
  std::optional<SlowNotice> notice;
  if (!is_watched) {
    notice.emplace(fmt::format("replaying {} tick by tick; the summary comes at its end", options.file.string()));
  }
  const tools::offline::LockstepResult result =
      options.as_recorded ? replay_in_lockstep(options, installation_of(options, 1.0), progress, {})
                          : replay_in_lockstep(options, options.run.config(), progress, {});
  notice.reset();
  if (is_watched) fmt::print(stderr, "\r\x1b[K");
  fmt::print(
      "readings   {} in {:.1f} s of log time\n"
      "recorded   mean {:.2f} m/s, max {:.2f} m/s\n"
      "replayed   mean {:.2f} m/s, max {:.2f} m/s: the wind that moved the scenes\n"
      "ticks      {}\n"
      "pose hash  {:016x}\n",
      result.readings, result.log_duration_s, result.reading_mean_m_s, result.reading_max_m_s, result.wind_mean_m_s,
      result.wind_max_m_s, result.ticks, result.pose_hash);
  if (result.held_back_ticks > 0) {
    fmt::print(
        "ceiling    held the wind back for {:.1f} % of the time (ceiling of [shaping]); without it the mean is {:.2f} "
        "m/s, the max {:.2f} m/s\n",
        100.0 * static_cast<double>(result.held_back_ticks) / static_cast<double>(result.live_ticks),
        result.free_wind_mean_m_s, result.free_wind_max_m_s);
  }
}

void replay(const ReplayOptions& options) {
  const service::DaemonLog log(options.run.verbose);
  if (const auto reader = drivers::windlog::Reader::open(options.file)) {
    for (const std::string& damage : reader->damage()) spdlog::warn("{}", damage);
  }
  if (options.is_to_stdout && options.rate != "max") {
    throw ExitError(kExitUsage, "--to-stdout waits for its reader, not for a clock: add --rate max");
  }
  if (!options.states_folder.empty() && (options.rate != "max" || options.as_recorded || options.playback.loop)) {
    throw ExitError(kExitUsage, "--states is for --rate max, without --as-recorded and --loop");
  }
  if (options.as_recorded && options.rate != "max") {
    const sensing::RecordedInstallation installation = installation_of(options, parse_rate(options.rate));
    service::Service(installation.config, {.record = {},
                                           .duration_s = options.run.duration_s,
                                           .end_with_recordings = true,
                                           .recorded_from = installation.begin,
                                           .lead_s = live_lead_of(options)})
        .run();
    return;
  }
  drivers::windlog::Playback::open(options.file, options.playback)
      .value();  // fails immediately, while a daemon would wait for the file
  if (options.rate == "max") return replay_at_full_speed(options);

  settings::Config config = options.run.config();
  config.sensors = {replay_sensor(options, parse_rate(options.rate))};
  config.wind.fallback.reset();
  service::Service(config, {.record = {},
                            .duration_s = options.run.duration_s,
                            .end_with_recordings = true,
                            .lead_s = live_lead_of(options)})
      .run();
}

void add_replay(CLI::App& app) {
  CLI::App* command = app.add_subcommand("replay", "run the daemon with a recording in place of the sensors");
  command->footer(
      "Ends with the recording, unless it loops. With --rate max no client is served: the recording runs through wind\n"
      "and scenes tick by tick, and a summary with a hash over all poses is printed; the same seed and recording give\n"
      "the same hash.\n"
      "  yuragi replay storm.windlog --rate 4 --start 90\n"
      "  yuragi replay storm.windlog --rate max\n"
      "  yuragi replay year.windlog --same-time-of-day --loop\n"
      "\n"
      "--as-recorded replays a day with the configuration in the recording: its scenes, shaping, opening hours (by "
      "the\n"
      "recorded clock), and each sensor by its name with its calibration, judging and part in the blend. The\n"
      "configuration at the start is used to the end; the log shows where the recording has another.\n"
      "A recording does not contain what was learnt of the site before (site_file), the fall-back recording, refused\n"
      "messages, and passwords.\n"
      "  yuragi replay wall.windlog --as-recorded --start 2026-05-01T06:00:00Z\n"
      "While it runs, in another terminal: yuragi player pause, step, seek, rate, status.");
  auto options = std::make_shared<ReplayOptions>();
  command->add_option("file", options->file, "the recording")->required()->type_name("FILE.windlog");
  command->add_option("--rate", options->rate, "how many times faster than it was recorded, or max (default 1)")
      ->type_name("X|max");
  command->add_flag("--loop", options->playback.loop, "start again at the end");
  command
      ->add_option("--start", options->playback.start,
                   "where to begin: seconds from its beginning, or a UTC time (ISO 8601)")
      ->type_name("T");
  command
      ->add_option("--seam", options->seam_s,
                   "duration of the cross-fade at the end of a loop and at a seek (default 5; 0: none)")
      ->type_name("TIME")
      ->transform(duration_in_seconds())
      ->check(CLI::Range(0.0, 600.0));
  command->add_flag("--same-time-of-day", options->at_time_of_day,
                    "begin where the recording's local time of day is that of now");
  command
      ->add_option(
          "--utc-offset", options->utc_offset,
          "for that: how far the clocks where it was recorded were ahead of UTC; without it: this machine's zone")
      ->type_name("HOURS");
  command->add_flag("--as-recorded", options->as_recorded,
                    "with the configuration and all sensors of the recording, by its clock");
  command->add_flag("--to-stdout", options->is_to_stdout,
                    "with --rate max: write every tick to standard output, as a daemon streams it, and wait for the "
                    "reader (yuragi-viewer --render reads it). The 15 s before --start move the scenes, and are not "
                    "written");
  command
      ->add_option("--states", options->states_folder,
                   "with --rate max: the poses are those of a replay from the recording's beginning, wherever this one "
                   "begins; the scenes' state at each minute is kept in this folder, so that the next replay need not "
                   "compute what came before")
      ->type_name("FOLDER");
  command->add_flag("--paused", options->is_paused, "start paused, at the first reading (see `yuragi player`)");
  command->add_option("--sensor", options->playback.sensor, "which sensor; default: the one with the first reading")
      ->type_name("NAME");
  options->run.add_to(*command);
  command->callback([options] { replay(*options); });
}

}  // namespace

extern const Command kReplayCommand;
const Command kReplayCommand{add_replay};

}  // namespace yuragi::daemon::commands
