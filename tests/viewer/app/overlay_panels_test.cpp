// The overlay's panels, drawn by ImGui without a window and without OpenGL.
#include "viewer/app/overlay_panels.hpp"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "viewer/app/overlay.hpp"
#include "viewer/app/panel.hpp"

namespace yuragi::viewer::app {
namespace {

constexpr unsigned kCombinations = 1U << kPanelCount;

/// The windows that ImGui draws in this frame.
std::vector<const ImGuiWindow*> seen_windows() {
  std::vector<const ImGuiWindow*> seen;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
    if (window->Active && !window->Hidden && !window->IsFallbackWindow) seen.push_back(window);
  }
  return seen;
}

class OverlayPanelsTest : public testing::Test {
 protected:
  OverlayPanelsTest() {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    wire::SensorStatus sensor;
    sensor.name = "the roof's east corner";
    sensor.driver = "gill";
    sensor.state_reason = "no message for 20 s: look at the cable, the power and the baud rate";
    sensors_.sensors.assign(2, sensor);
    for (int i = 0; i < 100; ++i) trace_.hear(i * WindTrace::kInterval_s, 3.0 + i % 5, 2.0);
    for (int i = 0; i < 12; ++i) passes_.emplace_back().name = "shadows of the trees";
    panel_.set_connected(true);
    const auto asked = panel_.next(0.0);
    wire::ParameterGroup group;
    wire::ParameterState haze;
    haze.name = "haze";
    haze.value = "0.2";
    group.parameters.assign(20, haze);
    panel_.take_reply({.done = true,
                       .message = {},
                       .scenes = {},
                       .parameters = wire::ParameterReport{.number = asked->parameters->number, .groups = {group}}});
  }
  ~OverlayPanelsTest() override { ImGui::DestroyContext(); }
  OverlayPanelsTest(const OverlayPanelsTest&) = delete;
  OverlayPanelsTest& operator=(const OverlayPanelsTest&) = delete;

  static void set_size(const PixelSize& size) {
    OverlayPanels::set_scale(overlay_scale(1.0, size, {}));
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->Build();
    io.DisplaySize = ImVec2(static_cast<float>(size.width_px), static_cast<float>(size.height_px));
  }

  /// A bit a PanelId.
  OverlayFacts facts_of(unsigned shown) {
    const auto has = [shown](PanelId id) { return (shown >> static_cast<unsigned>(id) & 1U) != 0; };
    OverlayFacts facts;
    facts.playback = stream::Playback::kLive;
    facts.stream = {.state = stream::State::kConnected, .text = "connected to 127.0.0.1:7410"};
    facts.sensors = &sensors_;
    facts.age = "the readings in the pictures are 0.2 s old at most";
    facts.has_texts = has(PanelId::kTexts);
    facts.has_help = has(PanelId::kHelp);
    facts.is_paused = has(PanelId::kPause);
    if (has(PanelId::kNotice)) facts.notice = kNotice;
    if (has(PanelId::kTrace)) facts.wind_trace = &trace_;
    if (has(PanelId::kProfile)) facts.passes = &passes_;
    facts.picture_times_ms = times_ms_;
    if (has(PanelId::kValues)) facts.panel = &panel_;
    return facts;
  }

  void draw(unsigned shown) {
    ImGui::NewFrame();
    panels_.draw(facts_of(shown));
    ImGui::Render();
  }

