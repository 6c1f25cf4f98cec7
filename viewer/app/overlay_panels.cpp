#include "viewer/app/overlay_panels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <imgui.h>

#include "engine/base/compass.hpp"
#include "engine/base/units.hpp"
#include "engine/wire/sensor_trouble.hpp"
#include "viewer/app/keys.hpp"
#include "viewer/app/panel_view.hpp"
#include "viewer/app/wind_place_text.hpp"
#include "viewer/pace/quality.hpp"

namespace yuragi::viewer::app {
namespace {

constexpr ImU32 kInk = IM_COL32(250, 248, 240, 255);
constexpr ImU32 kFaint = IM_COL32(250, 248, 240, 110);
constexpr ImU32 kMeasured = IM_COL32(130, 200, 255, 255);
constexpr ImU32 kArrow = IM_COL32(255, 214, 120, 255);
const ImVec4 kQuiet(0.98F, 0.97F, 0.94F, 0.66F);
const ImVec4 kDim(0.98F, 0.97F, 0.94F, 0.36F);
const ImVec4 kGood(0.62F, 0.90F, 0.52F, 1.0F);
const ImVec4 kWarn(1.0F, 0.78F, 0.36F, 1.0F);

constexpr float kReasonWidthInLetters = 24.0F;
constexpr float kNoticeWidthInLetters = 32.0F;
constexpr float kNoticeScale = 1.4F;
constexpr float kNoticeOpacity = 0.85F;  // opacity of the background of its text

/// As wide as its texts, even if the window is narrower.
constexpr ImGuiTableFlags kTableOfTexts =
    ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoHostExtendX | ImGuiTableFlags_NoKeepColumnsVisible;

constexpr double kArrowFullSpeed_m_s = 12.0;  // as long as the compass is wide

/// A font that most systems have; if it is missing, ImGui's own is used.
void load_font(double scale) {
  constexpr std::array kFonts = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                 "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
                                 "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"};
  for (const char* file : kFonts) {
    std::error_code error;
    if (std::filesystem::is_regular_file(file, error)) {
      ImGui::GetIO().Fonts->AddFontFromFileTTF(file, static_cast<float>(15.0 * scale));
      return;
    }
  }
  ImFontConfig config;
  config.SizePixels = static_cast<float>(std::round(13.0 * scale));
  ImGui::GetIO().Fonts->AddFontDefault(&config);
}

/// Around the picture's edge and between panels.
float margin() {
  return ImGui::GetFontSize();
}

void write(const std::string& text) {
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
}
void write(const ImVec4& color, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  write(text);
  ImGui::PopStyleColor();
}

/// A rose that turns with the camera, and an arrow the way the wind blows.
void draw_compass(const wind::State& wind, double heading_deg, float radius) {
  ImDrawList* const list = ImGui::GetWindowDrawList();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 center(corner.x + radius, corner.y + radius);
  ImGui::Dummy(ImVec2(2.0F * radius, 2.0F * radius));
  const auto at = [&](double bearing_deg, float reach) {
    const auto angle = static_cast<float>((bearing_deg - heading_deg) * kRadPerDeg);
    return ImVec2(center.x + reach * std::sin(angle), center.y - reach * std::cos(angle));
  };

  list->AddCircle(center, radius * 0.98F, kFaint, 48, 1.2F);
  for (int mark = 0; mark < 16; ++mark) {
    const double bearing_deg = 22.5 * mark;
    list->AddLine(at(bearing_deg, radius * (mark % 4 == 0 ? 0.84F : 0.91F)), at(bearing_deg, radius * 0.98F), kFaint,
                  1.2F);
  }
  for (const auto& [bearing_deg, letter] :
       {std::pair{0.0, "N"}, std::pair{90.0, "E"}, std::pair{180.0, "S"}, std::pair{270.0, "W"}}) {
    const ImVec2 size = ImGui::CalcTextSize(letter);
    const ImVec2 middle = at(bearing_deg, radius * 0.68F);
    list->AddText(ImVec2(middle.x - size.x / 2, middle.y - size.y / 2), bearing_deg == 0.0 ? kInk : kFaint, letter);
  }

  // The arrow's length is the speed.
  const double speed_m_s = speed_of(wind.wind);
  const double toward_deg = wind::direction_from_deg(wind.wind) + 180.0;
  const float reach = radius * static_cast<float>(0.16 + 0.68 * std::min(1.0, speed_m_s / kArrowFullSpeed_m_s));
  if (speed_m_s < 0.05) {
    list->AddCircleFilled(center, radius * 0.06F, kArrow);
    return;
  }
  const ImVec2 tip = at(toward_deg, reach);
  const auto beside = [&](double turn_deg, float back) {
    const auto angle = static_cast<float>((toward_deg - heading_deg + turn_deg) * kRadPerDeg);
    return ImVec2(tip.x - back * std::sin(angle), tip.y + back * std::cos(angle));
  };
  list->AddLine(at(toward_deg + 180.0, reach), beside(0.0, radius * 0.16F), kArrow, radius * 0.07F);
  list->AddTriangleFilled(tip, beside(26.0, radius * 0.30F), beside(-26.0, radius * 0.30F), kArrow);
}

/// Returns true if at least one sensor has sent a reading, and all that have fulfil the condition.
template <class Property>
bool is_true_of_all_that_speak(const wire::Sensors* sensors, Property property) {
  if (sensors == nullptr) return false;
  const auto is_live = [](const wire::SensorStatus& sensor) { return is_believed(sensor.state); };
  const auto differs = [&](const wire::SensorStatus& sensor) { return is_live(sensor) && !(sensor.*property); };
  return std::any_of(sensors->sensors.begin(), sensors->sensors.end(), is_live) &&
         std::none_of(sensors->sensors.begin(), sensors->sensors.end(), differs);
}

void write_wind(const OverlayFacts& facts, float scale) {
  draw_compass(facts.wind, facts.heading_deg, 44.0F * scale);
  ImGui::SameLine(0.0F, 14.0F * scale);
  ImGui::BeginGroup();
  const double direction_deg = wind::direction_from_deg(facts.wind.wind);
  ImGui::SetWindowFontScale(1.5F);
  write(fmt::format("{:.1f} m/s", speed_of(facts.wind.wind)));
  ImGui::SetWindowFontScale(1.0F);
  write(fmt::format("from {:.0f}\u00b0 {}", direction_deg, nearest_compass_point(direction_deg)));
  if (const std::string place = wind_place_text(facts.wind); !place.empty()) write(kQuiet, place);
  switch (facts.wind.source) {
    case wind::Source::kLive:
      if (is_true_of_all_that_speak(facts.sensors, &wire::SensorStatus::replayed)) {
        write(kWarn, "REPLAY of a recording");
      } else {
        const bool is_simulated = is_true_of_all_that_speak(facts.sensors, &wire::SensorStatus::simulated);
        write(kGood, is_simulated ? "live, simulated sensor" : "live sensor");
      }
      break;
    case wind::Source::kHandover:
      write(kWarn, fmt::format("handing over, {:.0f} % live", 100.0 * facts.wind.live_weight));
      break;
    case wind::Source::kDefault:
      write(kQuiet, "default wind, no sensor");
      break;
  }
  ImGui::EndGroup();
}

/// A line for a sensor and, below it, what is wrong and how to correct it.
void write_sensor(const wire::SensorStatus& sensor) {
  const std::string trouble = trouble_of(sensor);
  std::string text = fmt::format("{} ({}): {}", sensor.name, sensor.driver, name_of(sensor.state));
  if (sensor.speed_m_s) text += fmt::format(", {:.1f} m/s", *sensor.speed_m_s);
  if (sensor.direction_deg) text += fmt::format(" from {:.0f}\u00b0", *sensor.direction_deg);
  if (sensor.replayed && sensor.state != wind::judging::SensorState::kReplayed) text += ", REPLAY";
  write(sensor.state == wind::judging::SensorState::kReplayed || !trouble.empty() ? kWarn : kGood, text);
  if (trouble.empty()) return;
  ImGui::PushTextWrapPos(kReasonWidthInLetters * ImGui::GetFontSize());
  write(kQuiet, trouble);
  ImGui::PopTextWrapPos();
}

/// Why the wind of the picture is not the one outside, a line for each reason.
void write_shaping(const OverlayFacts& facts) {
  if (facts.sensors == nullptr) return;
  for (std::string_view text = facts.sensors->shaping.text; !text.empty();) {
    constexpr std::string_view kBetween = "; ";
    const std::size_t end = text.find(kBetween);
    write(kWarn, std::string(text.substr(0, end)));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + kBetween.size());
  }
}

