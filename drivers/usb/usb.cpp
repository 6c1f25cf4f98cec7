// A cup anemometer and a potentiometer vane on a counter and ADC device, by libusb: any cup that closes a contact and
// any vane that is a potentiometer, sampled up to 100 times a second. The devices' messages stand in
// drivers/decode/usb/mcc1208.hpp and labjack.hpp, with their sources. How they are wired:
//
//   device       USB id      cup    vane's wiper                                      vane's track
//   mcc1208      09db:00e8   CTR    CH0 to CH7 IN, against ground: -10 to 10 V        ground to +VO (5 V)
//   labjack-u3   0cd5:0003   FIO4   AIN0 to AIN3: -10 to 10 V, on a U3-LV 0 to 2.4 V  ground to VS (5 V), or less
//
// A cup closes a contact to ground, with a resistor up to 5 V where the pin has none of its own. Its data sheet gives
// its line as m/s for each Hz, which is metres for each pulse, and an offset: 0.765 and 0.35 m/s for an NRG #40C, say.
#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "drivers/sensor/driver.hpp"
#include "drivers/usb/usb_sensor.hpp"

namespace yuragi::drivers::usb {
namespace {

constexpr std::array<std::string_view, 3> kUsbDevices = {"auto", "mcc1208", "labjack-u3"};

const std::array kUsbParameters = {
    Parameter{.name = "device",
              .unit = "",
              .default_value = std::string("auto"),
              .help = "which kind of counter and ADC device; auto: the first of any that is plugged in",
              .choices = kUsbDevices},
    Parameter{.name = "serial",
              .unit = "",
              .default_value = std::string(""),
              .help = "its serial number; not needed where there is only one device"},
    Parameter{.name = "port",
              .unit = "",
              .default_value = std::string(""),
              .help = "the USB port that it is plugged into, such as 1-2.3, where serial numbers do not help"},
    Parameter{.name = "counter",
              .unit = "",
              .default_value = std::int64_t{0},
              .min = 0,
              .max = 1,
              .help = "the counter that the cup is connected to"},
    Parameter{.name = "metres_per_pulse",
              .unit = "m",
              .default_value = 0.1,
              .min = 0.001,
              .max = 20.0,
              .help = "the cup's slope: m/s for each pulse per second"},
    Parameter{.name = "offset",
              .unit = "m/s",
              .default_value = 0.0,
              .min = -5.0,
              .max = 5.0,
              .help = "the cup's offset: added while it turns"},
    Parameter{.name = "window_pulses",
              .unit = "",
              .default_value = std::int64_t{4},
              .min = 1,
              .max = 100000,
              .help = "pulses per reading; more give smoother, but later speeds"},
    Parameter{.name = "window",
              .unit = "s",
              .default_value = 1.0,
              .min = 0.05,
              .max = 60.0,
              .help = "longest wait for these pulses, and so the longest interval between readings"},
    Parameter{.name = "sample_rate",
              .unit = "Hz",
              .default_value = 10.0,
              .min = 0.2,
              .max = 100.0,
              .help = "how often the counter and the vane are read"},
    Parameter{.name = "vane_channel",
              .unit = "",
              .default_value = std::int64_t{0},
              .min = -1,
              .max = 7,
              .help = "the analogue input that the vane's wiper is connected to; -1: there is no vane"},
    Parameter{.name = "vane_start",
              .unit = "deg",
              .default_value = 0.0,
              .min = -360.0,
              .max = 360.0,
              .help = "the direction at the beginning of the vane's track, where the voltage is lowest"},
    Parameter{.name = "vane_span",
              .unit = "deg",
              .default_value = 356.0,
              .min = 1.0,
              .max = 360.0,
              .help = "the angle of the track, clockwise; the rest of the circle is its dead band, without direction"},
    Parameter{.name = "vane_lowest",
              .unit = "",
              .default_value = 0.0,
              .min = 0.0,
              .max = 1.0,
              .help = "share of the reference voltage at the beginning of the track"},
    Parameter{.name = "vane_highest",
              .unit = "",
              .default_value = 1.0,
              .min = 0.0,
              .max = 1.0,
              .help = "share of the reference voltage at its end"},
    Parameter{.name = "reference_voltage",
              .unit = "V",
              .default_value = 5.0,
              .min = 0.1,
              .max = 20.0,
              .help = "voltage across the track, where it is not measured"},
    Parameter{.name = "reference_channel",
              .unit = "",
              .default_value = std::int64_t{-1},
              .min = -1,
              .max = 7,
              .help = "analogue input that measures this voltage, since the 5 V of a USB port are not exact; -1: none"},
    Parameter{.name = "response_timeout",
              .unit = "s",
              .default_value = 0.5,
              .min = 0.01,
              .max = 10.0,
              .help = "longest wait for a reply"},
};

std::optional<std::uint8_t> channel_of(const ParameterValues& values, std::string_view name) {
  const std::int64_t channel = values.integer(name);
  return channel < 0 ? std::nullopt : std::optional(static_cast<std::uint8_t>(channel));
}

UsbSettings usb_settings_of(const ParameterValues& values) {
  UsbSettings settings;
  for (const UsbDaqModel* const model : usb_daq_models()) {
    if (values.text("device") == "auto" || values.text("device") == model->name) settings.models.push_back(model);
  }
  settings.serial = values.text("serial");
  settings.port = values.text("port");
  settings.wiring.counter = static_cast<std::uint8_t>(values.integer("counter"));
  settings.wiring.vane_channel = channel_of(values, "vane_channel");
  settings.wiring.reference_channel = channel_of(values, "reference_channel");

  settings.cup.metres_per_pulse = values.number("metres_per_pulse");
  settings.cup.offset_m_s = values.number("offset");
  settings.cup.enough_pulses = static_cast<std::uint32_t>(values.integer("window_pulses"));
  settings.cup.longest_window_s = values.number("window");
  settings.cup.shortest_window_s = std::min(settings.cup.shortest_window_s, settings.cup.longest_window_s);
  settings.vane.start_deg = values.number("vane_start");
  settings.vane.electrical_deg = values.number("vane_span");
  settings.vane.lowest_ratio = values.number("vane_lowest");
  settings.vane.highest_ratio = values.number("vane_highest");
  settings.reference_v = values.number("reference_voltage");
  settings.period = from_seconds(1.0 / values.number("sample_rate"));
  settings.timeout = from_seconds(values.number("response_timeout"));
  return settings;
}

/// Throws where the values cannot work together.
void check_together(const UsbSettings& settings) {
  if (settings.vane.lowest_ratio >= settings.vane.highest_ratio) {
    throw std::runtime_error("vane_lowest: must be below vane_highest");
  }
  if (settings.wiring.reference_channel && settings.wiring.reference_channel == settings.wiring.vane_channel) {
    throw std::runtime_error(
        "reference_channel: is vane_channel; give the input that is connected to the vane's track");
  }
  // With "auto" it is enough that one of the models can do it: which it is shows when one is plugged in.
  std::string wrong;
  for (const UsbDaqModel* const model : settings.models) {
    wrong = wrong_wiring(*model, settings.wiring);
    if (wrong.empty()) return;
  }
  throw std::runtime_error(wrong);
}

std::vector<bus::UsbId> ids_of(std::span<const UsbDaqModel* const> models) {
  std::vector<bus::UsbId> ids;
  ids.reserve(models.size());
  for (const UsbDaqModel* const model : models) ids.push_back(model->id);
  return ids;
}

std::unique_ptr<sensor::Sensor> open_usb(const ParameterValues& values) {
  UsbSettings settings = usb_settings_of(values);
  check_together(settings);
  auto device = bus::make_usb_device(ids_of(settings.models));
  const std::uint32_t seed = sensor::seed_of("usb" + settings.serial + settings.port);
  return std::make_unique<UsbSensor>(std::move(settings), seed, std::move(device));
}

sensor::ValueSelection usb_selection(const ParameterValues& values) {
  const std::string& device = values.text("device");
  return {.device = "USB device",
          .parts = {{.key = "device", .value = device == "auto" ? "" : device},
                    {.key = "serial", .value = values.text("serial")},
                    {.key = "port", .value = values.text("port")}}};
}

std::vector<sensor::FoundDevice> find_usb() {
  std::vector<sensor::FoundDevice> found;
  const auto plugged = bus::make_usb_device(ids_of(usb_daq_models()))->plugged();
  if (!plugged) return found;
  for (const bus::PluggedUsbDevice& device : *plugged) {
    const UsbDaqModel& model =
        **std::ranges::find(usb_daq_models(), device.id, [](const UsbDaqModel* one) { return one->id; });
    sensor::FoundDevice& one = found.emplace_back();
    one.what = fmt::format("{} ({}) at USB port {}", model.what, describe(model.id), device.port);
    one.settings = fmt::format("device = \"{}\"\n{} = \"{}\"", model.name, device.serial.empty() ? "port" : "serial",
                               device.serial.empty() ? device.port : device.serial);
    if (device.is_permitted) continue;
    one.trouble = fmt::format("this user may not open {}", device.node);
    one.remedy = "install config/udev/70-yuragi.rules, join the group plugdev, and plug the device in again";
  }
  return found;
}

/// Pulses are counted from one reading to the next.
std::optional<sensor::StatedValue> usb_value(const ParameterValues& /*values*/) {
  return sensor::StatedValue{.value = wind::ReadingValue::kMean, .source = "pulses are counted over the interval"};
}

}  // namespace

extern const sensor::DriverDescription kUsbDriver;
const sensor::DriverDescription kUsbDriver{
    .name = "usb",
    .summary = "a cup and a vane on a counter and ADC device: MCC USB-1208FS-Plus, LabJack U3",
    .parameters = kUsbParameters,
    .open = open_usb,
    .find = find_usb,
    .selection = usb_selection,
    .stated_value = usb_value};

}  // namespace yuragi::drivers::usb
