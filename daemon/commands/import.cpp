// `yuragi import`: converts a CSV file to a recording.
#include <array>
#include <chrono>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/settings/output_file.hpp"
#include "daemon/tools/csv/csv_import.hpp"
#include "drivers/windlog/format.hpp"
#include "drivers/windlog/windlog_writer.hpp"
#include "engine/base/count_text.hpp"
#include "engine/base/version.hpp"

namespace yuragi::daemon::commands {

extern const Command kImportCommand;

namespace {

constexpr const char* kImportFooter =
    "The columns are found by their names: time or timestamp, wind_speed, direction, gust, or u and v; a unit in a "
    "name\n"
    "(u_ms, speed_kmh, \"Gust (mph)\") is understood. The choice is printed. Rows that are not readings, or go\n"
    "back in time, are left out and counted.\n"
    "\n"
    "Examples:\n"
    "  yuragi import mast.csv -o mast.windlog\n"
    "  yuragi import station.csv -o station.windlog --speed \"Avg Wind\" --unit km/h --direction Dir --time-format "
    "unix\n"
    "  yuragi import sonic.csv -o sonic.windlog --u Ux --v Uy --uv-from\n"
    "Then: yuragi replay mast.windlog";

struct ImportOptions {
  std::string input;
  std::string output;
  tools::csv::CsvImportOptions csv;
  std::string unit;
  std::string delimiter;
  std::string comment = "#";
  bool force = false;
};

char delimiter_named(const std::string& text) {
  if (text.empty()) return 0;
  if (text == "tab" || text == "\\t" || text == "\t") return '\t';
  if (text == "," || text == ";") return text[0];
  throw ExitError(kExitUsage, "--delimiter: is \"" + text + "\"; allowed: , or ; or tab");
}

tools::csv::CsvImportOptions csv_options(const ImportOptions& options) {
  tools::csv::CsvImportOptions csv = options.csv;
  csv.delimiter = delimiter_named(options.delimiter);
  if (options.comment.size() > 1) throw ExitError(kExitUsage, "--comment: give one character, or \"\" for none");
  csv.comment = options.comment.empty() ? '\0' : options.comment[0];
  if (!options.unit.empty()) csv.unit = tools::csv::find_speed_unit(options.unit);
  return csv;
}

/// Writes the imported readings to one session of a new recording.
class Target {
 public:
  Target(const std::filesystem::path& file, std::string configuration)
      : writer_(open(file)), configuration_(std::move(configuration)), is_watched_(isatty(STDERR_FILENO) != 0) {}

  void take(std::string_view sensor, const wind::WindReading& reading) {
    if (count_ == 0) must(writer_.begin_session({reading.time, with_version("yuragi"), configuration_}));
    auto known = sensors_.find(sensor);
    if (known == sensors_.end()) {
      const auto id = writer_.add_sensor(sensor, "import", "");
      if (!id) throw ExitError(kExitCannotCreate, id.error().message);
      known = sensors_.emplace(sensor, *id).first;
    }
    must(writer_.append(known->second, reading));

    // Transactions of bounded size; shows progress now and then when it takes long.
    constexpr std::size_t kRowsPerCommit = 100'000;
    if (++count_ % kRowsPerCommit == 0) {
      must(writer_.commit());
      const bool is_slow = std::chrono::steady_clock::now() - began_ > std::chrono::seconds(1);
      if (is_watched_ && is_slow) fmt::print(stderr, "\r{} readings", count_);
      has_shown_ = has_shown_ || (is_watched_ && is_slow);
    }
  }

  void close() {
    if (has_shown_) fmt::print(stderr, "\n");
    must(writer_.close());
  }

 private:
  static drivers::windlog::WindlogWriter open(const std::filesystem::path& file) {
    auto writer = drivers::windlog::WindlogWriter::open(file);
    if (!writer) throw ExitError(kExitCannotCreate, writer.error().message);
    return std::move(*writer);
  }

  static void must(const Result<void, Failure>& done) {
    if (!done) throw ExitError(kExitCannotCreate, done.error().message);
  }

