#include "daemon/tools/csv/line_log_import.hpp"

#include <algorithm>
#include <istream>
#include <map>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_input.hpp"
#include "daemon/tools/csv/csv_lines.hpp"
#include "daemon/tools/csv/line_log_message.hpp"
#include "daemon/tools/csv/line_log_time.hpp"
#include "drivers/windlog/windlog_writer.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

namespace decode = drivers::decode;

std::string_view text_of(Lines& lines) {
  const std::span<char> line = lines.line();
  return {line.data(), line.size()};
}

/// The content of a log, before one of its sources is chosen.
struct LogContents {
  std::map<std::string, std::size_t, std::less<>> sources;  ///< readings with a speed, by source
  std::size_t leading_times = 0;
  std::size_t messages = 0;
  bool has_clock = false;
};

LogContents contents_of(std::istream& in, const LineLogOptions& options) {
  LogContents contents;
  Lines lines(in, 0);
  NmeaClock clock;
  while (lines.next()) {
    if (clock.take(text_of(lines))) contents.has_clock = true;
    const auto message = find_message(text_of(lines));
    if (!message || !message->wind || !message->wind->speed_m_s) continue;
    ++contents.messages;
    if (leading_time(message->prefix, options.time_format)) ++contents.leading_times;
    constexpr std::size_t kMaxSources = 100;
    const bool is_new = contents.sources.size() < kMaxSources;
    if (is_new || contents.sources.contains(message->source)) ++contents.sources[message->source];
  }
  return contents;
}

/// Less is better: angles from north, from the device's own mark, with its motion taken out.
int rank_of(std::string_view source) {
  constexpr std::array<std::string_view, 8> kOrder = {"MWD", "MDA", "MWV R", "VWR", "MWV T", "VWT", "XDR", ""};
  const auto* const found =
      std::ranges::find_if(kOrder, [&](std::string_view name) { return source.starts_with(name); });
  return static_cast<int>(found - kOrder.begin());
}

/// The best of those that the log has half as often as any, or more.
std::string chosen_source(const LogContents& contents, const LineLogOptions& options) {
  const auto is_wanted = [&](std::string_view source) {
    return options.sentence.empty() || source.starts_with(options.sentence);
  };
  std::size_t most = 0;
  for (const auto& [source, count] : contents.sources) {
    if (is_wanted(source)) most = std::max(most, count);
  }
  std::string chosen;
  for (const auto& [source, count] : contents.sources) {
    if (!is_wanted(source) || 2 * count < most) continue;
    if (chosen.empty() || rank_of(source) < rank_of(chosen)) chosen = source;
  }
  return chosen;
}

class LogImport {
 public:
  LogImport(const std::string& name, const LineLogOptions& options, const Sinks& sinks, std::string source,
            bool has_leading_times)
      : name_(name),
        options_(options),
        sinks_(sinks),
        source_(std::move(source)),
        has_leading_times_(has_leading_times) {}

  Result<ImportReport, Failure> run(std::istream& in) {
    Lines lines(in, 0);
    while (lines.next()) {
      const std::string_view line = text_of(lines);
      clock_.take(line);
      const auto message = find_message(line);
      if (!message || (message->source != source_ && !message->quantities)) {
        ++passed_over_;
        continue;
      }
      if (message->source != source_) {
        take_quantities(*message);
        continue;
      }
      ++report_.rows;
      const auto taken = take(*message);
      if (!taken) {
        if (report_.first_refusals.size() < ImportReport::kMaxRefusalsListed) {
          report_.first_refusals.push_back(fmt::format("{}:{}: {}", name_, lines.number(), taken.error().message));
        }
        if (options_.strict) return Failure{report_.first_refusals.front()};
      }
    }
    if (lines.is_too_long()) return too_long_line(name_, lines.number() + 1);
    if (same_time_ > 0) {
      report_.notes.push_back("the same time as the one before: " + count_text(same_time_, "reading") +
                              ", kept a nanosecond apart");
    }
    if (passed_over_ > 0) report_.notes.push_back("something else: " + count_text(passed_over_, "line"));
    return std::move(report_);
  }

 private:
  Result<UtcTime, Failure> time_of(const LineLogMessage& message) {
    if (options_.start && options_.interval) {
      return *options_.start + *options_.interval * static_cast<std::int64_t>(report_.rows - 1);
    }
    if (has_leading_times_) {
      const auto written = leading_time(message.prefix, options_.time_format);
      if (!written) return Failure{"no time before the message"};
      if (written->utc_offset) return written->clock - *written->utc_offset;
      const auto utc = options_.zone.value_or(Zone()).to_utc(written->clock, last_);
      if (!utc) return Failure{"a time that does not exist in the zone; check --zone"};
      return *utc;
    }
    if (!clock_.now()) return Failure{"no time has been received yet"};
    return *clock_.now();
  }

