// `yuragi import`: converts a CSV file to a recording.
#include <array>
#include <chrono>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/lock_recording.hpp"
#include "daemon/tools/csv/csv_import.hpp"
#include "daemon/tools/csv/csv_preview.hpp"
#include "daemon/tools/decode/recognise.hpp"
#include "daemon/tools/logs/log_import.hpp"
#include "drivers/windlog/format.hpp"
#include "drivers/windlog/windlog_writer.hpp"
#include "engine/base/count_text.hpp"
#include "engine/base/version.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::commands {

extern const Command kImportCommand;

namespace {

constexpr const char* kImportFooter =
    "What `import` finds by itself, and prints:\n"
    "  the header       below a preamble (Campbell TOA5, HOBO, open-meteo), over two lines (Davis), or in a comment\n"
    "                   (KNMI, NDBC); rows of units below it\n"
    "  the columns      by their usual names: timestamp, wind_speed, direction, gust, or u and v; date and time, or\n"
    "                   year, month, day, hour in separate columns; temperature, pressure, humidity, w\n"
    "  the units        from the column's name (\"Gust (mph)\"), the row of units, the preamble, the fields\n"
    "                   (\"5.4 kn\"), the program that wrote the file, the column beside it; otherwise m/s is "
    "assumed,\n"
    "                   and printed. If that is implausible, or the unit is a word that is not known, --unit is "
    "required\n"
    "  the times        ISO 8601, 20.7.2018, 7/20/18 2:00 PM, 201807201400, Unix time; year, day of the year and "
    "1359;\n"
    "                   typical years are put on one year. If day and month are unclear,\n"
    "                   --time-format is required. Times without a zone are in UTC, or in --zone\n"
    "  missing values   --, M, VRB, -999, 9999, 99.0 far above all others ... A missing direction leaves the speed in\n"
    "  the order        a file with its newest row first is read from its end\n"
    "A log of messages, one a line (NMEA 0183, NMEA 2000, Gill, FT, UMB, WXT, Tempest, WeatherLink Live, Signal K, "
    "pushes\n"
    "of stations, and keys in text or JSON: \"speed=4.2 direction=270\", wind_avg_m_s), is dated by the times that a "
    "logger\n"
    "wrote before them, by those in the messages, by its RMC, ZDA and GLL, or by --start and --interval. Where "
    "messages\n"
    "have the time of the day alone, --start gives the first day. --speed, --direction, --gust and --unit name keys, "
    "too.\n"
    "Rows that are not readings, repeat the one before, or go back in time, are left out and counted by reason.\n"
    "Before the recording is written, first and last time, interval, gaps, mean, strongest and directions are shown; "
    "on\n"
    "a terminal you are asked. What is hardly a wind (an interval below 10 ms, a mean above 40 m/s, changes above\n"
    "10 m/s in 30 % of the steps) is refused without --force.\n"
    "\n"
    "Examples:\n"
    "  yuragi import mast.csv -o mast.windlog\n"
    "  yuragi import station.csv -o station.windlog --speed \"Avg Wind\" --unit km/h --direction Dir --time-format "
    "unix\n"
    "  yuragi import garden.csv -o garden.windlog --time-format day-first --zone Europe/Berlin --missing 99.0\n"
    "  yuragi import history.csv -o roof.windlog --where entity_id=sensor.wind_speed --speed state --unit km/h\n"
    "  yuragi import windsonic.log -o roof.windlog --start 2023-06-25T22:00:00Z --interval 0.25\n"
    "  yuragi import boat.raw -o boat.windlog --start 2023-06-25\n"
    "  yuragi import sonic.csv -o sonic.windlog --u Ux --v Uy --uv-from\n"
    "Then: yuragi replay mast.windlog";

enum class Format : std::uint8_t { kAuto, kCsv, kLog };

struct ImportOptions {
  std::string input;
  std::string output;
  tools::csv::ImportOptions csv;
  std::string unit;
  std::string gust_unit;
  std::string zone;
  std::vector<std::string> conditions;
  std::string header;
  std::string start;
  double interval_s = 0.0;
  std::string sentence;
  Format format = Format::kAuto;
  std::string delimiter;
  std::string comment = "#";
  bool force = false;
  bool is_dry_run = false;
  bool is_confirmed = false;
};

char delimiter_named(const std::string& text) {
  if (text.empty()) return 0;
  if (text == "tab" || text == "\\t" || text == "\t") return '\t';
  if (text == "blank" || text == " ") return ' ';
  if (text == "," || text == ";" || text == "|") return text[0];
  throw ExitError(kExitUsage, "--delimiter: is \"" + text + "\"; allowed: , or ; or | or tab or blank");
}

std::optional<tools::csv::Unit> speed_unit_named(const char* option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto unit = tools::csv::find_speed_unit(text);
  if (unit) return unit;
  throw ExitError(kExitUsage,
                  fmt::format("{}: is \"{}\"; allowed: m/s, km/h, kn, mph, ft/s, cm/s, 0.1 m/s", option, text));
}

tools::csv::Condition condition_in(const std::string& text) {
  const auto sign = text.find('=');
  if (sign == std::string::npos || sign == 0) {
    throw ExitError(kExitUsage, "--where: is \"" + text + "\"; allowed: COLUMN=VALUE");
  }
  return {text.substr(0, sign), text.substr(sign + 1)};
}

tools::csv::ImportOptions csv_options(const ImportOptions& options) {
  tools::csv::ImportOptions csv = options.csv;
  csv.delimiter = delimiter_named(options.delimiter);
  if (options.comment.size() > 1) throw ExitError(kExitUsage, "--comment: give one character, or \"\" for none");
  csv.comment = options.comment.empty() ? '\0' : options.comment[0];
  csv.unit = speed_unit_named("--unit", options.unit);
  csv.gust_unit = speed_unit_named("--gust-unit", options.gust_unit);
  if (!options.zone.empty()) {
    const auto zone = tools::csv::Zone::parse(options.zone);
    if (!zone) throw ExitError(kExitUsage, "--zone: " + zone.error().message);
    csv.zone = *zone;
  }
  std::istringstream names(options.header);
  for (std::string name; std::getline(names, name, ',');) csv.header.push_back(name);
  for (const std::string& condition : options.conditions) csv.conditions.push_back(condition_in(condition));
  return csv;
}

tools::logs::Options log_options(const ImportOptions& options, const tools::csv::ImportOptions& csv) {
  tools::logs::Options log;
  log.table = csv;
  log.sentence = options.sentence;
  if (options.interval_s > 0.0) log.interval = from_seconds(options.interval_s);
  if (options.start.empty()) return log;
  const auto start = tools::csv::parse_time(options.start, tools::csv::TimeFormat::kIso);
  if (!start) throw ExitError(kExitUsage, "--start: is \"" + options.start + "\"; allowed: 2023-06-25T22:00:00Z");
  log.start = start->clock - start->utc_offset.value_or(Nanoseconds{0});
  return log;
}

/// Imports it as a table or as a log, by its first lines.
Result<tools::csv::ImportReport, Failure> import_any(const ImportOptions& options, std::istream& in,
                                                     const tools::csv::Sinks& sinks) {
  const tools::csv::ImportOptions csv = csv_options(options);
  const tools::logs::Options log = log_options(options, csv);
  tools::csv::Input input(in);
  const auto lines = tools::csv::first_lines(input, options.input);
  if (!lines) return lines.error();
  Format format = options.format;
  if (format == Format::kAuto) {
    format = tools::logs::looks_like_log(*lines, csv) ? Format::kLog : Format::kCsv;
  }
  auto report = format == Format::kLog ? tools::logs::import_log(input, options.input, log, sinks)
                                       : tools::csv::import_csv(input, options.input, csv, sinks);
  if (!report) {
    // The decoders know messages that no log of them is imported of.
    const std::string other = tools::decode::recognised_text(*lines);
    return other.empty() ? report
                         : Failure{fmt::format("{}; `yuragi decode` reads them as {}", report.error().message, other),
                                   report.error().kind};
  }
  if (input.encoding() != tools::csv::Encoding::kUtf8)
    report->notes.insert(report->notes.begin(), fmt::format("text in {}", name_of(input.encoding())));
  return report;
}

/// Writes the imported readings to one session of a new recording.
class Target {
 public:
  Target(const std::filesystem::path& file, std::string configuration)
      : writer_(open(file)), configuration_(std::move(configuration)), is_watched_(isatty(STDERR_FILENO) != 0) {}

