#include "viewer/gl/strip_indices.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace yuragi::viewer::gl {
namespace {

constexpr std::size_t kStripsOfMesh = 2048;

}  // namespace

void StripIndices::draw(GLint first_corner_place, std::size_t corners, std::size_t first, std::size_t strips) {
  if (corners < 4 || corners > (std::size_t{1} << kCornerBits)) return;
  const auto [place, is_new] = meshes_.try_emplace(corners);
  Mesh& mesh = place->second;
  glBindVertexArray(mesh.array.name());
  if (is_new) {
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * (corners - 2) * kStripsOfMesh);
    for (std::uint32_t strip = 0; strip < kStripsOfMesh; ++strip) {
      const std::uint32_t corner = strip << kCornerBits;
      for (std::uint32_t i = 0; i + 2 < corners; ++i) {
        indices.insert(indices.end(), {corner + i, corner + i + 1, corner + i + 2});
      }
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)),
                 indices.data(), GL_STATIC_DRAW);
  }
  for (std::size_t drawn = 0; drawn < strips; drawn += kStripsOfMesh) {
    const std::size_t count = 3 * (corners - 2) * std::min(strips - drawn, kStripsOfMesh);
    glUniform1i(first_corner_place, static_cast<GLint>((first + drawn) << kCornerBits));
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count), GL_UNSIGNED_INT, nullptr);
  }
}

}  // namespace yuragi::viewer::gl
