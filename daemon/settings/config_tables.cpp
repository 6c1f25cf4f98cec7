#include "daemon/settings/config_tables.hpp"

#include <array>
#include <cstdint>
#include <string>

#include "daemon/settings/control_permission.hpp"
#include "daemon/settings/shaping_parameters.hpp"
#include "drivers/sensor/speed_unit.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi {
namespace {

const std::array kGeneralParameters = {
    Parameter{.name = "seed",
              .unit = "",
              .default_value = std::int64_t{1},
              .min = 0,
              .help = "everything random comes from it: the same seed and wind give the same motion"},
};

const std::array kStreamParameters = {
    Parameter{.name = "listen",
              .unit = "",
              .default_value = std::string("127.0.0.1:7410"),
              .help = "address and port that viewers connect to; 0.0.0.0:7410 accepts other machines, too"},
    Parameter{.name = "max_clients",
              .unit = "",
              .default_value = std::int64_t{32},
              .min = 1,
              .max = 1000,
              .help = "simultaneous connections; more are refused"},
    Parameter{.name = "control",
              .unit = "",
              .default_value = std::string("loopback"),
              .help = "from where scenes may be shown and hidden (yuragi scene): this machine, anywhere, or nobody",
              .choices = kControlPermissionNames},
};

const std::array kAnimationParameters = {
    Parameter{.name = "rate", .unit = "Hz", .default_value = 60.0, .min = 1.0, .max = 240.0, .help = "poses a second"},
    Parameter{.name = "threads",
              .unit = "",
              .default_value = std::int64_t{1},
              .min = 1,
              .max = 64,
              .help = "threads that share a tick: more than one is worth while from about a million nodes on"},
};

const std::array kWindParameters = {
    Parameter{.name = "default_speed",
              .unit = "m/s",
              .default_value = 3.0,
              .min = 0.0,
              .max = 40.0,
              .help = "mean speed of the wind that is used while no sensor is live"},
    Parameter{.name = "default_direction",
              .unit = "deg",
              .default_value = 240.0,
              .min = 0.0,
              .max = 360.0,
              .help = "where that wind comes from, clockwise from north; also used for sensors without a vane"},
    Parameter{.name = "default_turbulence",
              .unit = "",
              .default_value = 0.3,
              .min = 0.0,
              .max = 1.0,
              .help = "its turbulence intensity: standard deviation over mean speed"},
    Parameter{.name = "default_length",
              .unit = "m",
              .default_value = 0.0,
              .min = 0.0,
              .max = 1000.0,
              .help = "how far gusts reach, that wind's and those between a sensor's readings: the integral length "
                      "scale; 0: by the height in each sensor's calibration, 5.7 m a metre up to 60 m (25 m at 4.4 m, "
                      "85 m at 15 m); where none is told, 57 m, as over open land at 10 m"},
    Parameter{.name = "gustiness",
              .unit = "",
              .default_value = 0.3,
              .min = 0.0,
              .max = 0.6,
              .help = "how much gusts differ in strength: in real wind some hundred metres are gustier than the next "
                      "(about 0.3); 0: all alike. Of the gusts that are made up, not of those that a sensor measured"},
    Parameter{.name = "site_octaves",
              .unit = "dB",
              .default_value = std::string(""),
              .help = "how much stronger than a slow sensor lets expect the gusts of this site are at 0.0375 to 0.075 "
                      "Hz, 0.075 to 0.15 Hz and so on, up to 7 numbers, as `yuragi report` prints them for a recording "
                      "of a quick sensor; the daemon learns them too, while a sensor of 1 s or quicker speaks, and "
                      "keeps them in site_file of [shaping]"},
    Parameter{.name = "evolving",
              .unit = "",
              .default_value = true,
              .help = "gusts change while they travel; false: they pass as a picture does (frozen turbulence)"},
    Parameter{.name = "handover",
              .unit = "s",
              .default_value = 3.0,
              .min = 0.2,
              .max = 60.0,
              .help = "duration of the transition from one source of wind to another"},
    Parameter{.name = "stale_intervals",
              .unit = "",
              .default_value = 5.0,
              .min = 2.0,
              .max = 100.0,
              .help = "a sensor that is silent for this many of its own intervals is stale"},
    Parameter{.name = "return_after",
              .unit = "s",
              .default_value = 10.0,
              .min = 0.0,
              .max = 3600.0,
              .help = "a stale sensor is used again after it has sent readings for this long; twice as long each time"},
    Parameter{.name = "fallback_recording",
              .unit = "",
              .default_value = std::string{},
              .help = "a .windlog that is played while every sensor is silent; empty: the default wind blows then"},
    Parameter{.name = "fallback_after",
              .unit = "s",
              .default_value = 60.0,
              .min = 1.0,
              .max = 86400.0,
              .help = "how long every sensor must have been silent for that"},
};

const std::array kCalibrationParameters = {
    Parameter{.name = "unit",
              .unit = "",
              .default_value = std::string("m/s"),
              .help = "what the sensor's numbers really are, where its driver takes them for m/s",
              .choices = kSpeedUnitNames},
    Parameter{.name = "gain",
              .unit = "",
              .default_value = 1.0,
              .min = 0.01,
              .max = 100.0,
              .help = "the speed in m/s is multiplied by this"},
    Parameter{.name = "offset",
              .unit = "m/s",
              .default_value = 0.0,
              .min = -20.0,
              .max = 20.0,
              .help = "and this is added, but for a calm"},
    Parameter{.name = "curve",
              .unit = "m/s",
              .default_value = std::string(""),
              .help = "then points measured:true, \"0:0 5:5.2 12:12.9\"; empty: none"},
    Parameter{.name = "north_offset",
              .unit = "deg",
              .default_value = 0.0,
              .min = -360.0,
              .max = 360.0,
              .help = "clockwise: where the sensor's mark points instead of to north"},
    Parameter{.name = "height",
              .unit = "m",
              .default_value = 0.0,
              .min = 0.0,
              .max = 1000.0,
              .help =
                  "of the sensor above the ground; it says how far its gusts reach, too (default_length of [wind]); "
                  "0: the wind is taken as it is measured"},
    Parameter{.name = "scene_height",
              .unit = "m",
              .default_value = 10.0,
              .min = 0.1,
              .max = 1000.0,
              .help = "the height whose wind moves the scenes"},
    Parameter{.name = "roughness",
              .unit = "m",
              .default_value = 0.03,
              .min = 0.0001,
              .max = 5.0,
              .help = "of the ground around: 0.0002 water, 0.03 meadow, 0.5 suburb, 1 city"},
};

const std::array kJudgeParameters = {
    Parameter{.name = "enabled",
              .unit = "",
              .default_value = true,
              .help =
                  "readings that are not believable are kept from the wind (never from a recording); false: all are "
                  "taken; simulated ones always are"},
    Parameter{.name = "max_speed",
              .unit = "m/s",
              .default_value = kMaxPlausibleSpeed_m_s,
              .min = 1.0,
              .max = kMaxPlausibleSpeed_m_s,
              .help = "faster than this is out of the sensor's range"},
    Parameter{.name = "spike",
              .unit = "m/s",
              .default_value = 4.0,
              .min = 0.1,
              .max = 100.0,
              .help = "what differs from the last readings by less than this and half the wind is no spike"},
    Parameter{.name = "slew",
              .unit = "m/s^2",
              .default_value = 5.0,
              .min = 0.01,
              .max = 1000.0,
              .help = "a larger step is believed once it has lasted for as long as it takes at this rate"},
    Parameter{.name = "frozen",
              .unit = "s",
              .default_value = 30.0,
              .min = 1.0,
              .max = 86400.0,
              .help =
                  "exactly the same for so long, and 20 times, is frozen; a sensor that repeats itself by nature, or "
                  "never said anything else, has longer"},
    Parameter{.name = "seized",
              .unit = "s",
              .default_value = 7200.0,
              .min = 60.0,
              .max = 864000.0,
              .help = "standing still for so long while the other sensors have more than 3 m/s is seized; one that is "
                      "alone has six times as long, after a windy day"},
    Parameter{.name = "compare",
              .unit = "",
              .default_value = true,
              .help = "its mean over 5 min is compared with the other sensors' (a microphone's never is); where three "
                      "or more speak, one that "
                      "differs from most by more than 3 times and 3 m/s for 10 min is not believed"},
};

const std::array kCommonSceneParameters = {
    Parameter{.name = "x",
              .unit = "m",
              .default_value = 0.0,
              .min = -1000.0,
              .max = 1000.0,
              .help = "where the scene stands, to the east"},
    Parameter{.name = "y", .unit = "m", .default_value = 0.0, .min = -1000.0, .max = 1000.0, .help = "upward"},
    Parameter{.name = "z", .unit = "m", .default_value = 0.0, .min = -1000.0, .max = 1000.0, .help = "to the south"},
    Parameter{.name = "heading",
              .unit = "deg",
              .default_value = 0.0,
              .min = -360.0,
              .max = 360.0,
              .help = "where the scene's own north points to, clockwise from north; the wind is not turned with it"},
    Parameter{.name = "gain",
              .unit = "",
              .default_value = 1.0,
              .min = 0.0,
              .max = 10.0,
              .help = "how many times stronger than it is the wind is for this scene"},
    Parameter{.name = "shown",
              .unit = "",
              .default_value = true,
              .help = "false: hidden until `yuragi scene show` or `switch` asks for it"},
};

const std::array kConfigTables = {
    ConfigTable{"", "at the top of the file", kGeneralParameters},
    ConfigTable{"stream", "where viewers connect", kStreamParameters},
    ConfigTable{"animation", "the pace", kAnimationParameters},
    ConfigTable{"wind", "the wind without a live sensor, and the transition from one wind to another", kWindParameters},
    ConfigTable{"shaping", "days without wind, storms, opening hours: from the real wind to the scenes'",
                shaping_parameters()},
};

}  // namespace

std::span<const ConfigTable> config_tables() {
  return kConfigTables;
}

std::span<const Parameter> general_parameters() {
  return kGeneralParameters;
}

std::span<const Parameter> stream_parameters() {
  return kStreamParameters;
}

std::span<const Parameter> animation_parameters() {
  return kAnimationParameters;
}

std::span<const Parameter> wind_parameters() {
  return kWindParameters;
}

std::span<const Parameter> calibration_parameters() {
  return kCalibrationParameters;
}

std::span<const Parameter> judge_parameters() {
  return kJudgeParameters;
}

std::span<const Parameter> common_scene_parameters() {
  return kCommonSceneParameters;
}

}  // namespace yuragi
