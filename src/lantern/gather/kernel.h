// SPDX-License-Identifier: MIT
// The inner loop: sixteen shading points against all lights, shadow rays in packets.
#pragma once

#include "lantern/lights/virtual_lights.h"
#include "lantern/trace/tracer.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lantern {

/// VirtualLights made ready for the loop: black ones left out, grouped by kind, one record per
/// light (the loop reads all of it), positions lifted off their surfaces.
struct GatherLights {
  struct Surface {
    float position[3], normal[3], flux[3];  // flux over π: radiant intensity along the normal
    float bound;                            // its own on the geometry term, where that is higher
  };
  struct Point {
    float position[3], axis[3], intensity[3];
    float cone[2];  // cosines; a point light that is no spot has {-2, -3}: full in every direction
  };
  struct Directional {
    float direction[3], irradiance[3];
  };
  std::vector<Surface> surface;
  std::vector<Point> point;
  std::vector<Directional> directional;

  GatherLights() = default;
  /// `bounds`: one for each light, or empty for none of their own.
  GatherLights(const VirtualLights& lights, float coordinate_scale,
               std::span<const float> bounds = {});
  /// Adds light i; `own_bound` as above.
  void add(const VirtualLights& lights, std::size_t i, float coordinate_scale,
           float own_bound = 0.0f);
  std::size_t size() const { return surface.size() + point.size() + directional.size(); }
};

/// Sixteen points, lifted off their surfaces; both normals on the side they are seen from.
struct alignas(64) ShadingPacket {
  float x[kPacket], y[kPacket], z[kPacket];
  float shading_x[kPacket], shading_y[kPacket], shading_z[kPacket];
  float geometric_x[kPacket], geometric_y[kPacket], geometric_z[kPacket];
  LaneMask active;

  /// Fills lane i and makes it active.
  void set(std::size_t i, const Vec3& position, const Vec3& shading, const Vec3& geometric) {
    x[i] = position.x;
    y[i] = position.y;
    z[i] = position.z;
    shading_x[i] = shading.x;
    shading_y[i] = shading.y;
    shading_z[i] = shading.z;
    geometric_x[i] = geometric.x;
    geometric_y[i] = geometric.y;
    geometric_z[i] = geometric.z;
    active.lane[i] = -1;
  }
};

/// Irradiance in W/m² by channel.
struct alignas(64) IrradiancePacket {
  float r[kPacket], g[kPacket], b[kPacket];
};

enum class ShadowRays { kPackets, kSingle };

/// Sums E = Σ I cos_x / d² V over the lights; the geometry term cos_x cos_y / d² of surface lights
/// cut at `bound` (1/m²; infinite: never) or at the light's own, whichever is higher. Returns the
/// number of shadow rays traced: a ray is saved where light or point face away from each other.
/// [Keller 1997, equation 4]
std::uint64_t gather_irradiance(const GatherLights& lights, const ShadingPacket& points,
                                const Tracer& tracer, float bound, ShadowRays rays,
                                IrradiancePacket& irradiance);

}  // namespace lantern
