// `yuragi decode`: decodes logged messages with the drivers' own decoders.
#include <array>
#include <cerrno>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/decode_options.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/settings/standard_output.hpp"
#include "daemon/tools/decode/decode_formats.hpp"
#include "daemon/tools/decode/recognise.hpp"
#include "daemon/tools/decode/unit_reader.hpp"
#include "engine/base/count_text.hpp"
#include "engine/base/json_text.hpp"
#include "engine/base/printable_text.hpp"

namespace yuragi::daemon::commands {
namespace {

using Json = nlohmann::ordered_json;

/// An input to read from to its end: a file, a pipe, a terminal.
class Input {
 public:
  explicit Input(const std::string& file) : name_(file == "-" ? "standard input" : file) {
    if (file != "-") fd_ = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd_ < 0) refuse();
  }
  ~Input() {
    if (fd_ > STDIN_FILENO) close(fd_);
  }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// The next block, waiting until there is one. Empty: the end.
  drivers::decode::ByteSpan read_some() {
    while (true) {
      const ssize_t size = read(fd_, block_.data(), block_.size());
      if (size >= 0) return drivers::decode::ByteSpan(block_).first(static_cast<std::size_t>(size));
      if (errno != EINTR) refuse();
    }
  }

 private:
  [[noreturn]] void refuse() const {
    const std::string why = std::generic_category().message(errno);
    throw ExitError(
        kExitNoInput,
        fmt::format("cannot read {}: {}. Give the name of a readable file, or - for standard input", name_, why));
  }

  std::string name_;
  int fd_ = STDIN_FILENO;
  std::array<std::uint8_t, 16384> block_{};
};

/// `text` for JSON: if it is not valid UTF-8, each byte beyond ASCII as \xNN.
std::string as_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::string escaped;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    escaped += byte < 0x80 ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
  }
  return escaped;
}

