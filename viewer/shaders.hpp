#pragma once

#include <string_view>

/// The text of viewer/shaders/*.glsl, which the build puts into the program.
namespace yuragi::shaders {

extern const std::string_view kCommon;  ///< in front of each of the others
extern const std::string_view kGrassVert;
extern const std::string_view kGrassFrag;
extern const std::string_view kGroundVert;
extern const std::string_view kGroundFrag;
extern const std::string_view kHillsVert;
extern const std::string_view kHillsFrag;
extern const std::string_view kSkyVert;
extern const std::string_view kSkyFrag;

}  // namespace yuragi::shaders
