// SPDX-License-Identifier: MIT
#include "lantern/raster/map_faces.h"

#include <glm/gtc/constants.hpp>

namespace lantern {
namespace {

/// Least and largest of dot(axis, p) over the box.
Vec2 extent(const Vec3& axis, const Bounds& box) {
  const Vec3 a = axis * box.low, b = axis * box.high;
  const Vec3 low = glm::min(a, b), high = glm::max(a, b);
  return {low.x + low.y + low.z, high.x + high.y + high.z};
}

float grid_step(const Bounds& scene) {
  constexpr float kSteps = 32.0f;
  const Vec3 size = scene.high - scene.low;
  return std::max(size.x, std::max(size.y, size.z)) / kSteps;
}

MapFrame parallel_frame(const Vec3& travel, const MapBounds& bounds, int size) {
  const Frame frame(travel);
  // A texel at each side stays empty.
  const float used = 1.0f - 2.0f / static_cast<float>(size);
  const auto to_map = [&](const Vec3& axis) {
    const Vec2 all = extent(axis, bounds.receivers);
    const float scale = 2.0f * used / std::max(all.y - all.x, 1e-3f * bounds.scene.radius());
    return Vec4(axis * scale, -0.5f * (all.x + all.y) * scale);
  };
  return {to_map(frame.tangent), to_map(frame.bitangent),
          Vec4(travel, -extent(travel, bounds.scene).x)};
}

/// Rows of a clip matrix whose depth is w's, as View has it.
Mat4 clip_matrix(const Vec3& x, const Vec3& y, const Vec3& w, float radius, ClipRange range) {
  const bool near_is_1 = range == ClipRange::kFarIs0;
  const float near = radius * (near_is_1 ? 1e-6f : 1e-4f);
  const Vec4 depth = near_is_1 ? Vec4(0.0f, 0.0f, 0.0f, near) : Vec4(w, -2.0f * near);
  return glm::transpose(Mat4(Vec4(x, 0.0f), Vec4(y, 0.0f), depth, Vec4(w, 0.0f)));
}

/// The face of an octahedron where the coordinates have these signs: |x| + |y| + |z| is linear in
/// it, and what is divided by that is its picture.
MapFace octant(const MapFrame& frame, const Vec3& sign, float radius, int size, ClipRange range) {
  const Vec3 x = Vec3(frame.x) * sign.x, y = Vec3(frame.y) * sign.y, z = Vec3(frame.z) * sign.z;
  const Vec3 w = x + y + z;
  MapFace face;
  face.width = face.height = size / 2;
  face.x = sign.x > 0.0f ? face.width : 0;
  face.y = sign.y > 0.0f ? face.height : 0;
  face.edges[0] = sign.z * Vec3(-sign.x, -sign.y, 1.0f);
  face.origin = Vec3(frame.x.w, frame.y.w, frame.z.w);
  // From the map's middle lines outwards, 0 to 1; the lower half is folded out.
  const Vec3 a = sign.z > 0.0f ? x : w - y;
  const Vec3 b = sign.z > 0.0f ? y : w - x;
  face.clip = clip_matrix(sign.x * (2.0f * a - w), sign.y * (2.0f * b - w), w, radius, range);
  face.depth = w;
  face.planes = {Vec4(x, 0.0f), Vec4(y, 0.0f), Vec4(z, 0.0f)};
  return face;
}

/// The face of half an octahedron, turned by an eighth, between the map's middle and its side in
/// the direction `x`, of which `y` is across.
MapFace quarter(const MapFrame& frame, const glm::ivec2& x, float radius, int size,
                ClipRange range) {
  const Vec2 to_side(x), across(-x.y, x.x);
  const auto of_light = [&](const Vec2& v) { return v.x * Vec3(frame.x) + v.y * Vec3(frame.y); };
  const Vec3 side = of_light(to_side), z = Vec3(frame.z);
  const Vec3 w = side + z;
  MapFace face;
  const int half = size / 2;
  face.width = x.x != 0 ? half : size;
  face.height = x.y != 0 ? half : size;
  face.x = x.x > 0 ? half : 0;
  face.y = x.y > 0 ? half : 0;
  face.edges = {Vec3(to_side - across, 0.0f), Vec3(to_side + across, 0.0f)};
  face.origin = Vec3(frame.x.w, frame.y.w, frame.z.w);
  // From the middle to the side, or from side to side.
  const auto clip = [&](const Vec3& v, int sign) {
    return sign == 0 ? v : 2.0f * v - static_cast<float>(sign) * w;
  };
  face.clip = clip_matrix(clip(Vec3(frame.x), x.x), clip(Vec3(frame.y), x.y), w, radius, range);
  face.depth = w;
  face.planes = {Vec4(side - of_light(across), 0.0f), Vec4(side + of_light(across), 0.0f),
                 Vec4(z, 0.0f)};
  return face;
}

MapFace parallel_face(const MapFrame& frame, const Bounds& bounds, int size, ClipRange range) {
  const Vec3 travel(frame.z);
  const Vec2 depths = extent(travel, bounds);
  const float deep = std::max(depths.y - depths.x, 1e-3f * bounds.radius());
  MapFace face;
  face.width = face.height = size;
  face.origin = travel * depths.x;
  face.depth = travel;
  // From a little less than 1 at the nearest to 0, or from -1 to 1.
  const bool near_is_1 = range == ClipRange::kFarIs0;
  const float scale = (near_is_1 ? -0.9f : 1.8f) / deep;
  const Vec4 depth(travel * scale, near_is_1 ? 0.95f : -0.9f);
  face.clip = glm::transpose(Mat4(frame.x, frame.y, depth, Vec4(0.0f, 0.0f, 0.0f, 1.0f)));
  for (const Vec4& row : {frame.x, frame.y}) {
    face.planes.push_back(row + Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    face.planes.push_back(-row + Vec4(0.0f, 0.0f, 0.0f, 1.0f));
  }
  return face;
}

}  // namespace

int octahedron_size(std::size_t casters) {
  // Among many triangles more edges of shadows have to be told apart: lights that shine to one side
  // have two texels a triangle or more, until maps would take too much memory.
  constexpr std::size_t kMany = 10'000, kVeryMany = 40'000;
  return casters < kMany ? 256 : casters < kVeryMany ? 384 : 512;
}

int map_size(LightFormula formula, int octahedron) {
  // All that is seen from infinity is in one picture, near things too.
  constexpr int kFromInfinity = 1024;
  if (formula == LightFormula::kDirectional) return kFromInfinity;
  return formula == LightFormula::kPunctual ? octahedron : octahedron * 3 / 4;
}

std::vector<MapFrame> map_frames(const LightGroup& group, const MapBounds& bounds, int size) {
  std::vector<MapFrame> frames;
  for (const LightRecord& record : group.records) {
    if (group.formula == LightFormula::kDirectional) {
      frames.push_back(parallel_frame(Vec3(record.place), bounds, size));
      continue;
    }
    // A point light has no axis.
    const bool to_one_side = group.formula == LightFormula::kSurface;
    const Frame frame(to_one_side ? Vec3(record.axis) : Vec3(0.0f, 0.0f, 1.0f));
    const float scale = to_one_side ? glm::root_two<float>() : 1.0f;
    frames.push_back({Vec4(scale * frame.tangent, record.place.x),
                      Vec4(scale * frame.bitangent, record.place.y),
                      Vec4(frame.normal, record.place.z)});
  }
  return frames;
}

Bounds snapped(const Bounds& receivers, const Bounds& scene) {
  if (receivers.empty()) return scene;
  const float step = grid_step(scene);
  if (!(step > 0.0f)) return scene;
  const Vec3 low = glm::floor((receivers.low - scene.low) / step);
  const Vec3 high = glm::ceil((receivers.high - scene.low) / step);
  return {glm::max(scene.low + step * low, scene.low),
          glm::min(scene.low + step * high, scene.high)};
}

bool still_fits(const Bounds& kept, const Bounds& wanted, const Bounds& scene) {
  const float most = 2.5f * grid_step(scene);  // two steps and rounding
  const auto fits = [&](const Vec3& more) {
    return glm::all(glm::greaterThanEqual(more, Vec3(0.0f))) &&
           glm::all(glm::lessThanEqual(more, Vec3(most)));
  };
  return fits(wanted.low - kept.low) && fits(kept.high - wanted.high);
}

std::vector<MapFace> map_faces(const MapFrame& frame, LightFormula formula, const Bounds& bounds,
                               int size, ClipRange range) {
  if (formula == LightFormula::kDirectional) return {parallel_face(frame, bounds, size, range)};
  std::vector<MapFace> faces;
  if (formula == LightFormula::kSurface) {
    for (const glm::ivec2 side : {glm::ivec2(1, 0), {0, 1}, {-1, 0}, {0, -1}}) {
      faces.push_back(quarter(frame, side, bounds.radius(), size, range));
    }
    return faces;
  }
  for (const float z : {1.0f, -1.0f}) {
    for (const float y : {1.0f, -1.0f}) {
      for (const float x : {1.0f, -1.0f}) {
        faces.push_back(octant(frame, Vec3(x, y, z), bounds.radius(), size, range));
      }
    }
  }
  return faces;
}

}  // namespace lantern
