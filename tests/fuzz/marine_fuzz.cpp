// Any bytes as lines of NMEA 2000 gateways, of candump, of canboat and of a Signal K server: what is decoded has a
// speed and is physical.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "drivers/decode/marine/actisense.hpp"
#include "drivers/decode/marine/bus_line.hpp"
#include "drivers/decode/marine/canboat.hpp"
#include "drivers/decode/marine/canboat_plain.hpp"
#include "drivers/decode/marine/candump.hpp"
#include "drivers/decode/marine/signalk.hpp"
#include "drivers/decode/marine/yacht_devices.hpp"

namespace {

using namespace yuragi::drivers::decode;

void require_marine(bool holds) {
  if (!holds) std::abort();
}

void require_wind(const yuragi::Result<marine::BusWind, Refusal>& said) {
  if (said) require_marine(said->wind.speed_m_s.has_value() && checked(said->wind).has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
  const std::string line(reinterpret_cast<const char*>(data), size);
  require_wind(marine::decode_yacht_devices(line));
  for (const std::string& frame : {line, "can0 09FD0205#" + line, "can0  09FD0205   [8]  " + line}) {
    require_wind(marine::decode_candump(frame));
    const auto told = marine::candump_controller_state(frame);
    if (told) require_marine(marine::decode_candump(frame).error() == Refusal::kException);
  }
  for (const std::string& message : {line, "2018-02-14T15:55:07.944Z,2,130306,3,255,8," + line})
    require_wind(marine::decode_canboat_plain(message));
  for (const std::string& message : {line, "A173321.107 23FF2 1FD02 " + line})
    require_wind(marine::decode_actisense(message));
  for (const std::string& message : {line, "1597516803000;A;" + line}) {
    const auto time = marine::bus_line_time(message);
    if (time) require_marine(!time->text.empty() && message.find(time->text) != message.npos);
    static_cast<void>(marine::bus_line_format_of(message));
  }
  require_wind(marine::decode_wind_data(1, ByteSpan(data, size)));
  for (const std::string& record : {line, R"({"src":1,"pgn":130306,"fields":{)" + line + "}}"}) {
    require_wind(marine::decode_canboat({.angle_unit = {}}, record));
    require_wind(marine::decode_canboat({.angle_unit = marine::AngleUnit::kRadians}, record));
    static_cast<void>(marine::canboat_angle_unit(record));
  }
  marine::BusLineDecoder lines({});
  for (const std::string& each : {line, "can0 20000040#" + line, "1597516803000;A;" + line, line})
    require_wind(lines.decode(each));
  static_cast<void>(marine::signalk_hello(line));
  for (const std::string& delta : {line, R"({"updates":[{"values":[)" + line + "]}]}"}) {
    const auto said = marine::decode_signalk(delta);
    if (!said) continue;
    for (const marine::SignalKUpdate& update : said->updates) {
      for (const auto& wind : marine::signalk_winds(update.values)) {
        if (wind) require_marine(checked(wind->wind).has_value());
      }
    }
  }
  return 0;
}
