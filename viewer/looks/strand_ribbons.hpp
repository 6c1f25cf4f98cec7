#pragma once

#include <vector>

#include "engine/pose/strand_kinematics.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/gl/strip_indices.hpp"
#include "viewer/gl/texel_buffer.hpp"
#include "viewer/meshes/blades.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::looks {

/// Strands on the GPU, each a ribbon along its joints, with more vertices the larger it is in the picture. Needs a
/// current context.
///
/// A shader finds the Blades in the sampler `blades` (kStripsUnit), the joints in the sampler `joints` (unit 0, see
/// shaders/picture/common.glsl), and the uniforms `links`, `rings`, `copies` and `first_corner`: strip i (StripIndices)
/// is ribbon i % copies of Blade i / copies.
class StrandRibbons {
 public:
  /// `strands` must outlive this. Each is drawn as `copies` ribbons.
  StrandRibbons(const pose::StrandSkeleton& strands, GLint copies);

  /// Computes and uploads the joints of this pose.
  void move_to(const pose::StrandPose& pose);
  /// Of that pose.
  const pose::JointPositions& joints() const { return joints_; }
  /// meshes::Partings', of that pose.
  void set_openings(std::span<const float> openings) { sorter_.set_openings(openings); }
  /// Draws the visible ones, near ones first, with `program`.
  void draw(const gl::Program& program, const meshes::View& view);

 private:
  const pose::StrandSkeleton* strands_;
  GLint copies_;
  meshes::BladeSorter sorter_;
  pose::JointPositions joints_;
  gl::TexelBuffer joints_on_gpu_{GL_R32F};
  gl::TexelBuffer blades_on_gpu_{GL_RGBA32F};
  std::vector<meshes::Blade> blades_;  // of all levels, one behind the other
  gl::StripIndices strips_;
};

}  // namespace yuragi::viewer::looks
