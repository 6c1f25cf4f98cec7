// `yuragi wind`: the estimator of the daemon over a recording, as a table.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/config.hpp"
#include "daemon/exit.hpp"
#include "daemon/offline_wind.hpp"
#include "daemon/output_file.hpp"
#include "daemon/sensor_hub.hpp"
#include "daemon/shaping_config.hpp"

namespace yuragi {

extern const Command kWindCommand;

namespace {

constexpr const char* kWindFooter =
    "Hears the recording as the daemon hears its sensor, reading by reading, and writes the wind that it makes of "
    "them:\n"
    "time_s (since the start), u_m_s and v_m_s (east and north, toward which it blows), speed_m_s,\n"
    "direction_deg (where it comes from), trust (0: all default wind, 1: all sensor), state (default, handover, "
    "live).\n"
    "\n"
    "Readings that the daemon would not believe (spikes, a value that is frozen) are left out here, too; a --config\n"
    "with [sensor.judge] enabled = false takes them all.\n"
    "\n"
    "--sensor-interval plays a slower sensor: vector means over so many seconds, heard at their end. --gap leaves out\n"
    "what was said from one second on and before another; it can be given again. The same recording, options and seed\n"
    "give the same table. The wind is the real one; --shaped writes the one that moves the scenes (opening hours are\n"
    "left out, and the site gain begins at 1).\n"
    "\n"
    "  yuragi wind mast.windlog --rate 60 --sensor-interval 14 --gap 600,700 -o blended.csv";

struct WindOptions {
  std::filesystem::path file;
  std::string output;
  OfflineWindOptions offline;
  std::vector<std::string> gaps;
  PlaybackOptions playback;
  std::optional<std::filesystem::path> config_file;
  std::optional<std::uint64_t> seed;
  bool shaped = false;
  bool force = false;
};

/// "FROM,TO" in seconds.
OfflineGap parse_gap(const std::string& text) {
  OfflineGap gap;
  int used = 0;
  const int found = std::sscanf(text.c_str(), "%lf,%lf%n", &gap.from_s, &gap.to_s, &used);
  if (found != 2 || static_cast<std::size_t>(used) != text.size() || !(gap.from_s >= 0.0) || !(gap.to_s > gap.from_s)) {
    throw ExitError(kExitUsage, "--gap: is \"" + text + "\"; allowed: FROM,TO in seconds, the second larger");
  }
  return gap;
}

std::string_view name_of(WindSource source) {
  switch (source) {
    case WindSource::kDefault:
      return "default";
    case WindSource::kHandover:
      return "handover";
    case WindSource::kLive:
      return "live";
  }
  return "?";
}

/// Text that goes out in blocks. What the disk does not take is told at the end.
class Table {
 public:
  explicit Table(std::FILE* out) : out_(out) { text_ = "time_s,u_m_s,v_m_s,speed_m_s,direction_deg,trust,state\n"; }

  void add(double time_s, const WindState& state) {
    // A hair west of north is rounded to north, not to 360.
    const double direction_deg = std::fmod(std::round(direction_from_deg(state.wind) * 1e4) / 1e4, 360.0);
    fmt::format_to(std::back_inserter(text_), "{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{}\n", time_s,
                   state.wind.u_m_s, state.wind.v_m_s, speed_of(state.wind), direction_deg, state.live_weight,
                   name_of(state.source));
    if (text_.size() > kBlock) flush();
  }
  void flush() {
    is_complete_ = std::fwrite(text_.data(), 1, text_.size(), out_) == text_.size() && is_complete_;
    text_.clear();
  }
  void end(const std::string& name) {
    flush();
    if (!is_complete_ || std::fflush(out_) != 0) {
      throw ExitError(kExitCannotCreate, name + ": could not be written to the end; is there room?");
    }
  }

