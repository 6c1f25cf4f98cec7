#include "daemon/commands/json_output.hpp"

#include "daemon/settings/standard_output.hpp"
#include "engine/base/json_text.hpp"

namespace yuragi::daemon::commands {
namespace {

void print_indented(const nlohmann::ordered_json& json, int indent) {
  settings::write_at_once(json_text(json, indent) + "\n");
}

}  // namespace

void add_json(CLI::App& command, bool& as_json) {
  command.add_flag("--json", as_json, "print it as JSON");
}

void print_json(const nlohmann::ordered_json& json) {
  print_indented(json, 2);
}

void print_json_line(const nlohmann::ordered_json& json) {
  print_indented(json, -1);
}

}  // namespace yuragi::daemon::commands
