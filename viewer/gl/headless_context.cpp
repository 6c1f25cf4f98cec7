#include "viewer/gl/headless_context.hpp"

#include <array>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <epoxy/egl.h>

namespace yuragi::viewer::gl {
namespace {

constexpr EGLint kMostDevices = 16;

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
    std::array<EGLDeviceEXT, kMostDevices> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(kMostDevices, devices.data(), &count) != EGL_TRUE) count = 0;
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

  /// Makes a context on this display current. Returns whether that was possible.
  bool begin(EGLDisplay on, const HeadlessOptions& options) {
    if (on == EGL_NO_DISPLAY || eglInitialize(on, nullptr, nullptr) != EGL_TRUE) return false;
    display = on;
    if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) return false;
    constexpr std::array<EGLint, 5> kConfig{EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                            EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE ||
        eglChooseConfig(display, kConfig.data(), &config, 1, &count) != EGL_TRUE || count == 0) {
      return false;
    }
    const std::array<EGLint, 11> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                            3,
                                            EGL_CONTEXT_MINOR_VERSION,
                                            3,
                                            EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                            EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE,
                                            EGL_TRUE,
                                            EGL_CONTEXT_OPENGL_DEBUG,
                                            options.has_messages ? EGL_TRUE : EGL_FALSE,
                                            EGL_NONE};
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
    return context != EGL_NO_CONTEXT && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE;
  }

  void end() {
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
    context = EGL_NO_CONTEXT;
    display = EGL_NO_DISPLAY;
  }
};

HeadlessContext::HeadlessContext(HeadlessOptions options) : state_(std::make_unique<State>()) {
  for (const EGLDisplay display : displays(options)) {
    if (state_->begin(display, options)) return;
    state_->end();
  }
  throw std::runtime_error("no graphics driver of this machine has OpenGL 3.3 without a display (EGL)");
}

HeadlessContext::~HeadlessContext() {
  state_->end();
}

}  // namespace yuragi::viewer::gl
