#include <memory>

#include "simulators/core/command.hpp"
#include "simulators/text/nmea2000_device.hpp"
#include "simulators/text/text_options.hpp"

namespace yuragi::simulators::text {
namespace {

struct Nmea2000Options {
  std::string format = "yacht-devices";
  std::string reference = "apparent";
  Options text;
};

}  // namespace

extern const core::Command kNmea2000Command;
const core::Command kNmea2000Command{[](CLI::App& app) {
  auto options = std::make_shared<Nmea2000Options>();
  CLI::App* command = app.add_subcommand(
      "nmea2000", "anemometer on an NMEA 2000 bus, on a CAN interface or behind a gateway that sends lines");
  command->add_option("--format", options->format, "format of the lines")
      ->check(CLI::IsMember(nmea2000_format_names()))
      ->capture_default_str();
  command->add_option("--reference", options->reference, "what its angles are measured from")
      ->check(CLI::IsMember(nmea2000_reference_names()))
      ->capture_default_str();
  options->text.add_to(*command).add_option("--can", options->text.can,
                                            "frames on this CAN interface, such as vcan0; ignores the format");
  command->callback([options] {
    const bool is_on_bus = !options->text.can.empty();
    options->text.run(is_on_bus ? make_nmea2000_can_device(options->reference)
                                : make_nmea2000_device(options->format, options->reference));
  });
}};

}  // namespace yuragi::simulators::text
