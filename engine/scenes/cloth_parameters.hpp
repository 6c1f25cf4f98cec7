#pragma once

#include <string>

#include "engine/base/parameter.hpp"

namespace yuragi::scenes {

// The look of a cloth, for the viewer only: it does not change the motion.

inline const Parameter kClothColor = {
    .name = "color",
    .default_value = std::string(),
    .help = "of the cloth, \"#rrggbb\"; without color_2 it is plain",
    .left_out = "as the viewer paints it",
};
inline const Parameter kClothColor2 = {
    .name = "color_2",
    .default_value = std::string(),
    .help = "of its pattern, \"#rrggbb\"",
    .left_out = "as the viewer paints it",
};
inline const Parameter kClothImage = {
    .name = "image",
    .default_value = std::string(),
    .help =
        "a PNG or JPEG file that covers the cloth, from this file's folder on; larger pictures are scaled down to a "
        "million pixels, and clear parts show color, or white",
    .left_out = "none",
    .change = KeyChange::kTakesReload,
};

}  // namespace yuragi::scenes
