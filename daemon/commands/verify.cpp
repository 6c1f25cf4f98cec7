// `yuragi verify`: checks a recording against itself.
#include <chrono>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/settings/standard_output.hpp"
#include "drivers/windlog/iso_time.hpp"
#include "drivers/windlog/verify_recording.hpp"
#include "engine/base/count_text.hpp"
#include "engine/base/printable_text.hpp"

namespace yuragi::daemon::commands {

extern const Command kVerifyCommand;

namespace {

namespace windlog = drivers::windlog;

constexpr const char* kVerifyFooter =
    "Reads all files of the recording and prints a line for each one, with what is wrong with it: pages that are\n"
    "damaged, times out of order, rows that are not readings of a sensor of a session, readings that were changed or\n"
    "are missing since their session was closed, a file that is missing between two. A session that was not closed "
    "(its\n"
    "program was killed, or still records) or is of an older version has no count to compare with.\n"
    "Times without a reading of a sensor that are longer than --gap are listed; they are not damage.\n"
    "The exit code is 0 if all is sound, and 1 if something is damaged or missing.\n"
    "--json prints is_sound, files (file, is_sound, damage, readings, sessions, sessions_without_count, first, last),\n"
    "missing, gap_s and gaps (sensor, from, to, length_s).\n"
    "\n"
    "Examples:\n"
    "  yuragi verify wall.windlog\n"
    "  yuragi verify wall.windlog --gap 10 --json";

struct VerifyOptions {
  std::string file;
  double gap_s = 900.0;
  bool as_json = false;
};

double seconds_of(Nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

std::string printable(std::string text) {
  make_printable(text);
  return text;
}

nlohmann::ordered_json json_of(const windlog::Verification& verification, double gap_s) {
  using Json = nlohmann::ordered_json;
  const auto time_of = [](const auto& time) { return time ? Json(windlog::iso_time_text(*time)) : Json(); };
  Json json = {{"is_sound", verification.is_sound()},
               {"files", Json::array()},
               {"missing", Json::array()},
               {"gap_s", gap_s},
               {"gaps", Json::array()}};
  for (const windlog::VerifiedFile& file : verification.files) {
    json["files"].push_back({{"file", file.file.string()},
                             {"is_sound", file.damage.empty()},
                             {"damage", file.damage},
                             {"readings", file.readings},
                             {"sessions", file.sessions},
                             {"sessions_without_count", file.sessions_without_count},
                             {"first", time_of(file.first)},
                             {"last", time_of(file.last)}});
  }
  for (const auto& file : verification.missing) json["missing"].push_back(file.string());
  for (const windlog::RecordingGap& gap : verification.gaps) {
    json["gaps"].push_back({{"sensor", gap.sensor},
                            {"from", windlog::iso_time_text(gap.from)},
                            {"to", windlog::iso_time_text(gap.to)},
                            {"length_s", seconds_of(gap.length)}});
  }
  return json;
}

std::string line_of(const windlog::VerifiedFile& file) {
  std::string line = fmt::format("{}: {}; {} in {}", file.file.string(), file.damage.empty() ? "sound" : "damaged",
                                 count_text(file.readings, "reading"), count_text(file.sessions, "session"));
  if (file.first && file.last) {
    line += fmt::format(", {} to {}", windlog::iso_time_text(*file.first), windlog::iso_time_text(*file.last));
  }
  if (file.sessions_without_count > 0) {
    line += fmt::format("; {} without a count", count_text(file.sessions_without_count, "session"));
  }
  for (const std::string& damage : file.damage) line.append("\n  ").append(printable(damage));
  return line + "\n";
}

std::string text_of(const windlog::Verification& verification, double gap_s) {
  std::string text;
  std::uint64_t readings = 0;
  for (const windlog::VerifiedFile& file : verification.files) {
    text += line_of(file);
    readings += file.readings;
  }
  for (const auto& file : verification.missing) text += fmt::format("{}: missing\n", file.string());
  for (const windlog::RecordingGap& gap : verification.gaps) {
    text += fmt::format("gap: {}, {} to {}, {:.0f} s\n", printable(gap.sensor), windlog::iso_time_text(gap.from),
                        windlog::iso_time_text(gap.to), seconds_of(gap.length));
  }
  return text + fmt::format("{}: {} in {}, {} longer than {:g} s\n", verification.is_sound() ? "sound" : "damaged",
                            count_text(readings, "reading"), count_text(verification.files.size(), "file"),
                            count_text(verification.gaps.size(), "gap"), gap_s);
}

void run_verify(const VerifyOptions& options) {
  const auto verification =
      windlog::verify_recording(options.file, Nanoseconds(static_cast<std::int64_t>(1e9 * options.gap_s)));
  if (!verification) throw ExitError(exit_code_of(verification.error().kind), verification.error().message);
  if (options.as_json) {
    print_json(json_of(*verification, options.gap_s));
  } else {
    settings::write_at_once(text_of(*verification, options.gap_s));
  }
  if (!verification->is_sound()) throw ExitError(kExitAttention, "");
}

void add_verify(CLI::App& app) {
  const auto options = std::make_shared<VerifyOptions>();
  CLI::App* command = app.add_subcommand("verify", "Check a recording against itself");
  command->footer(kVerifyFooter);
  command->add_option("file", options->file, "the recording")->required()->type_name("FILE.windlog");
  command->add_option("--gap", options->gap_s, "list times without a reading that are longer, s")
      ->check(CLI::Range(0.001, 1e8))
      ->type_name("S")
      ->capture_default_str();
  add_json(*command, options->as_json);
  command->callback([options] { run_verify(*options); });
}

}  // namespace

const Command kVerifyCommand{add_verify};

}  // namespace yuragi::daemon::commands
