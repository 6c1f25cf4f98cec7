// Fine Offset WH1080, WH3080 (1941:8021). Sources: weewx fousb.py, pywws weatherstation.py.
//
// A memory of 64 KiB. The output report a1 HH LL 20 a1 HH LL 20 brings the 32 bytes at HHLL, in four input reports;
// a2 HH LL 20 a2 DD 00 20 writes the byte DD there, and brings a5 eight times.
//
//   0x0000  55 aa                        0x0100 ... 0xffff  a ring of records
//   0x0010  minutes between two records  record  0  minutes since the last record was kept
//   0x001b  number of records (2)                9  average, low 8 bits      10  gust, low 8 bits, 0.1 m/s
//   0x001e  address of the current one           11 average, then gust: high 4 bits
//           (2, low byte first)                  12 point of the compass     15 status: 0x40 no contact
//
// Every 48 s the console writes what it measured into the current record, every minute how old that is, and after some
// minutes it goes on to the next one. It writes byte after byte, so a block that is read meanwhile is half old, half
// new.
#include "simulators/usb/fineoffset.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace yuragi::simulators::usb {
namespace {

constexpr std::array kFineOffsetFaults = {
    core::FaultKind::kSilence, core::FaultKind::kFreeze,  core::FaultKind::kSpike, core::FaultKind::kGarbage,
    core::FaultKind::kSplit,   core::FaultKind::kPartial, core::FaultKind::kLate};
constexpr std::size_t kMemory = 0x10000;
constexpr std::uint16_t kFirstRecord = 0x0100;
constexpr std::uint16_t kRecordCountAt = 0x001B;
constexpr std::uint16_t kPositionAt = 0x001E;
constexpr std::uint8_t kMinutesPerRecord = 5;

constexpr double kUpdateEvery_s = 48.0;
constexpr double kMinute_s = 60.0;
constexpr double kFirstUpdate_s = 7.0;  // the two clocks of the console are not in step
constexpr double kFirstMinute_s = 31.0;
constexpr double kNearWriting_s = 3.0;
constexpr double kWriteByte_s = 0.03;
constexpr double kBlockReply_s = 0.02;       // from the request to the first report
constexpr double kBlockReport_s = 0.01;      // from one report to the next
constexpr double kBlockSplitReport_s = 0.3;  // with the fault
constexpr double kBlockLateReply_s = 2.5;    // with the fault: longer than a host's timeout of 1 s

}  // namespace

FineOffset::FineOffset(FineOffsetRecord record, const HidModelOptions& options)
    : HidModel({.vendor = 0x1941,
                .product = 0x8021,
                .manufacturer = "",
                .product_name = "",
                .report_descriptor = plain_report_descriptor(8)},
               kFineOffsetFaults, options),
      record_size_(static_cast<std::uint16_t>(record)),
      memory_(kMemory, 0xFF),
      position_(kFirstRecord),
      next_update_s_(paced(kFirstUpdate_s)),
      next_minute_s_(paced(kFirstMinute_s)) {
  // The fixed block of a console that has been set up, and one record with no message of its sensors yet.
  memory_[0x00] = 0x55;
  memory_[0x01] = 0xAA;
  std::fill(memory_.begin() + 0x10, memory_.begin() + 0x100, std::uint8_t{0});
  memory_[0x10] = kMinutesPerRecord;
  memory_[kRecordCountAt] = 1;
  memory_[kPositionAt + 1] = static_cast<std::uint8_t>(position_ >> 8U);
  memory_[position_ + 15U] = 0x40;
}

void FineOffset::play() {
  if (!has_begun_) {  // the first record is measured, as by a console that has run for a while
    has_begun_ = true;
    std::ranges::copy(measured(), memory_.begin() + position_);
  }
  gust_m_s_ = std::max(gust_m_s_, wind().speed_m_s);
  while (!writes_.empty() && writes_.front().at_s <= now_s()) {
    memory_[writes_.front().address] = writes_.front().value;
    writes_.pop_front();
  }
  if (now_s() >= next_update_s_) {
    next_update_s_ = std::max(next_update_s_ + paced(kUpdateEvery_s), now_s());
    update_current_record();
  }
  if (now_s() >= next_minute_s_) {
    next_minute_s_ = std::max(next_minute_s_ + paced(kMinute_s), now_s());
    end_minute();
  }
}

