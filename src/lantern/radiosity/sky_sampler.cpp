// SPDX-License-Identifier: MIT
#include "lantern/radiosity/sky_sampler.h"

#include "lantern/scene/sky.h"
#include "lantern/scene/texture.h"

#include <algorithm>
#include <cassert>

namespace lantern {
namespace {

/// The place of u in a cumulated row whose last value is its sum: a cell and how far into it.
struct Found {
  int cell;
  double within;
  double share;  // of the sum that the cell has
};

Found find(const double* cumulated, int count, double u) {
  const double target = u * cumulated[count - 1];
  const double* const end = cumulated + count;
  const double* const at = std::min(std::upper_bound(cumulated, end, target), end - 1);
  const double before = at == cumulated ? 0.0 : *(at - 1);
  const double width = *at - before;
  return {static_cast<int>(at - cumulated), width > 0.0 ? (target - before) / width : 0.5,
          width / cumulated[count - 1]};
}

}  // namespace

SkySampler::SkySampler(const Scene& scene) : scene_(scene) {
  assert(scene.sky && scene.sky->texture);
  const Texture& texture = scene.textures[index(*scene.sky->texture)];
  width_ = texture.width;
  height_ = texture.height;
  double all = 0.0;
  for (int y = 0; y < height_; ++y) {
    const double polar = glm::pi<double>() * (y + 0.5) / height_;
    double row = 0.0;
    for (int x = 0; x < width_; ++x) {
      // A look-up mixes neighbours, so none of them may be the only one that counts.
      double most = 0.0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const Vec4 c =
              texel(texture, (x + dx + width_) % width_, std::clamp(y + dy, 0, height_ - 1));
          most = std::max(most, static_cast<double>(std::max(luminance(Rgb(c)), 0.0f)));
        }
      }
      row += most * std::sin(polar);
      cells_.push_back(row);
    }
    all += row;
    rows_.push_back(all);
  }
}

SkySampler::Draw SkySampler::draw(Vec2 u) const {
  if (!(rows_.back() > 0.0)) return {Vec3(0.0f, 1.0f, 0.0f), Rgb(0.0f)};
  const Found row = find(rows_.data(), height_, static_cast<double>(u.y));
  const Found cell = find(cells_.data() + static_cast<std::ptrdiff_t>(row.cell) * width_, width_,
                          static_cast<double>(u.x));
  const double azimuth = glm::two_pi<double>() * (cell.cell + cell.within) / width_;
  const double polar = glm::pi<double>() * (row.cell + row.within) / height_;
  const double sine = std::sin(polar);
  const Vec3 towards(
      glm::dvec3(sine * std::sin(azimuth), std::cos(polar), -sine * std::cos(azimuth)));
  const double cells = static_cast<double>(width_) * static_cast<double>(height_);
  const double pdf = row.share * cell.share * cells / (2.0 * glm::pi<double>() * glm::pi<double>());
  if (!(pdf > 0.0)) return {towards, Rgb(0.0f)};
  return {towards, sky_radiance(scene_, towards) * static_cast<float>(sine / pdf)};
}

}  // namespace lantern