Json number_or_null(std::optional<double> value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json_of(const tools::decode::UnitReading& reading) {
  const drivers::decode::DecodedWind& wind = reading.wind;
  Json json = {{"speed_m_s", number_or_null(wind.speed_m_s)},
               {"direction_deg", number_or_null(wind.direction_deg)},
               {"gust_m_s", number_or_null(wind.gust_m_s)}};
  if (wind.reference != drivers::decode::WindReference::kUnknown) json["reference"] = name_of(wind.reference);
  json["status"] = name_of(wind.status);
  if (reading.count) json["count"] = *reading.count;
  if (reading.volts) json["volts"] = *reading.volts;
  return json;
}

/// Writes one JSON object per line, flushing each.
class Output {
 public:
  explicit Output(bool shows_refused) : shows_refused_(shows_refused) {}

  void reading(const tools::decode::UnitReading& reading) {
    ++readings_;
    write(json_of(reading));
  }

  void refusal(drivers::decode::Refusal why, std::string_view detail, std::string_view input) {
    ++refused_[name_of(why)];
    if (!shows_refused_) return;
    Json json = {{"refused", name_of(why)}};
    if (!detail.empty()) json["detail"] = detail;
    json["input"] = as_utf8(input);
    write(json);
  }

  std::uint64_t readings() const { return readings_; }

  /// For people, beside the output: how much was refused, or that nothing is a reading.
  void summary() const {
    if (refused_.empty() && readings_ > 0) return;
    if (refused_.empty()) return fmt::print(stderr, "decode: no reading\n");
    std::string reasons;
    for (const auto& [why, count] : refused_)
      reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", why, count);
    fmt::print(stderr, "decode: {}; refused: {}{}\n", count_text(readings_, "reading"), reasons,
               shows_refused_ ? "" : "; --refused shows each");
  }

 private:
  static void write(const Json& json) { settings::write_at_once(ascii_json_text(json) + "\n"); }

  bool shows_refused_;
  std::uint64_t readings_ = 0;
  std::map<std::string_view, std::uint64_t> refused_;
};

const tools::decode::UnitFormat& format_of(DecodeCommandOptions& options) {
  const tools::decode::UnitFormat* format = tools::decode::find_unit_format(options.format);
  if (format == nullptr) {
    std::string known;
    for (const tools::decode::UnitFormat& each : tools::decode::unit_formats())
      known += fmt::format("{}{}", known.empty() ? "" : ", ", each.name);
    throw ExitError(kExitUsage, fmt::format("'{}' is not a format; allowed: {}", options.format, known));
  }
  if (!format->is_text && !options.is_hex) {
    throw ExitError(kExitUsage, fmt::format("{} is a binary format: write the bytes as hexadecimal digits, {} per "
                                            "line, and give --hex (xxd -p converts a file)",
                                            options.format, format->unit));
  }
  if (const auto colon = options.format.find(':'); colon != std::string::npos) {
    options.decoder.profile = options.format.substr(colon + 1);
  }
  return *format;
}

std::unique_ptr<tools::decode::UnitDecoder> make_decoder(const tools::decode::UnitFormat& format,
                                                         const tools::decode::UnitDecoderOptions& options) {
  try {
    return format.make(options);
  } catch (const std::runtime_error& error) {
    throw ExitError(kExitConfig, error.what());
  }
}

void decode_input(DecodeCommandOptions& options) {
  const tools::decode::UnitFormat& format = format_of(options);
  const auto decoder = make_decoder(format, options.decoder);
  Input input(options.file);
  Output output(options.shows_refused);

  std::vector<std::string> first_lines;  // which another format may read
  std::string_view text;                 // of the present message
  const auto outcome = [&](const tools::decode::UnitDecoder::Outcome& decoded) {
    if (decoded) {
      output.reading(*decoded);
    } else {
      output.refusal(decoded.error().why, decoded.error().detail, text);
    }
  };
  const auto message = [&](const tools::decode::ReadUnit& unit) {
    if (unit.why) return output.refusal(*unit.why, unit.detail, unit.text);
    text = unit.text;
    constexpr std::size_t kLinesToRecognise = 200;
    if (format.is_text && first_lines.size() < kLinesToRecognise)
      first_lines.emplace_back(reinterpret_cast<const char*>(unit.bytes.data()), unit.bytes.size());
    decoder->take({unit.bytes, unit.request}, outcome);
  };

  using Form = tools::decode::UnitReader::Form;
  const Form form = !options.is_hex ? Form::kLines : format.is_text ? Form::kHexLines : Form::kHexFrames;
  tools::decode::UnitReader reader(form, format.ending, format.longest_line);
  for (drivers::decode::ByteSpan bytes = input.read_some(); !bytes.empty(); bytes = input.read_some())
    reader.feed(bytes, message);
  reader.finish(message);
  text = {};
  decoder->finish(outcome);
  output.summary();
  if (output.readings() > 0) return;
  if (const std::string other = tools::decode::recognised_text(first_lines); !other.empty())
    fmt::print(stderr, "decode: the format {} reads them\n", other);
}

std::string footer() {
  std::string text =
      "Each reading is one JSON object per line: speed_m_s, direction_deg and gust_m_s (null if the message has "
      "none),\n"
      "reference (of the direction: relative, true, north or magnetic, if the message has it), status (good, "
      "uncertain).\n"
      "Counters also give count and volts. With --refused, a refused message gives an object with refused (the "
      "reason),\n"
      "detail and input.\n"
      "\n"
      "Formats, and an example of each:\n";
  for (const tools::decode::UnitFormat& format : tools::decode::unit_formats()) {
    text += fmt::format("  {:<15} {}\n{:18}{}: {}\n{:18}yuragi decode {}\n", format.name, format.devices, "",
                        format.is_text ? "text" : "bytes", format.unit, "", format.example);
  }
  text +=
      "Text can be given as hexadecimal digits, too (--hex). Standard input can be endless:\n"
      "  tail -f voyage.log | yuragi decode nmea | jq .speed_m_s\n"
      "Exit code 0: the input was read to its end, even if messages were refused; 64: wrong command line; 66: the "
      "input cannot "
      "be\n"
      "read; 78: the Modbus profile is missing or wrong.";
  return text;
}

void add_decode(CLI::App& app) {
  CLI::App* command = app.add_subcommand("decode", "decode a sensor's messages from a file or pipe, as the drivers do");
  command->footer(footer());
  auto options = std::make_shared<DecodeCommandOptions>();
  options->add_to(*command);
  command->callback([options] {
    options->check();
    decode_input(*options);
  });
}

}  // namespace

extern const Command kDecodeCommand;
const Command kDecodeCommand{add_decode};

}  // namespace yuragi::daemon::commands
