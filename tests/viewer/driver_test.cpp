#include "viewer/gl/driver.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::viewer::gl {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(DriverTest, GivesEachContextAGlslThatItKnows) {
  EXPECT_EQ(glsl_version_line(31), "#version 140");
  EXPECT_EQ(glsl_version_line(32), "#version 140");
  EXPECT_EQ(glsl_version_line(33), "#version 330 core");
  EXPECT_EQ(glsl_version_line(46), "#version 330 core");
  EXPECT_EQ(glsl_version_line(30, true), "#version 300 es");
  EXPECT_EQ(glsl_version_line(32, true), "#version 300 es");
}

TEST(DriverTest, AsksForTheNewestFirstAndForACoreContextWhereThereIsSuchAThing) {
  EXPECT_TRUE(std::ranges::is_sorted(kVersionsToAskFor, std::ranges::greater{}, &Version::number));
  EXPECT_TRUE((Version{3, 3}.is_core()));
  EXPECT_FALSE((Version{3, 1}.is_core()));
}

TEST(DriverTest, Opengl31IsEnoughWithTheExtensions) {
  EXPECT_TRUE(is_enough({.gl_version = 31}));
  EXPECT_TRUE(is_enough({.gl_version = 46}));
  EXPECT_FALSE(is_enough({.gl_version = 30}));
  EXPECT_FALSE(is_enough({.gl_version = 31, .missing_extensions = {"GL_ARB_shader_bit_encoding"}}));
}

TEST(DriverTest, OpenglEs30IsEnough) {
  EXPECT_TRUE(is_enough({.gl_version = 30, .is_es = true}));
  EXPECT_FALSE(is_enough({.gl_version = 20, .is_es = true}));
  EXPECT_THAT(too_old_text({.renderer = "A card", .gl_version = 20, .is_es = true}), HasSubstr("lacks OpenGL ES 3.0"));
}

TEST(DriverTest, OnARaspberryPi4OfDebian12ThereIsAVariable) {
  const Driver driver{.renderer = "V3D 4.2", .vendor = "Broadcom", .version = "2.1 Mesa 22.3.6", .gl_version = 21};
  EXPECT_THAT(too_old_text(driver),
              AllOf(StartsWith("the graphics driver \"V3D 4.2\" of Broadcom (2.1 Mesa 22.3.6) lacks OpenGL 3.1.\n"),
                    HasSubstr("\n    MESA_GL_VERSION_OVERRIDE=3.1 yuragi-viewer\n"), HasSubstr("newer Mesa")));
}

TEST(DriverTest, OnARaspberryPi5ItIsANewerMesa) {
  const Driver driver{.renderer = "V3D 7.1", .vendor = "Broadcom", .version = "2.1 Mesa 22.3.6", .gl_version = 21};
  EXPECT_THAT(too_old_text(driver),
              AllOf(HasSubstr("\"V3D 7.1\" of Broadcom (2.1 Mesa 22.3.6)"), HasSubstr("install a newer Mesa"),
                    HasSubstr("Raspberry Pi OS"), Not(HasSubstr("MESA_GL_VERSION_OVERRIDE"))));
}

TEST(DriverTest, WhereTheGraphicsCannotTheProcessorDraws) {
  const Driver driver{.renderer = "VC4 V3D 2.1", .vendor = "Broadcom", .version = "2.1 Mesa 22.3.6", .gl_version = 21};
  EXPECT_THAT(too_old_text(driver), AllOf(HasSubstr("Raspberry Pi 3"), HasSubstr("LIBGL_ALWAYS_SOFTWARE=1")));
}

TEST(DriverTest, NamesTheExtensionsThatAreMissing) {
  const Driver driver{.renderer = "A card",
                      .vendor = "A maker",
                      .version = "3.1.0 - Build 9.17",
                      .gl_version = 31,
                      .missing_extensions = {"GL_ARB_shader_bit_encoding", "GL_ARB_sampler_objects"}};
  EXPECT_THAT(too_old_text(driver),
              AllOf(StartsWith("the graphics driver \"A card\" of A maker (3.1.0 - Build 9.17) lacks "
                               "GL_ARB_shader_bit_encoding, GL_ARB_sampler_objects.\n"),
                    HasSubstr("Install a newer graphics driver"), HasSubstr("LIBGL_ALWAYS_SOFTWARE=1")));
}

}  // namespace
}  // namespace yuragi::viewer::gl