  drivers::windlog::WindlogWriter writer_;
  std::string configuration_;
  bool is_watched_;
  bool has_shown_ = false;
  std::size_t count_ = 0;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::map<std::string, std::int64_t, std::less<>> sensors_;
};

void print_report(const ImportOptions& options, const tools::csv::CsvImportReport& report) {
  for (const std::string& line : report.columns) fmt::print("  {}\n", line);
  for (const std::string& line : report.first_refusals) fmt::print(stderr, "left out: {}\n", line);
  if (report.refused() > report.first_refusals.size()) {
    fmt::print(stderr, "left out: {} more\n", report.refused() - report.first_refusals.size());
  }
  fmt::print("{}: {} of {}, {} left out\n", options.output, count_text(report.taken, "reading"),
             count_text(report.rows, "row"), report.refused());
}

void run_import(const ImportOptions& options) {
  const tools::csv::CsvImportOptions csv = csv_options(options);
  std::ifstream file;
  const bool is_standard_input = options.input == "-";
  if (!is_standard_input) {
    if (std::filesystem::is_directory(options.input)) throw ExitError(kExitNoInput, options.input + ": is a folder");
    file.open(options.input, std::ios::binary);
    if (!file) throw ExitError(kExitNoInput, options.input + ": cannot be read; does it exist?");
  }

  settings::OutputFile output(options.output, options.force, drivers::windlog::kSideSuffixes);
  Target target(output.working_path(), fmt::format("# imported from {}\n", options.input));
  const auto report = tools::csv::import_csv(
      is_standard_input ? std::cin : file, options.input, csv,
      [&target](std::string_view sensor, const wind::WindReading& reading) { target.take(sensor, reading); });
  if (!report) throw ExitError(kExitDataError, report.error().message);
  if (!is_standard_input && file.bad()) throw ExitError(kExitNoInput, options.input + ": could not be read completely");
  target.close();
  if (report->taken == 0) {
    print_report(options, *report);
    throw ExitError(kExitDataError, options.input + ": no row is a reading; nothing was written");
  }
  output.commit().value();
  print_report(options, *report);
}

void add_import(CLI::App& app) {
  const auto options = std::make_shared<ImportOptions>();
  CLI::App* command = app.add_subcommand("import", "Convert a CSV file to a recording");
  command->footer(kImportFooter);
  command->add_option("file", options->input, "the CSV file; - is standard input")->required();
  command->add_option("-o,--output", options->output, "the recording to write (.windlog)")->required();
  command->add_flag("--force", options->force, "overwrite it");

  const auto add_column = [&](const char* flag, tools::csv::CsvRole role, const char* help) {
    command->add_option(flag, options->csv.columns[static_cast<std::size_t>(role)], help)->type_name("COLUMN");
  };
  add_column("--time", tools::csv::CsvRole::kTime, "the column of times");
  add_column("--speed", tools::csv::CsvRole::kSpeed, "the column of wind speeds");
  add_column("--direction", tools::csv::CsvRole::kDirection, "the column of directions");
  add_column("--gust", tools::csv::CsvRole::kGust, "the column of gusts");
  add_column("--u", tools::csv::CsvRole::kU, "the column of the eastward component");
  add_column("--v", tools::csv::CsvRole::kV, "the column of the northward component");
  command->add_flag("--uv-from", options->csv.components_are_from, "u and v point toward where the wind comes from");

  static const std::map<std::string, tools::csv::CsvTimeFormat> kTimeFormats = {
      {"auto", tools::csv::CsvTimeFormat::kAuto},
      {"iso", tools::csv::CsvTimeFormat::kIso},
      {"unix", tools::csv::CsvTimeFormat::kUnix},
      {"unix-ms", tools::csv::CsvTimeFormat::kUnixMs},
      {"seconds", tools::csv::CsvTimeFormat::kSeconds}};
  command->add_option("--time-format", options->csv.time_format, "format of the times; auto: by the first row")
      ->transform(CLI::CheckedTransformer(kTimeFormats))
      ->option_text("auto|iso|unix|unix-ms|seconds");
  command
      ->add_option("--unit", options->unit, "unit of speed, gust, u and v; default: as the column's name says, or m/s")
      ->check(CLI::IsMember({"m/s", "km/h", "kn", "mph"}))
      ->option_text("m/s|km/h|kn|mph");
  static const std::map<std::string, bool> kConventions = {{"from", false}, {"toward", true}};
  command
      ->add_option("--direction-convention", options->csv.direction_is_toward,
                   "whether directions are where the wind comes from, or blows to")
      ->transform(CLI::CheckedTransformer(kConventions))
      ->option_text("from|toward");
  static const std::map<std::string, tools::csv::CsvDirectionUnit> kDirectionUnits = {
      {"deg", tools::csv::CsvDirectionUnit::kDegrees},
      {"rad", tools::csv::CsvDirectionUnit::kRadians},
      {"point16", tools::csv::CsvDirectionUnit::kPoint16}};
  command->add_option("--direction-unit", options->csv.direction_unit, "point16: 0 to 15, clockwise from north")
      ->transform(CLI::CheckedTransformer(kDirectionUnits))
      ->option_text("deg|rad|point16");
  command->add_option("--delimiter", options->delimiter, ", or ; or tab; default: the most frequent one in the header");
  command->add_option("--comment", options->comment, "lines that begin with this character are ignored (default #)");
  command->add_option("--sensor", options->csv.sensor, "name of the sensor")->capture_default_str();
  command->add_flag("--strict", options->csv.strict, "stop at the first row that is not a reading");
  command->callback([options] { run_import(*options); });
}

}  // namespace

const Command kImportCommand{add_import};

}  // namespace yuragi::daemon::commands
