#pragma once

#include <glm/vec3.hpp>

#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::meshes {

/// The sun's view of a box, without perspective: the view for drawing a shadow map of `texels` x `texels`. `to_sun` is
/// a unit vector above the horizon.
View shadow_view(const Bounds& casters, const glm::vec3& to_sun, int texels);

/// Makes things drawn with `view` receive shadows from the map that was drawn with `shadows`.
void add_shadows(View& view, const View& shadows, int texels);

/// The view without penumbras: one lookup per place.
View with_hard_shadows(View view);

}  // namespace yuragi::viewer::meshes
