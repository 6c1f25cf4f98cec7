#include "daemon/recording/retention.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#include "daemon/recording/clock_judge.hpp"

namespace yuragi::daemon::recording {

bool is_complete(const settings::RecordingConfig& rules, UtcTime begin, std::uint64_t bytes, UtcTime now) {
  const bool is_of_a_later_day =
      std::chrono::floor<std::chrono::days>(now) > std::chrono::floor<std::chrono::days>(begin);
  const bool is_set_back = now + kMaxClockStep < begin;
  return (rules.is_daily && (is_of_a_later_day || is_set_back)) ||
         (rules.most_file_bytes > 0 && bytes > rules.most_file_bytes);
}

settings::RecordingConfig with_room_to_grow(settings::RecordingConfig rules) {
  rules.most_bytes -= std::min(kGrowthBetweenLooks_bytes, rules.most_bytes / 4);
  const std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max();
  if (rules.least_free_bytes > 0) {
    rules.least_free_bytes += std::min(kGrowthBetweenLooks_bytes, most_bytes - rules.least_free_bytes);
  }
  return rules;
}

std::vector<PartToDelete> parts_to_delete(const settings::RecordingConfig& rules, std::span<const KeptPart> parts,
                                          std::uint64_t written_bytes, std::uint64_t free_bytes, UtcTime now,
                                          std::size_t max_by_age) {
  std::uint64_t total_bytes = written_bytes;
  for (const KeptPart& part : parts) total_bytes += part.bytes;
  std::vector<PartToDelete> deleted;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const KeptPart& part = parts[i];
    const UtcTime end = i + 1 < parts.size() ? parts[i + 1].begin : now;
    const bool is_old = rules.keep_days > 0 && now - end > std::chrono::days(rules.keep_days);
    const bool are_too_large = rules.most_bytes > 0 && total_bytes > rules.most_bytes;
    const bool is_by_age = !are_too_large && free_bytes >= rules.least_free_bytes;
    if (is_by_age && (!is_old || max_by_age-- == 0)) break;
    deleted.push_back({part.file, is_by_age});
    total_bytes -= part.bytes;
    free_bytes += part.bytes;
  }
  return deleted;
}

}  // namespace yuragi::daemon::recording
