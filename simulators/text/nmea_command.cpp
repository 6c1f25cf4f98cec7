#include <algorithm>
#include <memory>

#include "simulators/core/command.hpp"
#include "simulators/text/nmea_device.hpp"
#include "simulators/text/text_options.hpp"

namespace yuragi::simulators::text {
namespace {

struct NmeaOptions {
  std::vector<std::string> formats = {"mwv"};
  Options text;
};

void simulate_nmea(NmeaOptions options) {
  const bool is_mute = std::ranges::any_of(options.formats, [](const auto& format) { return is_only_polled(format); });
  if (is_mute && options.formats.size() > 1)
    throw CLI::ValidationError("--format", "umb cannot be combined with another format");
  if (is_mute) options.text.rate_hz = 0.0;
  options.text.run(make_nmea_device(options.formats));
}

}  // namespace

extern const core::Command kNmeaCommand;
const core::Command kNmeaCommand{[](CLI::App& app) {
  auto options = std::make_shared<NmeaOptions>();
  CLI::App* command =
      app.add_subcommand("nmea", "anemometer that sends NMEA 0183, or the text formats of Gill, FT, Lufft or Vaisala");
  command->add_option("--format", options->formats, "formats; several, separated by commas, are sent in one burst")
      ->delimiter(',')
      ->check(CLI::IsMember(nmea_format_names()))
      ->capture_default_str();
  options->text.add_to(*command);
  command->callback([options] { simulate_nmea(*options); });
}};

}  // namespace yuragi::simulators::text
