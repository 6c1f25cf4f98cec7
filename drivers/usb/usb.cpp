// A cup anemometer and a potentiometer vane on a counter and ADC device, by libusb: any cup that closes a contact and
// any vane that is a potentiometer, sampled up to 100 times a second. The devices' messages stand in
// drivers/decode/usb/mcc1208.hpp and labjack.hpp, with their sources. How they are wired:
//
//   device       USB id      cup    vane's wiper                                      vane's track
//   mcc1208      09db:00e8   CTR    CH0 to CH7 IN, against ground: -10 to 10 V        ground to +VO (5 V)
//   labjack-u3   0cd5:0003   FIO4   AIN0 to AIN3: -10 to 10 V, on a U3-LV 0 to 2.4 V  ground to VS (5 V), or less
//
// A cup closes a contact to ground, with a resistor up to 5 V if the pin has none of its own. Its data sheet gives its
// line as m/s for each Hz, which is metres for each pulse, and an offset: 0.765 and 0.35 m/s for an NRG #40C, say.
#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "drivers/sensor/driver.hpp"
#include "drivers/usb/usb_sensor.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::usb {
namespace {

using decode::usb::CupCalibration;
using decode::usb::VaneCalibration;

constexpr std::array<std::string_view, 3> kUsbDevices = {"auto", "mcc1208", "labjack-u3"};

std::vector<const DaqModel*> models_named(const std::string& name) {
  std::vector<const DaqModel*> models;
  for (const DaqModel* const model : usb_daq_models()) {
    if (name == kUsbDevices[0] || name == model->name) models.push_back(model);
  }
  return models;
}

std::optional<std::uint8_t> channel_of(std::int64_t channel) {
  return channel < 0 ? std::nullopt : std::optional(static_cast<std::uint8_t>(channel));
}

auto of_wiring(auto member) {
  return member_of(&Settings::wiring, member);
}
auto of_cup(auto member) {
  return member_of(&Settings::cup, member);
}
auto of_vane(auto member) {
  return member_of(&Settings::vane, member);
}

const Fields<Settings> kUsbFields = {
    {{.name = "device",
      .default_value = std::string("auto"),
      .help = "which kind of counter and ADC device; auto: the first one found",
      .choices = kUsbDevices},
     &Settings::models,
     models_named},
    {{.name = "serial",
      .default_value = std::string(""),
      .help = "its serial number; not needed if there is only one device"},
     &Settings::serial},
    {{.name = "port",
      .default_value = std::string(""),
      .help = "the USB port that it is plugged into, such as 1-2.3, if the serial number does not identify it"},
     &Settings::port},
    {{"counter", "", std::int64_t{0}, 0, 1, "the counter that the cup is connected to"},
     of_wiring(&DaqWiring::counter)},
    {{"metres_per_pulse", "m", 0.1, 0.001, 20.0, "the cup's slope: m/s for each pulse per second"},
     of_cup(&CupCalibration::metres_per_pulse)},
    {{"offset", "m/s", 0.0, -5.0, 5.0, "the cup's offset: added while it turns"}, of_cup(&CupCalibration::offset_m_s)},
    {{"window_pulses", "", std::int64_t{4}, 1, 100000, "pulses per reading; more give smoother, but later speeds"},
     of_cup(&CupCalibration::enough_pulses)},
    {{"window", "s", 1.0, 0.05, 60.0, "maximum wait for these pulses, which limits the interval between readings"},
     of_cup(&CupCalibration::longest_window_s)},
    {{"sample_rate", "Hz", 10.0, 0.2, 100.0, "how often the counter and the vane are read"},
     &Settings::period,
     [](double rate_hz) { return from_seconds(1.0 / rate_hz); }},
    {{"vane_channel", "", std::int64_t{0}, -1, 7,
      "the analogue input that the vane's wiper is connected to; -1: there is no vane"},
     of_wiring(&DaqWiring::vane_channel),
     channel_of},
    {{"vane_start", "deg", 0.0, -360.0, 360.0,
      "the direction at the beginning of the vane's track, where the voltage is lowest"},
     of_vane(&VaneCalibration::start_deg)},
    {{"vane_span", "deg", 356.0, 1.0, 360.0,
      "the angle of the track, clockwise; the rest of the circle is its dead band, without direction"},
     of_vane(&VaneCalibration::electrical_deg)},
    {{"vane_lowest", "", 0.0, 0.0, 1.0, "share of the reference voltage at the beginning of the track"},
     of_vane(&VaneCalibration::lowest_ratio)},
    {{"vane_highest", "", 1.0, 0.0, 1.0, "share of the reference voltage at its end"},
     of_vane(&VaneCalibration::highest_ratio)},
    {{"reference_voltage", "V", 5.0, 0.1, 20.0, "voltage across the track, if it is not measured"},
     &Settings::reference_v},
    {{"reference_channel", "", std::int64_t{-1}, -1, 7,
      "analogue input that measures this voltage, because the 5 V of a USB port are not exact; -1: none"},
     of_wiring(&DaqWiring::reference_channel),
     channel_of},
    {{"response_timeout", "s", 0.5, 0.01, 10.0, "maximum wait for a reply"}, &Settings::timeout, from_seconds},
};

Settings usb_settings_of(const ParameterValues& values) {
  Settings settings = kUsbFields.of(values);
  settings.cup.shortest_window_s = std::min(settings.cup.shortest_window_s, settings.cup.longest_window_s);
  return settings;
}

/// Throws if the values cannot work together.
void check_together(const Settings& settings) {
  if (settings.vane.lowest_ratio >= settings.vane.highest_ratio) {
    throw std::runtime_error("vane_lowest: must be below vane_highest");
  }
  if (settings.wiring.reference_channel && settings.wiring.reference_channel == settings.wiring.vane_channel) {
    throw std::runtime_error(
        "reference_channel: is the same as vane_channel; give the input that is connected to the vane's track");
  }
  // With "auto" it is enough that one of the models can do it: which it is shows when one is plugged in.
  std::string wrong;
  for (const DaqModel* const model : settings.models) {
    wrong = wrong_wiring(*model, settings.wiring);
    if (wrong.empty()) return;
  }
  throw std::runtime_error(wrong);
}

std::vector<bus::UsbId> ids_of(std::span<const DaqModel* const> models) {
  std::vector<bus::UsbId> ids;
  ids.reserve(models.size());
  for (const DaqModel* const model : models) ids.push_back(model->id);
  return ids;
}

std::unique_ptr<sensor::Sensor> open_usb(const ParameterValues& values) {
  Settings settings = usb_settings_of(values);
  check_together(settings);
  auto device = bus::make_usb_device(ids_of(settings.models));
  const std::uint32_t seed = sensor::seed_of("usb" + settings.serial + settings.port);
  return std::make_unique<Sensor>(std::move(settings), seed, std::move(device));
}

sensor::ValueSelection usb_selection(const ParameterValues& values) {
  const Settings settings = kUsbFields.of(values);
  return {.device = "USB device",
          .parts = {
              {.key = "device", .value = settings.models.size() > 1 ? "" : std::string(settings.models.front()->name)},
              {.key = "serial", .value = settings.serial},
              {.key = "port", .value = settings.port}}};
}

std::vector<sensor::FoundDevice> find_usb() {
  std::vector<sensor::FoundDevice> found;
  const auto plugged = bus::make_usb_device(ids_of(usb_daq_models()))->plugged();
  if (!plugged) return found;
  for (const bus::PluggedUsbDevice& device : *plugged) {
    const DaqModel& model =
        **std::ranges::find(usb_daq_models(), device.id, [](const DaqModel* one) { return one->id; });
    sensor::FoundDevice& one = found.emplace_back();
    one.what = fmt::format("{} ({}) at USB port {}", model.what, describe(model.id), device.port);
    one.settings = fmt::format("device = \"{}\"\n{} = \"{}\"", model.name, device.serial.empty() ? "port" : "serial",
                               device.serial.empty() ? device.port : device.serial);
    if (device.is_permitted) continue;
    one.trouble = fmt::format("this user has no permission to open {}", device.node);
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
    .parameters = kUsbFields.parameters(),
    .open = open_usb,
    .find = find_usb,
    .endpoints =
        [](const ParameterValues&) { return std::vector{sensor::Endpoint{.kind = sensor::EndpointKind::kUsb}}; },
    .selection = usb_selection,
    .stated_value = usb_value,
    .simulated = [](const ParameterValues&) -> Result<sensor::SimulatedDevice, Failure> {
      return Failure{
          "a simulated usb cannot be started here: it needs a virtual USB bus, and the permission to create it"};
    },
    .formats = "mcc1208 labjack"};

}  // namespace yuragi::drivers::usb
