#include "daemon/service/parameter_director.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "daemon/service/parameter_groups.hpp"
#include "daemon/service/reload_report.hpp"

namespace yuragi::daemon::service {
namespace {

constexpr std::string_view kShownKey = "shown";

/// A text about the changes, for a person.
std::string changes_text(const std::vector<std::string>& changes) {
  if (changes.empty()) return "nothing has changed";
  return fmt::format("{} (until the configuration is read again)", fmt::join(changes, "; "));
}

}  // namespace

ParameterDirector::ParameterDirector(Reload& reload, animation::SceneDirector* scenes,
                                     settings::ControlPermission allowed, std::uint64_t revision)
    : reload_(reload), scenes_(scenes), allowed_(allowed), revision_(revision) {}

void ParameterDirector::handle(const wire::ParameterCommand& command, bool is_local, Reply reply) {
  const auto answer = [this, command, is_local, reply = std::move(reply)](bool is_done, std::string message) {
    reply({.done = is_done,
           .message = std::move(message),
           .scenes = {},
           .players = {},
           .reload = {},
           .parameters = report(command, is_local)});
  };
  if (command.edits.empty()) return answer(true, "nothing was changed");
  if (const auto why = refusal(is_local)) return answer(false, *why);

  std::vector<settings::ParameterEdit> edits;
  for (const wire::ParameterEdit& edit : command.edits) edits.push_back({command.scene, edit.key, edit.value});
  if (auto mistake = reload_.mistake_in(edits)) return answer(false, std::move(*mistake));

  // Showing scenes is switched as by any other client, independent of the configuration.
  std::vector<std::string> done;
  const auto is_shown_key = [](const settings::ParameterEdit& edit) { return edit.key == kShownKey; };
  if (!command.scene.empty()) {
    for (const settings::ParameterEdit& edit : edits) {
      if (!is_shown_key(edit)) continue;
      const auto& configured = reload_.configured().scenes;
      const auto before = std::ranges::find(configured, command.scene, &settings::SceneConfig::name);
      const bool was_shown = before == configured.end() || before->is_shown;
      const wire::ControlReply switched =
          scenes_->handle({.scene = command.scene, .shown = edit.value ? *edit.value == "true" : was_shown}, is_local);
      if (!switched.done) return answer(false, switched.message);
      note_change();
      done.push_back(switched.message);
    }
    std::erase_if(edits, is_shown_key);
  }
  if (edits.empty()) return answer(true, changes_text(done));
  reload_.set(edits, [answer, done, is_local](const wire::ReloadReport& made) {
    const wire::ReloadReport report = is_local ? made : without_folders(made);
    if (report.outcome != wire::ReloadOutcome::kDone) return answer(false, summary_of(report));
    std::vector<std::string> changes = done;
    changes.insert(changes.end(), report.applied.begin(), report.applied.end());
    answer(true, changes_text(changes));
  });
}

wire::ParameterReport ParameterDirector::report(const wire::ParameterCommand& command, bool is_local) const {
  wire::ParameterReport report{.number = command.number, .refusal = refusal(is_local).value_or("")};
  if (!command.describe) return report;
  const auto scenes =
      scenes_ != nullptr ? scenes_->handle({.scene = ""}, true).scenes : std::vector<wire::SceneState>();
  report.groups = parameter_groups(reload_.running(), reload_.configured(), scenes);
  if (!is_local) report.groups = without_folders(std::move(report.groups));
  return report;
}

std::optional<std::string> ParameterDirector::refusal(bool is_local) const {
  return settings::control_refusal(allowed_, is_local, "values cannot be set");
}

}  // namespace yuragi::daemon::service
