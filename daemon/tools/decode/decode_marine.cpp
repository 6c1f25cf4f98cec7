// `yuragi decode nmea2000` and `signalk`: lines of which some apply to the following ones, or have several winds.
#include <algorithm>
#include <array>

#include "daemon/tools/decode/decode_formats.hpp"
#include "drivers/decode/marine/bus_line.hpp"
#include "drivers/decode/marine/signalk.hpp"

namespace yuragi::daemon::tools::decode {
namespace {

namespace marine = drivers::decode::marine;

std::string_view text_of(drivers::decode::ByteSpan line) {
  return {reinterpret_cast<const char*>(line.data()), line.size()};
}

class Nmea2000UnitDecoder final : public UnitDecoder {
 public:
  explicit Nmea2000UnitDecoder(const UnitDecoderOptions& options) : lines_(options.bus_lines) {}

  void take(const RawUnit& unit, const Sink& sink) override {
    const auto said = lines_.decode(text_of(unit.bytes));
    if (said) return sink(UnitReading{said->wind, {}, {}});
    sink(UnitRefusal{said.error(), {}});
  }

 private:
  marine::BusLineDecoder lines_;
};

/// A server sends speed and angle one after the other: each is shown as it comes.
class SignalKUnitDecoder final : public UnitDecoder {
 public:
  void take(const RawUnit& unit, const Sink& sink) override {
    const auto delta = marine::decode_signalk(text_of(unit.bytes));
    if (!delta) return sink(UnitRefusal{delta.error(), {}});
    for (const marine::SignalKUpdate& update : delta->updates) {
      const auto winds = marine::signalk_winds(update.values);
      const bool has_speed = std::ranges::any_of(winds, [](const auto& wind) { return wind.has_value(); });
      for (const auto& wind : winds) {
        if (wind) sink(UnitReading{wind->wind, {}, {}});
      }
      if (!has_speed) show_angles(update.values, sink);
    }
  }

 private:
  static void show_angles(const marine::SignalKValues& values, const Sink& sink) {
    using drivers::decode::WindReference;
    using marine::SignalKQuantity;
    struct Angle {
      SignalKQuantity quantity;
      WindReference reference;
    };
    constexpr std::array<Angle, 5> kAngles = {{{SignalKQuantity::kDirectionTrue, WindReference::kNorth},
                                               {SignalKQuantity::kDirectionMagnetic, WindReference::kMagnetic},
                                               {SignalKQuantity::kAngleApparent, WindReference::kRelative},
                                               {SignalKQuantity::kAngleTrueGround, WindReference::kTrue},
                                               {SignalKQuantity::kAngleTrueWater, WindReference::kTrue}}};
    for (const Angle& angle : kAngles) {
      UnitReading reading;
      reading.wind.direction_deg = values[static_cast<std::size_t>(angle.quantity)];
      reading.wind.reference = angle.reference;
      if (reading.wind.direction_deg) sink(reading);
    }
  }
};

}  // namespace

std::unique_ptr<UnitDecoder> make_nmea2000_unit_decoder(const UnitDecoderOptions& options) {
  return std::make_unique<Nmea2000UnitDecoder>(options);
}

std::unique_ptr<UnitDecoder> make_signalk_unit_decoder(const UnitDecoderOptions& /*options*/) {
  return std::make_unique<SignalKUnitDecoder>();
}

}  // namespace yuragi::daemon::tools::decode
