#include "daemon/settings/shaping_parameters.hpp"

#include <array>
#include <string>

namespace yuragi {
namespace {

const std::array kShapingParameters = {
    Parameter{.name = "floor",
              .unit = "m/s",
              .default_value = 0.0,
              .min = 0.0,
              .max = 10.0,
              .help = "the least mean speed: a weaker wind is slowly raised to it, gusts and all; 0: none"},
    Parameter{.name = "site_median",
              .unit = "m/s",
              .default_value = 0.0,
              .min = 0.0,
              .max = 30.0,
              .help = "what the site's usual wind (its median) is brought to by a slow gain; 0: no such gain"},
    Parameter{.name = "site_strong",
              .unit = "m/s",
              .default_value = 0.0,
              .min = 0.0,
              .max = 40.0,
              .help = "what its strong wind (95th percentile) is brought to; 0: by the gain of the median"},
    Parameter{.name = "site_most_gain",
              .unit = "",
              .default_value = 3.0,
              .min = 1.0,
              .max = 10.0,
              .help = "the largest site gain; the smallest is 1 over this"},
    Parameter{.name = "site_memory",
              .unit = "days",
              .default_value = 7.0,
              .min = 0.1,
              .max = 365.0,
              .help = "how long the site's wind is remembered for that; the gain grows from 1 in the first 6 hours"},
    Parameter{.name = "site_file",
              .unit = "",
              .default_value = std::string(""),
              .help =
                  "where that memory is kept over a restart, and what is learnt of the site's gusts (site_octaves of "
                  "[wind]); empty: both begin anew"},
    Parameter{.name = "over",
              .unit = "s",
              .default_value = 120.0,
              .min = 10.0,
              .max = 3600.0,
              .help = "how long floor and site gain take to follow the wind's mean"},
    Parameter{.name = "gusts",
              .unit = "",
              .default_value = 1.0,
              .min = 0.0,
              .max = 3.0,
              .help =
                  "how strong gusts and lulls are, compared with the real ones: 0: an even wind, 1: as they are, 2: "
                  "twice as strong; the mean speed stays"},
    Parameter{.name = "ceiling",
              .unit = "m/s",
              .default_value = 17.0,
              .min = 0.0,
              .max = 75.0,
              .help = "from this speed on more and more of a storm is held back; 0: nothing"},
    Parameter{.name = "ceiling_most",
              .unit = "m/s",
              .default_value = 25.0,
              .min = 1.0,
              .max = 100.0,
              .help = "the speed that no storm quite reaches; above ceiling"},
    Parameter{.name = "hours",
              .unit = "",
              .default_value = std::string(""),
              .help = "opening hours in local time, \"10:00-18:00\" or \"Tue-Sun 10:00-18:00, Thu 18:00-21:00\"; "
                      "outside of them the wind fades; empty: always open"},
    Parameter{.name = "zone",
              .unit = "",
              .default_value = std::string(""),
              .help = "the time zone of the hours, \"Europe/Berlin\"; empty: this machine's"},
    Parameter{.name = "closed",
              .unit = "",
              .default_value = 0.0,
              .min = 0.0,
              .max = 1.0,
              .help = "the part of the wind that is left when closed; 0: calm"},
    Parameter{.name = "fade",
              .unit = "s",
              .default_value = 300.0,
              .min = 1.0,
              .max = 7200.0,
              .help = "how long the way from open to closed takes, and back; it begins at the hour"},
};

}  // namespace

std::span<const Parameter> shaping_parameters() {
  return kShapingParameters;
}

}  // namespace yuragi
