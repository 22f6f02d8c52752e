// SPDX-License-Identifier: MIT
#include "lantern/raster/shadow_maps.h"

#include "lantern/core/hash.h"
#include "lantern/gl/check.h"
#include "lantern/raster/corner_buffer.h"
#include "lantern/raster/draw_state.h"
#include "lantern/raster/neighbours.h"
#include "lantern/raster/triangle_texture.h"
#include "lantern/scene/surface.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <numeric>
#include <string>
#include <utility>

namespace lantern {
namespace {

constexpr int kMapsAcross = 4;  // as in shaders/shadow_maps.glsl
constexpr int kMapLevels = 6;   // as in shaders/shadow_map.glsl

constexpr GLuint kPosition = 0, kNumber = 1, kPatch = 2, kTexcoord = 3, kColour = 4, kHeight = 5;

/// Each light's holes are its own.
std::uint32_t seed_of(const MapFrame& frame) {
  std::uint64_t seed = 0;
  for (const Vec4& row : {frame.x, frame.y, frame.z}) {
    for (int i = 0; i < 4; ++i) seed = hash(seed, std::bit_cast<std::uint32_t>(row[i]));
  }
  return static_cast<std::uint32_t>(seed);
}

gl::Program caster_program(const gl::ShaderFiles& files, bool holes) {
  return gl::Program(files, "shaders/shadow_map.vert.glsl", "shaders/shadow_map.frag.glsl",
                     {{"HOLES", holes ? "1" : "0"}});
}

int rows_of(const LightGroup& group) {
  return (static_cast<int>(group.records.size()) - 1) / kMapsAcross + 1;
}

/// What is not as wide as this many texels may lie between them all. (Of a triangle find_widths()
/// tells half its height.)
constexpr float kSlender = 3.0f;

/// The least width that texels do not miss, at a distance.
float slender_where_w_is_1(const MapFace& face) {
  const Mat4 rows = glm::transpose(face.clip);
  const float texels = std::min(glm::length(Vec3(rows[0])) * static_cast<float>(face.width),
                                glm::length(Vec3(rows[1])) * static_cast<float>(face.height));
  return kSlender * 2.0f / texels;
}

/// And where the cluster is furthest from the light.
float slender_at(const MapFace& face, const Cluster& cluster) {
  const Mat4 rows = glm::transpose(face.clip);
  const float w = glm::dot(Vec3(rows[3]), cluster.centre - face.origin) + rows[3].w;
  const float most = w + cluster.radius * glm::length(Vec3(rows[3]));
  return slender_where_w_is_1(face) * most;
}

/// So that edges lie behind the triangles that they are of.
std::vector<MapFace> behind(std::vector<MapFace> faces, ClipRange range) {
  constexpr float kBehind = 0x1p-10f;
  for (MapFace& face : faces) {
    Mat4 rows = glm::transpose(face.clip);
    if (range == ClipRange::kFarIs0) {
      rows[2] *= 1.0f - kBehind;
    } else {
      rows[2] += kBehind * (rows[3] - rows[2]);
    }
    face.clip = glm::transpose(rows);
  }
  return faces;
}

/// Of each triangle, for each of its corners.
gl::Buffer least_heights(const World& world, std::span<const std::uint32_t> order) {
  std::vector<float> heights;
  heights.reserve(3 * order.size());
  for (const std::uint32_t t : order) {
    float longest = 0.0f;
    for (int corner = 0; corner < 3; ++corner) {
      const uvec3 v = world.triangles[t];
      longest = std::max(
          longest, glm::distance(world.positions[v[corner]], world.positions[v[(corner + 1) % 3]]));
    }
    heights.insert(heights.end(), 3, 2.0f * world.area(t) / longest);
  }
  return gl::Buffer(std::span<const float>(heights));
}

/// A row for each.
gl::Texture frame_texture(std::span<const MapFrame> frames) {
  std::vector<float> channels;
  for (const MapFrame& frame : frames) {
    for (const Vec4& row : {frame.x, frame.y, frame.z}) {
      channels.insert(channels.end(), {row.x, row.y, row.z, row.w});
    }
  }
  gl::Texture texture(gl::Format::kRgba32f, 3, static_cast<int>(frames.size()));
  texture.write<float>(channels);
  return texture;
}

}  // namespace

ShadowMaps::Unfinished::Unfinished(int size)
    : texels(gl::Format::kRgba32ui, size, size),
      others(gl::Format::kRgba32ui, size, size),
      depth(gl::Format::kDepth32f, size, size),
      framebuffer({&texels}, &depth),
      framebuffer_of_others({&others}, &depth) {}

ShadowMaps::Casters ShadowMaps::casters_of(const Scene& scene, const World& world,
                                           MapCasters which) {
  const auto material = [&](std::uint32_t t) { return index(world.materials[t]); };
  const auto holes = [&](std::uint32_t t) { return has_holes(scene.materials[material(t)]); };
  const std::vector<Vec4> walls = find_walls(world);
  // Solid ones first, then those of each wall, then those of each material.
  std::vector<std::size_t> batch_of(world.size());
  Casters casters;
  for (std::uint32_t t = 0; t < world.size(); ++t) {
    if (holes(t) != (which == MapCasters::kWithHoles)) continue;
    casters.order.push_back(t);
    const std::optional<std::size_t> wall = wall_of(world, t, walls);
    batch_of[t] = holes(t) ? 1 + walls.size() + material(t) : wall ? 1 + *wall : 0;
  }
  std::stable_sort(casters.order.begin(), casters.order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return batch_of[a] < batch_of[b]; });
  for (std::size_t first = 0; first < casters.order.size();) {
    const std::size_t batch = batch_of[casters.order[first]];
    std::size_t end = first;
    while (end < casters.order.size() && batch_of[casters.order[end]] == batch) ++end;
    Batch& added = casters.batches.emplace_back();
    if (batch > walls.size()) {
      added.material_with_holes = batch - 1 - walls.size();
      added.is_veil = even_coverage(scene.materials[*added.material_with_holes]).has_value();
    } else if (batch > 0) {
      added.wall = walls[batch - 1];
    }
    added.clusters = make_clusters(world, std::span(casters.order).subspan(first, end - first),
                                   static_cast<std::uint32_t>(first));
    first = end;
  }
  return casters;
}

