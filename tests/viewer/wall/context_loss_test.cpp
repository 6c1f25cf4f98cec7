#include <memory>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "viewer/gl/gl.hpp"
#include "viewer/gl/headless_context.hpp"

namespace yuragi::viewer::gl {
namespace {

TEST(ContextLoss, IsNoticed) {
  const HeadlessContext context({.is_software = true});
  EXPECT_FALSE(is_context_lost());
  // The driver's answer, in place of a graphics card that has been reset.
  const auto driver = epoxy_glGetGraphicsResetStatus;
  epoxy_glGetGraphicsResetStatus = []() -> GLenum { return GL_INNOCENT_CONTEXT_RESET; };
  EXPECT_TRUE(is_context_lost());
  epoxy_glGetGraphicsResetStatus = driver;
  EXPECT_FALSE(is_context_lost());
}

}  // namespace
}  // namespace yuragi::viewer::gl
