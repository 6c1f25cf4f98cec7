#pragma once

#include <glm/vec3.hpp>

#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::meshes {

/// What the sun sees of a box, without perspective: the view that a shadow map of `texels` x `texels` is drawn with.
/// `to_sun` is a unit vector above the horizon.
View shadow_view(const Bounds& casters, const glm::vec3& to_sun, int texels);

/// Lets things that are drawn with `view` look up their shadows in the map that was drawn with `shadows`.
void add_shadows(View& view, const View& shadows, int texels);

/// The view whose shadows have no penumbra: one look at the map for each place.
View with_hard_shadows(View view);

}  // namespace yuragi::viewer::meshes
