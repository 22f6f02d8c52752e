// SPDX-License-Identifier: MIT
#include "lantern/raster/view.h"

#include "lantern/core/hash.h"
#include "lantern/trace/eye.h"

#include <bit>
#include <cmath>

namespace lantern {

View make_view(const Camera& camera, const ViewOptions& options) {
  const Vec3 forward = glm::normalize(camera.forward);
  const Vec3 right = glm::normalize(glm::cross(forward, camera.up));
  const Vec3 down = glm::cross(forward, right);
  const Vec2 size(static_cast<float>(options.width), static_cast<float>(options.height));
  const Vec2 grid(static_cast<float>(options.columns()), static_cast<float>(options.rows()));
  const float step = static_cast<float>(options.step);
  const float pixel = 2.0f * std::tan(0.5f * camera.vertical_fov) / size.y;
  // GL samples column i at i + 1/2; there it must see pixel first + step i, at its offset.
  const Vec2 first = Vec2(options.first) + options.offset;
  const Vec2 shift = 2.0f * ((0.5f * size - first) / step + 0.5f) / grid - 1.0f;
  const Vec2 scale = 2.0f / (step * pixel * grid);
  const Vec4 w(forward, 0.0f);
  const Vec4 x = Vec4(right * scale.x, 0.0f) + w * shift.x;
  const Vec4 y = Vec4(down * scale.y, 0.0f) + w * shift.y;
  // Depth near / w is as exact for a tiny near as for any other; 1 - 2 near / w is not.
  const bool near_is_1 = options.range == ClipRange::kFarIs0;
  const float near = options.radius * (near_is_1 ? 1e-6f : 1e-3f);
  const Vec4 z = near_is_1 ? Vec4(0.0f, 0.0f, 0.0f, near) : w - Vec4(0.0f, 0.0f, 0.0f, 2.0f * near);

  const Eye eye(camera, options.width, options.height);
  const Vec3 corner = eye.direction(0.0f, 0.0f);
  return {camera.eye,
          glm::transpose(Mat4(x, y, z, w)),
          near_is_1,
          eye.direction(first.x, first.y),
          (eye.direction(1.0f, 0.0f) - corner) * step,
          (eye.direction(0.0f, 1.0f) - corner) * step,
          options.first,
          options.step,
          options.origin,
          {options.columns(), options.rows()},
          static_cast<std::uint32_t>(hash(std::bit_cast<std::uint32_t>(options.offset.x),
                                          std::bit_cast<std::uint32_t>(options.offset.y)))};
}

std::vector<Vec4> sides_of(const View& view) {
  const Mat4 rows = glm::transpose(view.clip);
  std::vector<Vec4> planes;
  for (const float sign : {-1.0f, 1.0f}) {
    for (int axis = 0; axis < 2; ++axis) {
      const Vec3 normal = glm::normalize(Vec3(rows[3] + sign * rows[axis]));
      planes.emplace_back(normal, -glm::dot(normal, view.eye));
    }
  }
  return planes;
}

}  // namespace lantern
