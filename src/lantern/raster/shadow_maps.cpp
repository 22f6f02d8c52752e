// SPDX-License-Identifier: MIT
#include "lantern/raster/shadow_maps.h"

#include "lantern/gl/check.h"
#include "lantern/raster/draw_state.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

namespace lantern {
namespace {

constexpr GLuint kFramesBinding = 1;
constexpr std::size_t kTexelBytes = 2 * sizeof(std::uint32_t);
constexpr int kMapsAcross = 4;  // as in shaders/shadow_maps.glsl

std::vector<std::uint32_t> all_triangles(const World& world) {
  std::vector<std::uint32_t> order(world.size());
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

gl::Buffer positions_of(const World& world, std::span<const std::uint32_t> order) {
  std::vector<Vec3> corners;
  corners.reserve(3 * order.size());
  for (const std::uint32_t t : order) {
    for (int i = 0; i < 3; ++i) corners.push_back(world.positions[world.triangles[t][i]]);
  }
  return gl::Buffer(std::span<const Vec3>(corners));
}

gl::Buffer numbers_of(std::span<const std::uint32_t> order) {
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * order.size());
  for (const std::uint32_t t : order) corners.insert(corners.end(), 3, t);
  return gl::Buffer(std::span<const std::uint32_t>(corners));
}

/// Of each triangle and edge (from its corner of this number to the next) a triangle that shares
/// it, by its number and 1; 0 where there is none.
std::vector<std::array<std::uint32_t, 3>> neighbours(const World& world) {
  struct Side {
    std::array<float, 6> edge;  // its ends, the smaller first
    std::uint32_t triangle;
    int corner;
  };
  std::vector<Side> sides;
  sides.reserve(3 * world.size());
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 a = world.positions[world.triangles[t][i]];
      const Vec3 b = world.positions[world.triangles[t][(i + 1) % 3]];
      const std::array<float, 3> from = {a.x, a.y, a.z}, to = {b.x, b.y, b.z};
      const auto [low, high] = std::minmax(from, to);
      sides.push_back({{low[0], low[1], low[2], high[0], high[1], high[2]}, t, i});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.edge, a.triangle, a.corner) < std::tie(b.edge, b.triangle, b.corner);
  });
  std::vector<std::array<std::uint32_t, 3>> result(world.size());
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t end = first + 1;
    while (end < sides.size() && sides[end].edge == sides[first].edge) ++end;
    for (std::size_t i = first; i < end; ++i) {
      const Side& next = sides[i + 1 < end ? i + 1 : first];
      if (next.triangle == sides[i].triangle) continue;
      result[sides[i].triangle][static_cast<std::size_t>(sides[i].corner)] = next.triangle + 1;
    }
    first = end;
  }
  return result;
}

/// The world's triangles as a texture: three texels each, in a picture that is about square.
gl::Texture triangle_texture(const World& world) {
  const std::vector<std::array<std::uint32_t, 3>> beyond = neighbours(world);
  const std::size_t texels = 3 * world.size();
  const auto root = static_cast<std::size_t>(std::sqrt(static_cast<double>(texels)));
  const std::size_t width = std::bit_ceil(root + 1);
  const std::size_t height = (texels + width - 1) / width;
  std::vector<float> rgba;
  rgba.reserve(4 * width * height);
  // Floats count no further.
  constexpr std::uint32_t kCounted = 1u << 24;
  for (std::size_t t = 0; t < world.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = world.positions[world.triangles[t][i]];
      const std::uint32_t next = beyond[t][static_cast<std::size_t>(i)];
      rgba.insert(rgba.end(), {p.x, p.y, p.z, next < kCounted ? static_cast<float>(next) : 0.0f});
    }
  }
  rgba.resize(4 * width * height);
  gl::Texture texture(gl::Format::kRgba32f, static_cast<int>(width), static_cast<int>(height));
  texture.write<float>(rgba);
  return texture;
}

int rows_of(const LightGroup& group) {
  return map_place(group.formula, group.records.size() - 1).tile / kMapsAcross + 1;
}

std::size_t bytes_of(const gl::Texture& texels) {
  return kTexelBytes * static_cast<std::size_t>(texels.width()) *
         static_cast<std::size_t>(texels.height());
}

}  // namespace

ShadowMaps::Unfinished::Unfinished(int width, int height)
    : texels(gl::Format::kRg32ui, width, height),
      depth(gl::Format::kDepth32f, width, height),
      framebuffer({&texels}, &depth) {}

ShadowMaps::ShadowMaps(const World& world, const gl::ShaderFiles& files,
                       const ShadowMapOptions& options)
    : bounds_(world.bounds),
      options_(options),
      triangles_program_(files, "shaders/shadow_map.vert.glsl", "shaders/shadow_map.frag.glsl",
                         {definition()}),
      blocks_program_(files, "shaders/full_screen.vert.glsl", "shaders/shadow_map_blocks.frag.glsl",
                      {definition()}),
      order_(all_triangles(world)),
      clusters_(make_clusters(world, order_)),
      positions_(positions_of(world, order_)),
      numbers_(numbers_of(order_)),
      indices_(std::span<const std::uint32_t>()),
      frames_(std::span<const MapFrame>()),
      array_({{.location = 0, .buffer = &positions_},
              {.location = 1, .buffer = &numbers_, .channels = 1, .integer = true}},
             &indices_),
      triangles_(triangle_texture(world)) {}

