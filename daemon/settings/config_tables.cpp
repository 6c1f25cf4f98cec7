#include "daemon/settings/config_tables.hpp"

#include <array>
#include <cstdint>
#include <string>

#include "daemon/settings/control_permission.hpp"
#include "daemon/settings/log_config.hpp"
#include "daemon/settings/recording_config.hpp"
#include "daemon/settings/shaping_config.hpp"
#include "drivers/sensor/speed_unit.hpp"
#include "engine/look/look.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::settings {
namespace {

const std::array kGeneralParameters = {
    Parameter{.name = "seed",
              .unit = "",
              .default_value = std::int64_t{1},
              .min = 0,
              .help = "seed of all random numbers: the same seed and wind give the same motion"},
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
              .help = "simultaneous connections; more are refused. The last 4 (of fewer than 8: half of them) are for "
                      "clients on this machine"},
    Parameter{.name = "max_clients_per_address",
              .unit = "",
              .default_value = std::int64_t{8},
              .min = 1,
              .max = 1000,
              .help = "simultaneous connections from each other machine; this machine has no such limit"},
    Parameter{.name = "control",
              .unit = "",
              .default_value = std::string("loopback"),
              .help =
                  "clients that may control scenes and recordings (yuragi scene, yuragi player), have this file read "
                  "again (yuragi reload), and see raw messages (yuragi sensors watch --raw): on this machine, "
                  "anywhere, or nobody",
              .choices = kControlPermissionNames},
};

constexpr std::array<std::string_view, 2> kReaders = {"anyone", "token"};

const std::array kHttpParameters = {
    Parameter{.name = "listen",
              .unit = "",
              .default_value = std::string(),
              .help = "address and port that browsers, scripts and Prometheus ask: 127.0.0.1:7480, or 0.0.0.0:7480 for "
                      "other machines, too; empty: none. Who may change something: token_file and [stream] control"},
    Parameter{.name = "hosts",
              .unit = "",
              .default_value = std::string(),
              .help = "names, with blanks between them, by which others call this machine, besides its own name, "
                      "localhost and its addresses; a request for any other is refused"},
    Parameter{
        .name = "token_file",
        .unit = "",
        .default_value = std::string(),
        .help = "a file with the token, which `yuragi token --new` makes; then only clients of the page and the stream "
                "that show it, and browsers that were paired with `yuragi token`, change something, whatever their "
                "address; empty: only this machine does. Behind a reverse proxy a token is required",
        .is_secret_file = true},
    Parameter{
        .name = "proxies",
        .unit = "",
        .default_value = std::string(),
        .help = "addresses, with blanks between them, of reverse proxies whose X-Forwarded-For is believed: 127.0.0.1; "
                "for the log and the limit of attempts to pair"},
    Parameter{.name = "readers",
              .unit = "",
              .default_value = std::string("anyone"),
              .help = "who may read over HTTP: anyone who reaches the port, or only those with the token; this machine "
                      "always reads /healthz",
              .choices = kReaders},
};

const std::array kRecordingParameters = {
    Parameter{
        .name = "file",
        .unit = "",
        .default_value = std::string(),
        .help = "record every reading into this file (.windlog); empty: record nothing; --record FILE overrides it"},
    Parameter{.name = "rotate",
              .unit = "",
              .default_value = std::string("never"),
              .help =
                  "begin a new file: never, or each day (UTC); completed files lie beside it, each with the moment of "
                  "its beginning in its name, and all of them are read as one recording",
              .choices = kRotationNames},
    Parameter{.name = "max_file_size",
              .unit = "MB",
              .default_value = 0.0,
              .min = 0.0,
              .max = 1e6,
              .help = "begin a new file when this one is larger; 0: never"},
    Parameter{.name = "keep_days",
              .unit = "days",
              .default_value = std::int64_t{0},
              .min = 0,
              .max = 36500,
              .help = "delete completed files that ended longer ago; 0: keep them"},
    Parameter{.name = "max_size",
              .unit = "MB",
              .default_value = 0.0,
              .min = 0.0,
              .max = 1e9,
              .help = "delete the oldest completed files while all files together are larger; 0: keep them"},
    Parameter{.name = "min_free",
              .unit = "MB",
              .default_value = 200.0,
              .min = 0.0,
              .max = 1e9,
              .help =
                  "space to leave free on the disk: below it the oldest completed files are deleted, and where that is "
                  "not enough nothing is recorded"},
};

