// Oregon Scientific WMR300: it sends packets by itself, the wind every 2.5 to 3 s, after a start request and for
// as long as it gets a heartbeat every 20 s and each data packet is acknowledged. Packets:
// drivers/decode/hid/wmr300.hpp. Source: drivers/SOURCES.md S2.2; weewx wmr300.py (a console that has fallen silent
// comes back when the device is opened again).
#include "drivers/decode/hid/wmr300.hpp"
#include "drivers/hid/hid_station.hpp"

namespace yuragi::drivers::hid {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kWmr300Listen = 500ms;
constexpr Nanoseconds kWmr300HeartbeatEvery = 20s;
constexpr Nanoseconds kWmr300NoWind = 15s;  // five winds that did not come
constexpr Nanoseconds kWmr300GiveUp = 60s;  // of silence; then the device is opened again

class Wmr300Station final : public Station {
 public:
  explicit Wmr300Station(const StationTiming& timing) : timing_(timing) {}

  Result<StationStep, Failure> step(Exchange& exchange) override {
    // The heartbeat.
    const MonoTime begin = exchange.now();
    if (begin >= next_heartbeat_) {
      if (!exchange.send(decode::hid::kWmr300Heartbeat)) return station_is_gone();
      if (next_heartbeat_ == MonoTime{}) received_at_ = wind_ = begin;
      next_heartbeat_ = begin + timing_.paced(kWmr300HeartbeatEvery);
    }

    const Nanoseconds until_heartbeat = next_heartbeat_ - begin;
    const Message message = exchange.read(std::min(kWmr300Listen, until_heartbeat));
    if (message.status == bus::HidStatus::kLost) return station_is_gone();
    StationStep step = StationStep::same(exchange.now());
    if (message.status == bus::HidStatus::kReport && !take(message.bytes, exchange, step)) return station_is_gone();
    if (step.health == StationHealth::kSame) return miss_the_wind(exchange, step);
    return step;
  }

 private:
  /// Handles a packet. Returns false if the device was gone when it was acknowledged.
  bool take(decode::ByteSpan packet, Exchange& exchange, StationStep& step) {
    const bool is_sound = decode::hid::is_sound_wmr300(packet);
    if (is_sound) received_at_ = step.next;
    if (!decode::hid::wants_wmr300_acknowledgement(packet)) {
      if (!is_sound) exchange.refuse(decode::Refusal::kMalformed);
      // It identifies itself. If no data came since the heartbeat before, it needs the command to start sending.
      const bool is_idle = step.next - data_ > timing_.paced(kWmr300HeartbeatEvery) / 2;
      return !decode::hid::is_wmr300_identity(packet) || !is_idle ||
             exchange.send(decode::hid::encode_wmr300_begin(packet));
    }

    const auto acknowledgement = decode::hid::encode_wmr300_acknowledgement(packet);
    exchange.publish(decode::hid::decode_wmr300_quantities(packet));
    const auto wind = decode::hid::decode_wmr300(packet);
    if (is_sound) data_ = step.next;
    if (!wind) {
      exchange.refuse(wind.error());
    } else if (exchange.publish(*wind)) {
      wind_ = step.next;
      step.health = StationHealth::kWell;
    }
    return exchange.send(acknowledgement);
  }

  Result<StationStep, Failure> miss_the_wind(Exchange& exchange, StationStep step) {
    if (step.next - received_at_ > timing_.paced(kWmr300GiveUp)) {
      exchange.refuse(decode::Refusal::kTimeout);
      return Failure{"sends no valid packets: reopening it"};
    }
    if (step.next - wind_ > timing_.paced(kWmr300NoWind)) {
      step.health = StationHealth::kUnwell;
      step.trouble = step.next - received_at_ > timing_.paced(kWmr300NoWind)
                         ? "sends no valid packets: check the console's power and the cable"
                         : "sends no wind: check the anemometer's battery and its distance to the console";
    }
    return step;
  }

  StationTiming timing_;
  MonoTime next_heartbeat_{};
  MonoTime received_at_{};  ///< the last valid packet
  MonoTime data_{};         ///< the last data packet, other than identifications
  MonoTime wind_{};         ///< the last wind
};

}  // namespace

std::unique_ptr<Station> make_wmr300_station(const StationTiming& timing) {
  return std::make_unique<Wmr300Station>(timing);
}

}  // namespace yuragi::drivers::hid
