// `yuragi-sim hid` and `yuragi-sim usb`: simulated USB devices, attached to a real kernel over USB/IP, or shown to one
// program in a testbed of umockdev's.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "simulators/core/command.hpp"
#include "simulators/core/common_options.hpp"
#include "simulators/usb/daqs.hpp"
#include "simulators/usb/hid_stations.hpp"
#include "simulators/usb/usb_port.hpp"
#include "simulators/usb/usbip_server.hpp"
#if YURAGI_UMOCKDEV
#include "simulators/usb/launched_program.hpp"
#include "simulators/usb/umockdev_simulator.hpp"
#include "simulators/usb/umockdev_testbed.hpp"
#endif

namespace yuragi::simulators::usb {
namespace {

struct Options {
  std::vector<std::string> devices;
  std::string usbip = "127.0.0.1:3240";
  bool in_umockdev = false;
  std::vector<std::string> program;
  double pace = 1.0;
  core::CommonOptions common;
};

using MakeUsbDevice = std::unique_ptr<Device> (*)(const std::string& name, const Options& options);

/// The devices, each in the same wind.
std::vector<std::unique_ptr<Port>> make_ports(const Options& options, MakeUsbDevice make) {
  std::vector<std::unique_ptr<Port>> ports;
  for (const std::string& name : options.devices) {
    ports.push_back(std::make_unique<Port>(make(name, options), options.common.make_wind()));
  }
  return ports;
}

void serve_usbip(const Options& options, MakeUsbDevice make) {
  const Address address = core::address_option("--usbip", options.usbip);
  UsbipServer server(address.host, address.port, make_ports(options, make));

  // Scripts wait for this line.
  std::printf("listening on %s:%u\n", address.host.c_str(), static_cast<unsigned>(server.port()));
  std::fflush(stdout);
  options.common.run_simulator(server);
}

#if YURAGI_UMOCKDEV
/// Shows the devices to one program; ends when it ends, with its exit code.
void launch_in_umockdev(const Options& options, MakeUsbDevice make) {
  if (options.program.empty()) throw CLI::RequiredError("PROGRAM");
  if (!is_in_umockdev()) restart_in_umockdev();
  UmockdevSimulator simulator(make_ports(options, make));
  LaunchedProgram program(options.program, simulator);
  options.common.run_simulator(program);
  if (program.exit_code().value_or(0) != 0) throw CLI::RuntimeError(*program.exit_code());
}
#endif

CLI::App* add_usb_options(CLI::App& app, const std::string& name, const std::string& summary,
                          const std::vector<std::string>& devices, const std::shared_ptr<Options>& options,
                          MakeUsbDevice make) {
  CLI::App* command = app.add_subcommand(name, summary);
  options->devices = {devices.front()};
  command->add_option("--device", options->devices, "the device to simulate; can be repeated")
      ->check(CLI::IsMember(devices))
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->capture_default_str();
  command
      ->add_option("--usbip", options->usbip,
                   "HOST:PORT to serve USB/IP on; port 0 takes a free one. A Linux machine with the module vhci_hcd "
                   "attaches the first device with `usbip attach -r HOST -b 1-1`, the second is 1-2")
      ->capture_default_str();
#if YURAGI_UMOCKDEV
  command
      ->add_flag("--umockdev", options->in_umockdev,
                 "instead: run a program that finds the devices in a simulated /sys and /dev, without kernel support; "
                 "ends with the program, and with its exit code")
      ->excludes("--usbip");
  command->add_option("program", options->program, "after --: that program, and its arguments")->type_name("PROGRAM");
#else
  command
      ->add_flag_callback("--umockdev",
                          [] {
                            throw CLI::ValidationError(
                                "--umockdev",
                                "is not built in: install libumockdev-dev (config/setup.sh --test) and build again");
                          })
      ->group("");  // not shown in the help
#endif
  options->common.add_to(*command);
  command->callback([options, make] {
#if YURAGI_UMOCKDEV
    if (options->in_umockdev) return launch_in_umockdev(*options, make);
#endif
    serve_usbip(*options, make);
  });
  return command;
}

}  // namespace

extern const core::Command kHidCommand;
const core::Command kHidCommand{[](CLI::App& app) {
  auto options = std::make_shared<Options>();
  std::vector<std::string> names;
  for (const std::string_view name : hid_station_names()) names.emplace_back(name);
  CLI::App* command = add_usb_options(app, "hid", "USB weather stations", names, options,
                                      [](const std::string& name, const Options& chosen) {
                                        return make_hid_station(name, chosen.pace, chosen.common.synthetic.seed);
                                      });
  command->add_option("--pace", options->pace, "how many times faster than the real station it measures")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
}};

extern const core::Command kUsbCommand;
const core::Command kUsbCommand{[](CLI::App& app) {
  add_usb_options(app, "usb", "USB counters and converters with a cup anemometer and a wind vane", daq_names(),
                  std::make_shared<Options>(),
                  [](const std::string& name, const Options& /*asked*/) { return make_daq(name); });
}};

}  // namespace yuragi::simulators::usb