const std::array kAnimationParameters = {
    Parameter{
        .name = "rate", .unit = "Hz", .default_value = 60.0, .min = 1.0, .max = 240.0, .help = "ticks per second"},
    Parameter{.name = "threads",
              .unit = "",
              .default_value = std::int64_t{1},
              .min = 1,
              .max = 64,
              .help = "threads that share a tick; more than one helps from about a million nodes on"},
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
              .help = "integral length scale of the gusts, of the default wind and between a sensor's readings; 0: "
                      "from the height in each sensor's calibration, 5.7 m per metre up to 60 m (25 m at 4.4 m, 85 m "
                      "at 15 m); without a height 57 m, as over open land at 10 m"},
    Parameter{.name = "gustiness",
              .unit = "",
              .default_value = 0.3,
              .min = 0.0,
              .max = 0.6,
              .help = "variation of the strength of generated gusts over some hundred metres of wind; about 0.3 in "
                      "real wind, 0: none. Measured gusts are not changed"},
    Parameter{.name = "site_octaves",
              .unit = "dB",
              .default_value = std::string(""),
              .help = "power of this site's gusts relative to the fit to a slow sensor, at 0.0375 to 0.075 Hz, 0.075 "
                      "to 0.15 Hz and so on, up to 7 numbers; `yuragi report` prints them for a recording of a fast "
                      "sensor. The daemon also fits them while a sensor with an interval of at most 1 s is live, and "
                      "keeps them in site_file of [shaping]"},
    Parameter{.name = "evolving",
              .unit = "",
              .default_value = true,
              .help = "gusts change while they travel; false: they travel unchanged (frozen turbulence)"},
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
    Parameter{.name = "relative_gains",
              .unit = "",
              .default_value = true,
              .help = "several sensors that differ by a constant factor, up to 1.5, are levelled to their common mean: "
                      "a sheltered and an exposed one, too, and what each reads times the group is shown. Learnt in "
                      "hours of wind, kept in site_file of [shaping]; false: no sensor is levelled"},
    Parameter{.name = "fallback_recording",
              .unit = "",
              .default_value = std::string{},
              .help = "a recording (.windlog) that is played while every sensor is silent; empty: none, the default "
                      "wind is used"},
    Parameter{.name = "fallback_after",
              .unit = "s",
              .default_value = 60.0,
              .min = 1.0,
              .max = 86400.0,
              .help = "for how long every sensor must have been silent before it is played"},
};

const std::array kLogParameters = {
    Parameter{.name = "level",
              .unit = "",
              .default_value = std::string("info"),
              .help = "lines of the log below this are not written; debug also has every attempt to connect to a "
                      "sensor, and --verbose sets it",
              .choices = kLogLevelNames},
};

const std::array kCalibrationParameters = {
    Parameter{.name = "unit",
              .unit = "",
              .default_value = std::string("m/s"),
              .help = "unit of the sensor's speeds, where its driver assumes m/s",
              .choices = drivers::sensor::kSpeedUnitNames},
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
              .help = "added to the speed after the gain, except in a calm"},
    Parameter{.name = "curve",
              .unit = "m/s",
              .default_value = std::string(""),
              .help = "applied after gain and offset: points measured:true, \"0:0 5:5.2 12:12.9\"; empty: none"},
    Parameter{.name = "north_offset",
              .unit = "deg",
              .default_value = 0.0,
              .min = -360.0,
              .max = 360.0,
              .help = "bearing of the sensor's north mark, clockwise from north"},
    Parameter{.name = "height",
              .unit = "m",
              .default_value = 0.0,
              .min = 0.0,
              .max = 1000.0,
              .help = "of the sensor above the ground, to scale its speeds to scene_height; also gives the length of "
                      "its gusts (default_length of [wind]); 0: speeds are not scaled"},
    Parameter{.name = "scene_height",
              .unit = "m",
              .default_value = 10.0,
              .min = 0.1,
              .max = 1000.0,
              .help = "height of the wind that moves the scenes"},
    Parameter{.name = "roughness",
              .unit = "m",
              .default_value = 0.03,
              .min = 0.0001,
              .max = 5.0,
              .help = "roughness length of the surrounding ground: 0.0002 water, 0.03 meadow, 0.5 suburb, 1 city"},
};

