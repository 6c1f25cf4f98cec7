// `yuragi sensors list`: lists the devices that are plugged in, announced on an MQTT broker, or found in the local
// networks, and how to configure them.
#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>

#include <fmt/core.h>

#include "daemon/commands/json_output.hpp"
#include "daemon/commands/sensors.hpp"
#include "daemon/tools/sensors/description_json.hpp"
#include "daemon/tools/sensors/device_list.hpp"
#include "drivers/mqtt/broker_search.hpp"
#include "drivers/mqtt/home_assistant.hpp"
#include "engine/base/address.hpp"
#include "engine/platform/secret_file.hpp"

namespace yuragi::daemon::commands {
namespace {

struct ListOptions {
  std::string broker;
  std::string user;
  std::string password_file;
  std::string ca_file;
  std::string prefix = "homeassistant";
  std::optional<double> network_s;
  std::string ask;
  bool uses_tls = false;
  bool all = false;
  bool as_json = false;
};

/// Returns how to reach the broker, and the same as keys of a sensor's table. Throws FailureError.
drivers::mqtt::BrokerSearch broker_search_of(const ListOptions& options) {
  constexpr std::uint16_t kPort = 1883;
  constexpr std::uint16_t kTlsPort = 8883;
  const std::uint16_t usual_port = options.uses_tls ? kTlsPort : kPort;
  const Address address = parse_address(options.broker, usual_port).value();
  drivers::mqtt::BrokerSearch search;
  search.prefix = options.prefix;
  search.broker.host = address.host;
  search.broker.port = address.port;
  search.broker.uses_tls = options.uses_tls;
  search.broker.ca_file = options.ca_file;
  search.broker.user = options.user;
  if (!options.password_file.empty()) search.broker.password = platform::secret_in_file(options.password_file).value();

  const auto add = [&](std::string_view key, const std::string& text) {
    if (!text.empty()) search.settings += fmt::format("{} = {}\n", key, drivers::mqtt::quoted_for_toml(text));
  };
  add("host", address.host);
  if (address.port != usual_port) search.settings += fmt::format("port = {}\n", address.port);
  if (options.uses_tls) search.settings += "tls = true\n";
  add("ca_file", options.ca_file);
  add("user", options.user);
  add("password_file", options.password_file);
  return search;
}

std::vector<tools::sensors::DeviceFinding> announced(const ListOptions& options) {
  const auto drivers = drivers::sensor::driver_table();
  const auto* const mqtt = *std::ranges::find(drivers, "mqtt", &drivers::sensor::DriverDescription::name);
  std::vector<tools::sensors::DeviceFinding> findings;
  for (drivers::sensor::FoundDevice& device : drivers::mqtt::find_announced(broker_search_of(options)).value())
    findings.push_back({mqtt, std::move(device)});
  return findings;
}

void list_plugged_in(bool as_json) {
  const auto drivers = drivers::sensor::driver_table();
  const std::vector<tools::sensors::DeviceFinding> findings = tools::sensors::find_devices(drivers);
  if (as_json) return print_json(tools::sensors::devices_json(findings));
  fmt::print(
      "{}Devices on a serial line or behind a Modbus gateway: `yuragi sensors probe modbus PORT|HOST:PORT`.\n"
      "Devices that are announced on an MQTT broker: `yuragi sensors list --broker HOST`.\n"
      "Stations and servers in the local network: `yuragi sensors list --network`.\n",
      tools::sensors::device_list(findings, drivers));
}

void list_announced(const ListOptions& options) {
  const std::vector<tools::sensors::DeviceFinding> findings = announced(options);
  if (options.as_json) return print_json(tools::sensors::devices_json(findings));
  if (!findings.empty()) return fmt::print("{}", tools::sensors::device_list(findings, {}));
  fmt::print(
      "No anemometer is announced on {} below {}/. Configure what is published without an announcement by "
      "hand:\n`yuragi sensors describe mqtt`.\n",
      options.broker, options.prefix);
}

void list_network(const ListOptions& options) {
  drivers::sensor::NetworkSearch search;
  search.duration = from_seconds(*options.network_s);
  search.to = options.ask;
  const auto findings = tools::sensors::find_devices_in_network(drivers::sensor::driver_table(), search);
  if (options.as_json) return print_json(tools::sensors::devices_json(findings));
  if (!findings.empty()) return fmt::print("{}", tools::sensors::device_list(findings, {}));
  fmt::print(
      "Nothing was found within {:g} s. Devices in another network, behind a firewall (UDP 50222, and replies to what "
      "is\nasked), or in a wireless network that isolates its stations are not found: give their address with --ask, "
      "or "
      "\nconfigure them by hand: `yuragi sensors describe tempest`, ecowitt, weatherlink, signalk.\n",
      *options.network_s);
}

/// What is plugged in, and then what is in the networks, within a short time.
void list_all(bool as_json) {
  constexpr double kShortSearch_s = 5.0;
  const auto drivers = drivers::sensor::driver_table();
  std::vector<tools::sensors::DeviceFinding> findings = tools::sensors::find_devices(drivers);
  drivers::sensor::NetworkSearch search;
  search.duration = from_seconds(kShortSearch_s);
  std::ranges::move(tools::sensors::find_devices_in_network(drivers, search), std::back_inserter(findings));
  if (as_json) return print_json(tools::sensors::devices_json(findings));
  fmt::print("{}", tools::sensors::device_list(findings, drivers));
}

}  // namespace

void add_sensors_list(CLI::App& sensors) {
  CLI::App* command =
      sensors.add_subcommand("list", "list the devices that are plugged in, and their lines for the configuration");
  command->footer(
      "Each driver looks for its devices, and opens none for longer than necessary, so that a running daemon is "
      "not\ndisturbed. If a permission is missing, the udev rule or group that grants it is shown.\n"
      "With --broker the anemometers are listed that ESPHome and others announce on an MQTT broker for Home "
      "Assistant.\n"
      "With --network the networks that this machine is in are searched, for so many seconds (12), each asked three "
      "times:\n"
      "  listens  UDP port 50222: the broadcasts of WeatherFlow's hubs (tempest)\n"
      "  sends    UDP broadcasts to port 46000: who is a gateway of Ecowitt's? (ecowitt)\n"
      "  sends    multicast DNS, 224.0.0.251 port 5353: who is _signalk-ws._tcp, _signalk-tcp._tcp (signalk), "
      "_weatherlinklive._tcp\n           (weatherlink)?\n"
      "Without it nothing is sent.\n"
      "--json: a list with driver, device, settings (TOML to paste), trouble and remedy (null if it can be "
      "opened).");
  auto options = std::make_shared<ListOptions>();
  CLI::Option* const broker = command->add_option("--broker", options->broker,
                                                  "HOST[:PORT]: list what is announced on this MQTT broker instead");
  command->add_option("--user", options->user, "the user name for the broker")->needs(broker);
  command->add_option("--password-file", options->password_file, "a file that holds the password for the broker")
      ->needs(broker);
  command->add_flag("--tls", options->uses_tls, "use TLS, and verify the broker")->needs(broker);
  command->add_option("--ca-file", options->ca_file, "the CA certificate (PEM) of the broker; default: the system's")
      ->needs(broker);
  command->add_option("--prefix", options->prefix, "the topic below which publishers announce what they have")
      ->needs(broker)
      ->capture_default_str();
  CLI::Option* const network =
      command
          ->add_option("--network", options->network_s,
                       "[SECONDS]: search the local networks instead; what is sent is listed below")
          ->expected(0, 1)
          ->default_str("12")
          ->check(CLI::Range(0.1, 3600.0))
          ->excludes(broker);
  command->add_option("--ask", options->ask, "ask only this IPv4 address")->needs(network)->check(CLI::ValidIPV4);
  command->add_flag("--all", options->all, "list what is plugged in, and search the local networks for 5 s")
      ->excludes(broker)
      ->excludes(network);
  add_json(*command, options->as_json);
  command->callback([options] {
    if (options->all) return list_all(options->as_json);
    if (options->network_s) return list_network(*options);
    options->broker.empty() ? list_plugged_in(options->as_json) : list_announced(*options);
  });
}

}  // namespace yuragi::daemon::commands
