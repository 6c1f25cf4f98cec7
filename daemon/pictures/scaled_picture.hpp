#pragma once

#include "engine/look/cloth_look.hpp"

namespace yuragi::daemon::pictures {

/// The picture, with as many pixels as a stream has room for (Image::kMaxPixels, Image::kMaxSide_px): each is the
/// mean light of those that fall into it. One that has room is not changed.
look::Image scaled_down(look::Image picture);

}  // namespace yuragi::daemon::pictures
