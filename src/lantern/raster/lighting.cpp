// SPDX-License-Identifier: MIT
#include "lantern/raster/lighting.h"

#include "lantern/gl/check.h"

#include <algorithm>
#include <string>
#include <utility>

namespace lantern {
namespace {

constexpr GLuint kLightsBinding = 0;

gl::Program shade_program(const gl::ShaderFiles& files, LightFormula formula) {
  gl::Program program(files, "shaders/full_screen.vert.glsl", "shaders/shade_by_maps.frag.glsl",
                      {{"KIND", std::to_string(static_cast<int>(formula))}});
  program.set_block("Lights", kLightsBinding);
  ShadowMaps::prepare(program);
  return program;
}

}  // namespace

Lighting::Lighting(const Surfaces& surfaces, const Shadows& shadows, StageTimes& times,
                   const gl::ShaderFiles& files, int width, int height)
    : surfaces_(surfaces),
      shadows_(shadows),
      times_(times),
      g_buffer_(width, height),
      mask_(gl::Format::kRgba8, width, height),
      mask_framebuffer_({&mask_}, &g_buffer_.depth),
      light_block_(std::span<const LightRecord>()),
      irradiance_{Target(gl::Format::kRgba32f, width, height),
                  Target(gl::Format::kRgba32f, width, height)} {
  if (!shadows.maps) {
    masked_.emplace(files, width, height, kLightsBinding);
    return;
  }
  for (const LightFormula formula :
       {LightFormula::kSurface, LightFormula::kPunctual, LightFormula::kDirectional}) {
    by_maps_.push_back(shade_program(files, formula));
  }
}

void Lighting::draw(const View& view, std::span<const LightGroup> groups,
                    const std::function<bool()>& group_done) {
  times_.begin(Stage::kSurfaces);
  surfaces_.draw(view, g_buffer_);
  times_.end();
  if (masked_) {
    masked_->clear();
  } else {
    irradiance_[0].framebuffer.bind();
    const float none[4] = {};
    glClearBufferfv(GL_COLOR, 0, none);
  }
  if (!shadows_.volumes) {
    const float all_seen[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    mask_framebuffer_.bind();
    glClearBufferfv(GL_COLOR, 0, all_seen);
  }
  for (const LightGroup& group : groups) {
    if (shadows_.volumes) shadows_.volumes->draw(group.points, view, mask_framebuffer_, times_);
    if (shadows_.maps) shadows_.maps->draw(group, times_);
    add(group);
    if (!group_done()) break;
  }
  if (masked_) masked_->copy_to(irradiance_[0].texture);
}

/// What the lights of the mask's bits give.
void Lighting::add(const LightGroup& group) {
  std::array<LightRecord, kLightsInGroup> records;
  std::copy(group.records.begin(), group.records.end(), records.begin());
  light_block_.write(std::span<const LightRecord>(records));
  light_block_.bind_as_uniforms(kLightsBinding);
  times_.begin(Stage::kShading);
  if (masked_) {
    masked_->add(group, g_buffer_, mask_);
    times_.end();
    return;
  }
  const gl::Program& program = by_maps_[static_cast<std::size_t>(group.formula)];
  program.set("u_points", 0, g_buffer_.points);
  program.set("u_reflectances", 1, g_buffer_.reflectances);
  program.set("u_mask", 2, mask_);
  program.set("u_sum", 3, irradiance_[0].texture);
  program.set("u_count", static_cast<int>(group.records.size()));
  shadows_.maps->set_in(program, 4);
  program.set("u_emissions", 6, g_buffer_.emissions);
  irradiance_[1].framebuffer.bind();
  gl::draw_full_screen(no_vertices_);
  times_.end();
  std::swap(irradiance_[0], irradiance_[1]);
  gl::check("shading");
}

}  // namespace lantern
