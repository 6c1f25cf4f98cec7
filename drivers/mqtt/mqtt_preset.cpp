// Where the messages of known publishers have the wind.
//
//   preset     topic               speed                   direction        gust                    unit
//   number     (yours, one each)   the payload is the number                                        m/s
//   tasmota    tele/+/SENSOR       /TX23/Speed/Act         /TX23/Dir/Deg    /TX23/Speed/Max         /SpeedUnit, or km/h
//   rtl_433    rtl_433/+/events    /wind_avg_m_s           /wind_dir_deg    /wind_max_m_s           m/s
//                                  /wind_avg_km_h                           /wind_max_km_h          km/h
//                                  /wind_avg_mi_h                           /wind_max_mi_h          mi/h
//   windnerd   (yours)             /wind_instant_speed     /wind_instant_dir                        /unit, or m/s
//
// Tasmota has TX20 or WindMeter in place of TX23 for other sensors (of which the latter has no direction).
//
// Sources: Home Assistant's mqtt_statestream publishes numbers on homeassistant/sensor/NAME/state; arendst/Tasmota
// tasmota/xsns_35_tx20.ino (Tx2xShow, Tx2xInit), xsns_68_windmeter.ino, MqttAppendSensorUnits; merbanan/rtl_433,
// its document of data fields, and src/devices/hideki.c, vevor_7in1.c, fineoffset_wh1080.c, lacrossews.c,
// fineoffset_ws80.c; windnerd.net/docs, MQTT.
#include "drivers/mqtt/mqtt_preset.hpp"

#include <algorithm>

#include "drivers/decode/speed_units.hpp"
#include "drivers/mqtt/mqtt_quantities.hpp"
#include "drivers/sensor/speed_unit.hpp"

namespace yuragi::drivers::mqtt {
namespace {

constexpr std::array<PresetPlace, 3> kTasmotaSpeed = {
    {{"/TX23/Speed/Act", ""}, {"/TX20/Speed/Act", ""}, {"/WindMeter/Speed/Act", ""}}};
constexpr std::array<PresetPlace, 2> kTasmotaDirection = {{{"/TX23/Dir/Deg", ""}, {"/TX20/Dir/Deg", ""}}};
constexpr std::array<PresetPlace, 3> kTasmotaGust = {
    {{"/TX23/Speed/Max", ""}, {"/TX20/Speed/Max", ""}, {"/WindMeter/Speed/Max", ""}}};
constexpr std::array<PresetPlace, 3> kRtl433Speed = {
    {{"/wind_avg_m_s", "m/s"}, {"/wind_avg_km_h", "km/h"}, {"/wind_avg_mi_h", "mi/h"}}};
constexpr std::array<PresetPlace, 1> kRtl433Direction = {{{"/wind_dir_deg", ""}}};
constexpr std::array<PresetPlace, 3> kRtl433Gust = {
    {{"/wind_max_m_s", "m/s"}, {"/wind_max_km_h", "km/h"}, {"/wind_max_mi_h", "mi/h"}}};
constexpr std::array<PresetPlace, 1> kWindnerdSpeed = {{{"/wind_instant_speed", ""}}};
constexpr std::array<PresetPlace, 1> kWindnerdDirection = {{{"/wind_instant_dir", ""}}};

const std::array<Preset, 4> kMqttPresets = {
    {{.name = "number", .topic = "", .unit = "m/s"},
     {.name = "tasmota",
      .topic = "tele/+/SENSOR",
      .speed = kTasmotaSpeed,
      .direction = kTasmotaDirection,
      .gust = kTasmotaGust,
      .unit = "km/h",
      .unit_pointer = "/SpeedUnit",
      .quantities = quantities_of_tasmota},
     {.name = "rtl_433",
      .topic = "rtl_433/+/events",
      .speed = kRtl433Speed,
      .direction = kRtl433Direction,
      .gust = kRtl433Gust,
      .unit = "m/s",
      .names_stations = true,
      .quantities = quantities_of_rtl_433},
     {.name = "windnerd", .topic = "", .speed = kWindnerdSpeed, .direction = kWindnerdDirection, .unit = "m/s"}}};

}  // namespace

const Preset& mqtt_preset_of(std::string_view name) noexcept {
  return *std::ranges::find(kMqttPresets, name, &Preset::name);
}

std::string_view speed_unit_of_word(std::string_view word) noexcept {
  const auto unit = decode::speed_unit_of_word(word);
  if (!unit || std::ranges::find(sensor::kSpeedUnitNames, unit->name) == sensor::kSpeedUnitNames.end()) return "";
  return unit->name;
}

}  // namespace yuragi::drivers::mqtt
