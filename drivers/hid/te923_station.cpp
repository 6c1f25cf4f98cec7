// Hideki TE923: replies to a request for a block of its memory in several reports, which are acknowledged. The wind in
// it is new every 33 s. Blocks: drivers/decode/hid/te923.hpp. Source: drivers/SOURCES.md S2.5.
#include <array>

#include "drivers/decode/hid/te923.hpp"
#include "drivers/hid/hid_station.hpp"

namespace yuragi::drivers::hid {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kTe923Every = 33s;
constexpr Nanoseconds kTe923Retry = 5s;
constexpr Nanoseconds kTe923Reply = 3s;       // for the whole block
constexpr Nanoseconds kTe923Report = 1200ms;  // for its next report
constexpr int kTe923GiveUp = 4;               // failures in a row; then it is opened again

class Te923Station final : public Station {
 public:
  explicit Te923Station(const StationTiming& timing) : timing_(timing) {}

  Result<StationStep, Failure> step(Exchange& exchange) override {
    const MonoTime begin = exchange.now();
    if (!exchange.discard_waiting() || !exchange.send(decode::hid::encode_te923_request(decode::hid::kTe923Readings)))
      return station_is_gone();
    if (!read_block(exchange)) return station_is_gone();
    if (size_ > 0 && !exchange.send(decode::hid::encode_te923_acknowledgement(decode::hid::kTe923Readings)))
      return station_is_gone();

    if (size_ == 0)
      return fail(exchange, decode::Refusal::kTimeout, "does not reply: check the console's power and its cable");
    const auto block = decode::ByteSpan(block_).first(size_);
    exchange.publish(decode::hid::decode_te923_quantities(block));
    const auto wind = decode::hid::decode_te923(block);
    if (wind && exchange.publish(*wind)) {
      failures_ = 0;
      return StationStep::well(begin + timing_.interval_or(kTe923Every));
    }
    const decode::Refusal why = wind ? decode::Refusal::kInvalid : wind.error();
    if (why != decode::Refusal::kInvalid) {
      return fail(exchange, why, "sends invalid blocks: check its cable");
    }
    // The console works, but has no wind.
    failures_ = 0;
    exchange.refuse(decode::Refusal::kInvalid);
    return StationStep::unwell(begin + timing_.interval_or(kTe923Every),
                               "has lost its anemometer: check its battery and its distance to the console");
  }

 private:
  /// Collects a block, or as much of it as comes. Returns false if the device is disconnected.
  bool read_block(Exchange& exchange) {
    size_ = 0;
    const MonoTime deadline = exchange.now() + kTe923Reply;
    while (size_ < decode::hid::kTe923Block && exchange.now() < deadline) {
      const Message message = exchange.read(kTe923Report);
      if (message.status == bus::HidStatus::kLost) return false;
      if (message.status != bus::HidStatus::kReport) break;
      // The number of valid bytes, then these. An impossible number invalidates the block.
      const std::size_t count = message.bytes[0];
      const bool is_sound = count <= 7 && count < message.bytes.size();
      const decode::ByteSpan valid = is_sound ? message.bytes.subspan(1, count) : message.bytes;
      for (const std::uint8_t byte : valid) block_[size_++] = byte;
      if (!is_sound) break;
    }
    return true;
  }

  Result<StationStep, Failure> fail(Exchange& exchange, decode::Refusal why, const std::string& trouble) {
    exchange.refuse(why);
    if (++failures_ >= kTe923GiveUp) return Failure{trouble};
    return StationStep::unwell(exchange.now() + timing_.paced(kTe923Retry), trouble);
  }

  StationTiming timing_;
  std::array<std::uint8_t, decode::hid::kTe923Block + 64> block_{};  ///< and one report more
  std::size_t size_ = 0;
  int failures_ = 0;  ///< in a row
};

}  // namespace

std::unique_ptr<Station> make_te923_station(const StationTiming& timing) {
  return std::make_unique<Te923Station>(timing);
}

}  // namespace yuragi::drivers::hid
