#include "daemon/tools/logs/log_import.hpp"

#include <algorithm>
#include <istream>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_input.hpp"
#include "daemon/tools/csv/csv_lines.hpp"
#include "daemon/tools/logs/log_time.hpp"
#include "daemon/tools/logs/message_finder.hpp"
#include "drivers/windlog/windlog_writer.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::tools::logs {
namespace {

namespace decode = drivers::decode;

std::string_view text_of(csv::Lines& lines) {
  const std::span<char> line = lines.line();
  return {line.data(), line.size()};
}

/// The winds of one source.
struct Source {
  std::string name = {};
  std::size_t winds = 0;
  std::size_t with_time = 0;
};

/// The content of a log, before one of its sources is chosen.
struct Contents {
  std::vector<Source> sources;  ///< in the order in which they come first
  std::size_t leading_times = 0;
  std::size_t own_times = 0;
  std::size_t times_of_day = 0;
  std::size_t messages = 0;
  std::size_t lines = 0;
  std::map<decode::Refusal, std::size_t> refusals;  ///< of messages without a wind
  bool has_clock = false;

  Source* find(std::string_view name) {
    const auto found = std::ranges::find(sources, name, &Source::name);
    return found == sources.end() ? nullptr : &*found;
  }
};

Contents contents_of(std::istream& in, const Options& options) {
  Contents contents;
  csv::Lines lines(in, 0);
  NmeaClock clock;
  MessageFinder finder(options.table);
  const auto count = [&](const std::optional<Message>& message) {
    if (!message) return;
    if (!message->wind) ++contents.refusals[message->wind.error()];
    if (!message->wind || !message->wind->speed_m_s) return;
    ++contents.messages;
    const bool has_leading_time = leading_time(message->prefix, options.table.time_format).has_value();
    if (has_leading_time) ++contents.leading_times;
    if (message->time) ++contents.own_times;
    if (message->time_of_day) ++contents.times_of_day;
    Source* source = contents.find(message->source);
    constexpr std::size_t kMaxSources = 100;
    if (source == nullptr) {
      if (contents.sources.size() == kMaxSources) return;
      source = &contents.sources.emplace_back(Source{.name = message->source});
    }
    ++source->winds;
    if (has_leading_time || message->time || message->time_of_day) ++source->with_time;
  };
  while (lines.next()) {
    ++contents.lines;
    if (clock.take(text_of(lines))) contents.has_clock = true;
    count(finder.find(text_of(lines)));
  }
  count(finder.finish());
  return contents;
}

/// Less is better: angles from north, from the device's own mark, with its motion taken out.
int rank_of(std::string_view source) {
  constexpr std::array<std::string_view, 13> kOrder = {"MWD",      "north", "MDA",      "MWV R", "relative",
                                                       "apparent", "VWR",   "magnetic", "MWV T", "true",
                                                       "ground",   "VWT",   "XDR"};
  const auto* const found =
      std::ranges::find_if(kOrder, [&](std::string_view name) { return source.find(name) != std::string_view::npos; });
  return static_cast<int>(found - kOrder.begin());
}

/// The best of those that the log has half as often as any, or more; of those as good the first, but one without times
/// after one with them. Nullptr: none is wanted.
const Source* chosen_source(const Contents& contents, const Options& options) {
  const auto is_wanted = [&](const Source& source) {
    return options.sentence.empty() || source.name.starts_with(options.sentence);
  };
  std::size_t most = 0;
  for (const Source& source : contents.sources) {
    if (is_wanted(source)) most = std::max(most, source.winds);
  }
  const Source* chosen = nullptr;
  for (const Source& source : contents.sources) {
    if (!is_wanted(source) || 2 * source.winds < most) continue;
    const auto key = [](const Source& each) { return std::tuple(-rank_of(each.name), each.with_time, each.winds); };
    if (chosen == nullptr || key(source) > key(*chosen)) chosen = &source;
  }
  return chosen;
}

/// Where the times of readings come from.
enum class TimeSource : std::uint8_t { kStart, kLeading, kOwn, kClock, kTimeOfDay };

std::optional<TimeSource> time_source_of(const Contents& contents, const Options& options) {
  if (options.start && options.interval) return TimeSource::kStart;
  if (2 * contents.leading_times > contents.messages) return TimeSource::kLeading;
  if (2 * contents.own_times > contents.messages) return TimeSource::kOwn;
  if (contents.has_clock) return TimeSource::kClock;
  if (options.start && 2 * contents.times_of_day > contents.messages) return TimeSource::kTimeOfDay;
  return std::nullopt;
}

class Import {
 public:
  Import(const std::string& name, const Options& options, const csv::Sinks& sinks, std::string source,
         TimeSource time_source)
      : name_(name),
        options_(options),
        sinks_(sinks),
        source_(std::move(source)),
        time_source_(time_source),
        finder_(options.table) {}