std::size_t ShadowMaps::Maps::bytes() const {
  return kMapTexelBytes * static_cast<std::size_t>(numbers.width()) *
         static_cast<std::size_t>(numbers.height());
}

ShadowMaps::ShadowMaps(const Scene& scene, const World& world, const Surfaces& surfaces,
                       const gl::ShaderFiles& files, const ShadowMapOptions& options)
    : triangles_(scene, world),
      bounds_(world.bounds),
      options_(options),
      surfaces_(surfaces),
      solid_(caster_program(files, false)),
      with_holes_(caster_program(files, true)),
      blocks_(files, "shaders/full_screen.vert.glsl", "shaders/shadow_map_blocks.frag.glsl"),
      windows_(files, "shaders/full_screen.vert.glsl", "shaders/shadow_map_windows.frag.glsl"),
      casters_(casters_of(scene, world, options.casters)),
      size_(options.size.value_or(octahedron_size(casters_.order.size()))),
      indices_(std::span<const std::uint32_t>()),
      array_({}, &indices_) {
  assert(size_ % 128 == 0);
  find_widths(world);
  find_bodies(scene, world);
  attributes_.reserve(6);
  const auto add = [&](gl::Buffer buffer, GLuint location, int channels, bool integer = false) {
    attributes_.push_back(std::move(buffer));
    array_.add({location, &attributes_.back(), channels, integer});
  };
  add(by_corner(world, casters_.order, world.positions), kPosition, 3);
  std::vector<std::uint32_t> numbers(world.size());
  const ConvexPatches& patches = triangles_.patches;
  for (std::uint32_t i = 0; i < world.size(); ++i) numbers[patches.order[i]] = i;
  add(for_corners(casters_.order, [&](std::uint32_t t) { return numbers[t]; }), kNumber, 1, true);
  add(for_corners(casters_.order,
                  [&](std::uint32_t t) { return patches.patches[patches.patch_of[t]].first + 1; }),
      kPatch, 1, true);
  const bool any_holes =
      std::any_of(casters_.batches.begin(), casters_.batches.end(),
                  [](const Batch& batch) { return batch.material_with_holes.has_value(); });
  if (!any_holes) return;
  add(least_heights(world, casters_.order), kHeight, 1);
  if (!world.texcoords.empty()) {
    add(by_corner(world, casters_.order, world.texcoords), kTexcoord, 2);
  }
  if (!world.colours.empty()) add(by_corner(world, casters_.order, world.colours), kColour, 4);
}

