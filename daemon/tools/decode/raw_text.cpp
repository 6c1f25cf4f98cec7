#include "daemon/tools/decode/raw_text.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "daemon/tools/decode/hex_text.hpp"

namespace yuragi::daemon::tools::decode {
namespace {

/// "20:40:01.123"
std::string time_of_day(std::int64_t utc_ns) {
  constexpr std::int64_t kPerDay_ms = std::int64_t{24} * 3600 * 1000;
  const std::int64_t utc_ms = utc_ns / 1'000'000;
  const std::int64_t day_ms = ((utc_ms % kPerDay_ms) + kPerDay_ms) % kPerDay_ms;
  return fmt::format("{:02}:{:02}:{:02}.{:03}", day_ms / 3'600'000, day_ms / 60'000 % 60, day_ms / 1000 % 60,
                     day_ms % 1000);
}

}  // namespace

std::string raw_text(const wire::RawTrace& trace) {
  constexpr std::size_t kBytesALine = 16;
  std::string text;
  const auto out = std::back_inserter(text);
  if (trace.lost > 0) fmt::format_to(out, "... {} messages of {:.40} were skipped\n", trace.lost, trace.sensor);

  // Only the first line has the time and the sensor.
  std::string margin =
      fmt::format("{} {:<12.12} {} ", time_of_day(trace.utc_ns), trace.sensor, trace.received ? "<-" : "->");
  const std::span<const std::uint8_t> bytes = trace.bytes;
  std::size_t at = 0;
  do {
    const auto here = bytes.subspan(at, std::min(kBytesALine, bytes.size() - at));
    fmt::format_to(out, "{}{:<47}  {}\n", margin, to_hex(here), to_printable(here));
    margin.assign(margin.size(), ' ');
    at += here.size();
  } while (at < bytes.size());
  if (trace.length > bytes.size())
    fmt::format_to(out, "{}... and {} bytes more\n", margin, trace.length - bytes.size());
  return text;
}

std::string RawHexLines::line_of(const wire::RawTrace& trace) {
  if (!trace.received) {
    sensor_ = trace.sensor;
    request_ = trace.bytes;
    return {};
  }
  const bool is_reply = !request_.empty() && sensor_ == trace.sensor;
  std::string line = is_reply ? to_hex(request_) + " | " : "";
  request_.clear();
  return line + to_hex(trace.bytes) + "\n";
}

}  // namespace yuragi::daemon::tools::decode
