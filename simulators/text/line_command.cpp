#include <memory>

#include "simulators/core/command.hpp"
#include "simulators/text/line_device.hpp"
#include "simulators/text/text_options.hpp"

namespace yuragi::simulators::text {
namespace {

struct LineOptions {
  std::string format = "csv";
  Options text;
};

}  // namespace

extern const core::Command kLineCommand;
const core::Command kLineCommand{[](CLI::App& app) {
  auto options = std::make_shared<LineOptions>();
  CLI::App* command = app.add_subcommand("line", "microcontroller that prints numbers, one reading per line");
  command->add_option("--format", options->format, "format of the lines")
      ->check(CLI::IsMember(line_format_names()))
      ->capture_default_str();
  options->text.add_to(*command);
  command->callback([options] { options->text.run(make_line_device(options->format)); });
}};

}  // namespace yuragi::simulators::text