/// Writes bytes into the memory one after the other, after those that are still being written.
void FineOffset::write(std::uint16_t address, std::span<const std::uint8_t> bytes) {
  double at_s = writes_.empty() ? now_s() : std::max(now_s(), writes_.back().at_s);
  for (const std::uint8_t byte : bytes) {
    at_s += kWriteByte_s;
    writes_.push_back({at_s, address++, byte});
  }
  last_write_s_ = at_s;
}

std::vector<std::uint8_t> FineOffset::measured() const {
  const auto average = static_cast<unsigned>(std::lround(10.0 * wind().speed_m_s));
  const auto gust = static_cast<unsigned>(std::lround(10.0 * std::max(gust_m_s_, wind().speed_m_s)));
  std::vector<std::uint8_t> record(record_size_, 0x00);
  constexpr std::array<std::uint8_t, 9> kIndoorsAndOut = {0, 45, 200, 0, 58, 120, 0, 0xA4, 0x27};
  std::ranges::copy(kIndoorsAndOut, record.begin());
  record[0] = delay_min_;
  record[9] = static_cast<std::uint8_t>(average & 0xFFU);
  record[10] = static_cast<std::uint8_t>(gust & 0xFFU);
  record[11] = static_cast<std::uint8_t>(((gust >> 8U) << 4U) | (average >> 8U));
  record[12] = static_cast<std::uint8_t>(compass_point(wind().direction_deg));
  return record;
}

void FineOffset::update_current_record() {
  write(position_, measured());
  gust_m_s_ = 0.0;
}

/// At the end of a minute: the current record is a minute older, or it is stored and a new one begins.
void FineOffset::end_minute() {
  ++delay_min_;
  if (delay_min_ < kMinutesPerRecord) {
    write(position_, std::array{delay_min_});
    return;
  }
  delay_min_ = 0;
  const unsigned next = position_ + 2U * record_size_ > kMemory ? kFirstRecord : position_ + record_size_;
  position_ = static_cast<std::uint16_t>(next);
  ++records_;
  write(position_, measured());
  write(kRecordCountAt,
        std::array{static_cast<std::uint8_t>(records_ & 0xFFU), static_cast<std::uint8_t>(records_ >> 8U),
                   std::uint8_t{0}, static_cast<std::uint8_t>(position_ & 0xFFU),
                   static_cast<std::uint8_t>(position_ >> 8U)});
}

bool FineOffset::take_output(std::span<const std::uint8_t> report) {
  if (report.size() != 8) return false;
  if (suffers(core::FaultKind::kSilence)) return true;
  const auto address = static_cast<std::uint16_t>((report[1] << 8U) | report[2]);
  const bool is_repeated = std::equal(report.begin(), report.begin() + 4, report.begin() + 4);
  if (report[0] == 0xA1 && is_repeated) {
    reply(address);
  } else if (report[0] == 0xA2 && report[4] == 0xA2) {
    write(address, report.subspan(5, 1));
    queue_report(Bytes(8, 0xA5), kBlockReply_s);
  }
  return true;
}

void FineOffset::reply(std::uint16_t address) {
  ++blocks_read_;
  const double since_s = std::abs(now_s() - last_write_s_);
  const double until_s = std::min(next_update_s_, next_minute_s_) - now_s();
  if (std::min(since_s, until_s) < paced(kNearWriting_s)) ++reads_near_writing_;

  Bytes block(32, 0xFF);
  for (std::size_t i = 0; i < block.size() && address + i < kMemory; ++i) block[i] = memory_[address + i];
  queue_block(std::move(block));
}

void FineOffset::queue_block(Bytes block) {
  if (suffers(core::FaultKind::kGarbage)) block = random_bytes(block.size());
  if (suffers(core::FaultKind::kPartial)) block.resize(16);
  double delay_s = suffers(core::FaultKind::kLate) ? kBlockLateReply_s : kBlockReply_s;
  for (std::size_t at = 0; at < block.size(); at += 8) {
    const auto from = block.begin() + static_cast<std::ptrdiff_t>(at);
    queue_report(Bytes(from, from + 8), delay_s);
    delay_s += suffers(core::FaultKind::kSplit) ? kBlockSplitReport_s : kBlockReport_s;
  }
}

}  // namespace yuragi::simulators::usb
