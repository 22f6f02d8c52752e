// SPDX-License-Identifier: MIT
#include "lantern/sampling/distribution.h"

#include "lantern/core/hash.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lantern {
namespace {

int cell_of(float x, int count) {
  return std::min(static_cast<int>(x * static_cast<float>(count)), count - 1);
}

/// The coordinate of a place within a cell, kept from being rounded into a neighbour: the density
/// looked up there must be the one it was drawn with.
float place_in_cell(std::size_t cell, float rest, int count) {
  const int wanted = static_cast<int>(cell);
  float x = static_cast<float>((static_cast<double>(cell) + static_cast<double>(rest)) / count);
  x = std::min(x, kBelowOne);
  while (cell_of(x, count) > wanted) x = std::nextafter(x, 0.0f);
  while (cell_of(x, count) < wanted) x = std::nextafter(x, 1.0f);
  return x;
}

}  // namespace

Distribution::Distribution(std::span<const double> weights) {
  cumulated_.reserve(weights.size() + 1);
  cumulated_.push_back(0.0);
  for (const double weight : weights) {
    assert(weight >= 0.0 && std::isfinite(weight));
    sum_ += weight;
    cumulated_.push_back(sum_);
  }
  assert(sum_ > 0.0 && std::isfinite(sum_));
  for (double& c : cumulated_) c /= sum_;
}

Distribution::Choice Distribution::choose(float u) const {
  assert(size() > 0 && u >= 0.0f && u < 1.0f);
  // The first bound above u closes an interval that is not empty: no weight of zero is chosen.
  const auto above = std::upper_bound(cumulated_.begin(), cumulated_.end(), static_cast<double>(u));
  const double high = *above;
  const double low = *(above - 1);
  const double rest = (static_cast<double>(u) - low) / (high - low);
  return {.index = static_cast<std::size_t>(above - cumulated_.begin()) - 1,
          .probability = static_cast<float>(high - low),
          .rest = std::min(static_cast<float>(rest), kBelowOne)};
}

float Distribution::probability(std::size_t index) const {
  assert(index < size());
  return static_cast<float>(cumulated_[index + 1] - cumulated_[index]);
}

Distribution2D::Distribution2D(std::span<const double> weights, int width, int height)
    : width_(width), height_(height) {
  assert(width > 0 && height > 0);
  const auto columns = static_cast<std::size_t>(width);
  const auto rows = static_cast<std::size_t>(height);
  assert(weights.size() == columns * rows);
  std::vector<double> sums(rows, 0.0);
  columns_.resize(rows);  // a row without weight stays empty: it is never chosen
  for (std::size_t y = 0; y < rows; ++y) {
    const auto row = weights.subspan(y * columns, columns);
    if (std::all_of(row.begin(), row.end(), [](double w) { return w == 0.0; })) continue;
    columns_[y] = Distribution(row);
    sums[y] = columns_[y].sum();
  }
  rows_ = Distribution(sums);
}

Distribution2D::Point Distribution2D::sample(Vec2 u) const {
  const Distribution::Choice row = rows_.choose(u.y);
  const Distribution::Choice column = columns_[row.index].choose(u.x);
  const float cells = static_cast<float>(width_) * static_cast<float>(height_);
  return {.position = Vec2(place_in_cell(column.index, column.rest, width_),
                           place_in_cell(row.index, row.rest, height_)),
          .pdf = row.probability * column.probability * cells};
}

float Distribution2D::pdf(Vec2 position) const {
  const auto row = static_cast<std::size_t>(cell_of(position.y, height_));
  const auto column = static_cast<std::size_t>(cell_of(position.x, width_));
  if (columns_[row].size() == 0) return 0.0f;
  const float cells = static_cast<float>(width_) * static_cast<float>(height_);
  return rows_.probability(row) * columns_[row].probability(column) * cells;
}

}  // namespace lantern
