#pragma once

#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "engine/output/output.hpp"

namespace yuragi::viewer::wall {

// Maps places on a monitor to places in the picture. Places are parts of width and height, x to the right, y down.
// Pure, without a GPU.

/// The projective map from the unit square to a convex quadrilateral: its corners go to `corners`, and straight lines
/// stay straight. (P. Heckbert, "Fundamentals of Texture Mapping and Image Warping", 1989, section 2.2.3.)
glm::dmat3 square_to(const output::Corners& corners);

/// Maps a place on the monitor to one in the window's crop, both from 0 to 1: undoes the rotation and the corners.
/// Homogeneous; the third coordinate is positive wherever the picture is visible.
glm::dmat3 monitor_to_crop(const output::Window& window);

/// A homogeneous map, applied.
glm::dvec2 mapped(const glm::dmat3& map, const glm::dvec2& place);

/// The blend's widths as parts of the window's crop.
output::Sides blend_of_crop(const output::Window& window);

/// The size of a picture with at least one pixel for each pixel of the finest window. `monitors`: the size of each
/// window's monitor, empty (0) if it is not connected.
output::Size picture_size(const output::Output& output, std::span<const output::Size> monitors);

}  // namespace yuragi::viewer::wall
