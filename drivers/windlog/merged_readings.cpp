#include "drivers/windlog/merged_readings.hpp"

#include <algorithm>
#include <utility>

namespace yuragi::drivers::windlog {

MergedReadings::MergedReadings(sqlite::Database* database, std::vector<std::unique_ptr<ReadingBlocks>> streams)
    : database_(database) {
  for (std::unique_ptr<ReadingBlocks>& blocks : streams) streams_.push_back({.blocks = std::move(blocks)});
}

void MergedReadings::seek(Nanoseconds log_time) {
  skipped_ = 0;
  ended_ = 0;
  for (Stream& stream : streams_) {
    stream.blocks->seek(log_time);
    stream.block.clear();
    stream.next = 0;
  }
}

Result<std::optional<LoggedReading>, Failure> MergedReadings::next() {
  const auto used_up = static_cast<std::size_t>(std::ranges::count_if(streams_, &Stream::is_used_up));
  if (used_up > ended_ || used_up == streams_.size()) {
    if (const auto filled = refill(); !filled) return filled.error();
  }
  Stream* earliest = nullptr;
  for (Stream& stream : streams_) {
    if (stream.is_used_up()) continue;
    if (earliest == nullptr || stream.block[stream.next].log_time < earliest->block[earliest->next].log_time) {
      earliest = &stream;
    }
  }
  if (earliest == nullptr) return std::optional<LoggedReading>{};
  return std::optional(earliest->block[earliest->next++]);
}

/// Reads on if a block is used up, at one moment of the file: a reading that another process commits meanwhile would
/// otherwise be merged after later ones.
Result<void, Failure> MergedReadings::refill() {
  if (database_ != nullptr) {
    if (auto begun = database_->run("BEGIN"); !begun) return begun;
  }
  Result<void, Failure> read = {};
  ended_ = 0;
  for (Stream& stream : streams_) {
    if (!stream.is_used_up()) continue;
    stream.next = 0;
    read = stream.blocks->read(stream.block, skipped_);
    if (!read) break;
    if (stream.block.empty()) ++ended_;
  }
  if (database_ != nullptr && database_->in_transaction()) static_cast<void>(database_->run("ROLLBACK"));
  return read;
}

}  // namespace yuragi::drivers::windlog