gl::Definition ShadowMaps::definition() const {
  return {"MAP_SIZE", std::to_string(options_.size)};
}

void ShadowMaps::prepare(const gl::Program& program) {
  program.set_block("LightMaps", kFramesBinding);
}

bool ShadowMaps::are_of(const Maps& maps, const LightGroup& group) const {
  return maps.formula == group.formula && maps.frames.size() == group.records.size() &&
         maps.frames == map_frames(group, bounds_, options_.size);
}

void ShadowMaps::keep(std::span<const LightGroup> groups) {
  std::erase_if(kept_, [&](const Maps& maps) {
    return std::none_of(groups.begin(), groups.end(),
                        [&](const LightGroup& group) { return are_of(maps, group); });
  });
}

/// Groups come round in the same order: of too many the one that was used last comes back last.
void ShadowMaps::make_room(std::size_t bytes) {
  for (const Maps& maps : kept_) bytes += bytes_of(maps.texels);
  while (bytes > options_.bytes && !kept_.empty()) {
    bytes -= bytes_of(kept_.back().texels);
    kept_.pop_back();
  }
}

void ShadowMaps::draw(const LightGroup& group, StageTimes& times) {
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const Maps& maps) { return are_of(maps, group); });
  if (found != kept_.end()) {
    kept_.splice(kept_.end(), kept_, found);
    return;
  }
  const int width = kMapsAcross * options_.size, height = rows_of(group) * options_.size;
  make_room(kTexelBytes * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  kept_.push_back({group.formula, map_frames(group, bounds_, options_.size),
                   gl::Texture(gl::Format::kRg32ui, width, height)});
  times.begin(Stage::kMaps);
  draw(kept_.back());
  times.end();
}

void ShadowMaps::draw(const Maps& maps) {
  const int width = maps.texels.width(), height = maps.texels.height();
  const Unfinished& unfinished = unfinished_.try_emplace(height, width, height).first->second;
  unfinished.framebuffer.bind();
  View view{};
  view.near_is_1 = options_.range == ClipRange::kFarIs0;
  apply({.depth = DepthUse::kDraw}, view);
  const GLuint nothing[4] = {};
  glClearBufferuiv(GL_COLOR, 0, nothing);
  const float far = far_depth(view);
  glClearBufferfv(GL_DEPTH, 0, &far);
  for (std::size_t i = 0; i < maps.frames.size(); ++i) draw_light(maps, i);
  drawn_ += maps.frames.size();
  reset_draw_state();

  const gl::Framebuffer finished({&maps.texels});
  finished.bind();
  blocks_program_.set("u_texels", 0, unfinished.texels);
  blocks_program_.set("u_halves", maps.formula == LightFormula::kSurface ? 1 : 0);
  gl::draw_full_screen(no_vertices_);
  gl::check("drawing shadow maps");
}

void ShadowMaps::draw_light(const Maps& maps, std::size_t light) {
  const MapPlace place = map_place(maps.formula, light);
  const std::vector<MapFace> faces = map_faces(maps.frames[light], maps.formula, place.half,
                                               bounds_, options_.size, options_.range);
  std::vector<std::uint32_t> indices;
  std::vector<std::size_t> ends;
  for (const MapFace& face : faces) {
    for (const Cluster& cluster : clusters_) {
      if (!may_lie_inside(cluster, face.origin, face.planes)) continue;
      const std::size_t first = indices.size();
      indices.resize(first + 3 * cluster.count);
      std::iota(indices.begin() + static_cast<std::ptrdiff_t>(first), indices.end(),
                3 * cluster.first);
    }
    ends.push_back(indices.size());
  }
  indices_.write(std::span<const std::uint32_t>(indices));
  array_.bind();
  const glm::ivec2 corner =
      glm::ivec2(place.tile % kMapsAcross, place.tile / kMapsAcross) * options_.size;
  triangles_program_.set("u_corner", corner);
  // Of two lights in a map neither has the diamond between them.
  triangles_program_.set("u_on", place.half == MapHalf::kWhole ? 0 : -1);
  std::size_t first = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const MapFace& face = faces[i];
    triangles_program_.set("u_origin", face.origin);
    triangles_program_.set("u_side", face.side);
    triangles_program_.set("u_clip", face.clip);
    triangles_program_.set("u_depth", face.depth);
    glViewport(corner.x + face.x, corner.y + face.y, face.size, face.size);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(ends[i] - first), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(first * sizeof(std::uint32_t)));
    first = ends[i];
  }
}

void ShadowMaps::set_in(const gl::Program& program, int unit) {
  const Maps& maps = kept_.back();
  std::array<MapFrame, kLightsInGroup> frames;
  std::copy(maps.frames.begin(), maps.frames.end(), frames.begin());
  frames_.write(std::span<const MapFrame>(frames));
  frames_.bind_as_uniforms(kFramesBinding);
  program.set("u_map_texels", unit, maps.texels);
  program.set("u_triangles", unit + 1, triangles_);
}

}  // namespace lantern
