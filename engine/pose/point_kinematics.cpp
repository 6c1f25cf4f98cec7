#include "engine/pose/point_kinematics.hpp"

namespace yuragi {

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
  for (const auto* array : {&pose->row_east_m, &pose->row_south_m, &pose->row_drop_m}) {
    if (array->size() != (skeleton->moves_rows ? skeleton->rows : 0)) return Problem::kPoseSize;
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
  if (!skeleton->moves_rows) return Problem::kNone;

  out = points->data().data();
  const auto move_rows = [&out, this](const std::vector<float>& ways_m, float sign) {
    for (const float way_m : ways_m) {
      const float moved_m = sign * way_m;
      for (std::size_t i = 0; i < skeleton->columns; ++i) out[i] += moved_m;
      out += skeleton->columns;
    }
  };
  move_rows(pose->row_east_m, 1.0F);
  move_rows(pose->row_drop_m, -1.0F);
  move_rows(pose->row_south_m, 1.0F);
  return Problem::kNone;
}

}  // namespace yuragi
