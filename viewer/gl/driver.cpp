#include "viewer/gl/driver.hpp"

#include <epoxy/gl.h>

namespace yuragi::viewer::gl {
namespace {

constexpr int kOldest = kVersionsToAskFor.back().number();
constexpr int kOldestEs = kVersionsOfBrowsers.back().number();

int oldest_of(const Driver& driver) {
  return driver.is_es ? kOldestEs : kOldest;
}

std::string text_of(GLenum name) {
  const auto* const text = reinterpret_cast<const char*>(glGetString(name));
  return text != nullptr ? text : "";
}

/// Returns what is wrong with the driver, as the end of a sentence.
std::string complaint_of(const Driver& driver) {
  if (is_enough(driver)) return "refuses each version of OpenGL that was asked for";
  if (driver.gl_version < oldest_of(driver)) return driver.is_es ? "lacks OpenGL ES 3.0" : "lacks OpenGL 3.1";
  std::string text = "lacks ";
  for (const std::string_view name : driver.missing_extensions) text.append(name).append(", ");
  return text.substr(0, text.size() - 2);
}

/// Returns advice, for drivers of 2026.
std::string remedy_text(const Driver& driver) {
  constexpr std::string_view kByProcessor =
      "To draw by the processor instead, which is slow:\n"
      "    LIBGL_ALWAYS_SOFTWARE=1 yuragi-viewer";
  constexpr std::string_view kNewerMesa =
      "install a newer Mesa, for example by a system upgrade to Debian 13, by the current Raspberry Pi OS, or from "
      "Debian 12's backports (libgl1-mesa-dri and libegl-mesa0).";
  const std::string_view renderer = driver.renderer;
  // Mesa 22.3 (Debian 12) reports OpenGL 2.1 for V3D, though it has what this program uses of 3.1; newer ones report
  // 3.1.
  if (renderer.starts_with("V3D 4")) {
    return "On a Raspberry Pi 4, start the viewer so:\n"
           "    MESA_GL_VERSION_OVERRIDE=3.1 yuragi-viewer\n"
           "or " +
           std::string(kNewerMesa);
  }
  if (renderer.starts_with("V3D")) return "On a Raspberry Pi 5, " + std::string(kNewerMesa);
  if (renderer.starts_with("VC4")) {
    return "The graphics of a Raspberry Pi 3 and older have no OpenGL 3.1. " + std::string(kByProcessor);
  }
  return "Install a newer graphics driver. " + std::string(kByProcessor);
}

}  // namespace

Driver current_driver() {
  Driver driver{.renderer = text_of(GL_RENDERER),
                .vendor = text_of(GL_VENDOR),
                .version = text_of(GL_VERSION),
                .gl_version = epoxy_gl_version(),
                .is_es = !epoxy_is_desktop_gl()};
  if (driver.is_es) return driver;  // 3.0 has them all
  for (const NeededExtension& extension : kNeededExtensions) {
    if (driver.gl_version < extension.part_of && !epoxy_has_gl_extension(extension.name.data())) {
      driver.missing_extensions.push_back(extension.name);
    }
  }
  return driver;
}

bool is_enough(const Driver& driver) {
  return driver.gl_version >= oldest_of(driver) && driver.missing_extensions.empty();
}

std::string too_old_text(const Driver& driver) {
  return "the graphics driver \"" + driver.renderer + "\" of " + driver.vendor + " (" + driver.version + ") " +
         complaint_of(driver) + ".\n" + remedy_text(driver);
}

std::string_view glsl_version_line(int gl_version, bool is_es) {
  if (is_es) return "#version 300 es";
  return gl_version >= 33 ? "#version 330 core" : "#version 140";
}
std::string_view glsl_version_line() {
  return glsl_version_line(epoxy_gl_version(), !epoxy_is_desktop_gl());
}

}  // namespace yuragi::viewer::gl
