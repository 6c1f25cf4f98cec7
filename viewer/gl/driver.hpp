#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace yuragi::viewer::gl {

/// A version of OpenGL, or of OpenGL ES, to request a context. "Core": without what OpenGL 3.1 removed; only from 3.2
/// on.
struct Version {
  int major = 0;
  int minor = 0;
  bool is_es = false;
  constexpr bool is_core() const { return !is_es && number() >= 32; }
  constexpr int number() const { return 10 * major + minor; }
  friend bool operator==(const Version&, const Version&) = default;
};

/// Requested in this order. A driver returns the newest version that is compatible with the requested one, so a driver
/// of 4.6 returns 4.6. 3.1 is what Mesa's driver of the Raspberry Pi 4 and 5 has.
inline constexpr std::array<Version, 2> kVersionsToAskFor{Version{3, 3}, Version{3, 1}};
/// What browsers have as WebGL 2. Tests draw with it.
inline constexpr std::array<Version, 1> kVersionsOfBrowsers{Version{3, 0, true}};

/// Features newer than OpenGL 3.1 that shaders and renderers use: an older context must have the extension. Other newer
/// features are checked at their use (tests/viewer/gl_names.py).
struct NeededExtension {
  std::string_view name;
  int part_of;  ///< Version::number() of the first version that has it without
};
inline constexpr std::array kNeededExtensions{
    NeededExtension{"GL_ARB_explicit_attrib_location", 33}, NeededExtension{"GL_ARB_shader_bit_encoding", 33},
    NeededExtension{"GL_ARB_instanced_arrays", 33}, NeededExtension{"GL_ARB_sampler_objects", 33}};

/// A driver's own description.
struct Driver {
  std::string renderer = {};                              ///< GL_RENDERER: "V3D 4.2"
  std::string vendor = {};                                ///< GL_VENDOR: "Broadcom"
  std::string version = {};                               ///< GL_VERSION: "2.1 Mesa 22.3.6"
  int gl_version = 0;                                     ///< Version::number() of the context
  bool is_es = false;                                     ///< OpenGL ES
  std::vector<std::string_view> missing_extensions = {};  ///< of kNeededExtensions
};

/// Returns that of the current context, of any version.
Driver current_driver();

/// Can the viewer draw with it?
bool is_enough(const Driver& driver);

/// For a person whose driver is too old: its description, what is missing, and what to do, in whole sentences.
std::string too_old_text(const Driver& driver);

/// The first line of each shader, without its end: the newest GLSL version that both this context and the shaders
/// support. common.glsl requests the extensions that GLSL 1.40 needs, and has the precisions of GLSL ES.
std::string_view glsl_version_line(int gl_version, bool is_es = false);
/// The same for the current context.
std::string_view glsl_version_line();

}  // namespace yuragi::viewer::gl