  Result<csv::ImportReport, Failure> run(std::istream& in) {
    csv::Lines lines(in, 0);
    while (lines.next()) {
      const std::string_view line = text_of(lines);
      clock_.take(line);
      const auto message = finder_.find(line);
      if (!message && finder_.has_absorbed()) continue;
      if (!take_message(message, lines.number())) return Failure{report_.first_refusals.front()};
    }
    if (lines.is_too_long()) return csv::too_long_line(name_, lines.number() + 1);
    if (const auto last = finder_.finish(); last && !take_message(last, lines.number()))
      return Failure{report_.first_refusals.front()};
    report_.columns = finder_.describe(source_);
    if (same_time_ > 0) {
      report_.notes.push_back("the same time as the one before: " + count_text(same_time_, "reading") +
                              ", kept a nanosecond apart");
    }
    if (passed_over_ > 0) report_.notes.push_back("something else: " + count_text(passed_over_, "line"));
    return std::move(report_);
  }

 private:
  /// False if it is refused, and that ends the import.
  bool take_message(const std::optional<Message>& message, std::size_t line) {
    if (!message || (message->source != source_ && !message->quantities)) {
      ++passed_over_;
      return true;
    }
    if (message->source != source_ ||
        (!message->wind && message->wind.error() == decode::Refusal::kNotMine && message->quantities)) {
      take_quantities(*message);
      return true;
    }
    ++report_.rows;
    const auto taken = take(*message);
    if (taken) return true;
    report_.refuse(name_, line, taken.error());
    return !options_.table.strict;
  }

  Result<UtcTime, csv::RowRefusal> time_of(const Message& message) {
    if (time_source_ == TimeSource::kStart)
      return *options_.start + *options_.interval * static_cast<std::int64_t>(report_.rows - 1);
    if (time_source_ == TimeSource::kClock) {
      if (!clock_.now()) return csv::RowRefusal{"no time has been received yet"};
      return *clock_.now();
    }
    if (time_source_ == TimeSource::kTimeOfDay) {
      if (!message.time_of_day) return csv::RowRefusal{"no time in the message"};
      return on_day(*message.time_of_day);
    }
    const bool is_leading = time_source_ == TimeSource::kLeading;
    const auto written = is_leading ? leading_time(message.prefix, options_.table.time_format) : message.time;
    if (!written) return csv::RowRefusal{is_leading ? "no time before the message" : "no time in the message"};
    if (written->utc_offset) return written->clock - *written->utc_offset;
    const auto utc = options_.table.zone.value_or(csv::Zone()).to_utc(written->clock, last_);
    if (!utc) return csv::RowRefusal{"a time that does not exist in the zone; check --zone"};
    return *utc;
  }

  /// On the day of --start, or, shortly after midnight, on the next one.
  UtcTime on_day(Nanoseconds time_of_day) const {
    constexpr Nanoseconds kDay = std::chrono::hours(24);
    UtcTime time = std::chrono::floor<std::chrono::days>(last_.value_or(*options_.start)) + time_of_day;
    if (last_ && *last_ - time > kDay / 2) time += kDay;
    return time;
  }

  Result<void, csv::RowRefusal> take(const Message& message) {
    if (!message.wind) return csv::RowRefusal{std::string(name_of(message.wind.error()))};
    if (!message.wind->speed_m_s) return csv::RowRefusal{"no speed"};
    const auto utc = time_of(message);
    if (!utc) return utc.error();
    if (last_ && *utc < *last_) return csv::RowRefusal{"time goes back"};
    wind::Reading reading;
    reading.time = {MonoTime(*utc - first_.value_or(*utc)), *utc};
    reading.speed_m_s = *message.wind->speed_m_s;
    reading.direction_deg = message.wind->direction_deg;
    reading.gust_m_s = message.wind->gust_m_s;
    if (message.wind->status == decode::DecodedStatus::kUncertain) reading.quality = wind::ReadingQuality::kUncertain;
    if (!drivers::windlog::is_recordable(reading)) return csv::RowRefusal{"time out of range"};
    if (last_ == *utc) ++same_time_;
    if (!first_) first_ = *utc;
    last_ = *utc;
    last_time_ = reading.time;
    sinks_.reading(options_.table.sensor, reading);
    ++report_.taken;
    take_quantities(message);
    return {};
  }

