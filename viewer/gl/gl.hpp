#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include <epoxy/gl.h>

namespace yuragi::viewer::gl {

// OpenGL objects that delete themselves. All of this needs a current context that is_enough()
// (driver.hpp), on its thread.

/// Owns one OpenGL object of a kind; movable. Kind::make() and Kind::unmake(name) are the GL calls.
template <class Kind>
class Object {
 public:
  Object() : name_(Kind::make()) {}
  // Not inlined: in std::optional::emplace() of a type that holds one, gcc 14 reports name_ as uninitialized.
  [[gnu::noinline]] ~Object() {
    if (name_ != 0) Kind::unmake(name_);
  }
  Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  GLuint name() const { return name_; }

 private:
  GLuint name_;
};

struct BufferKind {
  static GLuint make();
  static void unmake(GLuint name);
};
struct TextureKind {
  static GLuint make();
  static void unmake(GLuint name);
};
struct SamplerKind {
  static GLuint make();
  static void unmake(GLuint name);
};
struct VertexArrayKind {
  static GLuint make();
  static void unmake(GLuint name);
};
struct FramebufferKind {
  static GLuint make();
  static void unmake(GLuint name);
};
struct RenderbufferKind {
  static GLuint make();
  static void unmake(GLuint name);
};
struct ProgramKind {
  static GLuint make();
  static void unmake(GLuint name);
};

using Buffer = Object<BufferKind>;
using Texture = Object<TextureKind>;
using Sampler = Object<SamplerKind>;
using VertexArray = Object<VertexArrayKind>;
using Framebuffer = Object<FramebufferKind>;
using Renderbuffer = Object<RenderbufferKind>;
using Program = Object<ProgramKind>;

/// The binding of the uniform block that all renderers share (view.hpp).
inline constexpr GLuint kViewBinding = 0;
/// And the block of the light (viewer/light/light.hpp).
inline constexpr GLuint kLightBinding = 1;
/// And the block Ground, of those that draw grass (shaders/grass/sward.part.glsl).
inline constexpr GLuint kGroundBinding = 2;
/// And the block Fires (viewer/light/fire_light.hpp).
inline constexpr GLuint kFiresBinding = 3;

/// The texture units: one for each texture that stays bound while others draw. Unit 0 is free for temporary use.
enum TextureUnit : GLint {
  kNoiseUnit = 1,    // of grass and what grows in it (looks/ground_maps.hpp), like the next three; in every program, of
                     // cloud shadows
  kTurfUnit,         //
  kBendsUnit,        //
  kGrowthUnit,       //
  kBladesUnit,       // of those that are drawn, and their tiles or blocks
  kTilesUnit,        //
  kShadowUnit,       // the shadow map, in every program: compared with a depth, and as depths
  kShadowDepthUnit,  //
  kMirrorUnit,       // what water mirrors (Mirror)
  kSlopesUnit,       // of its waves
  kRipplesUnit,      //
  kWaterMemoryUnit,  // waves that gusts have raised on the water, and its foam
  kBedUnit,          // the colors of its bed
  kCloudsFromUnit,   // two maps of clouds
  kCloudsToUnit,     //
  kSmallSkyUnit,     // the sky of the picture, smaller
  kFlameRowsUnit,    //
  kFlameNoiseUnit,   //
  kFlameRampUnit,    //
  kStripsUnit,       // of the strips being drawn (StripIndices), temporarily
  kBeforeUnit,       // two pictures that cross-fade
  kNowUnit,          //
  kImpostorUnit,     // the pictures of a far tree, and the data for their light
  kImpostorFacingUnit,
  kGroundImageUnit,  // the image on the ground
  kEdgesUnit,        // the picture whose edges are smoothed
};

/// Compiles and links. Each stage begins with glsl_version_line() and shaders/picture/common.glsl. On an error throws
/// std::runtime_error with `name` and the compiler's message. The uniform blocks and the samplers of shadows are bound
/// as above.
Program link_program(const std::string& name, std::string_view vertex, std::string_view fragment);

/// Sets a sampler of `program` to a texture unit. Unknown names are ignored, since the compiler drops uniforms that are
/// not used.
void set_sampler(const Program& program, const char* name, GLint unit);

/// A texture of `side` x `side` texels that repeats, with smaller ones for the distance.
Texture make_tile(GLint kept_as, GLenum format, GLsizei side, std::span<const std::uint8_t> texels);

/// All that uploads count since the program began, in bytes. For measurements.
std::size_t uploaded_bytes();
/// The number of shaders compiled since the program started. For measurements: a picture that compiles takes longer
/// than others.
std::size_t compiled_shaders();
/// Call with every upload of a picture that stream_to() does not make.
void count_upload(std::size_t bytes);

/// Gives new content to a buffer that is drawn from every frame, without waiting for the GPU, which may still read the
/// old content.
template <class T>
void stream_to(GLenum target, const Buffer& buffer, std::span<const T> content) {
  glBindBuffer(target, buffer.name());
  glBufferData(target, static_cast<GLsizeiptr>(content.size_bytes()), content.data(), GL_STREAM_DRAW);
  count_upload(content.size_bytes());
}

/// Returns true if the driver computes every pixel on the processor, without graphics hardware.
bool is_software_renderer();

// What follows is in driver_reports.cpp, because OpenGL ES 3.0 and WebGL 2 do not have it.

/// Returns true if the graphics card was reset, which deletes the context's content. Only a new context, that is, a
/// restarted program, can then draw. Always false if the driver does not report it (GL_KHR_robustness).
bool is_context_lost();

/// From now on the driver's error messages go to standard error (KHR_debug; does nothing if the driver does not support
/// it).
void report_gl_errors();

/// How many errors the driver has reported since report_gl_errors(). For tests.
int gl_error_count();

}  // namespace yuragi::viewer::gl
