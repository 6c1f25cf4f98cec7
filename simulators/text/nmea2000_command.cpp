#include <memory>

#include "simulators/commands.hpp"
#include "simulators/text/nmea2000_device.hpp"
#include "simulators/text/text_options.hpp"

namespace yuragi::simulators::text {
namespace {

struct Nmea2000Options {
  std::string format = "yacht-devices";
  TextOptions text;
};

}  // namespace

void add_nmea2000_command(CLI::App& app) {
  auto options = std::make_shared<Nmea2000Options>();
  CLI::App* command =
      app.add_subcommand("nmea2000", "anemometer on an NMEA 2000 bus, behind a gateway that sends lines");
  command->add_option("--format", options->format, "format of the lines")
      ->check(CLI::IsMember(nmea2000_format_names()))
      ->capture_default_str();
  options->text.add_to(*command);
  command->callback([options] { options->text.run(make_nmea2000_device(options->format)); });
}

}  // namespace yuragi::simulators::text
