// SPDX-License-Identifier: MIT
// What a scene's sky looks like, and the lat-long map that its texture is: u = 0 towards -z and
// growing over +x, v = 0 straight up.
#pragma once

#include "lantern/scene/scene.h"

namespace lantern {

/// Place in [0, 1]² of a unit direction.
Vec2 to_lat_long(const Vec3& direction);
/// Unit direction of a place.
Vec3 from_lat_long(const Vec2& uv);
/// Solid angle in sr of a unit of the map's area; above 0 at the poles too.
float lat_long_solid_angle(const Vec2& uv);

/// Radiance that is seen along `towards` (any length) where no surface is; zero without a sky.
Rgb sky_radiance(const Scene& scene, const Vec3& towards);

}  // namespace lantern