  void take(std::string_view sensor, const wind::Reading& reading) {
    if (count_ == 0) must(writer_.begin_session({reading.time, with_version("yuragi"), configuration_}));
    auto known = sensors_.find(sensor);
    if (known == sensors_.end()) {
      const auto id = writer_.add_sensor(sensor, "import", "");
      if (!id) throw ExitError(kExitCannotCreate, id.error().message);
      known = sensors_.emplace(sensor, *id).first;
    }
    constexpr std::size_t kBatch = 128;
    if (known->second != last_sensor_ || batch_.size() == kBatch) write_batch();
    last_sensor_ = known->second;
    batch_.push_back(reading);

    // Transactions of bounded size; shows progress now and then when it takes long.
    constexpr std::size_t kRowsPerCommit = 100'000;
    if (++count_ % kRowsPerCommit == 0) {
      write_batch();
      must(writer_.commit());
      const bool is_slow = std::chrono::steady_clock::now() - began_ > std::chrono::seconds(1);
      if (is_watched_ && is_slow) fmt::print(stderr, "\r{} readings", count_);
      has_shown_ = has_shown_ || (is_watched_ && is_slow);
    }
  }

  /// Of the sensor and time of the last reading.
  void take(const wind::StationQuantities& quantities) {
    write_batch();
    const auto done = writer_.append(last_sensor_, quantities);
    if (!done) throw ExitError(kExitCannotCreate, done.error().message);
  }

