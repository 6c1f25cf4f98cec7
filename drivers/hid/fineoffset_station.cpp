// Fine Offset WH1080, WH3080: a console whose memory is read block by block. It writes what it measures there every
// 48 s, goes on to the next record every few minutes, and may lock up when it is read at that moment (only a power
// cycle helps then). Blocks: drivers/decode/hid/fineoffset.hpp. Source: drivers/SOURCES.md S2.3; weewx fousb.py ("USB
// lockups", polling).
//
// So it is read once for each time that it writes. That moment is determined at first, by reading a few times in one
// period of 48 s until the record changes, and again every six hours, since clocks drift. A block is accepted when two
// reads of it are equal; otherwise it was just being written. Each round of reading begins with the fixed block and
// ends with the record, so that a late reply to one is not taken for the other.
#include <algorithm>
#include <array>
#include <vector>

#include "drivers/decode/hid/fineoffset.hpp"
#include "drivers/hid/hid_station.hpp"
#include "drivers/hid/write_clock.hpp"

namespace yuragi::drivers::hid {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kFineOffsetEvery = 48s;
constexpr Nanoseconds kFineOffsetMinute = 60s;
constexpr Nanoseconds kFineOffsetMargin = 5s;  // 3, plus the drift of two quartzes until the next search
constexpr Nanoseconds kFineOffsetSearchStep = 6s;
constexpr Nanoseconds kFineOffsetSearchAgain = 6h;
constexpr Nanoseconds kFineOffsetSearchSoon = 1h;  // where nothing was found
constexpr int kFineOffsetSearchSteps = 10;  // a period and a little more: in a calm the console may change nothing
constexpr Nanoseconds kFineOffsetRetry = 6s;
constexpr Nanoseconds kFineOffsetReport = 1s;     // for each of a block's reports
constexpr Nanoseconds kFineOffsetWriting = 2s;    // until a block that was being written is read again
constexpr int kFineOffsetUnstable = 4;            // times that a block was not the same twice
constexpr Nanoseconds kFineOffsetStalled = 240s;  // without any change: at the least it counts minutes
constexpr int kFineOffsetGiveUp = 4;              // failures in a row; then it is opened again
constexpr std::size_t kFineOffsetRecord = 16;     // the common part of both models' records

using FineOffsetBytes = std::array<std::uint8_t, decode::hid::kFineOffsetBlock>;

class FineOffsetStation final : public Station {
 public:
  explicit FineOffsetStation(const StationTiming& timing)
      : timing_(timing),
        sensor_clock_(timing.paced(kFineOffsetEvery), timing.paced(kFineOffsetMargin)),
        record_clock_(timing.paced(kFineOffsetMinute), timing.paced(kFineOffsetMargin)) {
    begin_round();
  }

  Result<StationStep, Failure> step(Exchange& exchange) override {
    const MonoTime now = exchange.now();
    if (const MonoTime clear = keep_away(now); clear > now) return StationStep::same(clear);

    // Read one block; it is accepted when it is equal to the read before.
    FineOffsetBytes block{};
    const BlockStatus status = read_block(exchange, addresses_[blocks_.size()], block);
    if (status == BlockStatus::kLost) return station_is_gone();
    if (status != BlockStatus::kRead) {
      return fail(exchange, status == BlockStatus::kNone ? decode::Refusal::kTimeout : decode::Refusal::kTooShort,
                  "does not reply; if it has locked up, remove its batteries and unplug its cable for a moment");
    }
    if (!last_block_) {
      last_block_ = block;
      return StationStep::same(exchange.now());
    }
    if (*last_block_ != block) return wait_for_writing(exchange);
    last_block_.reset();
    blocks_.push_back(block);
    return blocks_.size() == 1 ? take_fixed_block(exchange) : take_record(exchange);
  }

 private:
  enum class BlockStatus : std::uint8_t { kRead, kNone, kCutOff, kLost };

  void begin_round() {
    addresses_ = {0};
    blocks_.clear();
    last_block_.reset();
    unstable_ = 0;
  }

  /// The first time from `time` on at which the console does not write, as far as is known.
  MonoTime keep_away(MonoTime time) const {
    // Each can push the time into the other's window; there is room between them.
    for (int i = 0; i < 4; ++i) time = record_clock_.clear_from(sensor_clock_.clear_from(time));
    return time;
  }

