#include "viewer/app/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "viewer/gl/driver.hpp"

namespace yuragi::viewer::app {

double overlay_scale(double content_scale, const PixelSize& picture, std::optional<double> asked) {
  if (asked) return *asked;
  constexpr double kUsualSide_px = 1080.0;
  const double quarters = std::floor(4.0 * std::min(picture.width_px, picture.height_px) / kUsualSide_px);
  return std::max(content_scale, quarters / 4.0);
}

Overlay::Overlay(GLFWwindow* window) : has_window_(window != nullptr) {
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // no settings file on disk
  if (has_window_) ImGui_ImplGlfw_InitForOpenGL(window, true);
  ImGui_ImplOpenGL3_Init(std::string(gl::glsl_version_line()).c_str());
}

void Overlay::set_scale(double scale) {
  if (scale == scale_) return;
  scale_ = scale;
  ImGui_ImplOpenGL3_DestroyDeviceObjects();  // also deletes the font's texture, which is made again
  OverlayPanels::set_scale(scale);
}

Overlay::~Overlay() {
  ImGui_ImplOpenGL3_Shutdown();
  if (has_window_) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

bool Overlay::takes_mouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}
bool Overlay::takes_keys() const {
  return ImGui::GetIO().WantCaptureKeyboard;
}

void Overlay::draw(const PixelSize& size, double scale, const OverlayFacts& facts) {
  set_scale(scale);
  ImGui_ImplOpenGL3_NewFrame();
  if (has_window_) {
    ImGui_ImplGlfw_NewFrame();
  }
  // The picture of a wall has not the size of the window that has the keyboard.
  ImGuiIO& io = ImGui::GetIO();
  const ImVec2 picture(static_cast<float>(size.width_px), static_cast<float>(size.height_px));
  const ImVec2 window(io.DisplaySize.x * io.DisplayFramebufferScale.x, io.DisplaySize.y * io.DisplayFramebufferScale.y);
  if (!has_window_ || std::lround(window.x) != size.width_px || std::lround(window.y) != size.height_px) {
    io.DisplaySize = picture;
    io.DisplayFramebufferScale = ImVec2(1.0F, 1.0F);
  }
  // A panel is placed only after its size is known: so a single picture, and the first of a film, is drawn again until
  // it is.
  while (!panels_.is_laid_out(facts)) {
    ImGui::NewFrame();
    panels_.draw(facts);
    ImGui::EndFrame();
  }
  ImGui::NewFrame();
  panels_.draw(facts);
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace yuragi::viewer::app
