// SPDX-License-Identifier: MIT
#include "lantern/raster/stencil_shadows.h"

#include "lantern/core/hash.h"
#include "lantern/core/parallel.h"
#include "lantern/gl/check.h"
#include "lantern/raster/draw_state.h"
#include "lantern/raster/raster_lights.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace lantern {
namespace {

/// Which of a vertex's three one is: see shaders/shadow_volume.vert.glsl.
enum class Place : std::uint32_t { kHere, kAtBox, kAtInfinity };
constexpr std::uint32_t kPlaces = 3;
constexpr int kStencilValues = 256;

std::uint32_t vertex_at(std::uint32_t vertex, Place place) {
  return kPlaces * vertex + static_cast<std::uint32_t>(place);
}

/// Once for each place, and at the end the corners of the screen.
std::vector<Vec3> drawn_vertices(const std::vector<Vec3>& vertices) {
  std::vector<Vec3> result;
  result.reserve(kPlaces * vertices.size() + 4);
  for (const Vec3& v : vertices) result.insert(result.end(), kPlaces, v);
  for (const float y : {-1.0f, 1.0f}) {
    for (const float x : {-1.0f, 1.0f}) result.emplace_back(x, y, 0.0f);
  }
  return result;
}

/// Encloses all that is seen, and the ways to it.
Bounds box_around(const World& world, const Vec3& eye) {
  Bounds box = world.bounds;
  box.add(eye);
  const float margin = 1e-3f * box.radius();
  box.low -= margin;
  box.high += margin;
  return box;
}

/// By which of its six sides the ray from the light through the vertex leaves the box.
int exit_side(const Vec3& vertex, const LightPoint& light, const Bounds& box) {
  const Vec3 way = light.w * vertex - Vec3(light);
  int nearest = 0;
  float least = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const float room =
        way[axis] > 0.0f ? box.high[axis] - vertex[axis] : vertex[axis] - box.low[axis];
    const float steps = room / std::max(std::abs(way[axis]), 1e-30f);
    if (steps < least) {
      least = steps;
      nearest = 2 * axis + (way[axis] > 0.0f ? 1 : 0);
    }
  }
  return nearest;
}

/// Moves a light by less than half of what keeps it off its surface, each time elsewhere.
LightPoint nudged(const LightPoint& light, float scale, std::uint64_t attempt) {
  constexpr float kSmall = 0x1p-20f;
  Vec3 way;
  for (int axis = 0; axis < 3; ++axis) {
    way[axis] = 2.0f * to_unit_float(hash(attempt, static_cast<std::uint64_t>(axis))) - 1.0f;
  }
  const float length = light.w != 0.0f ? scale : 1.0f;
  return light + Vec4(way * (kSmall * length), 0.0f);
}

void append_quad(const VolumeEdge& edge, Place start, Place end,
                 std::vector<std::uint32_t>& indices) {
  const std::uint32_t from = vertex_at(edge.from, start), to = vertex_at(edge.to, start);
  const std::uint32_t far_from = vertex_at(edge.from, end), far_to = vertex_at(edge.to, end);
  indices.insert(indices.end(), {to, from, far_from, to, far_from, far_to});
}

/// The part that is in the box. Between ends on two of its sides is a corner of it.
void append_quad_in_box(const VolumeEdge& edge, bool has_corner,
                        std::vector<std::uint32_t>& indices) {
  append_quad(edge, Place::kHere, Place::kAtBox, indices);
  if (has_corner) append_quad(edge, Place::kAtBox, Place::kAtInfinity, indices);
}

/// Fronts that cover the screen, or backs if there are less than none of them.
void append_covers(const EdgeList& list, int count, std::vector<std::uint32_t>& indices) {
  const auto corner = static_cast<std::uint32_t>(kPlaces * list.vertices().size());
  for (; count > 0; --count) {
    indices.insert(indices.end(), {corner, corner + 2, corner + 1});
    indices.insert(indices.end(), {corner + 1, corner + 2, corner + 3});
  }
  for (; count < 0; ++count) {
    indices.insert(indices.end(), {corner, corner + 1, corner + 2});
    indices.insert(indices.end(), {corner + 1, corner + 3, corner + 2});
  }
}

/// The volumes' ends: the casters themselves and, at infinity, their shadows' far ends. `outward`:
/// those whose front is the volume's outside, else the others.
void append_caps(const EdgeList& list, const LightPoint& light, bool outward,
                 std::vector<std::uint32_t>& indices) {
  const std::vector<std::int8_t> facing = list.facing(light);
  for (std::size_t t = 0; t < facing.size(); ++t) {
    const uvec3 caster = list.casters()[t];
    const Place place = (facing[t] > 0) == outward ? Place::kHere : Place::kAtInfinity;
    for (int corner = 0; corner < 3; ++corner) {
      indices.push_back(vertex_at(caster[corner], place));
    }
  }
}

