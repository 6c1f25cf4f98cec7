#include "viewer/looks/board_floor.hpp"

#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr float kSunInShade = 0.25F;  // some comes through the cloth
constexpr GLsizei kFloorVertices = 5 * 6;

void set_floor(const gl::GlProgram& program, const meshes::Floor& floor, float sunlight) {
  const auto place = [&](const char* name) { return glGetUniformLocation(program.name(), name); };
  glUseProgram(program.name());
  glUniform3f(place("middle_m"), floor.middle_m.x, floor.middle_m.y, floor.middle_m.z);
  glUniform2f(place("along"), floor.along.x, floor.along.y);
  glUniform2f(place("half_m"), floor.half_m.x, floor.half_m.y);
  glUniform1f(place("sunlight"), sunlight);
}

}  // namespace

BoardFloor::BoardFloor(const meshes::Floor& floor)
    : program_(gl::link_program("floor", gl::shaders::kFloorVert, gl::shaders::kFloorFrag)),
      shade_program_(gl::link_program("floor in shade", gl::shaders::kFloorShadeVert, gl::shaders::kFloorFrag)) {
  set_floor(program_, floor, 1.0F);
  set_floor(shade_program_, floor, kSunInShade);
}

void BoardFloor::draw() const {
  glUseProgram(program_.name());
  glBindVertexArray(no_attributes_.name());
  glDrawArrays(GL_TRIANGLES, 0, kFloorVertices);
}

}  // namespace yuragi::viewer::looks
