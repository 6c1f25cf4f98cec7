// Every shader through the driver's compiler; what a program's stages say to each other is checked where the pictures
// are drawn, and by glslangValidator (valid_shaders.py).

#include <array>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "viewer/gl/driver.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::gl {
namespace {

/// What compiling and linking complains of; empty: nothing.
std::string complaint_of(std::string_view vertex, std::string_view fragment) {
  try {
    link_program("a test", vertex, fragment);
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

/// Compiles each shader in the current context.
void compile_each() {
  constexpr std::string_view kPlainVertex = "void main() { gl_Position = to_clip * vec4(0.0, 0.0, 0.0, 1.0); }";
  for (const shaders::Shader& shader : shaders::all()) {
    if (shader.text == shaders::kCommon) continue;  // in front of each
    const bool is_vertex = shader.file.find(".vert.") != std::string_view::npos;
    const std::string complaint =
        is_vertex ? complaint_of(shader.text, "void main() {}") : complaint_of(kPlainVertex, shader.text);
    // A fragment shader alone misses what the vertex shader gives it: linking is not the matter here.
    EXPECT_THAT(complaint, testing::Not(testing::HasSubstr("cannot compile")));
  }
}

TEST(ShaderTest, EachCompiles) {
  const HeadlessContext context({.is_software = true, .has_messages = true});
  compile_each();
}

TEST(ShaderTest, EachCompilesAsABrowsers) {
  const HeadlessContext context({.is_software = true, .has_messages = true, .versions = kVersionsOfBrowsers});
  ASSERT_TRUE(current_driver().is_es) << current_driver().version;
  EXPECT_EQ(glsl_version_line(), "#version 300 es");
  compile_each();
}

TEST(HeadlessContextTest, TakesTheFirstVersionThatTheDriverHas) {
  constexpr std::array kVersions{Version{9, 9}, Version{3, 3}};
  const HeadlessContext context({.is_software = true, .versions = kVersions});
  EXPECT_TRUE(is_enough(current_driver())) << current_driver().version;
}

TEST(HeadlessContextTest, NamesTheDriverWhereThereIsNoneOfThem) {
  constexpr std::array kVersions{Version{9, 9}};
  try {
    const HeadlessContext context({.is_software = true, .versions = kVersions});
    FAIL() << "a context of " << current_driver().version;
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::ContainsRegex("graphics driver \"llvmpipe.*refuses each version"));
  }
}

TEST(ShaderTest, AnErrorIsToldWithItsProgramAndLine) {
  const HeadlessContext context({.is_software = true, .has_messages = true});
  const std::string complaint = complaint_of("void main() {\n  nonsense;\n}", "void main() {}");
  EXPECT_THAT(complaint, testing::AllOf(testing::HasSubstr("a test.vert"), testing::HasSubstr(":2(")));
}

TEST(ShaderTest, WhatDoesNotFitTogetherDoesNotLink) {
  const HeadlessContext context({.is_software = true, .has_messages = true});
  EXPECT_THAT(complaint_of("out vec2 given; void main() { given = vec2(0.5); gl_Position = vec4(0.0); }",
                           "in vec3 given; out vec4 color; void main() { color = given.xyzx; }"),
              testing::HasSubstr("cannot link the program a test"));
}

}  // namespace
}  // namespace yuragi::viewer::gl
