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

/// Clouds as they are seen from the ground, in all directions: how much they cover, and how much light of the sun and
/// of the sky comes to what one sees of them; without their color. Maps are drawn a few columns a picture, and shown
/// with a cross-fade, moved by as much as the clouds have drifted since: what is costly about clouds is spread over
/// seconds. Of the first one, what is in view is drawn before the picture, and the rest with the pictures after it.
/// Needs a current context.
class CloudMap {
 public:
  CloudMap();

  /// Goes on with the next map, or begins with a first one where there is none yet or the sky is another than at the
  /// last call. Then all that `view` and its mirrored one show is there. Binds another framebuffer. `noise`: the tile
  /// of viewer/gl/noise_texture.hpp.
  void advance(const light::Light& light, const gl::Texture& noise, const meshes::View& view);

  /// For `sky`, which is in use: the maps in view, and how far the clouds have drifted since.
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
  static constexpr int kStripColumns = 4;  // so many a picture, while the sky stays as it is
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
  std::bitset<kStrips> missing_;              // of a first map, which is alone in view
  std::size_t swept_ = 0;                     // strips of it that are there up to here
  bool is_first_ = true;
  Sky now_;
};

}  // namespace yuragi::viewer::looks
