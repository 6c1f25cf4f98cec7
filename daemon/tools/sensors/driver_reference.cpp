#include "daemon/tools/sensors/driver_reference.hpp"

#include <iterator>

#include <fmt/format.h>

namespace yuragi::daemon::tools::sensors {
namespace {

/// Escapes text for a cell of a Markdown table.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|' || c == '*' || c == '_' || c == '<') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

/// "maker, decoder", or "nobody".
std::string confirmed_by(const drivers::sensor::KnownDevice& device) {
  return device.confirmed_by.empty() ? "nobody" : fmt::format("{}", fmt::join(device.confirmed_by, ", "));
}

std::string known_device_text(const std::vector<drivers::sensor::KnownDevice>& devices) {
  std::string text;
  for (const drivers::sensor::KnownDevice& device : devices) {
    fmt::format_to(std::back_inserter(text), "  {}\n      {}; confirmed by: {}\n", device.name, device.device,
                   confirmed_by(device));
    if (device.value) fmt::format_to(std::back_inserter(text), "      speed: {}\n", value_text(*device.value));
    if (!device.unconfirmed.empty())
      fmt::format_to(std::back_inserter(text), "      unconfirmed: {}\n", device.unconfirmed);
  }
  return text;
}

/// Returns what a driver states of its speed: by default, and for each choice of a key that changes it. Empty if it
/// states nothing, and for a driver that knows devices by name: they are listed with it.
std::vector<std::string> value_texts(const drivers::sensor::DriverDescription& driver) {
  std::vector<std::string> texts;
  if (driver.stated_value == nullptr || driver.known_devices != nullptr) return texts;
  auto values = ParameterValues::resolve(driver.parameters, {});
  if (!values) return texts;
  const auto text_of = [&](const ParameterValues& of) {
    const auto stated = driver.stated_value(of);
    return stated ? value_text(*stated) : std::string();
  };
  const std::string by_default = text_of(*values);
  if (!by_default.empty()) texts.push_back(by_default);
  for (const Parameter& parameter : driver.parameters) {
    for (const std::string_view choice : parameter.choices) {
      ParameterValues of_choice = *values;
      of_choice.set(parameter.name, std::string(choice));
      const std::string text = text_of(of_choice);
      if (text != by_default) texts.push_back(fmt::format("{} = \"{}\": {}", parameter.name, choice, text));
    }
  }
  return texts;
}

}  // namespace

std::string parameter_text(std::span<const Parameter> parameters) {
  std::string text;
  for (const Parameter& parameter : parameters) {
    fmt::format_to(std::back_inserter(text), "  {:<18} {}\n  {:<18} {}\n", parameter.name, parameter.help, "",
                   describe_allowed(parameter));
  }
  return text;
}

std::string driver_names(std::span<const drivers::sensor::DriverDescription* const> drivers) {
  std::string text;
  for (const drivers::sensor::DriverDescription* driver : drivers) {
    fmt::format_to(std::back_inserter(text), "{:<12} {}\n", driver->name, driver->summary);
  }
  return text;
}

std::string describe_driver(const drivers::sensor::DriverDescription& driver) {
  std::string text = fmt::format(
      "{0}: {1}\n"
      "\n"
      "[[sensor]]\n"
      "name = \"{0}\"  # any text, different for each sensor\n"
      "driver = \"{0}\"\n",
      driver.name, driver.summary);
  if (driver.find_in_network != nullptr)
    text += "\n`yuragi sensors list --network` searches the local network for its devices.\n";
  if (!driver.parameters.empty()) text += "\nIts keys:\n" + parameter_text(driver.parameters);
  for (const std::string& value : value_texts(driver)) text += fmt::format("\nSpeed: {}\n", value);
  if (driver.known_devices != nullptr)
    text += "\nThe devices that it knows by name:\n" + known_device_text(driver.known_devices());
  if (!driver.device_setup.empty()) text += fmt::format("\nAt the device:\n{}", driver.device_setup);
  return text;
}

std::string driver_reference(std::span<const drivers::sensor::DriverDescription* const> drivers) {
  std::string text =
      "# Sensors\n\nA sensor is a `[[sensor]]` table of the configuration: a `name` of its own, its `driver`, and the\n"
      "driver's keys. This page is what `yuragi sensors describe --all` prints.\n";
  const auto out = std::back_inserter(text);
  for (const drivers::sensor::DriverDescription* driver : drivers) {
    fmt::format_to(out, "\n## {}\n\n{}\n", driver->name, cell(driver->summary));
    if (!driver->parameters.empty()) fmt::format_to(out, "\n| key | takes | what it is |\n| --- | --- | --- |\n");
    for (const Parameter& parameter : driver->parameters) {
      fmt::format_to(out, "| `{}` | {} | {} |\n", parameter.name, cell(describe_allowed(parameter)),
                     cell(parameter.help));
    }
    for (const std::string& value : value_texts(*driver)) fmt::format_to(out, "\nSpeed: {}\n", cell(value));
    if (!driver->device_setup.empty()) fmt::format_to(out, "\nAt the device:\n\n```\n{}```\n", driver->device_setup);
    if (driver->known_devices == nullptr) continue;
    fmt::format_to(out, "\n| name | device | speed | confirmed by | unconfirmed |\n| --- | --- | --- | --- | --- |\n");
    for (const drivers::sensor::KnownDevice& device : driver->known_devices()) {
      fmt::format_to(out, "| `{}` | {} | {} | {} | {} |\n", device.name, cell(device.device),
                     device.value ? cell(value_text(*device.value)) : "", confirmed_by(device),
                     cell(device.unconfirmed));
    }
  }
  return text;
}

}  // namespace yuragi::daemon::tools::sensors
