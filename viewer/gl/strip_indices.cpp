#include "viewer/gl/strip_indices.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace yuragi::viewer::gl {
namespace {

constexpr std::size_t kStripsOfMesh = 2048;

}  // namespace

void StripIndices::draw(std::size_t corners, std::size_t strips) {
  if (corners < 4 || corners > (std::size_t{1} << kCornerBits)) return;
  const auto [place, is_new] = meshes_.try_emplace(corners);
  Mesh& mesh = place->second;
  glBindVertexArray(mesh.array.name());
  if (is_new) {
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * (corners - 2) * kStripsOfMesh);
    for (std::uint32_t strip = 0; strip < kStripsOfMesh; ++strip) {
      const std::uint32_t first = strip << kCornerBits;
      for (std::uint32_t i = 0; i + 2 < corners; ++i) {
        indices.insert(indices.end(), {first + i, first + i + 1, first + i + 2});
      }
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)),
                 indices.data(), GL_STATIC_DRAW);
  }
  for (std::size_t first = 0; first < strips; first += kStripsOfMesh) {
    const std::size_t count = 3 * (corners - 2) * std::min(strips - first, kStripsOfMesh);
    glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(count), GL_UNSIGNED_INT, nullptr,
                             static_cast<GLint>(first << kCornerBits));
  }
}

}  // namespace yuragi::viewer::gl
