#pragma once

#include <span>
#include <string_view>

/// The text of viewer/gl/shaders/*/*.glsl, which the build puts into the program.
namespace yuragi::viewer::gl::shaders {

extern const std::string_view kCommon;  ///< prepended to each of the others
extern const std::string_view kShadeFrag;
extern const std::string_view kBankVert;
extern const std::string_view kBankFrag;
extern const std::string_view kBannerFrag;
extern const std::string_view kBedVert;
extern const std::string_view kBedFrag;
extern const std::string_view kBarkVert;
extern const std::string_view kBarkFrag;
extern const std::string_view kBowlShadeVert;
extern const std::string_view kBowlShadeFrag;
extern const std::string_view kClothVert;
extern const std::string_view kCloudsFrag;
extern const std::string_view kContactVert;
extern const std::string_view kContactFrag;
extern const std::string_view kCrossFadeFrag;
extern const std::string_view kCurtainFrag;
extern const std::string_view kDimFrag;
extern const std::string_view kDoorVert;
extern const std::string_view kDoorFrag;
extern const std::string_view kEmbersVert;
extern const std::string_view kEmbersFrag;
extern const std::string_view kFireVert;
extern const std::string_view kFireFrag;
extern const std::string_view kFlagFrag;
extern const std::string_view kFlameVert;
extern const std::string_view kFlameFrag;
extern const std::string_view kFloorVert;
extern const std::string_view kFloorFrag;
extern const std::string_view kFloorShadeVert;
extern const std::string_view kGlowVert;
extern const std::string_view kGlowFrag;
extern const std::string_view kSwardVert;
extern const std::string_view kGrassVert;
extern const std::string_view kGroundVert;
extern const std::string_view kGroundFrag;
extern const std::string_view kHairVert;
extern const std::string_view kHillsVert;
extern const std::string_view kHillsFrag;
extern const std::string_view kHoleVert;
extern const std::string_view kHoleFrag;
extern const std::string_view kImpostorVert;
extern const std::string_view kImpostorFrag;
extern const std::string_view kImpostorLookFrag;
extern const std::string_view kLeafShadeVert;
extern const std::string_view kLeafVert;
extern const std::string_view kLimbVert;
extern const std::string_view kLimbFrag;
extern const std::string_view kPlainGroundFrag;
extern const std::string_view kPlainLeafVert;
extern const std::string_view kPlainWaterFrag;
extern const std::string_view kReedVert;
extern const std::string_view kSkinVert;
extern const std::string_view kSkinFrag;
extern const std::string_view kSkyVert;
extern const std::string_view kSkyFrag;
extern const std::string_view kSmallSkyFrag;
extern const std::string_view kSmoothEdgesFrag;
extern const std::string_view kSolidVert;
extern const std::string_view kSolidFrag;
extern const std::string_view kSparkVert;
extern const std::string_view kSparkFrag;
extern const std::string_view kTestCardFrag;
extern const std::string_view kWallFrag;
extern const std::string_view kWaterVert;
extern const std::string_view kWaterFrag;
extern const std::string_view kWideHeavensFrag;
extern const std::string_view kWideSkyVert;
extern const std::string_view kWideSkyFrag;

struct Shader {
  std::string_view file;
  std::string_view text;
};
/// All of them.
std::span<const Shader> all();

}  // namespace yuragi::viewer::gl::shaders
