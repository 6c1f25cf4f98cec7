#include "viewer/gl/pass_clock.hpp"

#include <algorithm>
#include <ctime>

#include "viewer/gl/gl.hpp"

namespace yuragi::viewer::gl {
namespace {

GLuint64 timestamp_of(GLuint query) {
  GLuint64 result = 0;
  glGetQueryObjectui64v(query, GL_QUERY_RESULT, &result);
  return result;
}

GLuint count_of(GLuint query) {
  GLuint result = 0;
  glGetQueryObjectuiv(query, GL_QUERY_RESULT, &result);
  return result;
}

double time_ms(clockid_t clock) {
  std::timespec time{};
  ::clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace

PassClock::PassClock(By by)
    : by_(by),
      has_timestamps_(by == By::kGpu && (epoxy_gl_version() >= 33 || epoxy_has_gl_extension("GL_ARB_timer_query"))) {}

PassClock::~PassClock() {
  for (const std::vector<GLuint>* queries : {&timestamps_, &triangle_counts_}) {
    if (!queries->empty()) glDeleteQueries(static_cast<GLsizei>(queries->size()), queries->data());
  }
}

void PassClock::grow(std::vector<GLuint>& queries, std::size_t count) {
  while (queries.size() < count) glGenQueries(1, &queries.emplace_back(0));
}

void PassClock::put_mark() {
  const std::size_t number = names_.size();
  if (number > 0) glEndQuery(GL_PRIMITIVES_GENERATED);
  if (!has_timestamps_) {
    glFinish();
  } else {
    grow(timestamps_, number + 1);
    glQueryCounter(timestamps_[number], GL_TIMESTAMP);
  }
  spent_.push_back({.all_threads_ms = time_ms(CLOCK_PROCESS_CPUTIME_ID),
                    .thread_ms = time_ms(CLOCK_THREAD_CPUTIME_ID),
                    .clock_ms = time_ms(CLOCK_MONOTONIC),
                    .uploaded_bytes = uploaded_bytes()});
  grow(triangle_counts_, number + 1);
  glBeginQuery(GL_PRIMITIVES_GENERATED, triangle_counts_[number]);
}

void PassClock::begin() {
  names_.clear();
  spent_.clear();
  put_mark();
}

void PassClock::mark(std::string_view name) {
  names_.emplace_back(name);
  put_mark();
}

std::vector<PassClock::Pass> PassClock::end() {
  glEndQuery(GL_PRIMITIVES_GENERATED);
  std::vector<Pass> passes;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const Spent& from = spent_[i];
    const Spent& to = spent_[i + 1];
    auto pass = std::ranges::find(passes, names_[i], &Pass::name);
    if (pass == passes.end()) pass = passes.insert(passes.end(), {.name = names_[i]});
    if (has_timestamps_) {
      pass->time_ms += 1e-6 * static_cast<double>(timestamp_of(timestamps_[i + 1]) - timestamp_of(timestamps_[i]));
    } else {
      pass->time_ms += by_ == By::kProcessor ? to.all_threads_ms - from.all_threads_ms : to.clock_ms - from.clock_ms;
    }
    pass->thread_ms += to.thread_ms - from.thread_ms;
    pass->uploaded_bytes += to.uploaded_bytes - from.uploaded_bytes;
    pass->triangles += count_of(triangle_counts_[i]);
  }
  return passes;
}

}  // namespace yuragi::viewer::gl
