// AcuRite: sends nothing without a request; input report 1 is requested every 18 s. Its contents alternate, so that a
// report that is the same as the one before is not new. It has no checksum: it is read twice, and must be the same both
// times. Reports: drivers/decode/hid/acurite.hpp. Source: drivers/SOURCES.md S2.4.
#include <algorithm>
#include <array>

#include "drivers/decode/hid/acurite.hpp"
#include "drivers/hid/hid_station.hpp"

namespace yuragi::drivers::hid {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kAcuriteEvery = 18s;
constexpr Nanoseconds kAcuriteRetry = 6s;
constexpr Nanoseconds kAcuriteNothingNew = 90s;
constexpr int kAcuriteGiveUp = 4;  // failures in a row; then it is opened again, which helps some consoles

class AcuriteStation final : public Station {
 public:
  explicit AcuriteStation(const StationTiming& timing) : timing_(timing) {}

  Result<StationStep, Failure> step(Exchange& exchange) override {
    const MonoTime begin = exchange.now();
    if (last_new_ == MonoTime{}) last_new_ = begin;
    Report first;
    Report second;
    if (!request(exchange, first)) return station_is_gone();
    if (first.size != 0 && !request(exchange, second)) return station_is_gone();
    if (first.size == 0 || second.size == 0) {
      return fail(exchange, decode::Refusal::kTimeout, "does not reply: set the console's USB mode to 3 or 4");
    }
    if (first != second) {
      return fail(exchange, decode::Refusal::kMalformed,
                  "replies differently each time: unplug it and plug it in again");
    }

    const MonoTime next = begin + timing_.interval_or(kAcuriteEvery);
    if (first == last_) return wait_for_news(next, begin);
    const auto wind = decode::hid::decode_acurite(first.span());
    if (wind && exchange.publish(*wind)) {
      exchange.publish(decode::hid::decode_acurite_quantities(first.span()));
      failures_ = 0;
      last_ = first;
      last_new_ = begin;
      return StationStep::well(next);
    }
    const decode::Refusal why = wind ? decode::Refusal::kInvalid : wind.error();
    if (why != decode::Refusal::kInvalid) {
      return fail(exchange, why, "sends invalid reports: unplug it and plug it in again");
    }
    // The console works, but has no sensor, or old values of one.
    failures_ = 0;
    exchange.refuse(decode::Refusal::kInvalid);
    return StationStep::unwell(next,
                               "does not receive its sensors: check their batteries and their distance to the console");
  }

 private:
  struct Report {
    std::array<std::uint8_t, decode::hid::kAcuriteReport1> bytes{};
    std::size_t size = 0;

    decode::ByteSpan span() const { return decode::ByteSpan(bytes).first(size); }
    bool operator==(const Report&) const = default;
  };

  /// Report 1; nullopt if it was refused. Returns false if the device is disconnected.
  static bool request(Exchange& exchange, Report& report) {
    const Message message = exchange.get_input_report(1, decode::hid::kAcuriteReport1);
    if (message.status == bus::HidStatus::kLost) return false;
    report.size = message.bytes.size();
    std::ranges::copy(message.bytes, report.bytes.begin());
    return true;
  }

  /// The report is the one that was published last.
  StationStep wait_for_news(MonoTime next, MonoTime now) {
    failures_ = 0;
    if (now - last_new_ < timing_.paced(kAcuriteNothingNew)) return StationStep::same(next);
    return StationStep::unwell(next, "repeats the same report: unplug it and plug it in again");
  }

  Result<StationStep, Failure> fail(Exchange& exchange, decode::Refusal why, const std::string& trouble) {
    exchange.refuse(why);
    if (++failures_ >= kAcuriteGiveUp) return Failure{trouble};
    return StationStep::unwell(exchange.now() + timing_.paced(kAcuriteRetry), trouble);
  }

  StationTiming timing_;
  Report last_;          ///< that was published
  MonoTime last_new_{};  ///< when that was
  int failures_ = 0;     ///< in a row
};

}  // namespace

std::unique_ptr<Station> make_acurite_station(const StationTiming& timing) {
  return std::make_unique<AcuriteStation>(timing);
}

}  // namespace yuragi::drivers::hid
