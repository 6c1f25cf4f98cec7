#include "daemon/tools/csv/csv_resample.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_text.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

/// Vectors that cancel out to less than this part of their lengths have no direction.
constexpr double kMinPartOfDirection = 1e-9;

/// A sensor's readings in one block.
struct Block {
  std::size_t count = 0;
  double speed_sum_m_s = 0.0;
  double directed_speed_sum_m_s = 0.0;
  wind::Vector sum{};
  double gust_m_s = 0.0;

  void add(const wind::Reading& reading) {
    ++count;
    speed_sum_m_s += reading.speed_m_s;
    gust_m_s = std::max({gust_m_s, reading.speed_m_s, reading.gust_m_s.value_or(0.0)});
    if (!reading.direction_deg) return;
    directed_speed_sum_m_s += reading.speed_m_s;
    sum = sum + wind::wind_from(reading.speed_m_s, *reading.direction_deg);
  }

  std::optional<double> direction_deg() const {
    const double length_m_s = wind::speed_of(sum);
    if (length_m_s <= kMinPartOfDirection * directed_speed_sum_m_s) return std::nullopt;
    return wind::direction_from_deg(sum);
  }
};

/// The sensors' names in the order of the recording, and the name of each of its sensors.
struct Names {
  explicit Names(const drivers::windlog::Reader& reader) {
    std::map<std::string, std::size_t> known;
    for (const auto& sensor : reader.sensors()) {
      const auto [place, is_new] = known.emplace(sensor.name, names.size());
      if (is_new) names.push_back(sensor.name);
      of_sensor.push_back(place->second);
    }
  }

  std::vector<std::string> names;
  std::vector<std::size_t> of_sensor;
};

/// UTC less log time, by the clock of the session at `from`, as it was at its end.
Nanoseconds utc_at_log_time_zero(const drivers::windlog::Reader& reader, Nanoseconds from) {
  const auto sessions = reader.sessions();
  if (sessions.empty()) return Nanoseconds{0};
  const auto found = std::ranges::find_if(sessions, [from](const auto& session) { return session.log_end() >= from; });
  const auto& session = found == sessions.end() ? sessions.back() : *found;
  return session.last.utc.time_since_epoch() - session.log_end();
}

Nanoseconds floor_to(Nanoseconds time, Nanoseconds interval) {
  const Nanoseconds rest = time % interval;
  return time - rest - (rest < Nanoseconds{0} ? interval : Nanoseconds{0});
}

void append_block(std::string& text, UtcTime utc, Nanoseconds log_time, const std::string& sensor, const Block& block) {
  append_utc(text, utc);
  text += ',';
  // The first block begins before the first reading, at a log time below 0.
  if (log_time < Nanoseconds{0}) text += '-';
  append_log_time(text, log_time < Nanoseconds{0} ? -log_time : log_time);
  text += ',';
  append_text(text, sensor);
  if (block.count == 0) {
    text += ",,,,0\n";
    return;
  }
  text += ',';
  append_number(text, block.speed_sum_m_s / static_cast<double>(block.count));
  text += ',';
  append_number(text, block.direction_deg());
  text += ',';
  append_number(text, block.gust_m_s);
  text += fmt::format(",{}\n", block.count);
}

}  // namespace

Result<ExportReport, Failure> resample_csv(drivers::windlog::Reader& reader, const ExportRange& range,
                                           Nanoseconds interval, std::FILE* out,
                                           const std::function<void(std::size_t)>& progress) {
  const Names sensors(reader);
  const Nanoseconds utc_at_zero = utc_at_log_time_zero(reader, range.from);
  const Nanoseconds from = std::min(range.from, reader.duration());
  const Nanoseconds span = std::min(range.to, reader.duration()) - from;
  const std::int64_t rows = (span / interval + 2) * static_cast<std::int64_t>(sensors.names.size());
  if (rows > static_cast<std::int64_t>(kMaxResampledRows)) {
    return Failure{fmt::format("{}: this would be a table of {} rows; at most {} are written: choose longer blocks, or "
                               "a part of the recording",
                               reader.file().string(), rows, kMaxResampledRows),
                   FailureKind::kUsage};
  }

  ExportReport report;
  std::string text(kResampledHeader);
  text += '\n';
  std::vector<Block> blocks(sensors.names.size());
  const auto flush = [&]() -> Result<void, Failure> {
    if (const auto done = write_out(text, out); !done) return done.error();
    if (progress) progress(report.written);
    return {};
  };

  reader.seek(range.from);
  std::optional<Nanoseconds> begin;  // of the present block, in log time
  const auto end_block = [&]() -> Result<void, Failure> {
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      append_block(text, UtcTime(utc_at_zero + *begin), *begin, sensors.names[i], blocks[i]);
    }
    report.rows += blocks.size();
    std::ranges::fill(blocks, Block{});
    *begin += interval;
    if (text.size() < kCsvBufferBytes) return {};
    return flush();
  };
  for (;;) {
    const auto logged = reader.next();
    if (!logged) return logged.error();
    if (!*logged || (*logged)->log_time >= range.to) break;
    const Nanoseconds log_time = (*logged)->log_time;
    if (!begin) begin = floor_to(utc_at_zero + log_time, interval) - utc_at_zero;
    while (log_time >= *begin + interval) {
      if (const auto done = end_block(); !done) return done.error();
    }
    blocks[sensors.of_sensor[(*logged)->sensor]].add((*logged)->reading);
    ++report.written;
  }
  if (begin) {
    if (const auto done = end_block(); !done) return done.error();
  }
  if (const auto done = flush(); !done) return done.error();
  report.skipped = reader.skipped();
  return report;
}

}  // namespace yuragi::daemon::tools::csv
