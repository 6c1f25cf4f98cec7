#pragma once

#include <array>
#include <bitset>
#include <cstddef>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "viewer/gl/gl.hpp"
#include "viewer/light/light.hpp"
#include "viewer/meshes/view.hpp"

namespace yuragi::viewer::looks {

/// Clouds as they are seen from the ground, in all directions: their cover, and how much light of the sun and of the
/// sky reaches their visible side; without their color. Maps are drawn a few columns a picture, and shown with a
/// cross-fade, moved by as much as the clouds have drifted since: so the cost of clouds is spread over seconds. The
/// visible part of the first map is drawn before the picture, and the rest with the pictures after it. Needs a current
/// context.
class CloudMap {
 public:
  CloudMap();

  /// Continues with the next map, or begins a first one if there is none yet or the sky has changed since the last
  /// call; then everything that `view` and its mirrored view show is drawn first. Binds another framebuffer. `noise`:
  /// the tile of viewer/gl/noise_texture.hpp.
  void advance(const light::Light& light, const gl::Texture& noise, const meshes::View& view);

  /// Sets the uniforms of `sky`, the program in use: the maps in view, and the drift of the clouds since.
  void bind(const gl::Program& sky) const;

 private:
  /// What clouds depend on.
  struct Sky {
    glm::vec2 drift{0.0F};
    float clouds_begin = 1.0F;
    glm::vec3 to_sun{0.0F, 1.0F, 0.0F};
  };
  struct Map {
    gl::Texture texture;
    Sky sky;
  };
  static constexpr int kColumns = 2048;    // the shader has the same number
  static constexpr int kStripColumns = 4;  // columns per picture while the sky is unchanged
  static constexpr std::size_t kStrips = kColumns / kStripColumns;

  static Sky sky_of(const light::Light& light);
  void draw_missing(std::size_t first, std::size_t end);
  void draw_missing(const meshes::Arc& bearings);
  void draw_columns(const Map& map, int first, int count);

  gl::Program program_;
  gl::VertexArray no_attributes_;
  gl::Framebuffer framebuffer_;
  std::array<Map, 3> maps_;
  std::size_t from_ = 0, to_ = 1, next_ = 2;  // two are in view, one is being drawn
  int drawn_ = 0;                             // columns of the next
  std::bitset<kStrips> missing_;              // of a first map, the only one in view
  std::size_t swept_ = 0;                     // number of its strips that are drawn
  bool is_first_ = true;
  Sky now_;
};

}  // namespace yuragi::viewer::looks
