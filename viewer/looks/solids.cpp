#include "viewer/looks/solids.hpp"

#include <cstddef>
#include <vector>

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {

Solids::Solids(const meshes::SolidMesh& mesh)
    : index_count_(static_cast<GLsizei>(mesh.indices().size() + mesh.rings().size())),
      ring_index_count_(static_cast<GLsizei>(mesh.rings().size())),
      program_(gl::link_program("solid", gl::shaders::kSolidVert, gl::shaders::kSolidFrag)),
      axis_place_(glGetUniformLocation(program_.name(), "axis_m")),
      turn_place_(glGetUniformLocation(program_.name(), "turn")) {
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_.name());
  std::vector<std::uint32_t> indices = mesh.indices();
  indices.insert(indices.end(), mesh.rings().begin(), mesh.rings().end());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
               GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices().size() * sizeof(meshes::SolidVertex)),
               mesh.vertices().data(), GL_STATIC_DRAW);
  // OpenGL takes an offset in a buffer as a pointer.
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(meshes::SolidVertex),
                        at(offsetof(meshes::SolidVertex, place_m)));
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(meshes::SolidVertex),
                        at(offsetof(meshes::SolidVertex, normal)));
  glVertexAttribPointer(2, 3, GL_FLOAT, GL_FALSE, sizeof(meshes::SolidVertex), at(offsetof(meshes::SolidVertex, tint)));
  glVertexAttribPointer(3, 3, GL_FLOAT, GL_FALSE, sizeof(meshes::SolidVertex),
                        at(offsetof(meshes::SolidVertex, grain)));
  for (GLuint attribute = 0; attribute < 4; ++attribute) glEnableVertexAttribArray(attribute);
}

void Solids::turn(const glm::vec2& axis_m, float sine, float cosine) {
  glUseProgram(program_.name());
  glUniform2f(axis_place_, axis_m.x, axis_m.y);
  glUniform2f(turn_place_, sine, cosine - 1.0F);
}

void Solids::draw() const {
  glUseProgram(program_.name());
  glBindVertexArray(array_.name());
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

void Solids::draw_coarsely() const {
  glUseProgram(program_.name());
  glBindVertexArray(array_.name());
  glDrawElements(GL_TRIANGLES, index_count_ - ring_index_count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace yuragi::viewer::looks
