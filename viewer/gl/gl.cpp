#include "viewer/gl/gl.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <stdexcept>

#include "viewer/gl/driver.hpp"
#include "viewer/gl/shaders.hpp"

namespace yuragi::viewer::gl {
namespace {

struct Shader {
  explicit Shader(GLenum stage) : name(glCreateShader(stage)) {}
  ~Shader() { glDeleteShader(name); }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
  GLuint name;
};

/// Returns the file name of a shader text; `otherwise` if it is unknown.
std::string file_of(std::string_view source, const std::string& otherwise) {
  const auto all = shaders::all();
  const auto found = std::ranges::find(all, source, &shaders::Shader::text);
  return found == all.end() ? otherwise : std::string(found->file);
}

std::atomic<std::size_t> compile_count{0};

void compile(const Shader& shader, const std::string& name, std::string_view source) {
  // Lines from 10001 on are those of common.glsl.
  std::string text(glsl_version_line());
  text.append("\n#line 10001\n").append(shaders::kCommon).append("\n#line 1\n").append(source);
  const GLchar* const begin = text.data();
  const auto length = static_cast<GLint>(text.size());
  ++compile_count;
  glShaderSource(shader.name, 1, &begin, &length);
  glCompileShader(shader.name);

  GLint is_compiled = GL_FALSE;
  glGetShaderiv(shader.name, GL_COMPILE_STATUS, &is_compiled);
  if (is_compiled == GL_TRUE) return;
  std::array<GLchar, 4096> log{};
  glGetShaderInfoLog(shader.name, log.size(), nullptr, log.data());
  throw std::runtime_error("the graphics driver cannot compile " + file_of(source, name) +
                           " (10001 is line 1 of common.glsl):\n" + log.data());
}

std::atomic<std::size_t> upload_count{0};

}  // namespace

GLuint BufferKind::make() {
  GLuint name = 0;
  glGenBuffers(1, &name);
  return name;
}
void BufferKind::unmake(GLuint name) {
  glDeleteBuffers(1, &name);
}

GLuint TextureKind::make() {
  GLuint name = 0;
  glGenTextures(1, &name);
  return name;
}
void TextureKind::unmake(GLuint name) {
  glDeleteTextures(1, &name);
}

GLuint SamplerKind::make() {
  GLuint name = 0;
  glGenSamplers(1, &name);
  return name;
}
void SamplerKind::unmake(GLuint name) {
  glDeleteSamplers(1, &name);
}

GLuint VertexArrayKind::make() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return name;
}
void VertexArrayKind::unmake(GLuint name) {
  glDeleteVertexArrays(1, &name);
}

GLuint FramebufferKind::make() {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  return name;
}
void FramebufferKind::unmake(GLuint name) {
  glDeleteFramebuffers(1, &name);
}

GLuint RenderbufferKind::make() {
  GLuint name = 0;
  glGenRenderbuffers(1, &name);
  return name;
}
void RenderbufferKind::unmake(GLuint name) {
  glDeleteRenderbuffers(1, &name);
}

GLuint ProgramKind::make() {
  return glCreateProgram();
}
void ProgramKind::unmake(GLuint name) {
  glDeleteProgram(name);
}

Program link_program(const std::string& name, std::string_view vertex, std::string_view fragment) {
  const Shader vertex_shader(GL_VERTEX_SHADER);
  const Shader fragment_shader(GL_FRAGMENT_SHADER);
  compile(vertex_shader, name + ".vert", vertex);
  compile(fragment_shader, name + ".frag", fragment);

  Program program;
  glAttachShader(program.name(), vertex_shader.name);
  glAttachShader(program.name(), fragment_shader.name);
  glLinkProgram(program.name());
  GLint is_linked = GL_FALSE;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &is_linked);
  if (is_linked != GL_TRUE) {
    std::array<GLchar, 4096> log{};
    glGetProgramInfoLog(program.name(), log.size(), nullptr, log.data());
    throw std::runtime_error("the graphics driver cannot link the program " + name + ":\n" + log.data());
  }
  glDetachShader(program.name(), vertex_shader.name);
  glDetachShader(program.name(), fragment_shader.name);

  for (const auto& [block, binding] : {std::pair{"View", kViewBinding}, std::pair{"Light", kLightBinding},
                                       std::pair{"Ground", kGroundBinding}, std::pair{"Fires", kFiresBinding}}) {
    const GLuint place = glGetUniformBlockIndex(program.name(), block);
    if (place != GL_INVALID_INDEX) glUniformBlockBinding(program.name(), place, binding);
  }
  // Also if the sampler is not used: two kinds of sampler must not have one unit.
  set_sampler(program, "shadow_map", kShadowUnit);
  set_sampler(program, "shadow_depth", kShadowDepthUnit);
  set_sampler(program, "cloud_noise", kNoiseUnit);
  return program;
}

Texture make_tile(GLint kept_as, GLenum format, GLsizei side, std::span<const std::uint8_t> texels) {
  Texture texture;
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, kept_as, side, side, 0, format, GL_UNSIGNED_BYTE, texels.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

void set_sampler(const Program& program, const char* name, GLint unit) {
  glUseProgram(program.name());
  glUniform1i(glGetUniformLocation(program.name(), name), unit);
}

std::size_t compiled_shaders() {
  return compile_count;
}

std::size_t uploaded_bytes() {
  return upload_count;
}
void count_upload(std::size_t bytes) {
  upload_count += bytes;
}

bool is_software_renderer() {
  const auto* const renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (renderer == nullptr) return false;
  const std::string_view name(renderer);
  return name.find("llvmpipe") != std::string_view::npos || name.find("softpipe") != std::string_view::npos;
}

}  // namespace yuragi::viewer::gl
