#pragma once

#include "engine/pose/strand_kinematics.hpp"
#include "viewer/blades.hpp"
#include "viewer/gl.hpp"
#include "viewer/view.hpp"

namespace yuragi {

/// Draws strands as a meadow of lit blades. Owns its GPU objects; needs a current context. Thread-safe: no.
class GrassLook {
 public:
  /// `skeleton` must outlive this.
  explicit GrassLook(const StrandSkeleton& skeleton);

  /// The pose has the skeleton's layout; the View is bound (ViewBuffer::set).
  void draw(const StrandPose& pose, const View& view);

 private:
  const StrandSkeleton* skeleton_;
  BladeSorter sorter_;
  JointPositions joints_;
  GlProgram program_;
  GLint rings_place_ = -1;
  GlBuffer joint_buffer_;
  GlTexture joint_texture_;
  GlBuffer blade_buffer_;
  GlVertexArray blade_array_;
};

}  // namespace yuragi
