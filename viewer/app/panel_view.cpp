#include "viewer/app/panel_view.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "engine/base/parameter.hpp"

namespace yuragi::viewer::app {
namespace {

constexpr float kTooltipWidth = 26.0F;  // letters
constexpr double kLargeRatio = 1000.0;  // ratio of a slider's ends above which it is logarithmic
const ImVec4 kNotice(1.0F, 0.78F, 0.36F, 1.0F);
const ImVec4 kFaded(0.98F, 0.97F, 0.94F, 0.66F);

constexpr ImU32 faint_ink(std::uint8_t opacity) {
  return IM_COL32(250, 248, 240, opacity);
}
constexpr ImU32 kHandle = IM_COL32(255, 214, 120, 200);
constexpr std::array<std::pair<ImGuiCol, ImU32>, 12> kColors{{{ImGuiCol_FrameBg, faint_ink(28)},
                                                              {ImGuiCol_FrameBgHovered, faint_ink(48)},
                                                              {ImGuiCol_FrameBgActive, faint_ink(64)},
                                                              {ImGuiCol_SliderGrab, kHandle},
                                                              {ImGuiCol_SliderGrabActive, kHandle},
                                                              {ImGuiCol_CheckMark, kHandle},
                                                              {ImGuiCol_Header, faint_ink(36)},
                                                              {ImGuiCol_HeaderHovered, faint_ink(56)},
                                                              {ImGuiCol_HeaderActive, faint_ink(72)},
                                                              {ImGuiCol_Button, faint_ink(36)},
                                                              {ImGuiCol_ButtonHovered, faint_ink(56)},
                                                              {ImGuiCol_ButtonActive, faint_ink(72)}}};

/// Sets the colors of handles and headers for its lifetime.
class QuietColors {
 public:
  QuietColors() {
    for (const auto& [which, color] : kColors) ImGui::PushStyleColor(which, color);
  }
  ~QuietColors() { ImGui::PopStyleColor(static_cast<int>(kColors.size())); }
  QuietColors(const QuietColors&) = delete;
  QuietColors& operator=(const QuietColors&) = delete;
};

void write_wrapped(const ImVec4& color, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::PushTextWrapPos(0.0F);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

template <class Number>
Number number_in(const std::string& text, Number otherwise) {
  Number number = otherwise;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

std::string with_unit(const wire::ParameterState& state, const std::string& value) {
  return state.unit.empty() ? value : value + " " + state.unit;
}

/// Returns the format of a slider's number: as fine as the slider's steps. ImGui rounds to it.
std::string number_format(const wire::ParameterState& state) {
  const double range = *state.max - *state.min;
  const int decimals = range > 0.0 ? std::clamp(3 - static_cast<int>(std::floor(std::log10(range))), 1, 6) : 3;
  std::string unit = state.unit;
  for (std::size_t at = unit.find('%'); at != std::string::npos; at = unit.find('%', at + 2)) unit.insert(at, "%");
  return fmt::format("%.{}f{}{}", decimals, unit.empty() ? "" : " ", unit);
}

ImGuiSliderFlags slider_flags(double min, double max) {
  const bool is_logarithmic = min > 0.0 && max / min > kLargeRatio;
  return ImGuiSliderFlags_AlwaysClamp | (is_logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
}

// Each widget returns the value that a person has set with it, if any. `now`: nullopt if it is omitted.
using Input = std::optional<std::string>;

Input edit_number(const wire::ParameterState& state, const Input& now) {
  double number =
      now ? number_in(*now, 0.0) : std::clamp(0.0, state.min.value_or(0.0), std::max(0.0, state.max.value_or(0.0)));
  if (!state.min || !state.max) {
    const bool is_set = ImGui::InputDouble("##value", &number, 0.0, 0.0, "%.6g", ImGuiInputTextFlags_EnterReturnsTrue);
    return is_set ? Input(value_text(number)) : Input();
  }
  const std::string format = now ? number_format(state) : "left out";
  const bool is_moved = ImGui::SliderScalar("##value", ImGuiDataType_Double, &number, &*state.min, &*state.max,
                                            format.c_str(), slider_flags(*state.min, *state.max));
  return is_moved ? Input(value_text(number)) : Input();
}

Input edit_whole_number(const wire::ParameterState& state, const Input& now) {
  // ImGui's sliders take half of the range of 64 bits.
  constexpr double kMost = 0x1p62;
  const auto min = static_cast<std::int64_t>(std::max(state.min.value_or(-kMost), -kMost));
  const auto max = static_cast<std::int64_t>(std::min(state.max.value_or(kMost), kMost));
  std::int64_t number = now ? number_in(*now, min) : std::clamp(std::int64_t{0}, min, max);
  bool is_set = false;
  if (state.min && state.max) {
    is_set = ImGui::SliderScalar("##value", ImGuiDataType_S64, &number, &min, &max, now ? nullptr : "left out",
                                 slider_flags(static_cast<double>(min), static_cast<double>(max)));
  } else {
    is_set = ImGui::InputScalar("##value", ImGuiDataType_S64, &number, nullptr, nullptr, nullptr,
                                ImGuiInputTextFlags_EnterReturnsTrue);
  }
  return is_set ? Input(std::to_string(number)) : Input();
}

Input edit_yes_no(const Input& now) {
  bool is_on = now == "true";
  return ImGui::Checkbox("##value", &is_on) ? Input(is_on ? "true" : "false") : Input();
}

Input edit_choice(const wire::ParameterState& state, const Input& now) {
  Input chosen;
  if (!ImGui::BeginCombo("##value", now ? now->c_str() : "left out")) return chosen;
  for (const std::string& choice : state.choices) {
    if (ImGui::Selectable(choice.c_str(), choice == now)) chosen = choice;
  }
  ImGui::EndCombo();
  return chosen;
}

Input edit_text(const Input& now) {
  std::array<char, wire::kMaxTextBytes + 1> text{};
  now.value_or("").copy(text.data(), wire::kMaxTextBytes);
  const bool is_set = ImGui::InputTextWithHint("##value", now ? "" : "left out", text.data(), text.size(),
                                               ImGuiInputTextFlags_EnterReturnsTrue);
  return is_set ? Input(text.data()) : Input();
}

Input edit(const wire::ParameterState& state, const Input& now) {
  switch (state.kind) {
    case wire::ParameterKind::kNumber:
      return edit_number(state, now);
    case wire::ParameterKind::kWholeNumber:
      return edit_whole_number(state, now);
    case wire::ParameterKind::kYesNo:
      return edit_yes_no(now);
    case wire::ParameterKind::kText:
      break;
  }
  return state.choices.empty() ? edit_text(now) : edit_choice(state, now);
}

void explain(const wire::ParameterState& state) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(kTooltipWidth * ImGui::GetFontSize());
  ImGui::TextUnformatted(state.help.c_str());
  if (!state.left_out.empty()) ImGui::TextUnformatted(("Left out: " + state.left_out).c_str());
  if (state.change == KeyChange::kCrossFade) {
    ImGui::TextUnformatted("The scene is made anew, and cross-faded to.");
  }
  if (state.change == KeyChange::kTakesRestart) ImGui::TextUnformatted("Takes a restart of the daemon.");
  if (state.change == KeyChange::kTakesReload) {
    ImGui::TextUnformatted("Is read with the configuration: yuragi reload.");
  }
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

/// A line of the table: name, handle or value, and the way back.
void draw_parameter(Panel& panel, const wire::ParameterGroup& group, const wire::ParameterState& state) {
  const Input& now = panel.value(group, state);
  ImGui::PushID(state.name.c_str());
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(state.name.c_str());
  explain(state);
  ImGui::TableNextColumn();
  const bool is_fixed = state.change == KeyChange::kTakesRestart || state.change == KeyChange::kTakesReload;
  if (!panel.refusal().empty() || is_fixed) {
    ImGui::AlignTextToFramePadding();
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextUnformatted((now ? with_unit(state, *now) : "left out").c_str());
    ImGui::PopTextWrapPos();
    explain(state);
    ImGui::TableNextColumn();
  } else {
    ImGui::SetNextItemWidth(-1.0F);
    const Input set = edit(state, now);
    explain(state);
    ImGui::TableNextColumn();
    if (now != state.configured && ImGui::SmallButton("reset")) {
      panel.reset(group.scene, state.name);
    } else if (set) {
      panel.set(group.scene, state.name, *set);
    }
  }
  ImGui::PopID();
}

void draw_group(Panel& panel, const wire::ParameterGroup& group) {
  std::string title = group.scene.empty() ? "light and weather" : group.scene;
  if (!group.kind.empty() && group.kind != group.scene) title += " (" + group.kind + ")";
  const ImGuiTreeNodeFlags flags = group.scene.empty() ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None;
  // The part after ### distinguishes groups of the same name.
  if (!ImGui::CollapsingHeader((title + "###" + group.scene).c_str(), flags)) return;
  ImGui::PushID(group.scene.c_str());
  if (ImGui::BeginTable("parameters", 3)) {
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed, 0.4F * ImGui::GetContentRegionAvail().x);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("reset", ImGuiTableColumnFlags_WidthFixed,
                            ImGui::CalcTextSize("reset").x + ImGui::GetFontSize());
    for (const wire::ParameterState& state : group.parameters) draw_parameter(panel, group, state);
    ImGui::EndTable();
  }
  ImGui::PopID();
}

}  // namespace

void draw_panel(Panel& panel) {
  const QuietColors colors;
  if (!panel.refusal().empty()) write_wrapped(kNotice, panel.refusal());
  if (!panel.mistake().empty()) write_wrapped(kNotice, "Not set: " + panel.mistake());
  if (!panel.has_list() && panel.refusal().empty()) write_wrapped(kFaded, "waiting for the daemon's values");
  for (const wire::ParameterGroup& group : panel.groups()) draw_group(panel, group);
  if (panel.has_list() && panel.refusal().empty()) {
    write_wrapped(
        kFaded,
        "Until the configuration is read again. To keep: yuragi look values --toml, yuragi scene values --toml");
  }
}

}  // namespace yuragi::viewer::app
