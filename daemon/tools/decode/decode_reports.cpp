// `yuragi decode wmr100`, `te923` and `fineoffset` with --reports: input reports of 8 bytes, as received
// over USB, are joined to the messages that the drivers' decoders read.
#include <algorithm>
#include <array>
#include <vector>

#include "daemon/tools/decode/decode_formats.hpp"
#include "drivers/decode/hid/fineoffset.hpp"
#include "drivers/decode/hid/te923.hpp"
#include "drivers/decode/hid/wmr100.hpp"

namespace yuragi::daemon::tools::decode {
namespace {

constexpr std::size_t kStationReport = 8;

bool is_report(const RawUnit& unit, const UnitDecoder::Sink& sink) {
  if (unit.bytes.size() == kStationReport) return true;
  const bool is_short = unit.bytes.size() < kStationReport;
  sink(UnitRefusal{is_short ? drivers::decode::Refusal::kTooShort : drivers::decode::Refusal::kMalformed,
                   "a report has 8 bytes"});
  return false;
}

/// Each report has the number of valid bytes, then these: they form one stream.
class Wmr100Reports final : public UnitDecoder {
 public:
  explicit Wmr100Reports(std::unique_ptr<UnitDecoder> stream) : stream_(std::move(stream)) {}

  void take(const RawUnit& unit, const Sink& sink) override {
    if (is_report(unit, sink)) stream_->take({drivers::decode::hid::wmr100_report_bytes(unit.bytes), {}}, sink);
  }
  void finish(const Sink& sink) override { stream_->finish(sink); }

 private:
  std::unique_ptr<UnitDecoder> stream_;
};

/// The same, in blocks of 34 bytes, each after a request.
class Te923Reports final : public UnitDecoder {
 public:
  void take(const RawUnit& unit, const Sink& sink) override {
    if (!is_report(unit, sink)) return;
    if (!unit.request.empty()) finish(sink);
    const drivers::decode::ByteSpan valid = drivers::decode::hid::wmr100_report_bytes(unit.bytes);
    block_.insert(block_.end(), valid.begin(), valid.end());
    if (block_.size() >= drivers::decode::hid::kTe923Block) finish(sink);
  }

  /// The received part of a block.
  void finish(const Sink& sink) override {
    if (block_.empty()) return;
    sink(outcome_of(drivers::decode::hid::decode_te923(block_)));
    block_.clear();
  }

 private:
  std::vector<std::uint8_t> block_;
};

/// Four reports are a block of the console's memory, whose address is in the request before the first of them. The
/// fixed block at 0 contains the address of the current record.
class FineOffsetReports final : public UnitDecoder {
 public:
  void take(const RawUnit& unit, const Sink& sink) override {
    if (!is_report(unit, sink)) return;
    if (unit.request.size() == kStationReport) {
      size_ = 0;
      address_ = drivers::decode::big_endian_16(unit.request, 1);
    }
    if (!address_)
      return sink(
          UnitRefusal{drivers::decode::Refusal::kMalformed, "no request: write request | first report on one line"});
    std::ranges::copy(unit.bytes, block_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += unit.bytes.size();
    if (size_ < block_.size()) return;
    take_block(*address_, sink);
    address_.reset();
  }

 private:
  void take_block(std::uint16_t address, const Sink& sink) {
    if (address == 0) {
      auto fixed =
          drivers::decode::hid::decode_fineoffset_fixed_block(block_, drivers::decode::hid::FineOffsetModel::kWh1080);
      if (!fixed)
        fixed =
            drivers::decode::hid::decode_fineoffset_fixed_block(block_, drivers::decode::hid::FineOffsetModel::kWh3080);
      if (!fixed) return sink(UnitRefusal{fixed.error(), "the fixed block"});
      position_ = fixed->current_position;
      return;
    }
    // The record may begin in one block and end in the next.
    constexpr std::size_t kRecord = 16;
    const bool goes_on = !memory_.empty() && memory_address_ + memory_.size() == address;
    if (!goes_on) {
      memory_.clear();
      memory_address_ = address;
    }
    memory_.insert(memory_.end(), block_.begin(), block_.end());
    if (memory_.size() > 2 * block_.size()) {
      memory_.erase(memory_.begin(), memory_.begin() + static_cast<std::ptrdiff_t>(block_.size()));
      memory_address_ += block_.size();
    }
    const bool holds_record =
        position_ && memory_address_ <= *position_ && *position_ + kRecord <= memory_address_ + memory_.size();
    if (!holds_record) return;
    sink(outcome_of(drivers::decode::hid::decode_fineoffset_record(
        drivers::decode::ByteSpan(memory_).subspan(*position_ - memory_address_, kRecord))));
    memory_.clear();
  }

  std::array<std::uint8_t, drivers::decode::hid::kFineOffsetBlock> block_{};
  std::size_t size_ = 0;
  std::optional<std::uint16_t> address_;   ///< of the block being received
  std::optional<std::uint16_t> position_;  ///< of the current record
  std::vector<std::uint8_t> memory_;       ///< the last block or two
  std::size_t memory_address_ = 0;
};

}  // namespace

std::unique_ptr<UnitDecoder> make_wmr100_reports_decoder(std::unique_ptr<UnitDecoder> stream) {
  return std::make_unique<Wmr100Reports>(std::move(stream));
}

std::unique_ptr<UnitDecoder> make_te923_reports_decoder() {
  return std::make_unique<Te923Reports>();
}

std::unique_ptr<UnitDecoder> make_fineoffset_reports_decoder() {
  return std::make_unique<FineOffsetReports>();
}

}  // namespace yuragi::daemon::tools::decode