/// Of the most slender patch of each cluster, by its area and its length. Of what is not flat a
/// quarter of the surface is seen from a side, on average.
void ShadowMaps::find_widths(const World& world) {
  const ConvexPatches& patches = triangles_.patches;
  std::vector<float> widths;
  for (const ConvexPatches::Patch& patch : patches.patches) {
    const auto members = std::span(patches.order).subspan(patch.first, patch.count);
    float area = 0.0f;
    Bounds bounds;
    for (const std::uint32_t t : members) {
      area += world.area(t);
      for (int corner = 0; corner < 3; ++corner) {
        bounds.add(world.positions[world.triangles[t][corner]]);
      }
    }
    const bool is_flat = patches.sides[members.front()] == (kFrontIsOutside | kBackIsOutside);
    widths.push_back((is_flat ? 1.0f : 0.25f) * area / std::max(2.0f * bounds.radius(), 1e-30f));
  }
  for (Batch& batch : casters_.batches) {
    for (const Cluster& cluster : batch.clusters) {
      float least = kInfinity;
      for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
        least = std::min(least, widths[patches.patch_of[casters_.order[i]]]);
      }
      batch.widths.push_back(least);
    }
  }
}

void ShadowMaps::find_bodies(const Scene& scene, const World& world) {
  const auto neighbours = find_neighbours(scene, world);
  std::vector<std::uint32_t> triangles = casters_.order;
  casters_.bodies = make_bodies(world, neighbours, find_parts(neighbours), triangles);
  std::vector<std::uint32_t> of_triangle(world.size(), 0);
  for (std::uint32_t b = 0; b < casters_.bodies.size(); ++b) {
    const Body& body = casters_.bodies[b];
    for (const std::uint32_t t : std::span(triangles).subspan(body.first, body.count)) {
      of_triangle[t] = b;
    }
  }
  for (const std::uint32_t t : casters_.order) {
    casters_.body_of.push_back(of_triangle[t]);
    const bool is_front = casters_.bodies[of_triangle[t]].outside == SeenSide::kFront;
    const Vec3 normal = glm::normalize(is_front ? world.area_vector(t) : -world.area_vector(t));
    const Vec3 corner = world.positions[world.triangles[t].x];
    casters_.planes.emplace_back(normal, -glm::dot(normal, corner));
  }
}

bool ShadowMaps::is_turned_away(const Cluster& cluster, const LightPoint& light) const {
  // What is seen along its plane is not left out for a rounding.
  const float rounding = 1e-5f * (light.w != 0.0f ? bounds_.radius() : 1.0f);
  for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
    const Body& body = casters_.bodies[casters_.body_of[i]];
    const SeenSide side = light.w != 0.0f ? seen_side(body, Vec3(light)) : body.outside;
    if (side == SeenSide::kBoth || glm::dot(casters_.planes[i], light) > -rounding) return false;
  }
  return true;
}

int ShadowMaps::size_of(LightFormula formula) const {
  // Most holes have the edges of texels at any size.
  constexpr int kHolesFromInfinity = 512;
  const bool holes = options_.casters == MapCasters::kWithHoles;
  if (holes && formula == LightFormula::kDirectional) return kHolesFromInfinity;
  return map_size(formula, size_);
}

bool ShadowMaps::are_of(const Maps& maps, const LightGroup& group) {
  const auto same_place = [](const LightRecord& a, const LightRecord& b) {
    return Vec3(a.place) == Vec3(b.place) && Vec3(a.axis) == Vec3(b.axis);
  };
  return maps.formula == group.formula &&
         std::equal(maps.lights.begin(), maps.lights.end(), group.records.begin(),
                    group.records.end(), same_place);
}

