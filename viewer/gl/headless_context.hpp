#pragma once

#include <memory>
#include <span>

#include "viewer/gl/driver.hpp"

namespace yuragi::viewer::gl {

struct HeadlessOptions {
  bool is_software = false;   ///< use the processor, even if there is graphics hardware
  bool has_messages = false;  ///< the driver checks more, for report_gl_errors(); slower on some
  std::span<const Version> versions = kVersionsToAskFor;  ///< to be requested in this order
};

/// A current OpenGL context that is_enough() and needs no display and no window: EGL without a surface, on the first
/// graphics device that has it (EGL_EXT_platform_device), or by Mesa on any device, finally the processor
/// (EGL_MESA_platform_surfaceless). What is drawn goes into a RenderTarget; there is no framebuffer 0. Stays current on
/// the thread that made it until it ends there. Throws std::runtime_error if no driver can do this; its text, without a
/// full stop at the end, names the driver and helps a person (too_old_text()).
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
