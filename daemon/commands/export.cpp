// `yuragi export`: converts a recording to CSV, or copies it.
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/settings/output_file.hpp"
#include "daemon/tools/csv/csv_export.hpp"
#include "drivers/windlog/format.hpp"
#include "drivers/windlog/log_moment.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::commands {

extern const Command kExportCommand;

namespace {

constexpr const char* kExportFooter =
    "The CSV has the columns utc, time_s (seconds since the first reading), sensor, speed_m_s, direction_deg (where "
    "the\n"
    "wind comes from), gust_m_s and quality; `yuragi import` turns it into the same readings again.\n"
    "A .windlog as output is a consistent copy, even of a recording that is being written.\n"
    "\n"
    "Examples:\n"
    "  yuragi export mast.windlog -o mast.csv\n"
    "  yuragi export mast.windlog -o - --from 2018-07-20T14:05:00Z --to 2018-07-20T14:06:00Z | head\n"
    "  yuragi export live.windlog -o backup.windlog";

struct ExportOptions {
  std::string input;
  std::string output;
  std::string from;
  std::string to;
  bool force = false;
};

/// The log time of --from or --to; nothing if it is after the end.
std::optional<Nanoseconds> resolve(drivers::windlog::WindlogReader& reader, const std::string& option,
                                   const std::string& text) {
  const auto moment = drivers::windlog::parse_log_moment(text);
  if (!moment) throw ExitError(kExitUsage, option + ": " + moment.error().message);
  const auto log_time = drivers::windlog::log_time_of(reader, *moment);
  if (!log_time) throw ExitError(kExitDataError, log_time.error().message);
  return *log_time;
}

void export_as_csv(drivers::windlog::WindlogReader& reader, const ExportOptions& options, std::FILE* out) {
  tools::csv::CsvExportRange range;
  if (!options.from.empty()) range.from = resolve(reader, "--from", options.from).value_or(Nanoseconds::max());
  if (!options.to.empty()) range.to = resolve(reader, "--to", options.to).value_or(Nanoseconds::max());

  const bool is_watched = isatty(STDERR_FILENO) != 0 && isatty(fileno(out)) == 0;
  const auto began = std::chrono::steady_clock::now();
  bool has_shown = false;
  const auto report = tools::csv::export_csv(reader, range, out, [&](std::size_t written) {
    if (!is_watched || std::chrono::steady_clock::now() - began < std::chrono::seconds(1)) return;
    fmt::print(stderr, "\r{} readings", written);
    has_shown = true;
  });
  if (has_shown) fmt::print(stderr, "\n");
  if (!report) throw ExitError(kExitDataError, report.error().message);
  if (report->skipped > 0)
    fmt::print(stderr, "left out: {} that cannot be readings\n", count_text(report->skipped, "row"));
  fmt::print(stderr, "{}: {}\n", options.output == "-" ? "standard output" : options.output,
             count_text(report->written, "reading"));
}

void run_export(const ExportOptions& options) {
  auto reader = drivers::windlog::WindlogReader::open(options.input);
  if (!reader) {
    const bool is_there = std::filesystem::exists(options.input);
    throw ExitError(is_there ? kExitDataError : kExitNoInput, reader.error().message);
  }
  if (options.output == "-") return export_as_csv(*reader, options, stdout);

  settings::OutputFile output(options.output, options.force, drivers::windlog::kSideSuffixes);
  if (std::filesystem::path(options.output).extension() == ".windlog") {
    if (!options.from.empty() || !options.to.empty()) {
      throw ExitError(kExitUsage, "--from and --to are for CSV output; a copy is always of the whole recording");
    }
    if (const auto copied = reader->copy_to(output.working_path()); !copied) {
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
  CLI::App* command = app.add_subcommand("export", "Convert a recording to CSV, or copy it");
  command->footer(kExportFooter);
  command->add_option("file", options->input, "the recording (.windlog)")->required();
  command->add_option("-o,--output", options->output, "FILE.csv, COPY.windlog, or - for CSV on standard output")
      ->required();
  command->add_option("--from", options->from, "where to begin: seconds, or a time such as 2018-07-20T14:05:00Z");
  command->add_option("--to", options->to, "where to end, in the same form");
  command->add_flag("--force", options->force, "overwrite the output");
  command->callback([options] { run_export(*options); });
}

}  // namespace

const Command kExportCommand{add_export};

}  // namespace yuragi::daemon::commands
