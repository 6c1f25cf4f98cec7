// The messages of stations and gateways in the local network. Of several stations the first one is read, as by the
// drivers.
#include <optional>
#include <string>
#include <string_view>

#include "daemon/tools/decode/decode_formats.hpp"
#include "drivers/decode/davis/weatherlink_live.hpp"
#include "drivers/decode/network/ecowitt.hpp"
#include "drivers/decode/network/station_push.hpp"
#include "drivers/decode/network/tempest.hpp"

namespace yuragi::daemon::tools::decode {
namespace {

using drivers::decode::Refusal;
namespace davis = drivers::decode::davis;
namespace network = drivers::decode::network;

std::string_view line_of(const RawUnit& unit) {
  return {reinterpret_cast<const char*>(unit.bytes.data()), unit.bytes.size()};
}

/// The first station that is heard.
class FirstStation {
 public:
  bool is(std::string_view identity) {
    if (!first_) first_ = identity;
    return *first_ == identity;
  }

 private:
  std::optional<std::string> first_;
};

class TempestDecoder final : public UnitDecoder {
 public:
  void take(const RawUnit& unit, const Sink& sink) override {
    const auto message = network::decode_tempest(line_of(unit));
    if (!message) return sink(UnitRefusal{message.error(), {}});
    if (message->kind == network::TempestKind::kOther) return sink(UnitRefusal{Refusal::kNotMine, "no wind"});
    if (!station_.is(message->serial_number)) return sink(UnitRefusal{Refusal::kNotMine, "another station"});
    if (!winds_.is_new(*message)) return;
    if (!message->wind || winds_.is_wind(*message)) {
      has_shown_ = true;
      sink(outcome_of(message->wind));
    } else if (!has_shown_) {
      waiting_ = message->wind;
    }
  }
  /// An observation alone shows only then that no rapid wind belongs to it.
  void finish(const Sink& sink) override {
    if (!has_shown_ && waiting_) sink(outcome_of(*waiting_));
  }

 private:
  FirstStation station_;
  std::optional<Result<drivers::decode::DecodedWind, Refusal>> waiting_;
  bool has_shown_ = false;
  network::TempestWinds winds_;
};

class EcowittDecoder final : public UnitDecoder {
 public:
  void take(const RawUnit& unit, const Sink& sink) override {
    const auto values = network::decode_ecowitt(unit.bytes);
    sink(values ? outcome_of(values->wind) : UnitRefusal{values.error(), {}});
  }
};

class StationPushDecoder final : public UnitDecoder {
 public:
  void take(const RawUnit& unit, const Sink& sink) override {
    const auto push = network::decode_station_push(form_of(line_of(unit)));
    if (!push) return sink(UnitRefusal{push.error(), {}});
    if (!station_.is(push->identity)) return sink(UnitRefusal{Refusal::kNotMine, "another station"});
    sink(outcome_of(push->wind));
  }

 private:
  /// Of "GET /weatherstation/updateweatherstation.php?ID=a&b=c HTTP/1.1", of its target alone, or a form.
  static std::string_view form_of(std::string_view line) {
    if (line.starts_with("GET ")) {
      line.remove_prefix(4);
      line = line.substr(0, line.find(' '));
    }
    return line.starts_with('/') ? network::split_push_target(line).form : line;
  }

  FirstStation station_;
};

class WeatherlinkDecoder final : public UnitDecoder {
 public:
  void take(const RawUnit& unit, const Sink& sink) override {
    const auto conditions = davis::decode_live_conditions(line_of(unit), transmitter_);
    if (!conditions) {
      const bool is_about_broadcasts = davis::decode_live_broadcast_port(line_of(unit)).has_value();
      return sink(UnitRefusal{is_about_broadcasts ? Refusal::kNotMine : conditions.error(), {}});
    }
    if (!device_.is(conditions->device)) return sink(UnitRefusal{Refusal::kNotMine, "another WeatherLink Live"});
    transmitter_ = conditions->transmitter;
    sink(UnitReading{conditions->wind, {}, {}});
  }

 private:
  FirstStation device_;
  int transmitter_ = 0;  // the first one that has a wind
};

}  // namespace

std::unique_ptr<UnitDecoder> make_tempest_unit_decoder(const UnitDecoderOptions& /*options*/) {
  return std::make_unique<TempestDecoder>();
}

std::unique_ptr<UnitDecoder> make_ecowitt_unit_decoder(const UnitDecoderOptions& /*options*/) {
  return std::make_unique<EcowittDecoder>();
}

std::unique_ptr<UnitDecoder> make_station_push_unit_decoder(const UnitDecoderOptions& /*options*/) {
  return std::make_unique<StationPushDecoder>();
}

std::unique_ptr<UnitDecoder> make_weatherlink_unit_decoder(const UnitDecoderOptions& /*options*/) {
  return std::make_unique<WeatherlinkDecoder>();
}

}  // namespace yuragi::daemon::tools::decode
