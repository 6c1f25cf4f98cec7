#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace yuragi::viewer::gl {

/// A version of OpenGL, as one asks for a context of it. "Core": without what OpenGL 3.1 removed; only from 3.2 on.
struct Version {
  int major = 0;
  int minor = 0;
  constexpr bool is_core() const { return number() >= 32; }
  constexpr int number() const { return 10 * major + minor; }
  friend bool operator==(const Version&, const Version&) = default;
};

/// To be asked for in this order. A driver answers with the newest version that has everything of the one asked for, so
/// that a driver of 4.6 gives that. 3.1 is what Mesa's driver of the Raspberry Pi 4 and 5 has.
inline constexpr std::array<Version, 2> kVersionsToAskFor{Version{3, 3}, Version{3, 1}};

/// What shaders and renderers use of newer versions than 3.1: an older context must have it as an extension. Whatever
/// else is newer is asked for where it is used (tests/viewer/gl_names.py).
struct NeededExtension {
  std::string_view name;
  int part_of;  ///< Version::number() of the first version that has it without
};
inline constexpr std::array kNeededExtensions{
    NeededExtension{"GL_ARB_explicit_attrib_location", 33}, NeededExtension{"GL_ARB_shader_bit_encoding", 33},
    NeededExtension{"GL_ARB_draw_elements_base_vertex", 32}, NeededExtension{"GL_ARB_instanced_arrays", 33},
    NeededExtension{"GL_ARB_sampler_objects", 33}};

/// A driver as it describes itself.
struct Driver {
  std::string renderer = {};                              ///< GL_RENDERER: "V3D 4.2"
  std::string vendor = {};                                ///< GL_VENDOR: "Broadcom"
  std::string version = {};                               ///< GL_VERSION: "2.1 Mesa 22.3.6"
  int gl_version = 0;                                     ///< Version::number() of the context
  std::vector<std::string_view> missing_extensions = {};  ///< of kNeededExtensions
};

/// That of the current context. Any version.
Driver current_driver();

/// Can the viewer draw with it?
bool is_enough(const Driver& driver);

/// For a person whose driver is not enough: what it is, what is missing, and what to do, in whole sentences.
std::string too_old_text(const Driver& driver);

/// The first line of each shader, without its end: that of the newest GLSL that a context of this version and the
/// shaders both know. What GLSL 1.40 needs besides, common.glsl asks for.
std::string_view glsl_version_line(int gl_version);
/// The same for the current context.
std::string_view glsl_version_line();

}  // namespace yuragi::viewer::gl
