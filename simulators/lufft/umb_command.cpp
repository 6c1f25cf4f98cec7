#include <cstdio>
#include <memory>
#include <string>

#include "simulators/commands.hpp"
#include "simulators/common_options.hpp"
#include "simulators/lufft/umb_station.hpp"

namespace yuragi::simulators::lufft {
namespace {

struct UmbOptions {
  bool pty = false;
  std::string link;
  std::string tcp;
  UmbStationOptions station;
  bool has_no_fast_channels = false;
  CommonOptions common;

  void run() const {
    UmbStationOptions made = station;
    made.has_fast_channels = made.measures_more = !has_no_fast_channels;
    made.garbage_seed = common.synthetic.seed;
    UmbStation simulator(make_wire(), made, common.make_wind());
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

void add_umb_command(CLI::App& app) {
  auto options = std::make_shared<UmbOptions>();
  CLI::App* command = app.add_subcommand("umb", "Lufft weather station or VENTUS, with the binary UMB protocol");
  CLI::Option_group* wire = command->add_option_group("wire", "how it is connected");
  CLI::Option* pty_flag = wire->add_flag("--pty", options->pty, "a serial port (a pseudo terminal)");
  wire->add_option("--tcp", options->tcp, "a serial device server at HOST:PORT; port 0 takes a free one");
  wire->require_option(1);
  command
      ->add_option("--link", options->link,
                   "with --pty: create this link to the port, which stays when the device is unplugged")
      ->needs(pty_flag);
  command->add_option("--class", options->station.device_class, "7: a weather station; 8: a VENTUS")
      ->check(CLI::Range(1, 14))
      ->capture_default_str();
  command->add_option("--id", options->station.id, "its id on the line")
      ->check(CLI::Range(1, 255))
      ->capture_default_str();
  command->add_flag("--without-fast", options->has_no_fast_channels,
                    "has no fast channels, and measures nothing but the wind, as a VENTUS");
  command->add_flag("--only-wind", options->station.refuses_long_query, "refuses a query of more than two channels");
  command->add_flag("--echo", options->station.echoes, "its line has one pair of wires: clients hear what they say");
  options->common.add_to(*command);
  command->callback([options] { options->run(); });
}

}  // namespace yuragi::simulators::lufft
