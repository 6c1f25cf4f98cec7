#include "daemon/settings/wind_config.hpp"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string>
#include <utility>

#include "daemon/settings/site_octaves.hpp"
#include "engine/base/address.hpp"
#include "engine/base/fields.hpp"
#include "engine/wind/blend/blend_settings.hpp"

namespace yuragi::daemon::settings {
namespace {

/// [wind] as it is written.
struct WindTable {
  WindConfig wind;
  std::string fallback_recording;
  double fallback_after_s = 0.0;
};

auto of_wind(auto member) {
  return member_of(&WindTable::wind, member);
}

auto of_lead(auto member) {
  return member_of(&WindTable::wind, &WindConfig::lead, member);
}

/// "nats://one:4222, nats://two:4222".
Result<std::vector<std::string>, Failure> servers_of(const std::string& text) {
  std::vector<std::string> servers;
  std::istringstream words(text);
  for (std::string server; std::getline(words >> std::ws, server, ',');) {
    server.erase(server.find_last_not_of(' ') + 1);
    const std::size_t begin = server.find("://");
    const std::string scheme = server.substr(0, begin);
    if (begin == std::string::npos || (scheme != "nats" && scheme != "tls"))
      return Failure{"a server is nats://HOST:PORT or tls://HOST:PORT, several with commas between them"};
    if (const auto address = parse_address(server.substr(begin + 3)); !address) return address.error();
    servers.push_back(std::move(server));
  }
  return servers;
}

/// A word of a subject of NATS, or several with dots between them.
Result<std::string, Failure> channel_of(const std::string& text) {
  const bool is_word =
      !text.empty() && text.front() != '.' && text.back() != '.' && text.find("..") == std::string::npos &&
      text.size() <= 100 &&
      text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.") == std::string::npos;
  if (!is_word) return Failure{"a channel has letters, digits, - and _, with dots between its words: \"museum.roof\""};
  return {boost::system::in_place_value, text};
}

std::optional<double> length_unless_0(double length_m) {
  if (length_m == 0.0) return std::nullopt;
  return std::max(length_m, kMinGusts_m);
}

const Fields<WindTable>& wind_fields() {
  static const Fields<WindTable> kFields{
      {{.name = "default_speed",
        .unit = "m/s",
        .default_value = 3.0,
        .min = 0.0,
        .max = 40.0,
        .help = "mean speed of the wind that is used while no sensor is live"},
       of_wind(&WindConfig::default_speed_m_s)},
      {{.name = "default_direction",
        .unit = "deg",
        .default_value = 240.0,
        .min = 0.0,
        .max = 360.0,
        .help = "where that wind comes from, clockwise from north; also used for sensors without a vane"},
       of_wind(&WindConfig::default_direction_deg)},
      {{.name = "default_turbulence",
        .default_value = 0.3,
        .min = 0.0,
        .max = 1.0,
        .help = "its turbulence intensity: standard deviation over mean speed"},
       of_wind(&WindConfig::default_turbulence_intensity)},
      {{.name = "default_length",
        .unit = "m",
        .default_value = 0.0,
        .min = 0.0,
        .max = 1000.0,
        .help = "integral length scale of the gusts, of the default wind and between a sensor's readings; 0: "
                "from the height in each sensor's calibration, 5.7 m per metre up to 60 m (25 m at 4.4 m, 85 m "
                "at 15 m); without a height 57 m, as over open land at 10 m"},
       of_wind(&WindConfig::default_length_m),
       length_unless_0},
      {{.name = "gustiness",
        .default_value = 0.3,
        .min = 0.0,
        .max = 0.6,
        .help = "variation of the strength of generated gusts over some hundred metres of wind; about 0.3 in "
                "real wind, 0: none. Measured gusts are not changed"},
       of_wind(&WindConfig::gustiness)},
      {{.name = "site_octaves",
        .unit = "dB",
        .default_value = std::string(""),
        .help = "power of this site's gusts relative to the fit to a slow sensor, at 0.0375 to 0.075 Hz, 0.075 "
                "to 0.15 Hz and so on, up to 7 numbers; `yuragi report` prints them for a recording of a fast "
                "sensor. The daemon also fits them while a sensor with an interval of at most 1 s is live, and "
                "keeps them in site_file of [shaping]"},
       of_wind(&WindConfig::site_octaves_db),
       parse_site_octaves},
      {{.name = "evolving",
        .default_value = true,
        .help = "gusts change while they travel; false: they travel unchanged (frozen turbulence)"},
       of_wind(&WindConfig::is_evolving)},
      {{.name = "handover",
        .unit = "s",
        .default_value = 3.0,
        .min = 0.2,
        .max = 60.0,
        .help = "duration of the transition from one source of wind to another"},
       of_wind(&WindConfig::handover_s)},
      {{.name = "stale_intervals",
        .default_value = 5.0,
        .min = 2.0,
        .max = 100.0,
        .help = "a sensor that is silent for this many of its own intervals is stale"},
       of_wind(&WindConfig::stale_intervals)},
      {{.name = "return_after",
        .unit = "s",
        .default_value = 10.0,
        .min = 0.0,
        .max = 3600.0,
        .help = "a stale sensor is used again after it has sent readings for this long; twice as long each time"},
       of_wind(&WindConfig::return_after_s)},
      {{.name = "relative_gains",
        .default_value = true,
        .help = "several sensors that differ by a constant factor, up to 1.5, are levelled to their common mean: "
                "a sheltered and an exposed one, too, and what each reads times the group is shown. Learnt in "
                "hours of wind, kept in site_file of [shaping]; false: no sensor is levelled"},
       of_wind(&WindConfig::has_relative_gains)},
      {{.name = "fallback_recording",
        .default_value = std::string{},
        .help = "a recording (.windlog) that is played while every sensor is silent; empty: none, the default "
                "wind is used"},
       &WindTable::fallback_recording},
      {{.name = "fallback_after",
        .unit = "s",
        .default_value = 60.0,
        .min = 1.0,
        .max = 86400.0,
        .help = "for how long every sensor must have been silent before it is played"},
       &WindTable::fallback_after_s},
      {{.name = "lead",
        .default_value = std::string{},
        .help = "other daemons move in this one's wind: the NATS servers, one after the other tried, that pass it on "
                "(\"nats://10.0.0.5:4222, nats://10.0.0.6:4222\"); empty: none. Together with follow: a stand-by, "
                "which leads while no other leader is heard"},
       of_lead(&LeadConfig::lead),
       servers_of},
      {{.name = "follow",
        .default_value = std::string{},
        .help = "this daemon moves in the wind of one that leads, by way of these NATS servers; with the same scenes "
                "it has the same poses. While the leader is silent its own sensors are used; empty: always"},
       of_lead(&LeadConfig::follow),
       servers_of},
      {{.name = "delay",
        .unit = "s",
        .default_value = 0.3,
        .min = 0.05,
        .max = 5.0,
        .help = "from a tick of the leader's wind to its playing, on the leader's walls and on all others: a tick that "
                "is lost on the way can be asked for again meanwhile. The same for all, for walls in step"},
       of_lead(&LeadConfig::delay_s)},
      {{.name = "channel",
        .default_value = std::string("wind"),
        .help = "how the subjects at the NATS server begin: another one for each leader"},
       of_lead(&LeadConfig::channel),
       channel_of},
      {{.name = "node",
        .default_value = std::string{},
        .help = "what this daemon is called in the list of all, `yuragi fleet`: \"room 3, north wall\"; empty: the "
                "machine's name"},
       of_lead(&LeadConfig::node)},
      {{.name = "credentials",
        .default_value = std::string{},
        .help = "a file with what the NATS server knows this daemon by: NAME:PASSWORD, or the seed of an nkey; empty: "
                "nothing. Only its owner may be able to read it",
        .is_secret_file = true},
       of_lead(&LeadConfig::credentials)},
      {{.name = "authorities",
        .default_value = std::string{},
        .help = "a file with the certificates (PEM) by which a tls:// server is believed; empty: the system's"},
       of_lead(&LeadConfig::authorities)},
  };
  return kFields;
}

}  // namespace

double WindConfig::gust_length_m() const noexcept {
  return default_length_m.value_or(wind::blend::Settings{}.length_m);
}

std::span<const Parameter> wind_parameters() {
  return wind_fields().parameters();
}

std::vector<ParameterError> fill_wind(WindConfig& wind, const ParameterValues& values) {
  WindTable table;
  std::vector<ParameterError> errors = wind_fields().fill(table, values.all());
  wind = std::move(table.wind);
  const LeadConfig& lead = wind.lead;
  if (!lead.lead.empty() && !lead.follow.empty() && lead.lead != lead.follow)
    errors.push_back({"lead", "a stand-by leads by way of the same servers as it follows"});
  if (!table.fallback_recording.empty())
    wind.fallback = {.recording = table.fallback_recording, .after_s = table.fallback_after_s};
  return errors;
}

}  // namespace yuragi::daemon::settings
