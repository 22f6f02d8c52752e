// SPDX-License-Identifier: MIT
#include "lantern/raster/surfaces.h"

#include "lantern/gl/check.h"
#include "lantern/raster/corner_buffer.h"
#include "lantern/raster/draw_state.h"
#include "lantern/raster/edge_list.h"
#include "lantern/raster/neighbours.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/tracer.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

namespace lantern {
namespace {

constexpr GLuint kPosition = 0, kGeometricNormal = 1, kNormal = 2, kTexcoord = 3, kColour = 4,
                 kTriangle = 5;

gl::Texture upload(const Texture& texture) {
  const bool bytes = texture.linear.empty();
  gl::Texture uploaded(bytes ? gl::Format::kRgba8 : gl::Format::kRgba32f, texture.width,
                       texture.height);
  if (bytes) {
    uploaded.write<std::uint8_t>(texture.srgb8);
  } else {
    uploaded.write<float>(texture.linear);
  }
  return uploaded;
}

gl::Buffer geometric_normals(const World& world, std::span<const std::uint32_t> order) {
  std::vector<Vec3> normals;
  normals.reserve(3 * order.size());
  for (const std::uint32_t t : order) {
    normals.insert(normals.end(), 3, glm::normalize(world.area_vector(t)));
  }
  return gl::Buffer(std::span<const Vec3>(normals));
}

bool is_textured(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& m) { return m.reflectance_texture || m.emission_texture; });
}

bool has_sky_texture(const Scene& scene) { return scene.sky && scene.sky->texture; }

}  // namespace

GBuffer::GBuffer(int width, int height)
    : points(gl::Format::kRgba32ui, width, height),
      reflectances(gl::Format::kRgba32ui, width, height),
      emissions(gl::Format::kRgba32f, width, height),
      depth(gl::Format::kDepth32fStencil8, width, height),
      framebuffer({&points, &reflectances, &emissions}, &depth) {}

/// The order in which triangles are drawn.
std::vector<std::uint32_t> Surfaces::make_batches(const World& world) {
  std::vector<std::uint32_t> order(world.size());
  std::iota(order.begin(), order.end(), 0u);
  // Walls are behind all else: they come last, so that what is seen of them alone is written.
  const std::vector<Vec4> walls = find_walls(world);
  std::vector<std::uint8_t> is_in_wall(world.size());
  for (const std::uint32_t t : order) is_in_wall[t] = wall_of(world, t, walls) ? 1 : 0;
  const auto batch_of = [&](std::uint32_t t) {
    return std::tie(is_in_wall[t], world.materials[t]);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return batch_of(a) < batch_of(b); });
  const auto neighbours = find_neighbours(scene_, world);
  const Parts parts = find_parts(neighbours);
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first;
    while (end < order.size() && batch_of(order[end]) == batch_of(order[first])) ++end;
    batches_.push_back(
        {index(world.materials[order[first]]),
         make_bodies(world, neighbours, parts, std::span(order).subspan(first, end - first),
                     static_cast<std::uint32_t>(first))});
    first = end;
  }
  return order;
}

Surfaces::Surfaces(const Scene& scene, const World& world, const gl::ShaderFiles& files)
    : scene_(scene),
      lift_(glm::length(off_surface(Vec3(0.0f), Vec3(1.0f, 0.0f, 0.0f), world.coordinate_scale()))),
      textured_(is_textured(scene)),
      surface_(files, "shaders/surface.vert.glsl", "shaders/surface.frag.glsl",
               {{"TEXTURED", textured_ ? "1" : "0"}, {"HOLES", "0"}}),
      surface_with_holes_(files, "shaders/surface.vert.glsl", "shaders/surface.frag.glsl",
                          {{"TEXTURED", textured_ ? "1" : "0"}, {"HOLES", "1"}}),
      sky_(files, "shaders/sky.vert.glsl", "shaders/sky.frag.glsl",
           {{"TEXTURED", has_sky_texture(scene) ? "1" : "0"}}),
      no_texture_(gl::Format::kRgba8, 1, 1) {
  const auto use = [&](const std::optional<TextureId>& id) {
    if (id && !textures_.contains(*id)) textures_.emplace(*id, upload(scene.textures[index(*id)]));
  };
  if (scene.sky) use(scene.sky->texture);

  const std::vector<std::uint32_t> order = make_batches(world);
  for (const Batch& batch : batches_) {
    use(scene.materials[batch.material].reflectance_texture);
    use(scene.materials[batch.material].emission_texture);
  }

  buffers_.reserve(6);
  buffers_.push_back(by_corner(world, order, world.positions));
  buffers_.push_back(geometric_normals(world, order));
  buffers_.push_back(numbers_by_corner(order));
  vertices_.emplace(std::initializer_list<gl::Attribute>{
      {.location = kPosition, .buffer = &buffers_[0]},
      {.location = kGeometricNormal, .buffer = &buffers_[1]},
      {.location = kTriangle, .buffer = &buffers_[2], .channels = 1, .integer = true}});
  const auto add = [&](const auto& values, GLuint location, int channels) {
    if (values.empty()) return;
    buffers_.push_back(by_corner(world, order, values));
    vertices_->add({.location = location, .buffer = &buffers_.back(), .channels = channels});
  };
  add(world.normals, kNormal, 3);
  add(world.texcoords, kTexcoord, 2);
  add(world.colours, kColour, 4);
}

