// `yuragi export`: converts a recording to CSV or to a take for 3D programs, or copies it.
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/export_take.hpp"
#include "daemon/commands/lock_recording.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/tools/csv/csv_export.hpp"
#include "daemon/tools/csv/csv_quantities.hpp"
#include "daemon/tools/csv/csv_resample.hpp"
#include "drivers/windlog/format.hpp"
#include "drivers/windlog/iso_time.hpp"
#include "drivers/windlog/log_moment.hpp"
#include "drivers/windlog/recording_parts.hpp"
#include "engine/base/count_text.hpp"
#include "engine/base/duration.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::commands {

extern const Command kExportCommand;

namespace {

constexpr const char* kExportFooter =
    "The CSV has the columns utc, time_s (seconds since the first reading), sensor, speed_m_s, direction_deg (where\n"
    "the wind comes from), gust_m_s and quality; `yuragi import` turns it into the same readings again.\n"
    "With --resample each row is the mean of a block of so many seconds: utc and time_s of its beginning, at\n"
    "multiples of its length in UTC; the mean speed; the direction of the mean vector; the largest gust or speed;\n"
    "and the count of readings; with 0 readings the other values are empty (means as in WMO-No. 8). At most 10\n"
    "million rows.\n"
    "With --quantities it writes the other quantities of stations, at most one row per sensor and second, with the\n"
    "columns time_utc, sensor, vertical_speed_m_s (upward), air_temperature_c, pressure_hpa,\n"
    "relative_humidity_percent, rain_total_mm (the station's counter) and rain_rate_mm_h; empty if not reported.\n"
    "A .windlog as output is a consistent copy, even of a recording that is being written; of a series of files\n"
    "--this-file copies one.\n"
    "A .glb as output is a take: a scene, moved by the recorded wind, as glTF 2.0 for Blender and other 3D programs;\n"
    "each joint of its skeleton is a joint of a skinned mesh, thinned out to 12,000 (--every).\n"
    "\n"
    "Examples:\n"
    "  yuragi export mast.windlog -o mast.csv\n"
    "  yuragi export mast.windlog -o - --from 2018-07-20T14:05:00Z --to 2018-07-20T14:06:00Z | head\n"
    "  yuragi export mast.windlog -o week.csv --since 7d --resample 10min\n"
    "  yuragi export mast.windlog -o weather.csv --quantities --since 24h\n"
    "  yuragi export live.windlog -o backup.windlog\n"
    "  yuragi export storm.windlog -o flag.glb --config wall.toml --scene flag --from 90 --duration 20 --fps 25";

struct ExportOptions {
  std::string input;
  std::string output;
  std::string from;
  std::string to;
  std::string since;
  std::string until;
  std::optional<double> resample_s;
  bool quantities = false;
  bool this_file = false;
  bool force = false;
  TakeOptions take;
};

/// The log time of --from or --to; nullopt if it is after the end.
std::optional<Nanoseconds> resolve(drivers::windlog::Reader& reader, const std::string& option,
                                   const std::string& text) {
  const auto moment = drivers::windlog::parse_log_moment(text);
  if (!moment) throw ExitError(kExitUsage, option + ": " + moment.error().message);
  const auto log_time = drivers::windlog::log_time_of(reader, *moment);
  if (!log_time) throw ExitError(kExitDataError, log_time.error().message);
  return *log_time;
}

/// The log time of --since or --until: a moment, or a duration back from the end; nullopt if it is after the end.
std::optional<Nanoseconds> resolve_back(drivers::windlog::Reader& reader, const std::string& option,
                                        const std::string& text) {
  if (const auto back_s = parse_duration_s(text)) {
    const double last_s = seconds(reader.duration());
    return *back_s >= last_s ? Nanoseconds{0} : reader.duration() - from_seconds(*back_s);
  }
  const auto moment = drivers::windlog::parse_iso_time(text);
  if (!moment) {
    throw ExitError(kExitUsage, option + ": \"" + text +
                                    "\" is neither a time (2018-07-20T14:05:00Z; UTC if it has no zone) nor a duration "
                                    "back from the end (24h, 7d)");
  }
  const auto log_time = reader.log_time_of(*moment);
  if (!log_time) throw ExitError(kExitDataError, log_time.error().message);
  return *log_time;
}

tools::csv::ExportRange range_of(drivers::windlog::Reader& reader, const ExportOptions& options) {
  tools::csv::ExportRange range;
  if (!options.from.empty()) range.from = resolve(reader, "--from", options.from).value_or(Nanoseconds::max());
  if (!options.to.empty()) range.to = resolve(reader, "--to", options.to).value_or(Nanoseconds::max());
  if (!options.since.empty()) {
    range.from = resolve_back(reader, "--since", options.since).value_or(Nanoseconds::max());
  }
  if (!options.until.empty()) {
    range.to = resolve_back(reader, "--until", options.until).value_or(Nanoseconds::max());
  }
  return range;
}

void export_quantities(const drivers::windlog::Reader& reader, const tools::csv::ExportRange& range,
                       const std::string& output, std::FILE* out) {
  const auto report = tools::csv::export_quantities_csv(reader, range, out);
  if (!report) throw ExitError(kExitDataError, report.error().message);
  for (const std::string& damage : reader.damage()) fmt::print(stderr, "warning: {}\n", damage);
  if (report->skipped > 0) {
    fmt::print(stderr, "left out: {} that cannot be quantities\n", count_text(report->skipped, "row"));
  }
  fmt::print(stderr, "{}: {}\n", output == "-" ? "standard output" : output, count_text(report->written, "row"));
}

void export_as_csv(drivers::windlog::Reader& reader, const ExportOptions& options, std::FILE* out) {
  const tools::csv::ExportRange range = range_of(reader, options);
  if (options.quantities) return export_quantities(reader, range, options.output, out);
  const bool is_watched = isatty(STDERR_FILENO) != 0 && isatty(fileno(out)) == 0;
  const auto began = std::chrono::steady_clock::now();
  bool has_shown = false;
  const auto progress = [&](std::size_t written) {
    if (!is_watched || std::chrono::steady_clock::now() - began < std::chrono::seconds(1)) return;
    fmt::print(stderr, "\r{} readings", written);
    has_shown = true;
  };
  const auto report = options.resample_s
                          ? tools::csv::resample_csv(reader, range, from_seconds(*options.resample_s), out, progress)
                          : tools::csv::export_csv(reader, range, out, progress);
  if (has_shown) fmt::print(stderr, "\n");
  if (!report) {
    const bool is_usage = report.error().kind == FailureKind::kUsage;
    throw ExitError(is_usage ? kExitUsage : kExitDataError, report.error().message);
  }
  for (const std::string& damage : reader.damage()) fmt::print(stderr, "warning: {}\n", damage);
  if (report->skipped > 0)
    fmt::print(stderr, "left out: {} that cannot be readings\n", count_text(report->skipped, "row"));
  const std::string readings = count_text(report->written, "reading");
  fmt::print(stderr, "{}: {}\n", options.output == "-" ? "standard output" : options.output,
             options.resample_s ? fmt::format("{} from {}", count_text(report->rows, "row"), readings) : readings);
}

/// Names the option that is for another kind of output.
void refuse_others(const ExportOptions& options) {
  if (!options.to.empty() || !options.since.empty() || !options.until.empty() || options.resample_s ||
      options.quantities)
    throw ExitError(kExitUsage,
                    "--to, --since, --until, --resample and --quantities are for CSV output; a take goes from "
                    "--from on, for --duration");
}

void run_export(const ExportOptions& options) {
  if (std::filesystem::path(options.output).extension() == ".glb") {
    refuse_others(options);
    return export_take(options.take, options.input, options.from, options.output, options.force);
  }
  auto reader = drivers::windlog::Reader::open(options.input);
  if (!reader) {
    const bool is_there = drivers::windlog::recording_exists(options.input);
    throw ExitError(is_there ? kExitDataError : kExitNoInput, reader.error().message);
  }
  if (options.this_file && std::filesystem::path(options.output).extension() != ".windlog")
    throw ExitError(kExitUsage, "--this-file is for a copy: -o COPY.windlog");
  if (options.output == "-") return export_as_csv(*reader, options, stdout);

  const auto lock = lock_output(options.output);
  platform::OutputFile output(options.output, options.force, drivers::windlog::kSideSuffixes);
  if (std::filesystem::path(options.output).extension() == ".windlog") {
    if (!options.from.empty() || !options.to.empty() || !options.since.empty() || !options.until.empty() ||
        options.resample_s || options.quantities) {
      throw ExitError(
          kExitUsage,
          "--from, --to, --since, --until, --resample and --quantities are for CSV output; a copy is always "
          "of the whole recording");
    }
    const auto copied = options.this_file ? drivers::windlog::Reader::copy_file(options.input, output.working_path())
                                          : reader->copy_to(output.working_path());
    if (!copied) {
      throw ExitError(kExitCannotCreate, options.output + ": cannot be written: " + copied.error().message);
    }
    output.commit().value();
    fmt::print(stderr, "{}: a copy of {}\n", options.output, options.input);
    return;
  }

  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(output.working_path().c_str(), "we"),
                                                             &std::fclose);
  if (!file) throw ExitError(kExitCannotCreate, options.output + ": cannot be created; is its folder writable?");
  export_as_csv(*reader, options, file.get());
  output.commit().value();
}

