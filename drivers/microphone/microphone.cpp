// A bare microphone outdoors as an anemometer: wind is stagnation pressure at the microphone, whose root mean square in
// a low band goes as a power of the speed. One to four channels, by PortAudio, in a process of its own.
//
//   mic-worker (process)                                this driver
//   PortAudio -> SpscRing -> band powers, cross powers -> pipe -> coherence, noise floor, calibration -> wind::Reading
//
// Sources: Morgan and Raspet 1992, "Investigation of the mechanisms of low-frequency wind noise generation outdoors";
// Raspet, Webster and Dillion 2006, "Framework for wind noise studies" (stagnation pressure, f^-7/3); Nelke and Vary
// 2014, "Measurement, analysis and simulation of wind noise signals for mobile communication devices" (coherence).
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "drivers/bus/process_port.hpp"
#include "drivers/microphone/microphone_calibration.hpp"
#include "drivers/microphone/microphone_sensor.hpp"
#include "drivers/sensor/driver.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::microphone {
namespace {

using decode::microphone::MicEstimatorOptions;

/// What the worker records.
struct Input {
  std::string device;
  std::string host_api;
  std::size_t channels = 1;
  double rate_hz = 0.0;
};

const Fields<Input> kInputFields = {
    {{.name = "device",
      .default_value = std::string(""),
      .help =
          "part of the input's name, ignoring case, as `yuragi mic-worker --list` prints it; empty: the default input"},
     &Input::device},
    {{.name = "host_api",
      .default_value = std::string(""),
      .help = "part of the sound system's name (ALSA, JACK), if several have an input of that name"},
     &Input::host_api},
    {{"channels", "", std::int64_t{1}, 1, static_cast<double>(decode::microphone::kMicMaxChannels),
      "number of microphones; with two or more, sound that reaches all alike does not count as wind"},
     &Input::channels},
    {{"rate", "Hz", 0.0, 0.0, 192000.0, "sample rate; 0: the preferred rate of the device"}, &Input::rate_hz},
};

struct Keys {
  Settings settings;
  std::string faces;
  std::string worker;
};

auto of_estimator(auto member) {
  return member_of(&Keys::settings, &Settings::estimator, member);
}

const Fields<Keys> kMicrophoneFields = {
    {{"noise_memory", "s", 86400.0, 60.0, 604800.0,
      "memory of levels for this; no noise is subtracted in the first hour"},
     of_estimator(&MicEstimatorOptions::noise_memory_s)},
    {{.name = "ignore_sound",
      .default_value = true,
      .help = "with two or more channels: sound that reaches all alike, such as voices and music, does not count"},
     of_estimator(&MicEstimatorOptions::ignores_sound)},
    {{.name = "faces",
      .unit = "deg",
      .default_value = std::string(""),
      .help = "the directions that three or four microphones face, clockwise from north, such as \"0 120 240\"; empty: "
              "no direction"},
     &Keys::faces},
    {{"direction_smoothing", "s", 5.0, 0.5, 600.0, "time constant of the direction, smoothed as a vector"},
     of_estimator(&MicEstimatorOptions::direction_smoothing_s)},
    {{"least_confidence", "", 0.3, 0.0, 1.0, "minimum confidence of a direction; a reading below it has no direction"},
     of_estimator(&MicEstimatorOptions::least_confidence)},
    {{"window", "s", 1.0, 0.25, 60.0, "averaging time of each reading; there are four readings per second"},
     of_estimator(&MicEstimatorOptions::window_s)},
    {{"timeout", "s", 3.0, 1.0, 60.0, "silence from the worker after which it is killed and started again"},
     [](Keys& keys) -> Nanoseconds& { return keys.settings.sound_timeout; },
     from_seconds},
    {{.name = "worker", .default_value = std::string(""), .help = "path of the worker program; empty: this program"},
     &Keys::worker},
};

const std::vector<Parameter> kMicrophoneParameters =
    together(together(kInputFields.parameters(), mic_level_parameters()), kMicrophoneFields.parameters());

/// "0 120 240", with blanks or commas.
std::vector<double> parse_faces(const std::string& text) {
  std::vector<double> faces_deg;
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  while (at != end) {
    if (*at == ' ' || *at == ',') {
      ++at;
      continue;
    }
    double face_deg = 0.0;
    const auto [next, error] = std::from_chars(at, end, face_deg);
    if (error != std::errc() || !(std::abs(face_deg) <= 360.0)) {
      throw std::runtime_error("faces = \"" + text + "\": write degrees from north, such as \"0 120 240\"");
    }
    faces_deg.push_back(face_deg);
    at = next;
  }
  return faces_deg;
}

/// Throws if they cannot work together.
Settings settings_of(const Keys& keys, const MicLevelSettings& level, std::size_t channels) {
  Settings settings = keys.settings;
  MicEstimatorOptions& estimator = settings.estimator;
  settings.is_calibrated = level.is_calibrated;
  estimator.calibration = level.calibration;
  estimator.noise_floor_db = level.noise_floor_db;

  estimator.faces_deg = parse_faces(keys.faces);
  if (!estimator.faces_deg.empty()) {
    if (estimator.faces_deg.size() != channels) {
      throw std::runtime_error("faces: needs one direction for each channel");
    }
    try {
      decode::microphone::MicDirection(estimator.faces_deg, estimator.direction_smoothing_s);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(std::string("faces: ") + error.what());
    }
  }
  if (level.band_high_hz < 1.5 * level.band_low_hz) {
    throw std::runtime_error("band_high must be at least 1.5 times band_low");
  }
  return settings;
}

std::unique_ptr<sensor::Sensor> open_microphone(const ParameterValues& values) {
  const Input input = kInputFields.of(values);
  const MicLevelSettings level = mic_level_settings_of(values);
  const Keys keys = kMicrophoneFields.of(values);
  std::vector<std::string> command = {keys.worker.empty() ? microphone_worker_program() : keys.worker,
                                      "mic-worker",
                                      fmt::format("--channels={}", input.channels),
                                      fmt::format("--rate={}", input.rate_hz),
                                      fmt::format("--band-low={}", level.band_low_hz),
                                      fmt::format("--band-high={}", level.band_high_hz)};
  if (!input.device.empty()) command.push_back("--device=" + input.device);
  if (!input.host_api.empty()) command.push_back("--host-api=" + input.host_api);
  return std::make_unique<Sensor>(settings_of(keys, level, input.channels), sensor::seed_of(input.device),
                                  bus::make_process_port(std::move(command)));
}

/// A part of a name selects the first input that has it, so that a shorter part may select the same one. Sensors with
/// different numbers of channels all begin with the first channel.
bool name_covers(const std::string& wide, const std::string& narrow) {
  return narrow.find(wide) != std::string::npos;
}

sensor::ValueSelection microphone_selection(const ParameterValues& values) {
  const auto lower = [](std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
  };
  const Input input = kInputFields.of(values);
  const std::string device = lower(input.device);
  const std::string host_api = lower(input.host_api);
  return {.device = device.empty() && host_api.empty() ? "the default sound input" : "sound input",
          .parts = {{.key = "device", .value = device, .covers = name_covers},
                    {.key = "host_api", .value = host_api, .covers = name_covers}}};
}

std::vector<sensor::FoundDevice> find_plugged_microphones() {
  return find_microphones(microphone_worker_program());
}

/// The power of the sound is averaged over the window.
std::optional<sensor::StatedValue> microphone_value(const ParameterValues& values) {
  const double window_s = kMicrophoneFields.of(values).settings.estimator.window_s;
  return sensor::StatedValue{
      .value = wind::ReadingValue::kMean, .averaging_s = window_s, .source = "the driver's window"};
}

}  // namespace

extern const sensor::DriverDescription kMicrophoneDriver;
const sensor::DriverDescription kMicrophoneDriver{
    .name = "microphone",
    .summary = "one to four bare microphones, through PortAudio",
    .parameters = kMicrophoneParameters,
    .open = open_microphone,
    .find = find_plugged_microphones,
    .endpoints =
        [](const ParameterValues&) { return std::vector{sensor::Endpoint{.kind = sensor::EndpointKind::kSoundCard}}; },
    .selection = microphone_selection,
    .stated_value = microphone_value,
    .simulated = [](const ParameterValues&) -> Result<sensor::SimulatedDevice, Failure> {
      return Failure{
          "a simulated microphone cannot be started here: it needs a virtual sound input, and the permission to create "
          "it"};
    },
    .calibration = sensor::CalibrationMeans::kSoundLevel,
    .is_relative = true};

}  // namespace yuragi::drivers::microphone