void draw_indices(const IndexRange& range) {
  if (range.count == 0) return;
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(range.first * sizeof(std::uint32_t)));
}

}  // namespace

StencilShadows::StencilShadows(const World& world, const gl::ShaderFiles& files,
                               VolumeMethod method, const World* casters)
    : world_(world),
      casters_(casters ? *casters : world),
      method_(method),
      volume_(files, "shaders/shadow_volume.vert.glsl", "shaders/nothing.frag.glsl"),
      sides_(files, "shaders/shadow_volume.vert.glsl", "shaders/volume_sides.frag.glsl"),
      take_(files, "shaders/full_screen.vert.glsl", "shaders/constant.frag.glsl"),
      all_walls_(find_walls(world)),
      whole_(casters_),
      vertices_(std::span<const Vec3>(drawn_vertices(whole_.vertices()))),
      indices_(std::span<const std::uint32_t>()),
      array_({{.location = 0, .buffer = &vertices_}}, &indices_) {}

void StencilShadows::choose_walls(const Vec3& eye) {
  std::vector<Vec4> walls;
  for (const Vec4& wall : all_walls_) {
    if (is_inside(std::span(&wall, 1), Vec4(eye, 1.0f))) walls.push_back(wall);
  }
  if (inside_ && walls == walls_) return;
  walls_ = std::move(walls);
  inside_.emplace(casters_, walls_);
}

void StencilShadows::find_volumes(Prepared& prepared) const {
  const Vec3 eye = prepared.view->eye;
  const LightPoint light = prepared.light;
  const float scale = world_.coordinate_scale();
  // Closer to a quad's plane than this the eye may be on its other side for GL.
  const float clear = 0x1p-20f * scale;
  const VolumeCount count =
      method_ == VolumeMethod::kZFail ? VolumeCount::kPlain : VolumeCount::kHalved;
  std::vector<Vec4> region;
  float slack = 0.0f;
  if (method_ == VolumeMethod::kExact) {
    slack = prepared.slack * glm::length(prepared.view->step_x);
    region = sides_of(*prepared.view);
    if (prepared.front) region.push_back(*prepared.front);
  }
  constexpr std::uint64_t kAttempts = 8;
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    if (attempt > 0) prepared.light = nudged(light, scale, attempt);
    // From behind one meets also what is outside the walls; the classics know no walls.
    const bool inside = method_ == VolumeMethod::kExact && is_inside(walls_, prepared.light);
    prepared.list = inside ? &*inside_ : &whole_;
    prepared.volumes = prepared.list->volumes(prepared.light, eye, count, region, slack);
    if (is_clear_of(*prepared.list, prepared.volumes, prepared.light, eye, clear)) break;
  }
  if (method_ == VolumeMethod::kZPass) {
    prepared.volumes.eye_count = 0;
    prepared.volumes.dark = false;
  }
}

/// What the stencil is where this light is seen, had it been 0.
int StencilShadows::complete_count(const Prepared& prepared) const {
  // It starts at 0, not at the count of the eye.
  return method_ == VolumeMethod::kZFail ? 0 : -prepared.volumes.eye_count;
}

/// The light of this number is seen where the stencil is `reference`.
void StencilShadows::take(std::size_t number, int reference, const View& view) const {
  Vec4 bit(0.0f);
  bit[static_cast<int>(number / 8)] = static_cast<float>(1 << (number % 8)) / 255.0f;
  apply({.stencil = StencilUse::kTake, .reference = reference & (kStencilValues - 1), .add = true},
        view);
  take_.set("u_value", bit);
  gl::draw_full_screen(no_vertices_);
}

/// Counts a light's volumes in the stencil.
void StencilShadows::count(const Prepared& prepared, const View& view) const {
  volume_.set("u_light", prepared.light);
  DrawState state = {.depth = DepthUse::kTest,
                     .stencil = StencilUse::kCountPassing,
                     .colour = false,
                     .depth_clamp = method_ == VolumeMethod::kExact};
  if (method_ == VolumeMethod::kZFail) state.stencil = StencilUse::kCountHidden;
  apply(state, view);
  draw_indices(prepared.quads);
  if (method_ != VolumeMethod::kZFail) return;
  draw_indices(prepared.outward_caps);
  state.swap_sides = true;
  apply(state, view);
  draw_indices(prepared.inward_caps);
}

std::vector<StencilShadows::Prepared> StencilShadows::prepare(std::span<const LightsInView> views) {
  std::vector<Prepared> prepared;
  std::size_t most = 0;
  for (const LightsInView& of_view : views) most = std::max(most, of_view.lights.size());
  assert(most <= kLightsInGroup);
  for (std::size_t number = 0; number < most; ++number) {
    for (const LightsInView& of_view : views) {
      if (number >= of_view.lights.size()) continue;
      Prepared& p = prepared.emplace_back();
      p.light = of_view.lights[number];
      if (!of_view.fronts.empty()) p.front = of_view.fronts[number];
      p.number = number;
      p.view = &of_view.view;
      p.slack = of_view.slack;
    }
  }
  parallel_for(prepared.size(), 1, [&](std::size_t i) { find_volumes(prepared[i]); });
  return prepared;
}