/// The place of the sun, the weather, and what the quality omits.
void write_look(const OverlayFacts& facts) {
  if (facts.sky == nullptr) return;
  const light::SkyPlace& sun = facts.sky->sun;
  std::string text = sun.height_deg < -0.5
                         ? fmt::format("sun {:.0f}\u00b0 below the horizon", -sun.height_deg)
                         : fmt::format("sun {:.0f}\u00b0 high in the {}", std::max(0.0, sun.height_deg),
                                       nearest_compass_point(sun.azimuth_deg));
  text += fmt::format(", clouds {:.0f} %, haze {:.0f} %", 100.0 * facts.sky->clouds, 100.0 * facts.sky->haze);
  write(kQuiet, text);
  write(kQuiet, pace::quality_text(facts.quality, facts.drawn, facts.refreshes));
}

void write_stream(const OverlayFacts& facts) {
  switch (facts.playback) {
    case stream::Playback::kReplaying:
      write(kWarn, "stream lost: replaying its last seconds");
      break;
    case stream::Playback::kReturning:
      write(kGood, "stream is back");
      break;
    case stream::Playback::kNothing:
      write(kQuiet, "no picture yet");
      break;
    case stream::Playback::kLive:
      break;
  }
  write(facts.stream.state == stream::State::kConnected ? kQuiet : kWarn, facts.stream.text);
  if (!facts.age.empty()) {
    ImGui::PushTextWrapPos(kReasonWidthInLetters * ImGui::GetFontSize());
    write(kQuiet, facts.age);
    ImGui::PopTextWrapPos();
  }
  write(kQuiet, fmt::format("{} nodes, {:.0f} pictures/s", facts.nodes, facts.pictures_per_s));
}

