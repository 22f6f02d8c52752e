// SPDX-License-Identifier: MIT
#include "lantern/lights/resample.h"

#include "lantern/core/hash.h"
#include "lantern/sampling/halton.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace lantern {
namespace {

constexpr int kBits = 16;  // per axis: finer than any pool is dense

/// Position along the Hilbert curve of order kBits, its bits still spread over the three axes.
/// [Skilling 2004, Programming the Hilbert Curve]
void axes_to_transpose(std::uint32_t (&x)[3]) {
  constexpr std::uint32_t kTop = 1u << (kBits - 1);
  for (std::uint32_t q = kTop; q > 1; q >>= 1) {
    const std::uint32_t low = q - 1;
    for (std::uint32_t& axis : x) {
      if (axis & q) {
        x[0] ^= low;
      } else {
        const std::uint32_t swapped = (x[0] ^ axis) & low;
        x[0] ^= swapped;
        axis ^= swapped;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t flip = 0;
  for (std::uint32_t q = kTop; q > 1; q >>= 1) {
    if (x[2] & q) flip ^= q - 1;
  }
  for (std::uint32_t& axis : x) axis ^= flip;
}

std::uint64_t hilbert_index(const Vec3& unit) {
  std::uint32_t x[3];
  for (int axis = 0; axis < 3; ++axis) {
    constexpr float kCells = static_cast<float>((1u << kBits) - 1);
    x[axis] = static_cast<std::uint32_t>(std::clamp(unit[axis], 0.0f, 1.0f) * kCells);
  }
  axes_to_transpose(x);
  std::uint64_t result = 0;
  for (int bit = kBits - 1; bit >= 0; --bit) {
    for (const std::uint32_t axis : x) result = (result << 1) | ((axis >> bit) & 1u);
  }
  return result;
}

/// What lights are put next to each other by: lights from infinity by direction, others by place.
std::vector<std::uint64_t> curve_positions(const VirtualLights& lights) {
  Bounds bounds;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights.kind[i] != LightKind::kDirectional) bounds.add(lights.position[i]);
  }
  // One scale for all axes: cells of the curve are cubes.
  const Vec3 extent = bounds.empty() ? Vec3(1.0f) : bounds.high - bounds.low;
  const float scale = 1.0f / std::max(max_component(extent), std::numeric_limits<float>::min());
  constexpr std::uint64_t kBehindAllPlaces = std::uint64_t{1} << (3 * kBits);
  std::vector<std::uint64_t> keys(lights.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    keys[i] = lights.kind[i] == LightKind::kDirectional
                  ? kBehindAllPlaces + hilbert_index(0.5f * lights.normal[i] + 0.5f)
                  : hilbert_index((lights.position[i] - bounds.low) * scale);
  }
  return keys;
}

}  // namespace

std::vector<double> flux_weights(const VirtualLights& pool, double directional_area) {
  const auto flux = [&](std::size_t i) {
    const bool from_infinity = pool.kind[i] == LightKind::kDirectional;
    return glm::dvec3(pool.flux[i]) * (from_infinity ? directional_area : 1.0);
  };
  glm::dvec3 total(0.0);
  for (std::size_t i = 0; i < pool.size(); ++i) total += flux(i);
  std::vector<double> weights(pool.size(), 0.0);
  for (std::size_t i = 0; i < pool.size(); ++i) {
    const glm::dvec3 f = flux(i);
    for (int c = 0; c < 3; ++c) {
      if (total[c] > 0.0) weights[i] = std::max(weights[i], f[c] / total[c]);
    }
  }
  return weights;
}

VirtualLights resample(const VirtualLights& pool, std::span<const double> weights,
                       std::size_t count, std::uint64_t pass) {
  assert(weights.size() == pool.size());
  const std::vector<std::uint64_t> keys = curve_positions(pool);
  std::vector<std::uint32_t> order(pool.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
  });
  double all = 0.0;
  for (const std::uint32_t i : order) all += weights[i];

  VirtualLights lights;
  lights.paths = pool.paths;
  lights.reflectivity = pool.reflectivity;
  const double spacing = all / static_cast<double>(count);
  // One choice in each stratum. Over passes each goes through its stratum evenly, scrambled by
  // itself: choices that moved together would all err to the same side, and a sequence that the
  // walk shares would tie them to what they choose from.
  const auto choice = [&](std::size_t k) {
    return (static_cast<double>(k) + scrambled_radical_inverse(2, pass, hash(k))) * spacing;
  };
  double reached = 0.0;
  std::size_t next = 0;
  for (const std::uint32_t i : order) {
    const double w = weights[i];
    reached += w;
    int times = 0;
    for (; next < count && choice(next) < reached; ++next) ++times;
    if (times == 0) continue;
    lights.kind.push_back(pool.kind[i]);
    lights.position.push_back(pool.position[i]);
    lights.normal.push_back(pool.normal[i]);
    lights.flux.push_back(pool.flux[i] * static_cast<float>(times * spacing / w));
    lights.path.push_back(pool.path[i]);
    lights.bounce.push_back(pool.bounce[i]);
    lights.cone.push_back(pool.cone[i]);
  }
  return lights;
}

}  // namespace lantern