  static BlockStatus read_block(Exchange& exchange, std::uint16_t address, FineOffsetBytes& block) {
    if (!exchange.discard_waiting() || !exchange.send(decode::hid::encode_fineoffset_read(address)))
      return BlockStatus::kLost;
    for (std::size_t size = 0; size < block.size();) {
      const Message message = exchange.read(kFineOffsetReport);
      if (message.status == bus::HidStatus::kLost) return BlockStatus::kLost;
      if (message.status != bus::HidStatus::kReport) return size == 0 ? BlockStatus::kNone : BlockStatus::kCutOff;
      if (message.bytes.size() != 8) return BlockStatus::kCutOff;
      std::ranges::copy(message.bytes, block.begin() + static_cast<std::ptrdiff_t>(size));
      size += 8;
    }
    return BlockStatus::kRead;
  }

  /// The block was not the same twice: the console is writing to it, and will soon be done; or the cable is bad.
  Result<StationStep, Failure> wait_for_writing(Exchange& exchange) {
    last_block_.reset();
    if (++unstable_ >= kFineOffsetUnstable) {
      return fail(exchange, decode::Refusal::kMalformed, "reads differently each time: check its cable");
    }
    return StationStep::same(exchange.now() + timing_.paced(kFineOffsetWriting));
  }

  /// Reads the address of the current record, which is in the memory of either model.
  Result<StationStep, Failure> take_fixed_block(Exchange& exchange) {
    auto fixed = decode::hid::decode_fineoffset_fixed_block(blocks_[0], decode::hid::FineOffsetModel::kWh1080);
    if (!fixed) fixed = decode::hid::decode_fineoffset_fixed_block(blocks_[0], decode::hid::FineOffsetModel::kWh3080);
    if (!fixed) {
      return fail(
          exchange, fixed.error(),
          "is not a Fine Offset console, or has locked up: remove its batteries and unplug its cable for a moment");
    }
    // Blocks are read where the memory's own begin; a long record can reach into the next.
    position_ = fixed->current_position;
    const std::size_t offset = position_ % decode::hid::kFineOffsetBlock;
    const auto first = static_cast<std::uint16_t>(position_ - offset);
    addresses_.push_back(first);
    if (offset + kFineOffsetRecord > decode::hid::kFineOffsetBlock) {
      addresses_.push_back(static_cast<std::uint16_t>(first + decode::hid::kFineOffsetBlock));
    }
    return StationStep::same(exchange.now());
  }

  Result<StationStep, Failure> take_record(Exchange& exchange) {
    if (blocks_.back() == blocks_.front()) {
      return fail(exchange, decode::Refusal::kNotMine, "replies to another request: check its cable");
    }
    if (blocks_.size() < addresses_.size()) return StationStep::same(exchange.now());

    Record record{};
    std::array<std::uint8_t, 2 * decode::hid::kFineOffsetBlock> joined{};
    for (std::size_t i = 1; i < blocks_.size(); ++i) {
      std::ranges::copy(blocks_[i],
                        joined.begin() + static_cast<std::ptrdiff_t>((i - 1) * decode::hid::kFineOffsetBlock));
    }
    std::copy_n(joined.begin() + position_ % decode::hid::kFineOffsetBlock, record.size(), record.begin());
    begin_round();
    failures_ = 0;
    return judge(record, exchange);
  }

  using Record = std::array<std::uint8_t, kFineOffsetRecord>;

  /// The difference between two reads of the record.
  struct RecordChange {
    bool is_first = false;
    bool has_moved = false;     ///< the console has begun the next record
    bool has_measured = false;  ///< it has written a measurement
    bool has_counted = false;   ///< its minutes have changed

    bool is_news() const { return is_first || has_moved || has_measured || has_counted; }
  };

  RecordChange compare(const Record& record) const {
    if (last_read_ == MonoTime{}) return {.is_first = true};
    // The first byte counts minutes; the rest changes when the console has measured.
    return {.is_first = false,
            .has_moved = position_ != last_position_,
            .has_measured = !std::equal(record.begin() + 1, record.end(), last_record_.begin() + 1),
            .has_counted = record[0] != last_record_[0]};
  }

  /// Updates the clocks of the console's writing from the changes since the last read.
  void learn(const RecordChange& change, MonoTime now) {
    const bool is_turn_of_minute = change.has_moved || (change.has_counted && !change.has_measured);
    if (is_turn_of_minute) record_clock_.happened_between(last_read_, now);
    const bool has_measured_alone = change.has_measured && !change.has_moved;
    if (is_searching() && has_measured_alone && sensor_clock_.happened_between(last_read_, now)) end_search(now);
  }

