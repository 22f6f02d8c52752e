// SPDX-License-Identifier: MIT
#include "lantern/raster/stencil_shadows.h"

#include "lantern/core/hash.h"
#include "lantern/core/parallel.h"
#include "lantern/gl/check.h"
#include "lantern/raster/draw_state.h"
#include "lantern/raster/raster_lights.h"

#include <array>
#include <cassert>

namespace lantern {
namespace {

/// Each vertex where it is and once more, for the shader to move to infinity.
std::vector<Vec3> doubled(const std::vector<Vec3>& vertices) {
  std::vector<Vec3> result;
  result.reserve(2 * vertices.size());
  for (const Vec3& v : vertices) result.insert(result.end(), 2, v);
  return result;
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

void append_quad(const VolumeEdge& edge, std::vector<std::uint32_t>& indices) {
  const std::uint32_t from = 2 * edge.from, to = 2 * edge.to;
  indices.insert(indices.end(), {to, from, from + 1, to, from + 1, to + 1});
}

/// The volumes' ends: the casters themselves and, at infinity, their shadows' far ends. `outward`:
/// those whose front is the volume's outside, else the others.
void append_caps(const EdgeList& list, const LightPoint& light, bool outward,
                 std::vector<std::uint32_t>& indices) {
  const std::vector<std::int8_t> facing = list.facing(light);
  for (std::size_t t = 0; t < facing.size(); ++t) {
    const uvec3 caster = list.casters()[t];
    const std::uint32_t far = (facing[t] > 0) == outward ? 0 : 1;
    indices.insert(indices.end(), {2 * caster.x + far, 2 * caster.y + far, 2 * caster.z + far});
  }
}

struct Range {
  std::size_t first = 0, count = 0;
};

void draw_indices(const Range& range) {
  if (range.count == 0) return;
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(range.first * sizeof(std::uint32_t)));
}

/// What is drawn of one light's volumes.
struct Pieces {
  Range quads, outward_caps, inward_caps;
};

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
      vertices_(std::span<const Vec3>(doubled(whole_.vertices()))),
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

StencilShadows::Prepared StencilShadows::prepare(const LightPoint& light, const Vec3& eye) const {
  const float scale = world_.coordinate_scale();
  // Closer to a quad's plane than this the eye may be on its other side for GL.
  const float clear = 0x1p-20f * scale;
  const VolumeCount count =
      method_ == VolumeMethod::kZFail ? VolumeCount::kPlain : VolumeCount::kHalved;
  constexpr std::uint64_t kAttempts = 8;
  Prepared result;
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    result.light = attempt == 0 ? light : nudged(light, scale, attempt);
    // From behind one meets also what is outside the walls; the classics know no walls.
    const bool inside = method_ == VolumeMethod::kExact && is_inside(walls_, result.light);
    result.list = inside ? &*inside_ : &whole_;
    result.volumes = result.list->volumes(result.light, eye, count);
    if (is_clear_of(*result.list, result.volumes, result.light, eye, clear)) break;
  }
  if (method_ == VolumeMethod::kZPass) {
    result.volumes.eye_count = 0;
    result.volumes.dark = false;
  }
  return result;
}

/// Light number `light` is seen where the stencil is `reference`.
void StencilShadows::take(std::size_t light, int reference, const View& view) const {
  Vec4 bit(0.0f);
  bit[static_cast<int>(light / 8)] = static_cast<float>(1 << (light % 8)) / 255.0f;
  apply({.stencil = StencilUse::kTake, .reference = reference, .add = true}, view);
  take_.set("u_value", bit);
  gl::draw_full_screen(no_vertices_);
}

void StencilShadows::draw(std::span<const LightPoint> lights, const View& view,
                          const gl::Framebuffer& framebuffer, StageTimes& times) {
  assert(lights.size() <= kLightsInGroup);
  const Vec3 eye = view.eye;
  choose_walls(eye);
  std::vector<Prepared> prepared(lights.size());
  parallel_for(lights.size(), 1, [&](std::size_t i) { prepared[i] = prepare(lights[i], eye); });

  std::vector<std::uint32_t> indices;
  std::vector<Pieces> pieces;
  const auto range = [&](const auto& append) {
    const std::size_t first = indices.size();
    append();
    return Range{first, indices.size() - first};
  };
  for (const Prepared& p : prepared) {
    Pieces& of_light = pieces.emplace_back();
    of_light.quads = range([&] {
      for (const VolumeEdge& edge : p.volumes.edges) append_quad(edge, indices);
    });
    if (method_ != VolumeMethod::kZFail) continue;
    of_light.outward_caps = range([&] { append_caps(*p.list, p.light, true, indices); });
    of_light.inward_caps = range([&] { append_caps(*p.list, p.light, false, indices); });
  }
  indices_.write(std::span<const std::uint32_t>(indices));

  times.begin(Stage::kVolumes);
  framebuffer.bind();
  reset_draw_state();
  const float none[4] = {};
  glClearBufferfv(GL_COLOR, 0, none);
  volume_.set("u_eye", eye);
  volume_.set("u_clip", view.clip);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (prepared[i].volumes.dark) continue;
    volume_.set("u_light", prepared[i].light);
    array_.bind();
    if (method_ == VolumeMethod::kZFail) {
      DrawState state = {
          .depth = DepthUse::kTest, .stencil = StencilUse::kCountHidden, .colour = false};
      apply(state, view);
      draw_indices(pieces[i].quads);
      draw_indices(pieces[i].outward_caps);
      state.swap_sides = true;
      apply(state, view);
      draw_indices(pieces[i].inward_caps);
      take(i, 0, view);
      continue;
    }
    apply({.depth = DepthUse::kTest,
           .stencil = StencilUse::kCountPassing,
           .colour = false,
           .depth_clamp = method_ == VolumeMethod::kExact},
          view);
    draw_indices(pieces[i].quads);
    // The count starts at 0, not at that of the eye: it is complete where it is the negative.
    constexpr int kStencilValues = 256;
    const int around_eye = prepared[i].volumes.eye_count % kStencilValues;
    take(i, (kStencilValues - around_eye) % kStencilValues, view);
  }
  reset_draw_state();
  times.end();
  gl::check("drawing shadow volumes");
}

void StencilShadows::draw_sides(const LightPoint& light, const View& view,
                                const gl::Framebuffer& framebuffer) {
  choose_walls(view.eye);
  const Prepared prepared = prepare(light, view.eye);
  std::vector<std::uint32_t> indices;
  for (const VolumeEdge& edge : prepared.volumes.edges) append_quad(edge, indices);
  indices_.write(std::span<const std::uint32_t>(indices));
  framebuffer.bind();
  reset_draw_state();
  const float none[4] = {};
  glClearBufferfv(GL_COLOR, 0, none);
  apply({.depth = DepthUse::kTest, .add = true, .depth_clamp = method_ == VolumeMethod::kExact},
        view);
  sides_.set("u_eye", view.eye);
  sides_.set("u_clip", view.clip);
  sides_.set("u_light", prepared.light);
  array_.bind();
  draw_indices({0, indices.size()});
  reset_draw_state();
  gl::check("drawing the sides of shadow volumes");
}

}  // namespace lantern
