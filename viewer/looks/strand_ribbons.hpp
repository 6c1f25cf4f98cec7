#pragma once

#include "engine/pose/strand_kinematics.hpp"
#include "viewer/gl/gl.hpp"
#include "viewer/meshes/blades.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi {

/// Strands on the GPU, each a ribbon along its joints, with more vertices the larger it is in the picture. Needs a
/// current context.
///
/// A shader finds an instance's Blade in the attributes 0 to 2, the joints in the sampler `joints` (unit 0, see
/// shaders/common.glsl), and the uniforms `links` and `rings`.
class StrandRibbons {
 public:
  /// `strands` must outlive this.
  StrandRibbons(const StrandSkeleton& strands, BladeStyle style);

  /// Computes and uploads the joints of this pose.
  void move_to(const StrandPose& pose);
  /// Draws what is in view, near ones first, with `program`.
  void draw(const GlProgram& program, const View& view);
  /// Draws `corners` vertices, as a fan, for each strand in view of the last draw().
  void draw_fans(const GlProgram& program, GLsizei corners);

 private:
  const StrandSkeleton* strands_;
  BladeSorter sorter_;
  JointPositions joints_;
  GlBuffer joint_buffer_;
  GlTexture joint_texture_;
  GlBuffer blade_buffer_;
  GlVertexArray blade_array_;
};

}  // namespace yuragi