  /// Evaluates a complete round.
  StationStep judge(const Record& record, Exchange& exchange) {
    const MonoTime now = exchange.now();
    const RecordChange change = compare(record);
    learn(change, now);
    // A read between two of the console's measurements is for its clock alone.
    const bool is_due = change.is_first || change.has_measured || now - published_ >= timing_.paced(kFineOffsetEvery);
    const bool was_for_clock = is_searching() && !is_due;
    if (change.is_news()) last_news_ = now;
    last_record_ = record;
    last_position_ = position_;
    last_read_ = now;

    const MonoTime next = next_read(now);
    if (now - last_news_ >= timing_.paced(kFineOffsetStalled)) {
      exchange.refuse(decode::Refusal::kInvalid);
      return StationStep::unwell(
          next, "has stopped measuring; if it has locked up, remove its batteries and unplug its cable for a moment");
    }
    if (was_for_clock) return StationStep::same(next);
    published_ = now;
    return publish(record, exchange, next);
  }

  static StationStep publish(const Record& record, Exchange& exchange, MonoTime next) {
    exchange.publish(decode::hid::decode_fineoffset_quantities(record));
    const auto wind = decode::hid::decode_fineoffset_record(record);
    if (wind && exchange.publish(*wind)) return StationStep::well(next);
    if (!wind) exchange.refuse(wind.error());
    return StationStep::unwell(
        next, "receives no wind from its sensors: check their batteries and their distance to the console");
  }

  bool is_searching() const { return search_steps_ < kFineOffsetSearchSteps; }
  void end_search(MonoTime now) {
    search_steps_ = kFineOffsetSearchSteps;
    searched_ = now;
  }

  MonoTime next_read(MonoTime now) {
    if (is_searching()) {
      if (++search_steps_ == kFineOffsetSearchSteps) end_search(now);
      due_ = now + timing_.paced(kFineOffsetSearchStep);
      return due_;
    }
    const Nanoseconds search_again = sensor_clock_.is_known() ? kFineOffsetSearchAgain : kFineOffsetSearchSoon;
    if (now - searched_ >= timing_.paced(search_again)) {
      sensor_clock_.forget();
      record_clock_.forget();
      search_steps_ = 0;
    }
    // Once per interval, and soon after the console writes, if that time is known. A delayed read does not delay the
    // next one.
    const Nanoseconds interval = std::max(timing_.interval_or(kFineOffsetEvery), timing_.paced(kFineOffsetEvery));
    due_ = std::max(due_, now - interval / 2) + interval;
    if (sensor_clock_.is_known()) due_ = sensor_clock_.behind(due_ - interval / 4);
    return due_;
  }

  Result<StationStep, Failure> fail(Exchange& exchange, decode::Refusal why, const std::string& trouble) {
    begin_round();
    exchange.refuse(why);
    if (++failures_ >= kFineOffsetGiveUp) return Failure{trouble};
    return StationStep::unwell(exchange.now() + timing_.paced(kFineOffsetRetry), trouble);
  }

  StationTiming timing_;
  WriteClock sensor_clock_;  ///< when it writes its measurements
  WriteClock record_clock_;  ///< when it moves to the next record: at the turn of a minute

  // The present round.
  std::vector<std::uint16_t> addresses_;
  std::vector<FineOffsetBytes> blocks_;  ///< that were read, of these addresses
  std::optional<FineOffsetBytes> last_block_;
  int unstable_ = 0;
  std::uint16_t position_ = 0;  ///< of the current record

  // The last round.
  MonoTime last_read_{};
  Record last_record_{};
  std::uint16_t last_position_ = 0;

  int search_steps_ = 0;  ///< reads in the search for the sensor clock
  MonoTime searched_{};   ///< when the last search ended
  MonoTime published_{};  ///< the last read whose wind was published
  MonoTime last_news_{};  ///< the last read that found any change
  MonoTime due_{};        ///< when the next read is due, unless the console writes just then
  int failures_ = 0;      ///< in a row
};

}  // namespace

std::unique_ptr<Station> make_fineoffset_station(const StationTiming& timing) {
  return std::make_unique<FineOffsetStation>(timing);
}

}  // namespace yuragi::drivers::hid