  /// At the time of the last reading.
  void take_quantities(const Message& message) {
    if (!message.quantities || report_.taken == 0) return;
    wind::StationQuantities quantities = *message.quantities;
    quantities.time = last_time_;
    const auto plausible = wind::plausible_part(quantities);
    if (!plausible) return;
    ++report_.quantities;
    if (sinks_.quantities) sinks_.quantities(options_.table.sensor, *plausible);
  }

  const std::string& name_;
  const Options& options_;
  const csv::Sinks& sinks_;
  std::string source_;
  TimeSource time_source_;
  MessageFinder finder_;
  NmeaClock clock_;
  std::optional<UtcTime> first_;
  std::optional<UtcTime> last_;
  Instant last_time_;
  std::size_t same_time_ = 0;
  std::size_t passed_over_ = 0;
  csv::ImportReport report_;
};

}  // namespace

bool looks_like_log(const std::vector<std::string>& lines, const csv::ImportOptions& options) {
  std::size_t messages = 0;
  std::size_t others = 0;
  MessageFinder finder(options);
  for (const std::string& line : lines) {
    if (line.empty() || line.starts_with('#')) continue;
    const auto message = finder.find(line);
    if (!message && (finder.has_absorbed() || finder.has_keys())) continue;
    ++(message ? messages : others);
  }
  if (finder.finish()) ++messages;
  return messages > others;
}

Result<csv::ImportReport, Failure> import_log(csv::Input& input, const std::string& name, const Options& options,
                                              const csv::Sinks& sinks) {
  const Contents contents = contents_of(input.first_pass(), options);
  if (contents.messages == 0) {
    std::string refused;
    for (const auto& [why, count] : contents.refusals)
      refused += fmt::format("{}{} {}", refused.empty() ? "; messages without a wind: " : ", ", count, name_of(why));
    return Failure{fmt::format("{}: no line has a wind{}; {} are understood", name, refused, kMessagesThatAreFound)};
  }
  const Source* const source = chosen_source(contents, options);
  if (source == nullptr) return Failure{name + ": no line has the sentence " + options.sentence + " with a speed"};
  const auto time_source = time_source_of(contents, options);
  if (!time_source) {
    const std::string found = fmt::format("{}: {} from {} in {}", name, count_text(source->winds, "wind"), source->name,
                                          count_text(contents.lines, "line"));
    if (2 * contents.times_of_day > contents.messages)
      return Failure{found + ", with the time of the day alone; add --start with the first day (--start 2023-06-25)"};
    return Failure{found +
                   ", but no time was found, neither before the messages, nor in them, nor in RMC or ZDA; add --start "
                   "2023-06-25T22:00:00Z --interval 1 (or --time-format day-first or month-first, if a time stands "
                   "before them)"};
  }
  auto report = Import(name, options, sinks, source->name, *time_source).run(input.second_pass());
  if (!report) return report;
  std::vector<std::string> columns = {
      fmt::format("{}: {} in {}", source->name, count_text(source->winds, "wind"), count_text(contents.lines, "line"))};
  columns.insert(columns.end(), report->columns.begin(), report->columns.end());
  for (const Source& each : contents.sources) {
    if (&each != source)
      columns.push_back(fmt::format("not taken: {} ({} of them; --sentence)", each.name, each.winds));
  }
  const std::string zone = fmt::format(", in {} if it names no zone", options.table.zone.value_or(csv::Zone()).name());
  switch (*time_source) {
    case TimeSource::kStart:
      columns.emplace_back("time from --start and --interval");
      break;
    case TimeSource::kLeading:
      columns.push_back("time from before the messages" + zone);
      break;
    case TimeSource::kOwn:
      columns.push_back("time from the messages" + zone);
      break;
    case TimeSource::kTimeOfDay:
      columns.emplace_back("time from the messages, the day from --start");
      break;
    case TimeSource::kClock:
      columns.emplace_back("time from RMC, ZDA, GLL or GGA, which may be up to their interval old");
      break;
  }
  report->columns = std::move(columns);
  return report;
}

}  // namespace yuragi::daemon::tools::logs
