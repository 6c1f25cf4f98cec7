#include <memory>

#include "simulators/core/command.hpp"
#include "simulators/text/signalk_device.hpp"
#include "simulators/text/text_options.hpp"

namespace yuragi::simulators::text {

extern const core::Command kSignalkCommand;
const core::Command kSignalkCommand{[](CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("signalk", "Signal K server that streams wind; with --udp, a device's deltas");
  options->add_to(*command);
  options->websocket.path = "/signalk/v1/stream";
  options->add_websocket_to(*command);
  command->callback([options] { options->run(make_signalk_device(options->udp.empty())); });
}};

}  // namespace yuragi::simulators::text
