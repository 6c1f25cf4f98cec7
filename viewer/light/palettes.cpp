#include "viewer/light/palettes.hpp"

#include <array>

#include <glm/vec3.hpp>

namespace yuragi::viewer::light {
namespace {

/// Reflectance of each thing in red, green and blue, 0 to 1 (linear; a screen's values are about the square root).
/// Chosen by eye.
struct Palette {
  glm::vec3 lush;   ///< grass in moist places,
  glm::vec3 fresh;  ///< in between,
  glm::vec3 straw;  ///< and in dry places,
  glm::vec3 foot;   ///< and of every blade near the ground
  float dryness;    ///< more straw above 0, less below it; -1 to 1
  float flowers;    ///< number of flowers: 1 as in a meadow
  std::array<glm::vec3, 3> petals;
  glm::vec3 leaves;   ///< factor for the leaves of trees, but not for blossom,
  glm::vec3 turned;   ///< and on those that have turned the farthest
  float hanging;      ///< the share of leaves that hang: 0 is a bare tree
  glm::vec3 woods;    ///< factor on the woods far away
  float snow;         ///< snow on hills and mountains, 0 to 1
  float colorful;     ///< saturation of the whole picture: 0 is black and white
  float exposure_ev;  ///< brighter by this many doublings
};

// In the order of look::Palette.
constexpr std::array<Palette, 6> kPalettes{{
    // meadow
    {.lush = {0.050F, 0.120F, 0.034F},
     .fresh = {0.120F, 0.190F, 0.040F},
     .straw = {0.330F, 0.260F, 0.105F},
     .foot = {0.030F, 0.060F, 0.012F},
     .dryness = 0.0F,
     .flowers = 1.0F,
     .petals = {{{0.72F, 0.70F, 0.62F}, {0.70F, 0.45F, 0.05F}, {0.34F, 0.14F, 0.42F}}},
     .leaves = {1.0F, 1.0F, 1.0F},
     .turned = {1.12F, 1.0F, 0.95F},
     .hanging = 1.0F,
     .woods = {1.0F, 1.0F, 1.0F},
     .snow = 0.0F,
     .colorful = 1.0F,
     .exposure_ev = 0.0F},
    // spring: young green, many white and yellow flowers
    {.lush = {0.065F, 0.160F, 0.032F},
     .fresh = {0.150F, 0.250F, 0.038F},
     .straw = {0.230F, 0.270F, 0.075F},
     .foot = {0.034F, 0.078F, 0.012F},
     .dryness = -0.25F,
     .flowers = 2.6F,
     .petals = {{{0.80F, 0.78F, 0.72F}, {0.80F, 0.60F, 0.04F}, {0.62F, 0.26F, 0.40F}}},
     .leaves = {1.25F, 1.30F, 0.85F},
     .turned = {1.40F, 1.30F, 0.85F},
     .hanging = 1.0F,
     .woods = {1.35F, 1.45F, 0.85F},
     .snow = 0.0F,
     .colorful = 1.0F,
     .exposure_ev = 0.0F},
    // summer-dry: gold, with green only in the hollows
    {.lush = {0.150F, 0.150F, 0.045F},
     .fresh = {0.310F, 0.250F, 0.090F},
     .straw = {0.520F, 0.390F, 0.165F},
     .foot = {0.080F, 0.062F, 0.022F},
     .dryness = 0.30F,
     .flowers = 0.35F,
     .petals = {{{0.62F, 0.55F, 0.40F}, {0.60F, 0.36F, 0.06F}, {0.26F, 0.20F, 0.44F}}},
     .leaves = {1.10F, 1.0F, 0.72F},
     .turned = {1.75F, 1.05F, 0.60F},
     .hanging = 1.0F,
     .woods = {1.55F, 1.15F, 0.75F},
     .snow = 0.0F,
     .colorful = 1.0F,
     .exposure_ev = 0.0F},
    // autumn: russet and ochre
    {.lush = {0.110F, 0.105F, 0.028F},
     .fresh = {0.260F, 0.160F, 0.040F},
     .straw = {0.420F, 0.235F, 0.080F},
     .foot = {0.055F, 0.038F, 0.013F},
     .dryness = 0.12F,
     .flowers = 0.3F,
     .petals = {{{0.50F, 0.38F, 0.36F}, {0.58F, 0.20F, 0.04F}, {0.36F, 0.10F, 0.22F}}},
     .leaves = {2.5F, 1.40F, 0.42F},
     .turned = {5.0F, 0.72F, 0.32F},
     .hanging = 0.75F,
     .woods = {3.6F, 1.45F, 0.75F},
     .snow = 0.0F,
     .colorful = 1.0F,
     .exposure_ev = 0.0F},
    // winter: pale stalks under frost
    {.lush = {0.330F, 0.345F, 0.340F},
     .fresh = {0.470F, 0.470F, 0.450F},
     .straw = {0.620F, 0.580F, 0.510F},
     .foot = {0.130F, 0.115F, 0.085F},
     .dryness = 0.05F,
     .flowers = 0.0F,
     .petals = {{{0.70F, 0.70F, 0.70F}, {0.70F, 0.70F, 0.70F}, {0.70F, 0.70F, 0.70F}}},
     .leaves = {2.2F, 1.35F, 1.3F},
     .turned = {2.2F, 1.35F, 1.3F},
     .hanging = 0.0F,
     .woods = {1.9F, 1.35F, 1.8F},
     .snow = 0.85F,
     .colorful = 0.85F,
     .exposure_ev = -0.35F},
    // ink: brush and paper
    {.lush = {0.060F, 0.060F, 0.060F},
     .fresh = {0.160F, 0.160F, 0.160F},
     .straw = {0.400F, 0.400F, 0.400F},
     .foot = {0.020F, 0.020F, 0.020F},
     .dryness = -0.05F,
     .flowers = 0.5F,
     .petals = {{{0.80F, 0.80F, 0.80F}, {0.70F, 0.70F, 0.70F}, {0.05F, 0.05F, 0.05F}}},
     .leaves = {0.7F, 0.7F, 0.7F},
     .turned = {0.7F, 0.7F, 0.7F},
     .hanging = 1.0F,
     .woods = {0.8F, 0.8F, 0.8F},
     .snow = 0.0F,
     .colorful = 0.06F,
     .exposure_ev = 0.7F},
}};

/// The material of the ground where no grass grows.
struct Earth {
  glm::vec3 color;
  float relief;  ///< how uneven it looks
  float growth;  ///< how tall grass may grow: 0.25 is a lawn, 1 the meadow
};

// In the order of look::GroundKind.
constexpr std::array<Earth, 5> kEarths{{{.color = {0.070F, 0.050F, 0.030F}, .relief = 0.5F, .growth = 1.0F},
                                        {.color = {0.070F, 0.050F, 0.030F}, .relief = 0.5F, .growth = 0.25F},
                                        {.color = {0.400F, 0.310F, 0.200F}, .relief = 0.90F, .growth = 0.0F},
                                        {.color = {0.230F, 0.220F, 0.205F}, .relief = 1.6F, .growth = 0.0F},
                                        {.color = {0.620F, 0.670F, 0.730F}, .relief = 0.35F, .growth = 0.0F}}};

}  // namespace

void set_colors(const look::Look& look, Light& light) {
  const Palette& palette = kPalettes.at(static_cast<std::size_t>(look.palette));
  light.grass_lush = {palette.lush, palette.dryness};
  light.grass_fresh = {palette.fresh, palette.flowers};
  light.grass_straw = {palette.straw, 0.0F};
  light.grass_foot = {palette.foot, static_cast<float>(1.0 / look.ground_image_width_m)};
  for (std::size_t i = 0; i < palette.petals.size(); ++i) light.petals.at(i) = {palette.petals.at(i), 0.0F};
  light.leaves = {palette.leaves, palette.hanging};
  light.turned_leaves = {palette.turned, 0.0F};
  light.woods = {palette.woods, palette.snow};
  const Earth& earth = kEarths.at(static_cast<std::size_t>(look.ground));
  light.earth = {earth.color, earth.relief};
  light.colors.x = palette.colorful;
  light.colors.z = earth.growth;
  light.colors.w = palette.exposure_ev;
}

}  // namespace yuragi::viewer::light