/// Lights whose indices are in memory at once: a group's, but all of one number.
std::size_t StencilShadows::size_of_batch(std::span<const Prepared> prepared) {
  std::size_t end = std::min(prepared.size(), kLightsInGroup);
  while (end < prepared.size() && prepared[end].number == prepared[end - 1].number) ++end;
  return end;
}

/// The triangles to draw of each light: its volumes and so many that cover its view that where the
/// light is seen the stencil becomes what it does for the first of the same number.
void StencilShadows::write_indices(std::span<Prepared> prepared, const Bounds& box) {
  std::vector<std::uint32_t> indices;
  const auto range = [&](const auto& append) {
    const std::size_t first = indices.size();
    append();
    return IndexRange{first, indices.size() - first};
  };
  int reference = 0;
  for (Prepared& p : prepared) {
    if (&p == prepared.data() || p.number != (&p - 1)->number) reference = complete_count(p);
    p.reference = reference;
    p.quads = range([&] {
      if (p.volumes.dark) {
        append_covers(whole_, reference + 1, indices);
        return;
      }
      append_covers(whole_, reference - complete_count(p), indices);
      for (const VolumeEdge& edge : p.volumes.edges) {
        if (method_ != VolumeMethod::kExact) {
          append_quad(edge, Place::kHere, Place::kAtInfinity, indices);
          continue;
        }
        const auto side = [&](std::uint32_t vertex) {
          return exit_side(whole_.vertices()[vertex], p.light, box);
        };
        append_quad_in_box(edge, side(edge.from) != side(edge.to), indices);
      }
    });
    if (method_ != VolumeMethod::kZFail) continue;
    assert(!p.volumes.dark &&
           complete_count(p) == 0);  // nothing covers what is counted from behind
    p.outward_caps = range([&] { append_caps(*p.list, p.light, true, indices); });
    p.inward_caps = range([&] { append_caps(*p.list, p.light, false, indices); });
  }
  indices_.write(std::span<const std::uint32_t>(indices));
}

void StencilShadows::draw(std::span<const LightsInView> views, const gl::Framebuffer& framebuffer,
                          StageTimes& times) {
  const View& any_view = views.front().view;
  choose_walls(any_view.eye);
  std::vector<Prepared> prepared = prepare(views);
  const Bounds box = box_around(world_, any_view.eye);

  times.begin(Stage::kVolumes);
  framebuffer.bind();
  reset_draw_state();
  const float none[4] = {};
  glClearBufferfv(GL_COLOR, 0, none);
  volume_.set("u_eye", any_view.eye);
  volume_.set("u_low", box.low);
  volume_.set("u_high", box.high);
  volume_.set("u_corners", static_cast<int>(kPlaces * whole_.vertices().size()));
  volume_.set("u_cover", near_z(any_view));
  for (std::span<Prepared> left = prepared; !left.empty();) {
    const std::span<Prepared> batch = left.first(size_of_batch(left));
    left = left.subspan(batch.size());
    write_indices(batch, box);
    for (const Prepared& p : batch) {
      volume_.set("u_clip", p.view->clip);
      array_.bind();
      set_viewport(*p.view);
      count(p, *p.view);
      if (&p != &batch.back() && (&p + 1)->number == p.number) continue;
      framebuffer.bind();
      take(p.number, p.reference, *p.view);
    }
  }
  reset_draw_state();
  times.end();
  gl::check("drawing shadow volumes");
}

void StencilShadows::draw_sides(const LightPoint& light, const View& view,
                                const gl::Framebuffer& framebuffer) {
  choose_walls(view.eye);
  const LightsInView only{view, std::span(&light, 1)};
  const Prepared prepared = prepare(std::span(&only, 1)).front();
  std::vector<std::uint32_t> indices;
  for (const VolumeEdge& edge : prepared.volumes.edges) {
    append_quad(edge, Place::kHere, Place::kAtInfinity, indices);
  }
  indices_.write(std::span<const std::uint32_t>(indices));
  framebuffer.bind();
  reset_draw_state();
  const float none[4] = {};
  glClearBufferfv(GL_COLOR, 0, none);
  apply({.depth = DepthUse::kTest, .add = true, .depth_clamp = method_ == VolumeMethod::kExact},
        view);
  sides_.set("u_eye", view.eye);
  sides_.set("u_low", Vec3(0.0f));
  sides_.set("u_high", Vec3(0.0f));
  sides_.set("u_corners", std::numeric_limits<int>::max());
  sides_.set("u_cover", 0.0f);
  sides_.set("u_clip", view.clip);
  sides_.set("u_light", prepared.light);
  array_.bind();
  draw_indices({0, indices.size()});
  reset_draw_state();
  gl::check("drawing the sides of shadow volumes");
}

}  // namespace lantern
