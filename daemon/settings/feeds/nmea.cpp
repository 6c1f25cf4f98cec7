#include "daemon/settings/feeds/nmea.hpp"

#include <utility>

#include "engine/base/address.hpp"

namespace yuragi::daemon::settings::feeds {
namespace {

Result<std::string, Failure> checked_address(const std::string& text) {
  if (text.empty()) return {boost::system::in_place_value, text};
  if (const auto address = parse_address(text); !address) return address.error();
  return {boost::system::in_place_value, text};
}

const Fields<Nmea>& nmea_fields() {
  static const Fields<Nmea> kFields{
      {{.name = "to",
        .default_value = std::string("127.0.0.1:10110"),
        .help = "HOST:PORT to which sentences are sent by UDP, also a broadcast address; empty: to nobody"},
       &Nmea::to,
       checked_address},
      {{.name = "listen",
        .default_value = std::string(),
        .help = "HOST:PORT at which up to 16 programs get the sentences by TCP: 0.0.0.0:10110; empty: none"},
       &Nmea::listen,
       checked_address},
      {{.name = "rate",
        .unit = "Hz",
        .default_value = 1.0,
        .min = 1.0,
        .max = 10.0,
        .help = "how often MWV and MWD are sent"},
       &Nmea::rate_hz},
      {{.name = "wind",
        .default_value = std::string(values::kWindNames[0]),
        .help = "shaped: the wind that moves the scenes; real: the measured wind, marked as invalid while no sensor is "
                "live",
        .choices = values::kWindNames},
       &Nmea::wind},
  };
  return kFields;
}

}  // namespace

std::span<const Parameter> nmea_parameters() {
  return nmea_fields().parameters();
}

Result<Nmea, ParameterError> nmea_of(std::string name, const ParameterValues& values) {
  auto nmea = made_of(nmea_fields(), values);
  if (!nmea) return nmea;
  nmea->name = std::move(name);
  if (nmea->to.empty() && nmea->listen.empty())
    return ParameterError{"to", "and listen are empty; give one of them an address"};
  if (!nmea->to.empty() && parse_address(nmea->to).value().port == 0)
    return ParameterError{"to", "has port 0; give the port on which the receiver listens"};
  return nmea;
}

}  // namespace yuragi::daemon::settings::feeds