  Result<void, Failure> take(const LineLogMessage& message) {
    if (!message.wind) return Failure{std::string(name_of(message.wind.error()))};
    if (!message.wind->speed_m_s) return Failure{"no speed"};
    const auto utc = time_of(message);
    if (!utc) return utc.error();
    if (last_ && *utc < *last_) return Failure{"time goes back"};
    wind::Reading reading;
    reading.time = {MonoTime(*utc - first_.value_or(*utc)), *utc};
    reading.speed_m_s = *message.wind->speed_m_s;
    reading.direction_deg = message.wind->direction_deg;
    reading.gust_m_s = message.wind->gust_m_s;
    if (message.wind->status == decode::DecodedStatus::kUncertain) reading.quality = wind::ReadingQuality::kUncertain;
    if (!drivers::windlog::is_recordable(reading)) return Failure{"time out of range"};
    if (last_ == *utc) ++same_time_;
    if (!first_) first_ = *utc;
    last_ = *utc;
    last_time_ = reading.time;
    sinks_.reading(options_.sensor, reading);
    ++report_.taken;
    take_quantities(message);
    return {};
  }

  /// At the time of the last reading.
  void take_quantities(const LineLogMessage& message) {
    if (!message.quantities || report_.taken == 0) return;
    wind::StationQuantities quantities = *message.quantities;
    quantities.time = last_time_;
    const auto plausible = wind::plausible_part(quantities);
    if (!plausible) return;
    ++report_.quantities;
    if (sinks_.quantities) sinks_.quantities(options_.sensor, *plausible);
  }

  const std::string& name_;
  const LineLogOptions& options_;
  const Sinks& sinks_;
  std::string source_;
  bool has_leading_times_;
  NmeaClock clock_;
  std::optional<UtcTime> first_;
  std::optional<UtcTime> last_;
  Instant last_time_;
  std::size_t same_time_ = 0;
  std::size_t passed_over_ = 0;
  ImportReport report_;
};

}  // namespace

bool looks_like_line_log(const std::vector<std::string>& lines) {
  std::size_t messages = 0;
  std::size_t others = 0;
  for (const std::string& line : lines) {
    if (line.empty() || line.starts_with('#')) continue;
    const auto message = find_message(line);
    const bool is_message = message && (message->source != "keys" || message->wind);
    ++(is_message ? messages : others);
  }
  return messages > others;
}

Result<ImportReport, Failure> import_line_log(Input& input, const std::string& name, const LineLogOptions& options,
                                              const Sinks& sinks) {
  const LogContents contents = contents_of(input.first_pass(), options);
  if (contents.messages == 0) {
    return Failure{name +
                   ": no line has a wind; NMEA 0183, Gill, FT, UMB and \"speed=4.2 direction=270\" are understood"};
  }
  const std::string source = chosen_source(contents, options);
  if (source.empty()) return Failure{name + ": no line has the sentence " + options.sentence + " with a speed"};

  const bool has_leading_times = 2 * contents.leading_times > contents.messages;
  const bool has_start = options.start && options.interval;
  if (!has_leading_times && !contents.has_clock && !has_start) {
    return Failure{name +
                   ": no time was found, neither before the messages nor in RMC or ZDA; add --start "
                   "2023-06-25T22:00:00Z --interval 1 (or --time-format day-first or month-first, if a time stands "
                   "before them)"};
  }
  auto report = LogImport(name, options, sinks, source, has_leading_times).run(input.second_pass());
  if (!report) return report;
  std::vector<std::string> columns = {fmt::format("wind from {} ({} of them)", source, contents.sources.at(source))};
  for (const auto& [each, count] : contents.sources) {
    if (each != source) columns.push_back(fmt::format("not taken: {} ({} of them; --sentence)", each, count));
  }
  columns.push_back(has_start           ? "time from --start and --interval"
                    : has_leading_times ? fmt::format("time from before the messages, in {} if it names no zone",
                                                      options.zone.value_or(Zone()).name())
                                        : "time from RMC, ZDA, GLL or GGA, which may be up to their interval old");
  report->columns = std::move(columns);
  return report;
}

}  // namespace yuragi::daemon::tools::csv