void Surfaces::set_look_up(const gl::Program& program, const char* sampler, const char* how,
                           int unit, const std::optional<TextureId>& id) const {
  if (!id) {
    program.set(sampler, unit, no_texture_);
    program.set(how, Vec4(0.0f));
    return;
  }
  const Texture& texture = scene_.textures[index(*id)];
  const auto wrap = [](Wrap mode) {
    switch (mode) {
      case Wrap::kClamp:
        return 1.0f;
      case Wrap::kMirror:
        return 2.0f;
      case Wrap::kRepeat:
        break;
    }
    return 0.0f;
  };
  program.set(sampler, unit, textures_.at(*id));
  program.set(how, Vec4(wrap(texture.wrap_u), wrap(texture.wrap_v),
                        texture.linear.empty() ? 1.0f : 0.0f, 1.0f));
}

void Surfaces::set_opacity(const gl::Program& program, std::size_t id, int unit) const {
  const Material& material = scene_.materials[id];
  program.set("u_opacity", material.opacity);
  program.set("u_cutoff", material.alpha_cutoff.value_or(-1.0f));
  program.set("u_opacity_colours", material.vertex_colours ? 1 : 0);
  set_look_up(program, "u_opacity_texture", "u_opacity_look_up", unit,
              material.reflectance_texture);
}

void Surfaces::set_view(const gl::Program& program, const View& view) const {
  program.set("u_eye", view.eye);
  program.set("u_clip", view.clip);
  program.set("u_lift", lift_);
}

/// What may be seen of a batch, those with the same sides that follow each other at once.
void Surfaces::draw_bodies(const Batch& batch, const View& view) {
  const std::vector<Vec4> sides = sides_of(view);
  std::vector<std::pair<float, const Body*>> seen;  // and how far they are
  for (const Body& body : batch.bodies) {
    if (!may_lie_inside(body, sides)) continue;
    seen.emplace_back(glm::distance(body.centre, view.eye) - body.radius, &body);
  }
  // The nearest first, so that little is drawn over, unless that takes too many calls.
  constexpr std::size_t kMostCalls = 256;
  if (seen.size() <= kMostCalls) {
    std::stable_sort(seen.begin(), seen.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
  }
  GLint first = 0;
  GLsizei count = 0;
  SeenSide side = SeenSide::kBoth;
  const auto draw = [&] {
    if (count == 0) return;
    apply({.depth = DepthUse::kDraw, .sides = side}, view);
    glDrawArrays(GL_TRIANGLES, first, count);
    count = 0;
  };
  for (const auto& [distance, body] : seen) {
    const SeenSide its_side = seen_side(*body, view.eye);
    if (static_cast<GLint>(3 * body->first) != first + count || its_side != side) {
      draw();
      first = static_cast<GLint>(3 * body->first);
      side = its_side;
    }
    count += static_cast<GLsizei>(3 * body->count);
  }
  draw();
}

void Surfaces::draw(const View& view, const GBuffer& target) const {
  target.framebuffer.bind();
  set_viewport(view);
  apply({.depth = DepthUse::kDraw}, view);
  glEnable(GL_SCISSOR_TEST);
  glScissor(view.origin.x, view.origin.y, view.size.x, view.size.y);
  glClearBufferfi(GL_DEPTH_STENCIL, 0, far_depth(view), 0);
  glDisable(GL_SCISSOR_TEST);

  set_view(surface_, view);
  vertices_->bind();
  // What the vertices do not have: no normal of their own, white.
  glVertexAttrib3f(kNormal, 0.0f, 0.0f, 0.0f);
  glVertexAttrib4f(kColour, 1.0f, 1.0f, 1.0f, 1.0f);
  for (const Batch& batch : batches_) {
    const Material& material = scene_.materials[batch.material];
    const gl::Program& program = has_holes(material) ? surface_with_holes_ : surface_;
    if (has_holes(material)) {
      set_view(program, view);
      set_opacity(program, batch.material, 2);
      program.set("u_seed", view.seed);
      program.set("u_first_pixel", view.first - view.step * view.origin);
      program.set("u_pixel_step", view.step);
    }
    program.set("u_reflectance", material.reflectance);
    program.set("u_emission", material.emission);
    program.set("u_double_sided", material.double_sided ? 1 : 0);
    program.set("u_vertex_colours", material.vertex_colours ? 1 : 0);
    if (textured_) {
      set_look_up(program, "u_reflectance_texture", "u_reflectance_look_up", 0,
                  material.reflectance_texture);
      set_look_up(program, "u_emission_texture", "u_emission_look_up", 1,
                  material.emission_texture);
    }
    draw_bodies(batch, view);
  }
  // Last, so that only what is seen of it is looked up.
  apply({.depth = DepthUse::kFillGaps}, view);
  sky_.set("u_far", far_depth(view));
  sky_.set("u_radiance", scene_.sky ? scene_.sky->radiance : Rgb(0.0f));
  if (has_sky_texture(scene_)) {
    const Vec2 origin(view.origin);
    sky_.set("u_corner", view.corner - view.step_x * origin.x - view.step_y * origin.y);
    sky_.set("u_step_x", view.step_x);
    sky_.set("u_step_y", view.step_y);
    set_look_up(sky_, "u_sky", "u_look_up", 0, scene_.sky->texture);
  }
  gl::draw_full_screen(no_vertices_);
  reset_draw_state();
  gl::check("drawing the surfaces");
}

}  // namespace lantern
