#include <cstdio>
#include <memory>
#include <string>

#include "simulators/commands.hpp"
#include "simulators/common_options.hpp"
#include "simulators/davis/vantage_console.hpp"

namespace yuragi::simulators::davis {
namespace {

struct DavisOptions {
  bool pty = false;
  std::string link;
  std::string tcp;
  VantageConsoleOptions console;
  bool has_old_firmware = false;
  CommonOptions common;

  void run() const {
    VantageConsoleOptions made = console;
    made.knows_lps = !has_old_firmware;
    made.garbage_seed = common.synthetic.seed;
    VantageConsole simulator(make_wire(), made, common.make_wind());
    std::printf("%s\n", simulator.wire().place().c_str());
    std::fflush(stdout);
    common.run_simulator(simulator);
  }

 private:
  std::unique_ptr<text::TextWire> make_wire() const {
    if (pty) return text::make_pty_wire(link);
    const Address address = address_option("--tcp", tcp);
    return text::make_tcp_wire(address.host, address.port);
  }
};

}  // namespace

void add_davis_command(CLI::App& app) {
  auto options = std::make_shared<DavisOptions>();
  CLI::App* command = app.add_subcommand("davis", "console of a Davis Vantage station, with its data logger");
  CLI::Option_group* wire = command->add_option_group("wire", "how it is connected");
  CLI::Option* pty_flag = wire->add_flag("--pty", options->pty, "a serial port (a pseudo terminal)");
  wire->add_option("--tcp", options->tcp, "a server at HOST:PORT, as a WeatherLinkIP; port 0 takes a free one");
  wire->require_option(1);
  command
      ->add_option("--link", options->link,
                   "with --pty: create this link to the port, which stays when the device is unplugged")
      ->needs(pty_flag);
  command->add_option("--interval", options->console.interval_s, "seconds from packet to packet")
      ->check(CLI::Range(0.05, 60.0))
      ->capture_default_str();
  command->add_flag("--old-firmware", options->has_old_firmware, "does not know the command LPS (before 1.90)");
  options->common.add_to(*command);
  command->callback([options] { options->run(); });
}

}  // namespace yuragi::simulators::davis
