// A bare microphone outdoors as an anemometer: wind is stagnation pressure at the microphone, whose root mean square in
// a low band goes as a power of the speed. One to four channels, by PortAudio, in a process of its own.
//
//   mic-worker (process)                                this driver
//   PortAudio -> SpscRing -> band powers, cross powers -> pipe -> coherence, noise floor, calibration -> WindReading
//
// Sources: Morgan and Raspet 1992, "Investigation of the mechanisms of low-frequency wind noise generation outdoors";
// Raspet, Webster and Dillion 2006, "Framework for wind noise studies" (stagnation pressure, f^-7/3); Nelke and Vary
// 2014, "Measurement, analysis and simulation of wind noise signals for mobile communication devices" (coherence).
#include <algorithm>
#include <array>
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

namespace yuragi::drivers::microphone {
namespace {

const std::array kMicrophoneParameters = {
    Parameter{.name = "device",
              .unit = "",
              .default_value = std::string(""),
              .help = "part of the input's name, ignoring case, as `yuragi mic-worker --list` prints it; empty: the "
                      "default input"},
    Parameter{.name = "host_api",
              .unit = "",
              .default_value = std::string(""),
              .help = "part of the sound system's name (ALSA, JACK), where several have an input of that name"},
    Parameter{.name = "channels",
              .unit = "",
              .default_value = std::int64_t{1},
              .min = 1,
              .max = static_cast<double>(decode::microphone::kMicMaxChannels),
              .help = "number of microphones; with two or more, sound that reaches all alike does not count as wind"},
    Parameter{.name = "rate",
              .unit = "Hz",
              .default_value = 0.0,
              .min = 0.0,
              .max = 192000.0,
              .help = "sample rate; 0: the preferred rate of the device"},
    Parameter{.name = "band_low",
              .unit = "Hz",
              .default_value = 20.0,
              .min = 2.0,
              .max = 1000.0,
              .help = "lower limit of the band of the wind: what the microphone still passes"},
    Parameter{.name = "band_high",
              .unit = "Hz",
              .default_value = 200.0,
              .min = 10.0,
              .max = 2000.0,
              .help = "upper limit of the band"},
    Parameter{.name = "gain",
              .unit = "m/s",
              .default_value = 0.0,
              .min = 0.0,
              .max = 1e6,
              .help = "calibration: speed = gain (P - P_noise)^(1 / (2 exponent)), P the mean square in the band; 0: "
                      "not calibrated; 20 is used, and every reading is uncertain"},
    Parameter{.name = "exponent",
              .unit = "",
              .default_value = 2.0,
              .min = 0.3,
              .max = 6.0,
              .help = "calibration: exponent by which the sound's root mean square grows with the wind speed"},
    Parameter{
        .name = "curve",
        .unit = "",
        .default_value = std::string(""),
        .help = "calibration instead of gain and exponent: points level:speed in dB:m/s, \"-62:0 -50:1.2 -40:3.4\""},
    Parameter{
        .name = "noise_floor",
        .unit = "dB",
        .default_value = 0.0,
        .min = -200.0,
        .max = 0.0,
        .help =
            "level in a calm, relative to full scale; 0: determined while running, from the quietest 2 % of the time"},
    Parameter{.name = "noise_memory",
              .unit = "s",
              .default_value = 86400.0,
              .min = 60.0,
              .max = 604800.0,
              .help = "memory of levels for this; no noise is subtracted in the first hour"},
    Parameter{
        .name = "ignore_sound",
        .unit = "",
        .default_value = true,
        .help = "with two or more channels: sound that reaches all alike, such as voices and music, does not count"},
    Parameter{.name = "faces",
              .unit = "deg",
              .default_value = std::string(""),
              .help = "where each of three or four microphones faces, clockwise from north, \"0 120 240\"; empty: no "
                      "direction"},
    Parameter{.name = "direction_smoothing",
              .unit = "s",
              .default_value = 5.0,
              .min = 0.5,
              .max = 600.0,
              .help = "time constant of the direction, smoothed as a vector"},
    Parameter{.name = "least_confidence",
              .unit = "",
              .default_value = 0.3,
              .min = 0.0,
              .max = 1.0,
              .help = "least confidence of a direction; below it the reading has none"},
    Parameter{.name = "window",
              .unit = "s",
              .default_value = 1.0,
              .min = 0.25,
              .max = 60.0,
              .help = "averaging time of each reading; there are four readings per second"},
    Parameter{.name = "timeout",
              .unit = "s",
              .default_value = 3.0,
              .min = 1.0,
              .max = 60.0,
              .help = "silence from the worker after which it is killed and started again"},
    Parameter{.name = "worker",
              .unit = "",
              .default_value = std::string(""),
              .help = "path of the worker program; empty: this program"},
};

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

MicrophoneSettings settings_of(const ParameterValues& values) {
  MicrophoneSettings settings;
  decode::microphone::MicEstimatorOptions& estimator = settings.estimator;
  settings.is_calibrated = values.number("gain") > 0.0 || !values.text("curve").empty();
  const MicLevelSettings level = mic_level_settings_of(values);
  estimator.calibration = level.calibration;
  estimator.noise_floor_db = level.noise_floor_db;
  estimator.noise_memory_s = values.number("noise_memory");
  estimator.ignores_sound = values.flag("ignore_sound");
  estimator.window_s = values.number("window");
  estimator.direction_smoothing_s = values.number("direction_smoothing");
  estimator.least_confidence = values.number("least_confidence");
  settings.sound_timeout = from_seconds(values.number("timeout"));

  estimator.faces_deg = parse_faces(values.text("faces"));
  if (!estimator.faces_deg.empty()) {
    if (estimator.faces_deg.size() != static_cast<std::size_t>(values.integer("channels"))) {
      throw std::runtime_error("faces must have as many directions as there are channels");
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
  const std::string& worker = values.text("worker");
  const std::string& device = values.text("device");
  std::vector<std::string> command = {worker.empty() ? microphone_worker_program() : worker,
                                      "mic-worker",
                                      fmt::format("--channels={}", values.integer("channels")),
                                      fmt::format("--rate={}", values.number("rate")),
                                      fmt::format("--band-low={}", values.number("band_low")),
                                      fmt::format("--band-high={}", values.number("band_high"))};
  if (!device.empty()) command.push_back("--device=" + device);
  if (!values.text("host_api").empty()) command.push_back("--host-api=" + values.text("host_api"));
  return std::make_unique<MicrophoneSensor>(settings_of(values), sensor::seed_of(device),
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
  const std::string device = lower(values.text("device"));
  const std::string host_api = lower(values.text("host_api"));
  return {.device = device.empty() && host_api.empty() ? "the default sound input" : "sound input",
          .parts = {{.key = "device", .value = device, .covers = name_covers},
                    {.key = "host_api", .value = host_api, .covers = name_covers}}};
}

std::vector<sensor::FoundDevice> find_plugged_microphones() {
  return find_microphones(microphone_worker_program());
}

/// The power of the sound is averaged over the window.
std::optional<sensor::StatedValue> microphone_value(const ParameterValues& values) {
  return sensor::StatedValue{
      .value = wind::ReadingValue::kMean, .averaging_s = values.number("window"), .source = "the driver's window"};
}

}  // namespace

extern const sensor::DriverDescription kMicrophoneDriver;
const sensor::DriverDescription kMicrophoneDriver{.name = "microphone",
                                                  .summary = "one to four bare microphones, by PortAudio",
                                                  .parameters = kMicrophoneParameters,
                                                  .open = open_microphone,
                                                  .find = find_plugged_microphones,
                                                  .selection = microphone_selection,
                                                  .stated_value = microphone_value,
                                                  .is_relative = true};

}  // namespace yuragi::drivers::microphone
