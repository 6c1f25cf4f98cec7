#pragma once

#include <bitset>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/decode/marine/signalk.hpp"
#include "drivers/text/chosen_wind.hpp"
#include "drivers/text/text_sensor.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::text {

struct SignalKSensorSettings {
  SensorSettings text;
  std::string source;   ///< take this one of the server's sources only; empty: any
  std::string context;  ///< take this vessel only; empty: the server's own
  ChosenWindSettings wind = {};
};

/// The values of kSignalKDriver's parameters. Throws std::runtime_error if they cannot work together.
SignalKSensorSettings signalk_sensor_settings_of(const ParameterValues& values);

/// Wind of a Signal K server, or of a device that sends deltas.
///
/// A server sends the values of one message one after the other; they make one wind by their source and time. To a new
/// client it first sends what it remembers, however old that is: values from before the time in its hello are not used
/// until their source sends one with another time.
class SignalKSensor final : public Sensor {
 public:
  SignalKSensor(SignalKSensorSettings settings, std::unique_ptr<bus::BytePort> port);

 private:
  Judgement judge(std::string_view line, const Instant& now) override;
  std::optional<wind::Reading> take_held() override;
  void begin() override;
  std::string name() const override;
  std::string_view driver() const override { return "signalk"; }
  std::string advice(decode::Refusal why, std::string_view line) const override;

  /// The values of one source and time, as far as they have come.
  struct Moment {
    std::string source;
    std::string timestamp;
    decode::marine::SignalKValues values = {};
    std::bitset<decode::marine::kSignalKFrames> is_offered = {};
    Instant time = {};
  };
  /// The first time with which a source has sent a quantity.
  struct FirstTime {
    std::string source;
    std::size_t quantity = 0;
    std::string timestamp;
  };

  bool is_of_vessel(const std::string& context) const;
  void forget_remembered(decode::marine::SignalKUpdate& update);
  bool is_remembered(const decode::marine::SignalKUpdate& update, std::size_t quantity);
  Judgement take(const decode::marine::SignalKUpdate& update, const Instant& now);
  Judgement offer_moment(bool is_over);

  SignalKSensorSettings settings_;
  ChosenWind wind_;
  decode::marine::SignalKHello hello_;
  std::vector<FirstTime> first_times_;
  std::optional<Moment> moment_;
};

}  // namespace yuragi::drivers::text