const std::array kJudgeParameters = {
    Parameter{.name = "enabled",
              .unit = "",
              .default_value = true,
              .help = "implausible readings are not used for the wind (but recorded); false: all readings are used; "
                      "simulated ones always are"},
    Parameter{.name = "max_speed",
              .unit = "m/s",
              .default_value = wind::kMaxPlausibleSpeed_m_s,
              .min = 1.0,
              .max = wind::kMaxPlausibleSpeed_m_s,
              .help = "a speed above this is out of the sensor's range"},
    Parameter{.name = "spike",
              .unit = "m/s",
              .default_value = 4.0,
              .min = 0.1,
              .max = 100.0,
              .help = "a difference from the last readings below this plus half of the speed is not a spike"},
    Parameter{.name = "slew",
              .unit = "m/s^2",
              .default_value = 5.0,
              .min = 0.01,
              .max = 1000.0,
              .help = "a larger step is accepted once it has lasted for step / rate"},
    Parameter{.name = "frozen",
              .unit = "s",
              .default_value = 30.0,
              .min = 1.0,
              .max = 86400.0,
              .help = "a sensor is frozen after 20 exactly equal readings over this time; the time is longer for a "
                      "sensor that often repeats values, or has never sent another"},
    Parameter{.name = "seized",
              .unit = "s",
              .default_value = 7200.0,
              .min = 60.0,
              .max = 864000.0,
              .help = "a cup is seized when it stands still for this time while the other sensors measure more than 3 "
                      "m/s; without other sensors after six times as long, following a windy day"},
    Parameter{.name = "compare",
              .unit = "",
              .default_value = true,
              .help = "compare its mean of 5 min with that of the other sensors (never for a microphone); with three "
                      "or more live sensors, one that differs from the majority by more than a factor of 3 and 3 m/s "
                      "for 10 min is not used"},
};

const std::array kCommonSceneParameters = {
    Parameter{.name = "x",
              .unit = "m",
              .default_value = 0.0,
              .min = -1000.0,
              .max = 1000.0,
              .help = "position of the scene to the east"},
    Parameter{.name = "y",
              .unit = "m",
              .default_value = 0.0,
              .min = -1000.0,
              .max = 1000.0,
              .help = "position of the scene upward"},
    Parameter{.name = "z",
              .unit = "m",
              .default_value = 0.0,
              .min = -1000.0,
              .max = 1000.0,
              .help = "position of the scene to the south"},
    Parameter{.name = "heading",
              .unit = "deg",
              .default_value = 0.0,
              .min = -360.0,
              .max = 360.0,
              .help = "rotation of the scene, clockwise from north; the wind is not rotated with it"},
    Parameter{.name = "gain",
              .unit = "",
              .default_value = 1.0,
              .min = 0.0,
              .max = 10.0,
              .help = "factor on the wind speed for this scene"},
    Parameter{.name = "shown",
              .unit = "",
              .default_value = true,
              .help = "false: hidden until `yuragi scene show` or `yuragi scene switch` shows it"},
};

const std::array kConfigTables = {
    ConfigTable{"", "at the top of the file", kGeneralParameters},
    ConfigTable{"stream", "where viewers connect", kStreamParameters},
    ConfigTable{"http", "state and control by HTTP", kHttpParameters},
    ConfigTable{"recording", "what is recorded, and how much of it is kept", kRecordingParameters},
    ConfigTable{"animation", "the pace", kAnimationParameters},
    ConfigTable{"wind", "the wind without a live sensor, and the transition from one wind to another", kWindParameters},
    ConfigTable{"shaping", "days without wind, storms, opening hours: from the real wind to the scenes'",
                shaping_parameters()},
    ConfigTable{"look", "light and weather of the picture; viewers follow it at once", look::look_parameters()},
    ConfigTable{"log", "what the daemon writes to standard error", kLogParameters},
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

std::span<const Parameter> http_parameters() {
  return kHttpParameters;
}

std::span<const Parameter> recording_parameters() {
  return kRecordingParameters;
}

std::span<const Parameter> animation_parameters() {
  return kAnimationParameters;
}

std::span<const Parameter> wind_parameters() {
  return kWindParameters;
}

std::span<const Parameter> log_parameters() {
  return kLogParameters;
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

}  // namespace yuragi::daemon::settings
