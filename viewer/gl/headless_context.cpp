#include "viewer/gl/headless_context.hpp"

#include <array>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <epoxy/egl.h>

namespace yuragi::viewer::gl {
namespace {

constexpr EGLint kMaxDevices = 16;

bool is_software(EGLDeviceEXT device) {
  const char* const extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
  return extensions != nullptr &&
         std::string_view(extensions).find("EGL_MESA_device_software") != std::string_view::npos;
}

/// The displays to try, in this order. They are not initialised.
std::vector<EGLDisplay> displays(const HeadlessOptions& options) {
  std::vector<EGLDisplay> found;
  std::vector<EGLDisplay> of_processor;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
      epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
    std::array<EGLDeviceEXT, kMaxDevices> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(kMaxDevices, devices.data(), &count) != EGL_TRUE) count = 0;
    for (EGLint i = 0; i < count; ++i) {
      const EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
      const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
      (is_software(device) ? of_processor : found).push_back(display);
    }
  }
  if (options.is_software) found.clear();
  if (!options.is_software && epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  }
  found.insert(found.end(), of_processor.begin(), of_processor.end());
  return found;
}

}  // namespace

struct HeadlessContext::State {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;

  /// Makes a sufficient context on this display current. Returns whether that was possible; if not, `too_old` is the
  /// driver, if there is one.
  bool begin(EGLDisplay on, const HeadlessOptions& options, std::optional<Driver>& too_old) {
    if (on == EGL_NO_DISPLAY || eglInitialize(on, nullptr, nullptr) != EGL_TRUE) return false;
    display = on;
    if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) return false;
    for (const Version& version : options.versions) {
      if (!make_current(version.is_es, attributes_of(version, options))) continue;
      if (is_enough(current_driver())) return true;
      drop_context();
    }
    // Of any version, to learn its driver.
    if (make_current(false, {EGL_NONE})) too_old = current_driver();
    return false;
  }

  /// Returns what a context draws with; nullopt if there is nothing for this kind.
  std::optional<EGLConfig> config_of(bool is_es) const {
    const std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE,
                                       is_es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglBindAPI(is_es ? EGL_OPENGL_ES_API : EGL_OPENGL_API) != EGL_TRUE ||
        eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE || count == 0) {
      return std::nullopt;
    }
    return config;
  }

  static std::vector<EGLint> attributes_of(const Version& version, const HeadlessOptions& options) {
    std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION, version.major,
                                   EGL_CONTEXT_MINOR_VERSION, version.minor,
                                   EGL_CONTEXT_OPENGL_DEBUG,  options.has_messages ? EGL_TRUE : EGL_FALSE};
    if (!version.is_es) attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE, EGL_TRUE});
    if (version.is_core()) {
      attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT});
    }
    attributes.push_back(EGL_NONE);
    return attributes;
  }

  bool make_current(bool is_es, const std::vector<EGLint>& attributes) {
    const std::optional<EGLConfig> config = config_of(is_es);
    if (!config) return false;
    context = eglCreateContext(display, *config, EGL_NO_CONTEXT, attributes.data());
    if (context == EGL_NO_CONTEXT) return false;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) return true;
    drop_context();
    return false;
  }

  void drop_context() {
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    context = EGL_NO_CONTEXT;
  }

  void end() {
    if (display == EGL_NO_DISPLAY) return;
    drop_context();
    eglTerminate(display);
    display = EGL_NO_DISPLAY;
  }
};

HeadlessContext::HeadlessContext(HeadlessOptions options) : state_(std::make_unique<State>()) {
  std::optional<Driver> too_old;  // of the first display that has one, which is the graphics hardware's
  for (const EGLDisplay display : displays(options)) {
    std::optional<Driver> driver;
    if (state_->begin(display, options, driver)) return;
    state_->end();
    if (!too_old) too_old = driver;
  }
  if (too_old) throw std::runtime_error(too_old_text(*too_old));
  throw std::runtime_error(
      "this machine has no graphics driver that draws without a display (EGL).\nMesa's drivers, which can draw by the "
      "processor, are in the packages libegl-mesa0 and libgl1-mesa-dri.");
}

HeadlessContext::~HeadlessContext() {
  state_->end();
}

}  // namespace yuragi::viewer::gl
