// SPDX-License-Identifier: MIT
#include "lantern/gl/timer.h"

#include "lantern/gl/check.h"

namespace lantern::gl {
namespace {

bool has_timers() {
  return epoxy_is_desktop_gl() || epoxy_has_gl_extension("GL_EXT_disjoint_timer_query");
}

GLuint make_query() {
  GLuint id = 0;
  glGenQueries(1, &id);
  return id;
}

void stamp(GLuint query) {
  if (epoxy_is_desktop_gl()) {
    glQueryCounter(query, GL_TIMESTAMP);
  } else {
    glQueryCounterEXT(query, GL_TIMESTAMP_EXT);
  }
  check("timing");
}

GLuint64 nanoseconds(GLuint query) {
  GLuint64 value = 0;
  if (epoxy_is_desktop_gl()) {
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &value);
  } else {
    glGetQueryObjectui64vEXT(query, GL_QUERY_RESULT_EXT, &value);
  }
  check("timing");
  return value;
}

/// Whether the GPU's clock was disturbed since this was last asked.
bool is_disjoint() {
  if (epoxy_is_desktop_gl()) return false;
  GLint disjoint = 0;
  glGetIntegerv(GL_GPU_DISJOINT_EXT, &disjoint);
  return disjoint != 0;
}

}  // namespace

void delete_query(GLuint id) { glDeleteQueries(1, &id); }

Timer::Timer()
    : available_(has_timers()),
      begin_(available_ ? make_query() : 0),
      end_(available_ ? make_query() : 0) {}

void Timer::begin() {
  if (!available_) return;
  is_disjoint();
  stamp(begin_.id());
}

void Timer::end() {
  if (available_) stamp(end_.id());
}

std::optional<double> Timer::seconds() const {
  if (!available_) return std::nullopt;
  const GLuint64 from = nanoseconds(begin_.id()), to = nanoseconds(end_.id());
  if (is_disjoint()) return std::nullopt;
  constexpr double kNanosecond = 1e-9;
  return static_cast<double>(to - from) * kNanosecond;
}

}  // namespace lantern::gl
