#include "daemon/tools/doctor/sensor_probe.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/tools/doctor/local_port.hpp"
#include "drivers/bus/host_lookup.hpp"
#include "drivers/bus/interruption.hpp"
#include "drivers/bus/serial_ports.hpp"
#include "drivers/bus/tcp_connect.hpp"
#include "drivers/windlog/recording_parts.hpp"
#include "engine/base/address.hpp"

namespace yuragi::daemon::tools::doctor {
namespace {

/// Empty if the driver has no such key, or it is not given.
std::string text_or_empty(const ParameterValues& values, std::string_view name) {
  const auto found = values.all().find(name);
  if (found == values.all().end()) return {};
  const auto* text = std::get_if<std::string>(&found->second);
  return text == nullptr ? std::string() : *text;
}

std::string in_small_letters(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// The values of the keys that choose one of several equal devices; empty: any.
std::string chosen_text(const settings::SensorConfig& sensor) {
  std::string text;
  for (const char* const key : {"station", "device", "path", "serial", "port", "host_api"}) {
    const std::string value = text_or_empty(sensor.values, key);
    if (!value.empty() && value != "auto") text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, value);
  }
  return text;
}

/// "hid (station wmr300)".
std::string plugged_name(const settings::SensorConfig& sensor) {
  const std::string chosen = chosen_text(sensor);
  return fmt::format("{}{}", sensor.driver->name, chosen.empty() ? "" : " (" + chosen + ")");
}

/// Why nobody can connect; empty: somebody can.
std::string tcp_trouble(const std::string& name, Nanoseconds timeout) {
  const auto address = parse_address(name);
  if (!address) return address.error().message;
  drivers::bus::HostLookup host(address->host, address->port);
  const drivers::bus::Interruption never;
  const auto socket = drivers::bus::connect_tcp(host, timeout, never);
  if (!socket) return "cannot be reached: " + socket.error().message;
  close(*socket);
  return {};
}

void probe_plugged(DeviceFacts& device, const settings::SensorConfig& sensor,
                   std::span<const sensors::DeviceFinding> plugged) {
  for (const sensors::DeviceFinding& found : plugged) {
    if (!is_chosen(sensor, found)) continue;
    device.is_there = true;
    device.name = found.device.what;
    device.trouble = found.device.trouble;
    device.remedy = found.device.remedy;
    if (device.trouble.empty()) return;  // another one might be meant, but this one would do
  }
}

void probe_device(DeviceFacts& device, const settings::SensorConfig& sensor,
                  std::span<const sensors::DeviceFinding> plugged, Nanoseconds timeout) {
  std::error_code error;
  if (!device.kind) {
    device.is_there = true;
    return;
  }
  switch (*device.kind) {
    case EndpointKind::kSerialPort:
      device.is_there = std::filesystem::exists(device.name, error);
      if (device.is_there) {
        const drivers::bus::AccessTrouble access = drivers::bus::access_trouble(device.name);
        device.trouble = access.trouble;
        device.remedy = access.remedy;
      }
      return;
    case EndpointKind::kHid:
    case EndpointKind::kUsb:
    case EndpointKind::kSoundCard:
      return probe_plugged(device, sensor, plugged);
    case EndpointKind::kServer:
    case EndpointKind::kBroker:
      device.trouble = tcp_trouble(device.name, timeout);
      device.is_there = device.trouble.empty();
      return;
    case EndpointKind::kUdpPort:
      device.trouble = udp_trouble(device.name, device.is_shared);
      device.is_there = device.trouble.empty();
      return;
    case EndpointKind::kTcpPort: {
      bool is_in_use = false;
      device.trouble = listen_trouble(device.name, is_in_use);
      device.is_there = device.trouble.empty();
      return;
    }
    case EndpointKind::kFile:
      device.is_there = drivers::windlog::recording_exists(device.name) || std::filesystem::exists(device.name, error);
      if (device.is_there && access(device.name.c_str(), F_OK) == 0 && access(device.name.c_str(), R_OK) != 0) {
        device.trouble = "this user may not read it";
        device.remedy = fmt::format("sudo chmod g+r {0}; sudo chgrp yuragi {0}", device.name);
      }
      return;
  }
}

}  // namespace

std::vector<DeviceFacts> named_devices(const settings::SensorConfig& sensor) {
  const drivers::sensor::DriverDescription& driver = *sensor.driver;
  std::vector<DeviceFacts> devices;
  if (driver.endpoints != nullptr) {
    for (drivers::sensor::Endpoint& endpoint : driver.endpoints(sensor.values)) {
      DeviceFacts& device = devices.emplace_back();
      device.sensor = sensor.name;
      device.kind = endpoint.kind;
      device.name = is_usb(endpoint.kind) || endpoint.kind == EndpointKind::kSoundCard ? plugged_name(sensor)
                                                                                       : std::move(endpoint.name);
      device.is_shared = endpoint.is_shared;
    }
  }
  if (devices.empty()) {
    devices.push_back({.sensor = sensor.name, .name = fmt::format("{} needs no device", driver.name)});
  }
  return devices;
}

bool is_chosen(const settings::SensorConfig& sensor, const sensors::DeviceFinding& found) {
  if (found.driver != sensor.driver) return false;
  const auto offered = settings::parse_values(found.device.settings, found.driver->parameters);
  if (!offered) return false;
  const ParameterValues defaults = *settings::parse_values("", found.driver->parameters);
  for (const char* const key : {"station", "device", "path", "serial", "port", "host_api"}) {
    const std::string wanted = text_or_empty(sensor.values, key);
    const std::string there = text_or_empty(*offered, key);
    const std::string left_out = text_or_empty(defaults, key);
    if (wanted.empty() || wanted == left_out || there == left_out) continue;
    const auto endpoints = sensor.driver->endpoints(sensor.values);
    const bool is_sound_card = endpoints.front().kind == EndpointKind::kSoundCard;
    const bool is_same =
        is_sound_card ? in_small_letters(there).find(in_small_letters(wanted)) != std::string::npos : wanted == there;
    if (!is_same) return false;
  }
  return true;
}

std::vector<std::string> needed_groups(const settings::Config& config) {
  std::vector<std::string> groups;
  const auto need = [&](const char* group) {
    if (std::ranges::find(groups, group) == groups.end()) groups.emplace_back(group);
  };
  for (const settings::SensorConfig& sensor : config.sensors) {
    for (const DeviceFacts& device : named_devices(sensor)) {
      if (device.kind == EndpointKind::kSerialPort) need("dialout");
      if (is_usb(device.kind)) need("plugdev");
      if (device.kind == EndpointKind::kSoundCard) need("audio");
    }
  }
  return groups;
}

std::vector<DeviceFacts> probe_devices(const settings::Config& config, std::span<const sensors::DeviceFinding> plugged,
                                       const std::optional<wire::Sensors>& running, Nanoseconds timeout) {
  const auto is_used = [&](const std::string& name) {
    return running && std::ranges::any_of(running->sensors, [&](const wire::SensorStatus& sensor) {
             return sensor.name == name && is_believed(sensor.state);
           });
  };
  std::map<std::string, DeviceFacts> of_network;  // several sensors behind one gateway: asked once
  std::vector<DeviceFacts> all;
  for (const settings::SensorConfig& sensor : config.sensors) {
    for (DeviceFacts& device : named_devices(sensor)) {
      device.is_used = is_used(sensor.name);
      const bool is_of_network = device.kind == EndpointKind::kServer || device.kind == EndpointKind::kBroker;
      if (device.is_used) {
        device.is_there = true;
      } else if (const auto known = of_network.find(device.name); is_of_network && known != of_network.end()) {
        device.is_there = known->second.is_there;
        device.trouble = known->second.trouble;
      } else {
        probe_device(device, sensor, plugged, timeout);
        if (is_of_network) of_network.emplace(device.name, device);
      }
      all.push_back(std::move(device));
    }
  }
  return all;
}

}  // namespace yuragi::daemon::tools::doctor
