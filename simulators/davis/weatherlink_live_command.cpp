#include <memory>
#include <string>

#include "simulators/core/command.hpp"
#include "simulators/core/common_options.hpp"
#include "simulators/davis/weatherlink_live.hpp"
#include "simulators/text/text_options.hpp"

namespace yuragi::simulators::davis {
namespace {

struct LiveOptions {
  std::string tcp;
  std::string udp = "127.0.0.1:22222";
  WeatherLinkLiveOptions live;
  core::CommonOptions common;

  void run() const {
    const Address http = core::address_option("--tcp", tcp);
    const Address broadcasts = core::address_option("--udp", udp);
    WeatherLinkLiveOptions made = live;
    made.broadcast_port = broadcasts.port;
    made.garbage_seed = common.synthetic.seed;
    WeatherLinkLive simulator(text::make_tcp_wire(http.host, http.port),
                              text::make_udp_wire(broadcasts.host, broadcasts.port), made, common.make_wind());
    text::print_place(simulator.http());
    common.run_simulator(simulator);
  }
};

}  // namespace

extern const core::Command kWeatherlinkLiveCommand;
const core::Command kWeatherlinkLiveCommand{[](CLI::App& app) {
  auto options = std::make_shared<LiveOptions>();
  CLI::App* command = app.add_subcommand("weatherlink-live", "Davis WeatherLink Live: HTTP, and UDP broadcasts");
  command->add_option("--tcp", options->tcp, "HOST:PORT of its HTTP server; port 0 takes a free one")->required();
  command->add_option("--udp", options->udp, "HOST:PORT that it broadcasts to")->capture_default_str();
  command->add_option("--interval", options->live.interval_s, "seconds between broadcasts")
      ->check(CLI::Range(0.05, 60.0))
      ->capture_default_str();
  options->common.add_to(*command);
  command->callback([options] { options->run(); });
}};

}  // namespace yuragi::simulators::davis