  static constexpr const char* kNotice =
      "no daemon replies at wall.local:7410: Connection refused\n"
      "Start `yuragi run` on this machine, or name another daemon with --connect HOST:PORT.";
  wire::Sensors sensors_;
  WindTrace trace_;
  std::vector<gl::PassClock::Pass> passes_;
  std::array<float, 240> times_ms_{};
  Panel panel_;
  OverlayPanels panels_;
};

TEST_F(OverlayPanelsTest, NeverOverlapAndStayInThePicture) {
  for (const auto& [width_px, height_px] :
       {std::pair{640, 360}, {360, 640}, {640, 480}, {1024, 600}, {1280, 720}, {1080, 1920}, {3840, 2160}}) {
    set_size({.width_px = width_px, .height_px = height_px});
    const ImRect picture(0.0F, 0.0F, static_cast<float>(width_px), static_cast<float>(height_px));
    for (unsigned i = 0; i < kCombinations; ++i) {
      const unsigned shown = i ^ (i >> 1U);  // from one to the next a single panel comes or goes
      SCOPED_TRACE(testing::Message() << width_px << " x " << height_px << ", panels " << shown);
      for (int frame = 0; frame < 3; ++frame) {
        draw(shown);
        const auto seen = seen_windows();
        for (std::size_t a = 0; a < seen.size(); ++a) {
          ASSERT_TRUE(picture.Contains(seen[a]->Rect())) << seen[a]->Name;
          for (std::size_t b = 0; b < a; ++b) {
            ASSERT_FALSE(seen[a]->Rect().Overlaps(seen[b]->Rect())) << seen[a]->Name << ", " << seen[b]->Name;
          }
        }
      }
      const auto seen = seen_windows();
      ASSERT_EQ(seen.size(), static_cast<std::size_t>(__builtin_popcount(shown)));
      for (const ImGuiWindow* window : seen) {
        EXPECT_GT(std::min(window->Size.x, window->Size.y), 2.0F * ImGui::GetFontSize()) << window->Name;
      }
    }
  }
}

TEST_F(OverlayPanelsTest, AreInTheirPlaceOnceTheyAreLaidOut) {
  set_size({.width_px = 1280, .height_px = 720});
  const unsigned help = 1U << static_cast<unsigned>(PanelId::kHelp);
  int frames = 0;
  for (; !panels_.is_laid_out(facts_of(help)); ++frames) draw(help);
  EXPECT_LE(frames, 2);
  draw(help);
  const ImGuiWindow* const window = ImGui::FindWindowByName("help");
  ASSERT_NE(window, nullptr);
  const ImVec2 size = window->Size;
  EXPECT_GT(size.x, 10.0F * ImGui::GetFontSize());
  for (int frame = 0; frame < 3; ++frame) draw(help);
  EXPECT_EQ(window->Size.x, size.x) << "and stay as they are";
  EXPECT_EQ(window->Size.y, size.y);
}

TEST_F(OverlayPanelsTest, TheNoticeIsWholeAndItsLettersAreLarge) {
  for (const auto& [width_px, height_px] : {std::pair{640, 360}, {360, 640}, {3840, 2160}}) {
    set_size({.width_px = width_px, .height_px = height_px});
    const unsigned notice = 1U << static_cast<unsigned>(PanelId::kNotice);
    for (const unsigned shown : {notice, kCombinations - 1U}) {
      for (int frame = 0; frame < 3; ++frame) draw(shown);
      const ImGuiWindow* const window = ImGui::FindWindowByName("notice");
      ASSERT_NE(window, nullptr);
      EXPECT_EQ(window->ScrollMax.x, 0.0F);
      EXPECT_EQ(window->ScrollMax.y, 0.0F);
      EXPECT_GE(window->CalcFontSize() / static_cast<float>(std::min(width_px, height_px)), 1.0F / 60.0F);
    }
  }
}

TEST_F(OverlayPanelsTest, OnlyWhatIsCutOrHasHandlesTakesTheMouse) {
  const auto takes_mouse = [this](unsigned shown) {
    for (int frame = 0; frame < 3; ++frame) {
      const auto seen = seen_windows();
      if (!seen.empty()) ImGui::GetIO().MousePos = seen.front()->Rect().GetCenter();
      draw(shown);
    }
    return ImGui::GetIO().WantCaptureMouse;
  };
  const unsigned help = 1U << static_cast<unsigned>(PanelId::kHelp);
  set_size({.width_px = 1280, .height_px = 720});
  EXPECT_FALSE(takes_mouse(help));
  set_size({.width_px = 640, .height_px = 240});
  EXPECT_TRUE(takes_mouse(help)) << "its last lines are reached by the wheel";
}

}  // namespace
}  // namespace yuragi::viewer::app
