#include "viewer/looks/cloth_sheet.hpp"

#include "viewer/looks/grid_sheet.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr GLuint kPoint = 0;
constexpr GLuint kNormal = 3;
constexpr GLuint kBend = 6;
constexpr GLuint kPlace = 7;

/// Folds narrower than this block little of the sky's light.
constexpr float kBendReach_m = 0.03F;

}  // namespace

ClothSheet::ClothSheet(const meshes::GridLayout& joints, const meshes::ClothMeasure& lies, int level, int finer_down)
    : lies_(lies),
      surface_(joints, level, finer_down),
      bends_per_m_(surface_.layout().size()),
      rim_points_(6 * surface_.rim().size()),
      rim_normals_(rim_points_.size()) {
  const std::size_t size = surface_.layout().size();
  const std::vector<std::uint32_t> triangles = meshes::grid_triangles(surface_.layout());
  index_count_ = static_cast<GLsizei>(triangles.size());
  const std::vector<float> places_m = surface_.places_m(lies);
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_.name());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size() * sizeof(std::uint32_t)),
               triangles.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, place_buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(places_m.size() * sizeof(float)), places_m.data(),
               GL_STATIC_DRAW);
  describe_arrays(point_buffer_, kPoint, 3, size);
  describe_arrays(normal_buffer_, kNormal, 3, size);
  describe_arrays(bend_buffer_, kBend, 1, size);
  describe_arrays(place_buffer_, kPlace, 2, size);

  const std::size_t around = 2 * surface_.rim().size();
  std::vector<float> rim_places_m(2 * around);
  for (std::size_t i = 0; i < around; ++i) {
    rim_places_m[i] = places_m[surface_.rim()[i / 2]];
    rim_places_m[around + i] = places_m[size + surface_.rim()[i / 2]];
  }
  glBindVertexArray(rim_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, rim_place_buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(rim_places_m.size() * sizeof(float)), rim_places_m.data(),
               GL_STATIC_DRAW);
  describe_arrays(rim_point_buffer_, kPoint, 3, around);
  describe_arrays(rim_normal_buffer_, kNormal, 3, around);
  describe_arrays(rim_place_buffer_, kPlace, 2, around);
}

void ClothSheet::move_to(std::span<const float> joints) {
  surface_.move_to(joints);
  surface_.write_bends(kBendReach_m, lies_, bends_per_m_);
  gl::stream_to(GL_ARRAY_BUFFER, point_buffer_, surface_.points());
  gl::stream_to(GL_ARRAY_BUFFER, normal_buffer_, surface_.normals());
  gl::stream_to(GL_ARRAY_BUFFER, bend_buffer_, std::span<const float>(bends_per_m_));
  is_rim_there_ = false;
}

void ClothSheet::draw() const {
  glBindVertexArray(array_.name());
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

void ClothSheet::draw_rim(float half_thickness_m) {
  if (rim_points_.empty()) return;
  if (!is_rim_there_) {
    surface_.write_rim(half_thickness_m, rim_points_, rim_normals_);
    gl::stream_to(GL_ARRAY_BUFFER, rim_point_buffer_, std::span<const float>(rim_points_));
    gl::stream_to(GL_ARRAY_BUFFER, rim_normal_buffer_, std::span<const float>(rim_normals_));
    is_rim_there_ = true;
  }
  glBindVertexArray(rim_array_.name());
  glVertexAttrib1f(kBend, 0.0F);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, static_cast<GLsizei>(2 * surface_.rim().size()));
}

}  // namespace yuragi::viewer::looks
