#include "viewer/looks/board_floor.hpp"

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr GLsizei kFloorVertices = 5 * 6;

void set_floor(const gl::Program& program, const meshes::Floor& floor, const glm::vec3& through) {
  const auto place = [&](const char* name) { return glGetUniformLocation(program.name(), name); };
  glUseProgram(program.name());
  glUniform3f(place("middle_m"), floor.middle_m.x, floor.middle_m.y, floor.middle_m.z);
  glUniform2f(place("along"), floor.along.x, floor.along.y);
  glUniform2f(place("half_m"), floor.half_m.x, floor.half_m.y);
  glUniform3f(place("through"), through.r, through.g, through.b);
}

}  // namespace

BoardFloor::BoardFloor(const meshes::Floor& floor, const glm::vec3& through)
    : program_(gl::link_program("floor", gl::shaders::kFloorVert, gl::shaders::kFloorFrag)),
      shade_program_(gl::link_program("floor in shade", gl::shaders::kFloorShadeVert, gl::shaders::kFloorFrag)) {
  set_floor(program_, floor, through);
  set_floor(shade_program_, floor, through);
}

void BoardFloor::draw() const {
  glUseProgram(program_.name());
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, kFloorVertices);
}

}  // namespace yuragi::viewer::looks