 private:
  static constexpr std::size_t kBlock = 1 << 16;
  std::FILE* out_;
  std::string text_;
  bool is_complete_ = true;
};

void write_wind(const WindOptions& options, const Config& config, std::FILE* out) {
  WindlogPlayback playback(options.file, options.playback);
  const std::shared_ptr<const GustNoise> gusts = make_gust_noise(config);
  const std::unique_ptr<WindEstimator> estimator = make_estimator(config, gusts);
  WindShaping shaping(shaping_settings(config), gusts);
  Table table(out);
  const bool is_watched = isatty(STDERR_FILENO) != 0;
  const auto told_each = static_cast<std::uint64_t>(600.0 * options.offline.rate_hz);
  std::uint64_t states = 0;
  const OfflineWindResult result =
      run_offline(playback, *estimator, options.offline, [&](double time_s, const WindState& state) {
        DrivingWind wind{state, estimator->ground(), estimator->stroke()};
        if (options.shaped) shaping.shape(wind, true);
        table.add(time_s, wind.state);
        if (is_watched && ++states % told_each == 0) fmt::print(stderr, "\r{:.0f} s of the recording", time_s);
      });
  table.end(options.output);
  if (is_watched) fmt::print(stderr, "\r\x1b[K");
  fmt::print(stderr, "{}: {} states of {:.1f} s, from {} readings{}\n",
             options.output == "-" ? "standard output" : options.output, result.states, result.duration_s,
             result.readings, result.withheld > 0 ? fmt::format("; {} were not believed", result.withheld) : "");
}

void run_wind(WindOptions options) {
  if (!std::filesystem::exists(options.file)) {
    throw ExitError(kExitNoInput, options.file.string() + ": there is no such recording");
  }
  for (const std::string& gap : options.gaps) options.offline.gaps.push_back(parse_gap(gap));
  Config config = options.config_file ? load_config(*options.config_file) : default_config();
  config.sensors.resize(1);
  if (options.seed) config.seed = *options.seed;
  options.offline.judge = judge_settings_of(config.sensors[0]);

  if (options.output == "-") return write_wind(options, config, stdout);
  OutputFile output(options.output, options.force);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(output.working_path().c_str(), "we"),
                                                             &std::fclose);
  if (!file) {
    throw ExitError(kExitCannotCreate, options.output + ": cannot be created; may this user write to its folder?");
  }
  write_wind(options, config, file.get());
  output.commit();
}

void add_wind(CLI::App& app) {
  CLI::App* command = app.add_subcommand("wind", "Run the wind of the daemon over a recording, into a CSV file");
  command->footer(kWindFooter);
  auto options = std::make_shared<WindOptions>();
  command->add_option("file", options->file, "the recording")->required()->type_name("FILE.windlog");
  command->add_option("-o,--output", options->output, "FILE.csv, or - for standard output")->required();
  command->add_option("--rate", options->offline.rate_hz, "states a second")
      ->check(CLI::Range(0.01, 1000.0))
      ->type_name("HZ")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of the noise; without it that of the configuration");
  command->add_option("--sensor-interval", options->offline.sensor_interval_s, "as if the sensor spoke so rarely, s")
      ->check(CLI::Range(0.01, 3600.0))
      ->type_name("T");
  command->add_option("--gap", options->gaps, "leave out what was said from one second on to another")
      ->allow_extra_args(false)
      ->type_name("FROM,TO");
  command->add_option("--sensor", options->playback.sensor, "whose readings; without it: of the first that spoke")
      ->type_name("NAME");
  command->add_option("--start", options->playback.start, "where to begin: seconds, or a UTC time (ISO 8601)")
      ->type_name("T");
  command->add_option("--config", options->config_file, "the [wind] and [shaping] of this configuration")
      ->type_name("FILE.toml");
  command->add_flag("--shaped", options->shaped,
                    "what [shaping] makes of it for the scenes: floor, site gain, ceiling");
  command->add_flag("--force", options->force, "overwrite the output");
  command->callback([options] { run_wind(*options); });
}

}  // namespace

const Command kWindCommand{add_wind};

}  // namespace yuragi
