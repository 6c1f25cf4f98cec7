#include "engine/pose/point_kinematics.hpp"

namespace yuragi::pose {
namespace {

/// Points that have been moved along their normals, with their rows.
void move_rows(const SurfaceSkeleton& surface, const SurfacePose& pose, PointPositions& points) noexcept {
  float* x_m = points.data().data();
  float* y_m = x_m + points.size();
  float* z_m = y_m + points.size();
  for (std::size_t row = 0; row < surface.rows; ++row) {
    const float axis_x_m = surface.axis_x_m[row];
    const float axis_z_m = surface.axis_z_m[row];
    const float slope_east = pose.row_slope_east[row];
    const float slope_south = pose.row_slope_south[row];
    const float east_m = pose.row_east_m[row];
    const float south_m = pose.row_south_m[row];
    const float drop_m = pose.row_drop_m[row];
    for (std::size_t i = row * surface.columns; i < (row + 1) * surface.columns; ++i) {
      y_m[i] -= slope_east * (x_m[i] - axis_x_m) + slope_south * (z_m[i] - axis_z_m) + drop_m;
      x_m[i] += east_m;
      z_m[i] += south_m;
    }
  }
}

}  // namespace

GridKinematicsJob::Problem GridKinematicsJob::validate() const noexcept {
  if (skeleton == nullptr || pose == nullptr || points == nullptr) return Problem::kMissingPart;
  const std::size_t count = skeleton->rows * skeleton->stride();
  for (const auto* array : {&skeleton->rest_x_m, &skeleton->rest_y_m, &skeleton->rest_z_m}) {
    if (array->size() != count) return Problem::kSkeletonSize;
  }
  for (const auto* array : {&pose->offset_x_m, &pose->offset_y_m, &pose->offset_z_m}) {
    if (array->size() != count) return Problem::kPoseSize;
  }
  return points->size() == count ? Problem::kNone : Problem::kPointsSize;
}

GridKinematicsJob::Problem GridKinematicsJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  float* __restrict out = points->data().data();
  const auto add = [&out, count = points->size()](const float* rest_m, const float* offset_m) {
    for (std::size_t i = 0; i < count; ++i) out[i] = rest_m[i] + offset_m[i];
    out += count;
  };
  add(skeleton->rest_x_m.data(), pose->offset_x_m.data());
  add(skeleton->rest_y_m.data(), pose->offset_y_m.data());
  add(skeleton->rest_z_m.data(), pose->offset_z_m.data());
  return Problem::kNone;
}

SurfaceKinematicsJob::Problem SurfaceKinematicsJob::validate() const noexcept {
  if (skeleton == nullptr || pose == nullptr || points == nullptr) return Problem::kMissingPart;
  const std::size_t count = skeleton->rows * skeleton->columns;
  for (const auto* array : {&skeleton->rest_x_m, &skeleton->rest_y_m, &skeleton->rest_z_m, &skeleton->normal_x,
                            &skeleton->normal_y, &skeleton->normal_z}) {
    if (array->size() != count) return Problem::kSkeletonSize;
  }
  if (pose->displacement_m.size() != count) return Problem::kPoseSize;
  const std::size_t moved_rows = skeleton->moves_rows() ? skeleton->rows : 0;
  if (skeleton->axis_x_m.size() != moved_rows || skeleton->axis_z_m.size() != moved_rows) return Problem::kSkeletonSize;
  for (const auto* array :
       {&pose->row_east_m, &pose->row_south_m, &pose->row_drop_m, &pose->row_slope_east, &pose->row_slope_south}) {
    if (array->size() != moved_rows) return Problem::kPoseSize;
  }
  return points->size() == count ? Problem::kNone : Problem::kPointsSize;
}

SurfaceKinematicsJob::Problem SurfaceKinematicsJob::run() const noexcept {
  const Problem problem = validate();
  if (problem != Problem::kNone) return problem;
  float* __restrict out = points->data().data();
  const float* const displacement_m = pose->displacement_m.data();
  const auto move = [&out, displacement_m, count = points->size()](const float* rest_m, const float* normal) {
    for (std::size_t i = 0; i < count; ++i) out[i] = rest_m[i] + displacement_m[i] * normal[i];
    out += count;
  };
  move(skeleton->rest_x_m.data(), skeleton->normal_x.data());
  move(skeleton->rest_y_m.data(), skeleton->normal_y.data());
  move(skeleton->rest_z_m.data(), skeleton->normal_z.data());
  if (skeleton->moves_rows()) move_rows(*skeleton, *pose, *points);
  return Problem::kNone;
}

}  // namespace yuragi::pose
