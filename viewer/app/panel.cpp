#include "viewer/app/panel.hpp"

#include <algorithm>
#include <utility>

namespace yuragi::viewer::app {
namespace {

constexpr const char* kOlderDaemon = "The daemon is of an older version: its values cannot be seen or set from here.";

}  // namespace

void Panel::set_connected(bool is_connected) {
  if (is_connected == is_connected_) return;
  *this = Panel();
  is_connected_ = is_connected;
  is_list_due_ = is_connected;
}

void Panel::take_revision(std::uint64_t revision) {
  if (revision_ != revision) is_list_due_ = true;
  revision_ = revision;
}

void Panel::take_reply(const wire::ControlReply& reply) {
  if (!reply.parameters) {
    is_list_asked_ = false;
    refusal_ = kOlderDaemon;
    return;
  }
  refusal_ = reply.parameters->refusal;
  const std::uint32_t number = reply.parameters->number;
  const auto is_answered = [number](const Edit& edit) { return edit.stage == Stage::kSent && edit.number == number; };
  if (std::ranges::any_of(edits_, is_answered)) {
    mistake_ = reply.done ? "" : reply.message;
    is_list_due_ = true;
    if (!reply.done) std::erase_if(edits_, is_answered);
    for (Edit& edit : edits_) {
      if (is_answered(edit)) edit.stage = Stage::kDone;
    }
    return;
  }
  if (!reply.parameters->groups.empty()) {
    is_list_asked_ = false;
    groups_ = reply.parameters->groups;
    std::erase_if(edits_, [](const Edit& edit) { return edit.stage == Stage::kListed; });
  }
}

void Panel::set(std::string_view scene, std::string_view key, std::string value) {
  put({.scene = std::string(scene), .key = std::string(key), .value = value, .shown = value});
}

void Panel::reset(std::string_view scene, std::string_view key) {
  Edit edit{.scene = std::string(scene), .key = std::string(key), .value = {}, .shown = {}};
  for (const wire::ParameterGroup& group : groups_) {
    if (group.scene != scene) continue;
    const auto state = std::ranges::find(group.parameters, key, &wire::ParameterState::name);
    if (state != group.parameters.end()) edit.shown = state->configured;
  }
  put(std::move(edit));
}

/// Replaces a waiting value of the same parameter; what is shown is the last one.
void Panel::put(Edit edit) {
  if (!is_connected_ || !refusal_.empty()) return;
  std::erase_if(edits_, [&edit](const Edit& one) {
    return one.scene == edit.scene && one.key == edit.key && one.stage != Stage::kSent;
  });
  edits_.push_back(std::move(edit));
}

std::optional<wire::Control> Panel::next(double now_s) {
  if (!is_connected_) return std::nullopt;
  if (auto control = next_edits(now_s)) return control;
  return next_list(now_s);
}

std::optional<wire::Control> Panel::next_edits(double now_s) {
  if (sent_s_ && now_s - *sent_s_ < kSendEvery_s) return std::nullopt;
  const auto is_free = [this](const Edit& edit) {
    return edit.stage == Stage::kWaiting && std::ranges::none_of(edits_, [&edit](const Edit& other) {
             return other.stage == Stage::kSent && other.scene == edit.scene;
           });
  };
  const auto first = std::ranges::find_if(edits_, is_free);
  if (first == edits_.end()) return std::nullopt;
  wire::ParameterCommand command{.scene = first->scene, .number = ++number_};
  for (Edit& edit : edits_) {
    if (edit.stage != Stage::kWaiting || edit.scene != command.scene) continue;
    if (command.edits.size() == wire::kMaxParameterEdits) break;
    command.edits.push_back({edit.key, edit.value});
    edit.stage = Stage::kSent;
    edit.number = number_;
  }
  sent_s_ = now_s;
  return wire::Control{.scene = "", .parameters = std::move(command)};
}

std::optional<wire::Control> Panel::next_list(double now_s) {
  if (!is_list_due_ || is_list_asked_ || (asked_s_ && now_s - *asked_s_ < kListEvery_s)) return std::nullopt;
  for (Edit& edit : edits_) {
    if (edit.stage == Stage::kDone) edit.stage = Stage::kListed;
  }
  is_list_due_ = false;
  is_list_asked_ = true;
  asked_s_ = now_s;
  return wire::Control{.scene = "", .parameters = wire::ParameterCommand{.describe = true, .number = ++number_}};
}

const std::optional<std::string>& Panel::value(const wire::ParameterGroup& group,
                                               const wire::ParameterState& state) const {
  const auto last = std::find_if(edits_.rbegin(), edits_.rend(),
                                 [&](const Edit& edit) { return edit.scene == group.scene && edit.key == state.name; });
  return last == edits_.rend() ? state.value : last->shown;
}

}  // namespace yuragi::viewer::app