void add_export(CLI::App& app) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* command =
      app.add_subcommand("export", "Convert a recording to CSV or to a take for 3D programs, or copy it");
  command->footer(kExportFooter);
  command->add_option("file", options->input, "the recording (.windlog)")->required();
  command
      ->add_option("-o,--output", options->output, "FILE.csv, COPY.windlog, TAKE.glb, or - for CSV on standard output")
      ->required();
  auto* const from =
      command->add_option("--from", options->from, "where to begin: seconds, or a time such as 2018-07-20T14:05:00Z");
  auto* const to = command->add_option("--to", options->to, "where to end, in the same form");
  command
      ->add_option("--since", options->since,
                   "where to begin: a time such as 2018-07-20T14:05:00Z, or a duration back from the end: 24h, 7d")
      ->type_name("WHEN")
      ->excludes(from);
  command->add_option("--until", options->until, "where to end, in the same form")->type_name("WHEN")->excludes(to);
  auto* const resample = command
                             ->add_option("--resample", options->resample_s,
                                          "write means over blocks of this length: 60 (seconds), 10min, 1h")
                             ->type_name("TIME")
                             ->transform(duration_in_seconds())
                             ->check(CLI::Range(1e-3, 366.0 * 86400.0));
  command
      ->add_flag("--quantities", options->quantities,
                 "write what stations reported besides the wind: temperature, pressure, humidity, rain")
      ->excludes(resample);
  command->add_flag("--this-file", options->this_file, "of a series of files, copy only the file of this name");
  command->add_flag("--force", options->force, "overwrite the output");
  options->take.add_to(*command);
  command->callback([options] { run_export(*options); });
}

}  // namespace

const Command kExportCommand{add_export};

}  // namespace yuragi::daemon::commands
