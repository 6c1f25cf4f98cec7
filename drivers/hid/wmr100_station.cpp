// Oregon Scientific WMR100: after a start report it sends a stream of frames by itself, the wind about every
// 14 s. Reports and frames: drivers/decode/hid/wmr100.hpp. Source: drivers/SOURCES.md S2.1.
#include "drivers/decode/hid/wmr100.hpp"
#include "drivers/hid/hid_station.hpp"

namespace yuragi::drivers::hid {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kWmr100Listen = 1s;
constexpr Nanoseconds kWmr100Silent = 60s;   // the clock's frame comes once a minute, the wind's more often
constexpr Nanoseconds kWmr100Restart = 30s;  // from one start report to the next, to a console that is silent
constexpr Nanoseconds kWmr100GiveUp = 180s;  // of silence; then the device is opened again
constexpr Nanoseconds kWmr100NoWind = 90s;   // six missing winds

class Wmr100Station final : public Station {
 public:
  explicit Wmr100Station(const StationTiming& timing) : timing_(timing) {}

  Result<StationStep, Failure> step(Exchange& exchange) override {
    if (started_ == MonoTime{}) {
      if (!exchange.send(decode::hid::kWmr100Start)) return station_is_gone();
      started_ = received_at_ = wind_ = exchange.now();
    }
    const Message message = exchange.read(kWmr100Listen);
    if (message.status == bus::HidStatus::kLost) return station_is_gone();
    if (message.status != bus::HidStatus::kReport) return bear_silence(exchange);

    StationStep step = StationStep::same(exchange.now());
    for (const std::uint8_t byte : decode::hid::wmr100_report_bytes(message.bytes)) {
      if (const auto frame = decode::hid::take_wmr100_byte(stream_, byte)) judge(*frame, exchange, step);
    }
    if (step.health == StationHealth::kSame) miss_the_wind(step);
    return step;
  }

 private:
  /// A frame ended.
  void judge(const Result<decode::DecodedWind, decode::Refusal>& frame, Exchange& exchange, StationStep& step) {
    exchange.publish(decode::hid::decode_wmr100_quantities(decode::hid::ended_wmr100_frame(stream_)));
    if (frame || frame.error() == decode::Refusal::kNotMine) received_at_ = step.next;
    if (!frame) {
      exchange.refuse(frame.error());
    } else if (exchange.publish(*frame)) {
      wind_ = step.next;
      step.health = StationHealth::kWell;
    }
  }

  /// Checks that its frames include the wind.
  void miss_the_wind(StationStep& step) const {
    if (step.next - wind_ < timing_.paced(kWmr100NoWind)) return;
    step.health = StationHealth::kUnwell;
    step.trouble = "sends no wind: check the anemometer's battery and its distance to the console";
  }

  Result<StationStep, Failure> bear_silence(Exchange& exchange) {
    const MonoTime now = exchange.now();
    const Nanoseconds silent = now - received_at_;
    if (silent < timing_.paced(kWmr100Silent)) return StationStep::same(now);
    if (silent > timing_.paced(kWmr100GiveUp)) return Failure{"is silent: reopening it"};
    if (now - started_ >= timing_.paced(kWmr100Restart)) {
      started_ = now;
      exchange.refuse(decode::Refusal::kTimeout);
      if (!exchange.send(decode::hid::kWmr100Start)) return station_is_gone();
    }
    return StationStep::unwell(now, "is silent: check the console's power");
  }

  StationTiming timing_;
  decode::hid::Wmr100Stream stream_;
  MonoTime started_{};      ///< when the last start report went
  MonoTime received_at_{};  ///< the last valid frame
  MonoTime wind_{};         ///< the last wind
};

}  // namespace

std::unique_ptr<Station> make_wmr100_station(const StationTiming& timing) {
  return std::make_unique<Wmr100Station>(timing);
}

}  // namespace yuragi::drivers::hid