/// The scenes, and the opacity of those that fade.
void write_scenes(const OverlayFacts& facts) {
  for (std::size_t i = 0; i < std::min(facts.scenes.size(), facts.opacities.size()); ++i) {
    const float opacity = facts.opacities[i];
    const wire::SceneModel& scene = *facts.scenes[i];
    std::string text = scene.name;
    if (scene.kind != text) text += " (" + scene.kind + ")";
    if (opacity <= 0.0F) {
      text += ", hidden";
    } else if (opacity < 1.0F) {
      text += fmt::format(", {:.0f} %", 100.0F * opacity);
    }
    write(opacity > 0.0F ? kQuiet : kDim, text);
  }
}

void draw_texts(const OverlayFacts& facts) {
  const bool has_picture = facts.playback != stream::Playback::kNothing;
  if (has_picture) {
    write_wind(facts, ImGui::GetFontSize() / 15.0F);
    ImGui::Spacing();
  }
  if (facts.sensors != nullptr) {
    for (const wire::SensorStatus& sensor : facts.sensors->sensors) write_sensor(sensor);
  }
  write_shaping(facts);
  write_scenes(facts);
  if (has_picture) write_look(facts);
  if (!facts.camera.empty()) write(kQuiet, facts.camera);
  write_stream(facts);
}

void draw_help() {
  if (ImGui::BeginTable("keys", 2, kTableOfTexts)) {
    for (std::size_t line = 0; const auto help = key_help(line); ++line) {
      ImGui::TableNextColumn();
      write(help->keys);
      ImGui::TableNextColumn();
      write(kQuiet, std::string(help->text));
    }
    ImGui::EndTable();
  }
  write(kQuiet, "Drag to turn (left button) or to move (right), scroll to come nearer.");
}

/// A paused wall must be distinguishable from one that stands still.
void draw_pause() {
  write(kWarn, "paused; Space goes on");
}

void draw_profile(const OverlayFacts& facts) {
  const float letter = ImGui::GetFontSize();
  const auto& times_ms = facts.picture_times_ms;
  if (!times_ms.empty()) {
    const float longest_ms = *std::ranges::max_element(times_ms);
    ImGui::PlotLines("##times", times_ms.data(), static_cast<int>(times_ms.size()), 0, nullptr, 0.0F, 1.1F * longest_ms,
                     ImVec2(24.0F * letter, 3.0F * letter));
    write(fmt::format("{:.0f} ms a picture; longest of {}: {:.0f} ms", times_ms.back(), times_ms.size(), longest_ms));
  }
  if (ImGui::BeginTable("passes", 4, kTableOfTexts)) {
    const auto row = [](const ImVec4& color, const std::array<std::string, 4>& cells) {
      for (const std::string& cell : cells) {
        ImGui::TableNextColumn();
        write(color, cell);
      }
    };
    row(kDim, {"pass", "ms", "kB sent", "triangles"});
    for (const gl::PassClock::Pass& pass : *facts.passes) {
      row(kQuiet,
          {pass.name, fmt::format("{:.2f}", pass.time_ms),
           fmt::format("{:.0f}", 1e-3 * static_cast<double>(pass.uploaded_bytes)), fmt::format("{}", pass.triangles)});
    }
    ImGui::EndTable();
  }
  write(kDim, "Pictures take longer while this is measured.");
}