  void close() {
    if (has_shown_) fmt::print(stderr, "\n");
    write_batch();
    must(writer_.close());
  }

 private:
  static drivers::windlog::Writer open(const std::filesystem::path& file) {
    auto writer = drivers::windlog::Writer::open(file, drivers::windlog::Durability::kOnceClosed);
    if (!writer) throw ExitError(kExitCannotCreate, writer.error().message);
    return std::move(*writer);
  }

  void write_batch() {
    must(writer_.append(last_sensor_, batch_));
    batch_.clear();
  }

  static void must(const Result<void, Failure>& done) {
    if (!done) throw ExitError(kExitCannotCreate, done.error().message);
  }

  drivers::windlog::Writer writer_;
  std::string configuration_;
  bool is_watched_;
  bool has_shown_ = false;
  std::size_t count_ = 0;
  std::int64_t last_sensor_ = 0;
  std::vector<wind::Reading> batch_;  ///< of that sensor
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::map<std::string, std::int64_t, std::less<>> sensors_;
};

void print_report(const tools::csv::ImportReport& report, const tools::csv::Preview& preview) {
  for (const std::string& line : report.columns) fmt::print("  {}\n", line);
  for (const std::string& line : report.notes) fmt::print("  {}\n", line);
  for (const std::string& line : preview.describe()) fmt::print("  {}\n", line);
  for (const auto& [reason, count] : report.refusals)
    fmt::print(stderr, "left out: {}: {}\n", count_text(count, "row"), reason);
  for (const std::string& line : report.first_refusals) fmt::print(stderr, "  {}\n", line);
  if (report.refused() > report.first_refusals.size())
    fmt::print(stderr, "  and {} more\n", report.refused() - report.first_refusals.size());
}

void print_count(const std::string& output, const tools::csv::ImportReport& report) {
  fmt::print("{}: {} of {}, {} left out\n", output, count_text(report.taken, "reading"), count_text(report.rows, "row"),
             report.refused());
  if (report.quantities > 0)
    fmt::print("{} with other quantities besides the wind (yuragi export --quantities)\n",
               count_text(report.quantities, "row"));
}

/// Asks a person at a terminal; true if there is none.
bool is_wanted(const ImportOptions& options) {
  if (options.is_confirmed || isatty(STDIN_FILENO) == 0 || isatty(STDOUT_FILENO) == 0) return true;
  fmt::print("Write {}? [Y/n] ", options.output);
  std::fflush(stdout);
  std::string answer;
  if (!std::getline(std::cin, answer)) return false;
  return answer.empty() || answer.starts_with('y') || answer.starts_with('Y');
}

/// Reads the input into `sinks` and a preview, and reports both. Throws if there is nothing to record, or if it is
/// implausible and not forced.
tools::csv::ImportReport read_input(const ImportOptions& options, const tools::csv::Sinks& sinks) {
  std::ifstream file;
  const bool is_standard_input = options.input == "-";
  if (!is_standard_input) {
    if (std::filesystem::is_directory(options.input)) throw ExitError(kExitNoInput, options.input + ": is a folder");
    file.open(options.input, std::ios::binary);
    if (!file) throw ExitError(kExitNoInput, options.input + ": cannot be read; does it exist?");
  }
  tools::csv::Preview preview;
  const auto report = import_any(options, is_standard_input ? std::cin : file,
                                 {.reading =
                                      [&](std::string_view sensor, const wind::Reading& reading) {
                                        preview.take(sensor, reading);
                                        if (sinks.reading) sinks.reading(sensor, reading);
                                      },
                                  .quantities = sinks.quantities});
  if (!report) throw ExitError(kExitDataError, report.error().message);
  if (!is_standard_input && file.bad()) throw ExitError(kExitNoInput, options.input + ": could not be read completely");
  print_report(*report, preview);
  if (report->taken == 0) throw ExitError(kExitDataError, options.input + ": no row is a reading; nothing was written");
  const std::vector<std::string> doubts = report->is_own_export ? std::vector<std::string>{} : preview.implausible();
  for (const std::string& doubt : doubts) fmt::print(stderr, "implausible: {}\n", doubt);
  if (!doubts.empty() && !options.force)
    throw ExitError(kExitDataError,
                    options.input + ": these are hardly winds; nothing was written (--force writes it)");
  return *report;
}

void run_import(const ImportOptions& options) {
  csv_options(options);  // a mistake in them is reported before anything is opened
  if (options.is_dry_run) return print_count("nothing was written", read_input(options, {}));
  if (options.output.empty()) throw ExitError(kExitUsage, "--output: give the recording to write, or --dry-run");

  const auto lock = lock_recording(options.output);
  platform::OutputFile output(options.output, options.force, drivers::windlog::kSideSuffixes);
  Target target(output.working_path(), fmt::format("# imported from {}\n", options.input));
  const auto report = read_input(
      options,
      {.reading = [&target](std::string_view sensor, const wind::Reading& reading) { target.take(sensor, reading); },
       .quantities = [&target](std::string_view,
                               const wind::StationQuantities& quantities) { target.take(quantities); }});
  target.close();
  if (!is_wanted(options)) {
    fmt::print("nothing was written\n");
    return;
  }
  output.commit().value();
  print_count(options.output, report);
}

void add_import(CLI::App& app) {
  const auto options = std::make_shared<ImportOptions>();
  CLI::App* command =
      app.add_subcommand("import", "Convert a CSV file, or a log of an anemometer's messages, to a recording");
  command->footer(kImportFooter);
  command->add_option("file", options->input, "the CSV file or log; - is standard input")->required();
  command->add_option("-o,--output", options->output, "the recording to write (.windlog)");
  command->add_flag("--force", options->force, "overwrite it, and write what is implausible");
  command->add_flag("--dry-run", options->is_dry_run, "show what would be written, and write nothing");
  command->add_flag("-y,--yes", options->is_confirmed, "do not ask on a terminal before it is written");
  static const std::map<std::string, Format> kFormats = {
      {"auto", Format::kAuto}, {"csv", Format::kCsv}, {"log", Format::kLog}};
  command->add_option("--format", options->format, "what the file is; auto: by its first lines")
      ->transform(CLI::CheckedTransformer(kFormats))
      ->option_text("auto|csv|log");

  const auto add_column = [&](const char* flag, tools::csv::Role role, const char* help) {
    command->add_option(flag, options->csv.columns[static_cast<std::size_t>(role)], help)->type_name("COLUMN");
  };
  add_column("--time", tools::csv::Role::kTime, "the column of times");
  add_column("--date", tools::csv::Role::kDate, "the column of dates, if --time has none");
  add_column("--speed", tools::csv::Role::kSpeed, "the column of wind speeds");
  add_column("--direction", tools::csv::Role::kDirection, "the column of directions");
  add_column("--gust", tools::csv::Role::kGust, "the column of gusts");
  add_column("--u", tools::csv::Role::kU, "the column of the eastward component");
  add_column("--v", tools::csv::Role::kV, "the column of the northward component");
  add_column("--w", tools::csv::Role::kVerticalSpeed, "the column of the upward component");
  add_column("--temperature", tools::csv::Role::kTemperature, "the column of air temperatures");
  add_column("--pressure", tools::csv::Role::kPressure, "the column of air pressures");
  add_column("--humidity", tools::csv::Role::kHumidity, "the column of relative humidities");
  command->add_flag("--uv-from", options->csv.components_are_from, "u and v point toward where the wind comes from");

  static const std::map<std::string, tools::csv::TimeFormat> kTimeFormats = {
      {"auto", tools::csv::TimeFormat::kAuto},          {"iso", tools::csv::TimeFormat::kIso},
      {"day-first", tools::csv::TimeFormat::kDayFirst}, {"month-first", tools::csv::TimeFormat::kMonthFirst},
      {"compact", tools::csv::TimeFormat::kCompact},    {"unix", tools::csv::TimeFormat::kUnix},
      {"unix-ms", tools::csv::TimeFormat::kUnixMs},     {"unix-us", tools::csv::TimeFormat::kUnixUs},
      {"unix-ns", tools::csv::TimeFormat::kUnixNs},     {"seconds", tools::csv::TimeFormat::kSeconds}};
  command
      ->add_option("--time-format", options->csv.time_format,
                   "format of the times; auto: by all rows; compact: YYYYMMDDHH and so on")
      ->transform(CLI::CheckedTransformer(kTimeFormats))
      ->option_text("auto|iso|day-first|month-first|compact|unix|unix-ms|unix-us|unix-ns|seconds");
  command
      ->add_option("--zone", options->zone,
                   "zone of times that name none: UTC, +02:00, Europe/Berlin (default: given in the file, or UTC)")
      ->type_name("ZONE");
  command->add_option("--unit", options->unit, "unit of speed, gust, u, v and w; default: given in the file, or m/s")
      ->option_text("m/s|km/h|kn|mph|ft/s|cm/s|\"0.1 m/s\"");
  command->add_option("--gust-unit", options->gust_unit, "unit of the gust alone")->type_name("UNIT");
  static const std::map<std::string, bool> kConventions = {{"from", false}, {"toward", true}};
  command
      ->add_option("--direction-convention", options->csv.direction_is_toward,
                   "whether directions are where the wind comes from, or blows to")
      ->transform(CLI::CheckedTransformer(kConventions))
      ->option_text("from|toward");
  static const std::map<std::string, tools::csv::DirectionUnit> kDirectionUnits = {
      {"deg", tools::csv::DirectionUnit::kDegrees},
      {"rad", tools::csv::DirectionUnit::kRadians},
      {"point16", tools::csv::DirectionUnit::kPoint16}};
  command->add_option("--direction-unit", options->csv.direction_unit, "point16: 0 to 15, clockwise from north")
      ->transform(CLI::CheckedTransformer(kDirectionUnits))
      ->option_text("deg|rad|point16");
  command->add_option("--delimiter", options->delimiter, ", or ; or | or tab or blank; default: as the header has it");
  command->add_option("--comment", options->comment, "lines that begin with this character are ignored (default #)");
  command->add_option("--skip", options->csv.skip, "lines before the header; default: it is looked for")
      ->type_name("N");
  command
      ->add_option("--header", options->header,
                   "names for the columns of a file without a header, with commas between them")
      ->type_name("NAMES");
  command
      ->add_option("--where", options->conditions,
                   "take the rows where this column has this text; can be given several times")
      ->type_name("COLUMN=VALUE")
      ->allow_extra_args(false);
  command->add_option("--missing", options->csv.missing, "a text that stands for no value; can be given several times")
      ->type_name("TEXT")
      ->allow_extra_args(false);
  command->add_option("--sensor", options->csv.sensor, "name of the sensor")->capture_default_str();
  command->add_option("--start", options->start, "a log without times: when its first reading was")->type_name("TIME");
  command->add_option("--interval", options->interval_s, "a log without times: from one reading to the next")
      ->check(CLI::Range(0.001, 86400.0))
      ->type_name("SECONDS");
  command->add_option("--sentence", options->sentence, "a log of several sentences: the one to take (MWD, MWV R ...)")
      ->type_name("NAME");
  command->add_flag("--strict", options->csv.strict, "stop at the first row that is not a reading");
  command->callback([options] { run_import(*options); });
}

}  // namespace

const Command kImportCommand{add_import};

}  // namespace yuragi::daemon::commands
