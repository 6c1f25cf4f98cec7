#pragma once

#include <memory>

namespace yuragi::viewer::gl {

struct HeadlessOptions {
  bool is_software = false;   ///< drawn by the processor, even where there is graphics hardware
  bool has_messages = false;  ///< the driver checks more, for report_gl_errors(); slower on some
};

/// A current OpenGL 3.3 core context that needs no display and has no window: EGL without a surface, on the first
/// graphics device that has it (EGL_EXT_platform_device), or by Mesa on whatever there is, the processor at last
/// (EGL_MESA_platform_surfaceless). What is drawn goes into a RenderTarget; there is no framebuffer 0. Stays current
/// on the thread that made it until it ends there. Throws std::runtime_error where no driver can do this.
class HeadlessContext {
 public:
  explicit HeadlessContext(HeadlessOptions options = {});
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace yuragi::viewer::gl
