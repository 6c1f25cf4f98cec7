#include "viewer/gl/shadow_map.hpp"

#include <stdexcept>

namespace yuragi::viewer::gl {

ShadowMap::ShadowMap(int texels) : texels_(texels) {
  glActiveTexture(GL_TEXTURE0 + kShadowUnit);
  glBindTexture(GL_TEXTURE_2D, depth_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH24_STENCIL8, texels, texels, 0, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8,
               nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  // One texture with two lookups: the share that is nearer than a depth, and the depth itself.
  for (const Sampler* sampler : {&compared_, &plain_}) {
    glSamplerParameteri(sampler->name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glSamplerParameteri(sampler->name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    const GLint filter = sampler == &compared_ ? GL_LINEAR : GL_NEAREST;
    glSamplerParameteri(sampler->name(), GL_TEXTURE_MIN_FILTER, filter);
    glSamplerParameteri(sampler->name(), GL_TEXTURE_MAG_FILTER, filter);
  }
  glSamplerParameteri(compared_.name(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glSamplerParameteri(compared_.name(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glBindTexture(GL_TEXTURE_2D, 0);  // until end() there are no depths, nor a sampler that compares with them
  glActiveTexture(GL_TEXTURE0);

  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
  constexpr GLenum kNone = GL_NONE;
  glDrawBuffers(1, &kNone);
  glReadBuffer(GL_NONE);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("the graphics driver cannot draw shadows into a texture");
  }
}

void ShadowMap::begin() {
  // Must not be read while it is drawn.
  for (const TextureUnit unit : {kShadowUnit, kShadowDepthUnit}) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, 0);
  }
  glActiveTexture(GL_TEXTURE0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, texels_, texels_);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5F, 4.0F);
}

void ShadowMap::end() {
  glDisable(GL_POLYGON_OFFSET_FILL);
  for (const TextureUnit unit : {kShadowUnit, kShadowDepthUnit}) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, depth_.name());
    glBindSampler(static_cast<GLuint>(unit), unit == kShadowUnit ? compared_.name() : plain_.name());
  }
  glActiveTexture(GL_TEXTURE0);
}

}  // namespace yuragi::viewer::gl