void draw_wind_trace(const WindTrace& trace) {
  const float letter = ImGui::GetFontSize();
  const ImVec2 size(24.0F * letter, 5.0F * letter);
  const std::vector<float>& speeds = trace.speeds_m_s();
  const std::vector<float>& measured = trace.measured_m_s();
  const bool has_both = !speeds.empty();
  const float most =
      has_both ? std::max({1.0F, *std::ranges::max_element(speeds), *std::ranges::max_element(measured)}) : 1.0F;
  write(fmt::format("last minute, 0 to {:.1f} m/s", most));
  ImDrawList* const list = ImGui::GetWindowDrawList();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy(size);
  list->AddRect(corner, ImVec2(corner.x + size.x, corner.y + size.y), kFaint);
  const auto draw_line = [&](const std::vector<float>& values, ImU32 color) {
    const auto at = [&](std::size_t i) {
      const float age = static_cast<float>(values.size() - 1 - i) / static_cast<float>(WindTrace::kSamples - 1);
      return ImVec2(corner.x + size.x * (1.0F - age), corner.y + size.y * (1.0F - values[i] / most));
    };
    for (std::size_t i = 1; i < values.size(); ++i) list->AddLine(at(i - 1), at(i), color, 0.1F * letter);
  };
  draw_line(measured, kMeasured);
  draw_line(speeds, kArrow);
  write(ImGui::ColorConvertU32ToFloat4(kArrow), "in the scenes");
  ImGui::SameLine();
  write(ImGui::ColorConvertU32ToFloat4(kMeasured), "measured (mean of the sensors)");

  const std::vector<SpectrumBand> bands = spectrum_of(speeds);
  const ImVec2 below = ImGui::GetCursorScreenPos();
  ImGui::Dummy(size);
  list->AddRect(below, ImVec2(below.x + size.x, below.y + size.y), kFaint);
  // Both axes are logarithmic: 1/60 to 4 Hz, and six powers of ten.
  const auto at = [&](const SpectrumBand& band) {
    const double right = std::log(band.frequency_hz * 60.0) / std::log(240.0);
    const double up = (std::log10(std::max(band.density_m2_s, 1e-4)) + 4.0) / 6.0;
    return ImVec2(below.x + size.x * static_cast<float>(std::clamp(right, 0.0, 1.0)),
                  below.y + size.y * static_cast<float>(1.0 - std::clamp(up, 0.0, 1.0)));
  };
  for (std::size_t i = 1; i < bands.size(); ++i) list->AddLine(at(bands[i - 1]), at(bands[i]), kArrow, 0.1F * letter);
  write(kQuiet, bands.empty() ? "its spectrum comes after 8 s" : "its spectrum: 1/60 to 4 Hz, 1e-4 to 100 m\u00b2/s");
}

/// The first line states what is wrong.
void draw_notice(const std::string& notice) {
  ImGui::SetWindowFontScale(kNoticeScale);
  const float room = ImGui::GetIO().DisplaySize.x - 2.0F * (ImGui::GetCursorPosX() + margin());
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + std::min(kNoticeWidthInLetters * ImGui::GetFontSize(), room));
  const std::size_t end = std::min(notice.find('\n'), notice.size());
  write(kWarn, notice.substr(0, end));
  if (end < notice.size()) write(notice.substr(end + 1));
  ImGui::PopTextWrapPos();
}

constexpr std::size_t index_of(PanelId id) {
  return static_cast<std::size_t>(id);
}

OfPanels<bool> shown_panels(const OverlayFacts& facts) {
  OfPanels<bool> is_shown{};
  is_shown[index_of(PanelId::kTexts)] = facts.has_texts;
  is_shown[index_of(PanelId::kHelp)] = facts.has_help;
  is_shown[index_of(PanelId::kProfile)] = facts.passes != nullptr;
  is_shown[index_of(PanelId::kValues)] = facts.panel != nullptr;
  is_shown[index_of(PanelId::kTrace)] = facts.wind_trace != nullptr;
  is_shown[index_of(PanelId::kNotice)] = !facts.notice.empty();
  is_shown[index_of(PanelId::kPause)] = facts.is_paused;
  return is_shown;
}

}  // namespace

