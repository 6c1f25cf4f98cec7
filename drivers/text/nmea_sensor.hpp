#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/text_fields.hpp"
#include "drivers/text/chosen_wind.hpp"
#include "drivers/text/text_sensor.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::text {

/// The text format of an anemometer.
enum class NmeaFormat : std::uint8_t {
  kAuto,  ///< detected, line by line
  kNmea,
  kGill,
  kFt,
  kUmb,
  kWxt,
};

struct NmeaSensorSettings {
  SensorSettings text;
  NmeaFormat format = NmeaFormat::kAuto;
  std::vector<std::string> sentences;  ///< take these only (MWV, MWD, ...); none: all
  std::string talker;                  ///< take this one only; empty: any
  ChosenWindSettings wind;
  decode::WhenMissing checksum = decode::WhenMissing::kRefuse;  ///< of NMEA sentences, and Vaisala's messages
  decode::WhenMissing makers_checksum =
      decode::WhenMissing::kRefuse;  ///< of the other makers' own formats, which always have one
  decode::WhenMissing status = decode::WhenMissing::kAccept;
  int xdr_first_id = 0;
  double speed_range_m_s = 75.0;  ///< of Lufft's ASCII mode
};

/// The values of kNmeaDriver's parameters. Throws std::runtime_error if they cannot work together.
NmeaSensorSettings nmea_sensor_settings_of(const ParameterValues& values);

/// An anemometer that sends NMEA 0183, or the text of Gill, FT Technologies, Lufft or Vaisala.
class NmeaSensor final : public Sensor {
 public:
  NmeaSensor(NmeaSensorSettings settings, std::unique_ptr<bus::BytePort> port);

 private:
  Judgement judge(std::string_view line, const Instant& now) override;
  std::optional<wind::StationQuantities> quantities_of(std::string_view line) const override;
  std::optional<wind::Reading> take_held() override { return wind_.take_held(); }
  void begin() override { wind_.restart(); }
  std::string name() const override;
  std::string_view driver() const override { return "nmea"; }
  std::string advice(decode::Refusal why, std::string_view line) const override;

  Result<decode::DecodedWind, decode::Refusal> decode(NmeaFormat format, std::string_view line) const;

  NmeaSensorSettings settings_;
  ChosenWind wind_;
};

}  // namespace yuragi::drivers::text
