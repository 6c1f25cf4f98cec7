#include "viewer/gl/pass_clock.hpp"

#include <algorithm>
#include <ctime>

namespace yuragi::viewer::gl {
namespace {

GLuint64 time_of(GLuint query) {
  GLuint64 time_ns = 0;
  glGetQueryObjectui64v(query, GL_QUERY_RESULT, &time_ns);
  return time_ns;
}

}  // namespace

PassClock::~PassClock() {
  if (!queries_.empty()) glDeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
}

void PassClock::put_timestamp() {
  if (by_ == By::kProcessor) {
    glFinish();
    times_ms_.push_back(1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
    return;
  }
  const std::size_t number = names_.size();
  if (number == queries_.size()) glGenQueries(1, &queries_.emplace_back(0));
  glQueryCounter(queries_[number], GL_TIMESTAMP);
}

void PassClock::begin() {
  names_.clear();
  times_ms_.clear();
  put_timestamp();
}

void PassClock::mark(std::string_view name) {
  names_.emplace_back(name);
  put_timestamp();
}

std::vector<PassClock::Pass> PassClock::passes() const {
  std::vector<Pass> passes;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const double time_ms = by_ == By::kProcessor
                               ? times_ms_[i + 1] - times_ms_[i]
                               : 1e-6 * static_cast<double>(time_of(queries_[i + 1]) - time_of(queries_[i]));
    const auto same = std::ranges::find(passes, names_[i], &Pass::name);
    same == passes.end() ? passes.push_back({names_[i], time_ms}) : void(same->time_ms += time_ms);
  }
  return passes;
}

}  // namespace yuragi::viewer::gl
