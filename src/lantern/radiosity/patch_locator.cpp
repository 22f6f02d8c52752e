// SPDX-License-Identifier: MIT
#include "lantern/radiosity/patch_locator.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace lantern {
namespace {

/// Cells for each face of a triangle, so that a cell meets two or three faces.
constexpr double kCellsPerFace = 2.0;

/// A face counts as in the cells that it touches; grids are not as fine as this.
constexpr double kTouching = 1e-9;

std::uint32_t cell_of(float weight, std::uint32_t size) {
  const auto cell = static_cast<std::int64_t>(weight * static_cast<float>(size));
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(cell, 0, std::int64_t{size} - 1));
}

}  // namespace

PatchLocator::PatchLocator(const PatchMesh& mesh, std::size_t triangles) : grids_(triangles) {
  std::vector<std::uint32_t> order(mesh.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return mesh.faces[a].source < mesh.faces[b].source;
  });
  std::vector<std::vector<std::uint32_t>> in_cell;
  for (std::size_t begin = 0, end; begin < order.size(); begin = end) {
    const std::uint32_t source = mesh.faces[order[begin]].source;
    end = begin;
    while (end < order.size() && mesh.faces[order[end]].source == source) ++end;
    // The triangle is half of the square that its weights span.
    const double cells = 2.0 * kCellsPerFace * static_cast<double>(end - begin);
    Grid& grid = grids_[source];
    grid.first = static_cast<std::uint32_t>(cells_.size());
    grid.size = end - begin == 1 ? 1 : static_cast<std::uint32_t>(std::ceil(std::sqrt(cells)));
    in_cell.assign(static_cast<std::size_t>(grid.size) * grid.size, {});
    for (std::size_t i = begin; i < end; ++i) {
      const auto& p = mesh.faces[order[i]].places;
      // The sides as lines, positive inside; a cell that is below zero for one lies outside.
      glm::dvec3 sides[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 a = p[k], along = p[(k + 1) % 3] - a;
        sides[k] = {along.y * a.x - along.x * a.y, -along.y, along.x};
      }
      const glm::dvec2 low = glm::min(p[0], glm::min(p[1], p[2]));
      const glm::dvec2 high = glm::max(p[0], glm::max(p[1], p[2]));
      const double edge = 1.0 / grid.size;
      for (std::uint32_t y = cell_of(static_cast<float>(low.y), grid.size);
           y <= cell_of(static_cast<float>(high.y), grid.size); ++y) {
        for (std::uint32_t x = cell_of(static_cast<float>(low.x), grid.size);
             x <= cell_of(static_cast<float>(high.x), grid.size); ++x) {
          const bool outside =
              std::any_of(std::begin(sides), std::end(sides), [&](const glm::dvec3& s) {
                return s.x + s.y * edge * (x + (s.y > 0.0 ? 1 : 0)) +
                           s.z * edge * (y + (s.z > 0.0 ? 1 : 0)) <
                       -kTouching;
              });
          if (!outside) in_cell[static_cast<std::size_t>(y) * grid.size + x].push_back(order[i]);
        }
      }
    }
    for (const std::vector<std::uint32_t>& faces : in_cell) {
      cells_.push_back(static_cast<std::uint32_t>(faces_.size()));
      for (const std::uint32_t patch : faces) {
        const auto& p = mesh.faces[patch].places;
        const glm::dvec2 a = p[1] - p[0], b = p[2] - p[0];
        const double determinant = a.x * b.y - a.y * b.x;
        const glm::dvec2 u = glm::dvec2(b.y, -b.x) / determinant;
        const glm::dvec2 v = glm::dvec2(-a.y, a.x) / determinant;
        const auto line = [&](const glm::dvec2& w, float* out) {
          out[0] = static_cast<float>(-glm::dot(w, p[0]));
          out[1] = static_cast<float>(w.x);
          out[2] = static_cast<float>(w.y);
        };
        Face face{.u = {}, .v = {}, .patch = patch};
        line(u, face.u);
        line(v, face.v);
        faces_.push_back(face);
      }
    }
  }
  cells_.push_back(static_cast<std::uint32_t>(faces_.size()));
}

float PatchLocator::depth(const Face& face, Vec2 uv) {
  const float u = face.u[0] + face.u[1] * uv.x + face.u[2] * uv.y;
  const float v = face.v[0] + face.v[1] * uv.x + face.v[2] * uv.y;
  return std::min(std::min(u, v), 1.0f - u - v);
}

std::uint32_t PatchLocator::at(std::uint32_t triangle, Vec2 uv) const {
  // Out by a rounding, it could be in a cell that meets no face.
  if (const float sum = uv.x + uv.y; sum > 1.0f) uv /= sum;
  const Grid& grid = grids_[triangle];
  const std::size_t cell = grid.first +
                           static_cast<std::size_t>(cell_of(uv.y, grid.size)) * grid.size +
                           cell_of(uv.x, grid.size);
  const std::size_t begin = cells_[cell], end = cells_[cell + 1];
  assert(begin < end);
  std::size_t best = begin;
  float deepest = end - begin > 1 ? depth(faces_[begin], uv) : 0.0f;
  for (std::size_t i = begin + 1; i < end && deepest < 0.0f; ++i) {
    const float here = depth(faces_[i], uv);
    if (here <= deepest) continue;
    deepest = here;
    best = i;
  }
  return faces_[best].patch;
}

}  // namespace lantern