void OverlayPanels::set_scale(double scale) {
  ImGui::GetIO().Fonts->Clear();
  load_font(scale);
  ImGuiStyle style;
  ImGui::StyleColorsDark(&style);
  style.WindowRounding = 8.0F;
  style.WindowBorderSize = 0.0F;
  style.WindowPadding = ImVec2(14.0F, 12.0F);
  style.ItemSpacing = ImVec2(8.0F, 5.0F);
  style.ScaleAllSizes(static_cast<float>(scale));
  style.Colors[ImGuiCol_WindowBg] = ImVec4(0.06F, 0.07F, 0.06F, 0.62F);
  style.Colors[ImGuiCol_Text] = ImVec4(0.98F, 0.97F, 0.94F, 1.0F);
  ImGui::GetStyle() = style;
}

/// Called by ImGui with the size of the window's content.
void OverlayPanels::set_size(ImGuiSizeCallbackData* data) {
  Place& place = *static_cast<Place*>(data->UserData);
  place.wanted = {.width = data->DesiredSize.x, .height = data->DesiredSize.y};
  data->DesiredSize = ImVec2(place.rect.size.width, place.rect.size.height);
}

template <class Content>
void OverlayPanels::draw_panel_at(PanelId id, const char* name, const Content& content) {
  Place& place = places_[index_of(id)];
  const PanelSize& size = place.rect.size;
  const bool is_measured = !place.wanted.is_empty();
  if (is_measured && std::min(size.width, size.height) < ImGui::GetFontSize()) return;  // nothing could be read
  const bool is_cut = size.width < place.wanted.width || size.height < place.wanted.height;
  ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                           ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize |
                           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                           ImGuiWindowFlags_NoFocusOnAppearing;
  if (id != PanelId::kValues) {
    flags |= is_measured && is_cut ? ImGuiWindowFlags_HorizontalScrollbar
                                   : ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoInputs;
  }
  ImGui::SetNextWindowPos(ImVec2(place.rect.x, place.rect.y));
  const float any = std::numeric_limits<float>::max();
  ImGui::SetNextWindowSizeConstraints(ImVec2(0.0F, 0.0F), ImVec2(any, any), set_size, &place);
  if (id == PanelId::kNotice) ImGui::SetNextWindowBgAlpha(kNoticeOpacity);
  ImGui::Begin(name, nullptr, flags);
  content();
  ImGui::End();
}

bool OverlayPanels::is_laid_out(const OverlayFacts& facts) const {
  const OfPanels<bool> is_shown = shown_panels(facts);
  for (std::size_t i = 0; i < kPanelCount; ++i) {
    if (is_shown[i] && places_[i].frames < kFramesToMeasure) return false;
  }
  return true;
}

void OverlayPanels::draw(const OverlayFacts& facts) {
  const ImVec2 picture = ImGui::GetIO().DisplaySize;
  const OfPanels<bool> is_shown = shown_panels(facts);
  // The panel of values fills the width that it has.
  places_[index_of(PanelId::kValues)].wanted.width =
      std::min(kPanelWidthInLetters * ImGui::GetFontSize(), picture.x - 2.0F * margin());
  OfPanels<PanelSize> wanted{};
  for (std::size_t i = 0; i < kPanelCount; ++i) {
    if (is_shown[i]) wanted[i] = places_[i].wanted;
  }
  const auto rects = layout_.place({.width = picture.x, .height = picture.y}, margin(), wanted);
  for (std::size_t i = 0; i < kPanelCount; ++i) {
    places_[i].rect = rects[i];
    if (is_shown[i]) places_[i].frames = std::min(places_[i].frames + 1, kFramesToMeasure);
  }

  const auto draw_if_shown = [&](PanelId id, const char* name, const auto& content) {
    if (is_shown[index_of(id)]) draw_panel_at(id, name, content);
  };
  draw_if_shown(PanelId::kTexts, "wind", [&] { draw_texts(facts); });
  draw_if_shown(PanelId::kProfile, "profile", [&] { draw_profile(facts); });
  draw_if_shown(PanelId::kTrace, "trace", [&] { draw_wind_trace(*facts.wind_trace); });
  draw_if_shown(PanelId::kHelp, "help", [] { draw_help(); });
  draw_if_shown(PanelId::kValues, "values", [&] { draw_panel(*facts.panel); });
  draw_if_shown(PanelId::kNotice, "notice", [&] { draw_notice(facts.notice); });
  draw_if_shown(PanelId::kPause, "pause", [] { draw_pause(); });
}

}  // namespace yuragi::viewer::app