void ShadowMaps::keep(std::span<const LightGroup> groups) {
  std::erase_if(kept_, [&](const Maps& maps) {
    return std::none_of(groups.begin(), groups.end(),
                        [&](const LightGroup& group) { return are_of(maps, group); });
  });
}

/// Groups come round in the same order: of too many the one that was used last comes back last.
void ShadowMaps::make_room(std::size_t bytes) {
  for (const Maps& maps : kept_) bytes += maps.bytes();
  while (bytes > options_.bytes && !kept_.empty()) {
    bytes -= kept_.back().bytes();
    kept_.pop_back();
  }
}

void ShadowMaps::draw(const LightGroup& group, const Bounds& receivers, StageTimes& times) {
  const Bounds box = snapped(receivers, bounds_);
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const Maps& maps) { return are_of(maps, group); });
  if (found != kept_.end() && still_fits(found->receivers, box, bounds_)) {
    kept_.splice(kept_.end(), kept_, found);
    return;
  }
  if (found != kept_.end()) kept_.erase(found);  // of another place
  const int size = size_of(group.formula);
  const int width = kMapsAcross * size, height = rows_of(group) * size;
  make_room(kMapTexelBytes * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::vector<MapFrame> frames = map_frames(group, {.scene = bounds_, .receivers = box}, size);
  gl::Texture frame_texels = frame_texture(frames);
  kept_.push_back({group.formula, group.records, group.points, box, std::move(frames),
                   std::move(frame_texels),
                   gl::Texture(gl::Format::kRg32ui, width + width / 2, height),
                   gl::Texture(gl::Format::kRg32ui, width, height)});
  times.begin(Stage::kMaps);
  draw(kept_.back());
  times.end();
}

void ShadowMaps::draw(const Maps& maps) {
  const int size = size_of(maps.formula);
  const Unfinished& unfinished = unfinished_.try_emplace(size, size).first->second;
  const gl::Framebuffer finished({&maps.blocks, &maps.numbers});
  for (std::size_t light = 0; light < maps.frames.size(); ++light) {
    draw_light(maps, light, unfinished);
    reset_draw_state();
    finished.bind();
    const int place = static_cast<int>(light);
    const glm::ivec2 first = size * glm::ivec2(place % kMapsAcross, place / kMapsAcross);
    glViewport(first.x, first.y, size, size);
    blocks_.set("u_texels", 0, unfinished.texels);
    blocks_.set("u_others", 1, unfinished.others);
    blocks_.set("u_map_size", size);
    blocks_.set("u_first", first);
    gl::draw_full_screen(no_vertices_);
  }
  drawn_ += maps.frames.size();
  draw_windows(maps);
  gl::check("drawing shadow maps");
}

/// Each level by the one before, and from there to its place beside the blocks.
void ShadowMaps::draw_windows(const Maps& maps) {
  std::optional<gl::Texture> before;
  int width = maps.numbers.width(), height = maps.numbers.height(), y = 0;
  for (int level = 1; level < kMapLevels; ++level) {
    width /= 2, height /= 2;
    gl::Texture windows(gl::Format::kRg32ui, width, height);
    const gl::Framebuffer framebuffer({&windows});
    framebuffer.bind();
    windows_.set("u_windows", 0, before ? *before : maps.blocks);
    gl::draw_full_screen(no_vertices_);
    maps.blocks.bind(0);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glCopyTexSubImage2D(GL_TEXTURE_2D, 0, maps.numbers.width(), y, 0, 0, width, height);
    y += height;
    before = std::move(windows);
  }
}

void ShadowMaps::draw_light(const Maps& maps, std::size_t light, const Unfinished& unfinished) {
  const std::vector<MapFace> faces =
      map_faces(maps.frames[light], maps.formula, bounds_, size_of(maps.formula), options_.range);
  Drawn triangles{.mode = GL_TRIANGLES, .faces = faces};
  Drawn edges{.mode = GL_LINES, .faces = behind(faces, options_.range)};
  const LightPoint& point = maps.points[light];
  for (const Batch& batch : casters_.batches) {
    const bool none = batch.wall && is_inside(std::span(&*batch.wall, 1), point);
    std::vector<std::size_t> seen;
    for (std::size_t i = 0; i < batch.clusters.size() && !none; ++i) {
      if (!is_turned_away(batch.clusters[i], point)) seen.push_back(i);
    }
    for (const MapFace& face : faces) {
      for (const std::size_t i : seen) {
        const Cluster& cluster = batch.clusters[i];
        if (!may_lie_inside(cluster, face.origin, face.planes)) continue;
        const std::uint32_t end = 3 * (cluster.first + cluster.count);
        for (std::uint32_t v = 3 * cluster.first; v < end; ++v) triangles.indices.push_back(v);
        if (batch.material_with_holes || batch.widths[i] > slender_at(face, cluster)) continue;
        for (std::uint32_t v = 3 * cluster.first; v < end; v += 3) {
          edges.indices.insert(edges.indices.end(), {v, v + 1, v + 1, v + 2, v + 2, v});
        }
      }
      triangles.ends.push_back(triangles.indices.size());
      edges.ends.push_back(edges.indices.size());
    }
  }
  View view{};
  view.near_is_1 = options_.range == ClipRange::kFarIs0;
  const GLuint nothing[4] = {};
  const float far = far_depth(view);
  apply({.depth = DepthUse::kDraw}, view);
  unfinished.framebuffer.bind();
  glClearBufferuiv(GL_COLOR, 0, nothing);
  glClearBufferfv(GL_DEPTH, 0, &far);
  draw_batches(maps, light, triangles);
  unfinished.framebuffer_of_others.bind();
  glClearBufferuiv(GL_COLOR, 0, nothing);
  if (!edges.indices.empty()) draw_batches(maps, light, edges);
  const bool any_veil = std::any_of(casters_.batches.begin(), casters_.batches.end(),
                                    [](const Batch& batch) { return batch.is_veil; });
  if (!any_veil) return;
  glClearBufferfv(GL_DEPTH, 0, &far);
  triangles.before = &unfinished.texels;
  draw_batches(maps, light, triangles);
}

void ShadowMaps::draw_batches(const Maps& maps, std::size_t light, const Drawn& drawn) {
  indices_.write(std::span<const std::uint32_t>(drawn.indices));
  array_.bind();
  glVertexAttrib4f(kColour, 1.0f, 1.0f, 1.0f, 1.0f);
  std::size_t first = 0, part = 0;
  for (const Batch& batch : casters_.batches) {
    const gl::Program& program = batch.material_with_holes ? with_holes_ : solid_;
    if (batch.material_with_holes) {
      surfaces_.set_opacity(program, *batch.material_with_holes, 0);
      program.set("u_seed", seed_of(maps.frames[light]));
      program.set("u_is_veil", batch.is_veil ? 1 : 0);
      program.set("u_is_behind", drawn.before ? 1 : 0);
      program.set("u_before", 1, drawn.before ? *drawn.before : maps.numbers);
    }
    program.set("u_map_size", size_of(maps.formula));
    for (const MapFace& face : drawn.faces) {
      const std::size_t end = drawn.ends[part++];
      if (end == first) continue;
      program.set("u_origin", face.origin);
      program.set("u_edges[0]", face.edges[0]);
      program.set("u_edges[1]", face.edges[1]);
      program.set("u_clip", face.clip);
      program.set("u_depth", face.depth);
      if (batch.material_with_holes) program.set("u_slender", slender_where_w_is_1(face));
      glViewport(face.x, face.y, face.width, face.height);
      glDrawElements(drawn.mode, static_cast<GLsizei>(end - first), GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(first * sizeof(std::uint32_t)));
      first = end;
    }
  }
}

void ShadowMaps::set_in(const gl::Program& program, int unit) const {
  const Maps& maps = kept_.back();
  program.set("u_map_size", size_of(maps.formula));
  program.set("u_map_frames", unit, maps.frame_texels);
}

}  // namespace lantern
