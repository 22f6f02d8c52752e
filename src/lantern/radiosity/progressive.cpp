// SPDX-License-Identifier: MIT
#include "lantern/radiosity/progressive.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lantern {
namespace {

/// An element that emits the mean flux of all is worth a sixth of the finest hemicube's pixels: as
/// many find each of the others, more or less.
constexpr double kPixelsOfMean = 1.0 / 6.0;

/// From fewer points finer hemicubes do not pay: it is from close by that points matter.
constexpr double kLeastPoints = 4.0;

/// Pixels of a single shot: about a hundredth of a second.
constexpr std::size_t kMostPixels = std::size_t{1} << 18;

double sum(const glm::dvec3& flux) { return flux.r + flux.g + flux.b; }

glm::dvec3 sum(const std::vector<glm::dvec3>& values) {
  glm::dvec3 total(0.0);
  for (const glm::dvec3& value : values) total += value;
  return total;
}

}  // namespace

double FluxBalance::error() const {
  const glm::dvec3 difference = glm::abs(emitted - absorbed - escaped - unshot);
  double worst = 0.0;
  for (int c = 0; c < 3; ++c) {
    if (emitted[c] > 0.0) worst = std::max(worst, difference[c] / emitted[c]);
  }
  return worst;
}

ProgressiveRadiosity::ProgressiveRadiosity(const World& world, const Tracer& tracer,
                                           const Patches& patches,
                                           const ProgressiveOptions& options,
                                           std::span<const glm::dvec3> external)
    : patches_(patches), options_(options), rows_(world, tracer, patches, options.hemicube) {
  const std::size_t count = patches.elements();
  area_.resize(count);
  reflectance_.resize(count);
  unshot_.resize(count);
  received_.assign(count, glm::dvec3(0.0));
  order_.resize(count);
  points_used_.assign(count, 0);
  for (std::size_t e = 0; e < count; ++e) {
    area_[e] = patches.exposed_area(e);
    // What is covered reflects nothing, should a ray find it all the same.
    if (area_[e] > 0.0) reflectance_[e] = patches.reflectance[patches.patch[e]];
    if (!external.empty()) received_[e] = external[e] * area_[e];
    const glm::dvec3 sent = patches.emission[e] * area_[e];
    emitted_ += sent + received_[e];
    unshot_[e] = sent + reflectance_[e] * received_[e];
    order_[e] = sum(unshot_[e]);
  }
  look_for_next();
}

/// Pixels in proportion to the flux, so that all carry the same; from a few points at least, by the
/// finest hemicubes that this leaves them.
HemicubeRows::Points ProgressiveRadiosity::points_for(double flux) const {
  const auto cubes = rows_.cubes();
  const auto size = [&](std::size_t cube) { return static_cast<double>(cubes[cube].size()); };
  const double mean = sum(emitted_) / static_cast<double>(area_.size());
  const double pixels = flux / mean * kPixelsOfMean * size(0);
  HemicubeRows::Points points;
  while (points.cube + 1 < cubes.size() && kLeastPoints * size(points.cube) > pixels) {
    ++points.cube;
  }
  points.count = static_cast<std::size_t>(std::max(1.0, std::ceil(pixels / size(points.cube))));
  return points;
}

bool ProgressiveRadiosity::shoot() {
  if (unshot_share_ <= options_.cutoff) return false;
  const std::size_t shooter = next_;
  HemicubeRows::Points points = points_for(order_[shooter]);
  const std::size_t wanted = points.count;
  points.count =
      std::min(wanted, std::max<std::size_t>(1, kMostPixels / rows_.cubes()[points.cube].size()));
  points.first = points_used_[shooter];
  rows_.from_points(static_cast<std::uint32_t>(shooter), points, row_);
  points_used_[shooter] += points.count;

  const bool all = points.count == wanted;
  const double share = static_cast<double>(points.count) / static_cast<double>(wanted);
  const glm::dvec3 flux = unshot_[shooter] * share;
  unshot_[shooter] = all ? glm::dvec3(0.0) : unshot_[shooter] - flux;
  order_[shooter] = sum(unshot_[shooter]);
  for (std::size_t i = 0; i < row_.elements.size(); ++i) {
    const std::size_t e = row_.elements[i];
    const glm::dvec3 received = flux * row_.factors[i];
    received_[e] += received;
    unshot_[e] += reflectance_[e] * received;
    order_[e] = sum(unshot_[e]);
  }
  escaped_ += flux * row_.escaped;
  ++shots_;
  hemicubes_ += points.count;
  look_for_next();
  return true;
}

/// In strands of their own the sums and maxima of neighbours do not wait for each other: beside a
/// shot the search takes no time that would pay for a heap. Always in the same order.
void ProgressiveRadiosity::look_for_next() {
  constexpr std::size_t kStrands = 8, kBlock = 1024;
  double total = 0.0, most = -1.0;
  std::size_t most_block = 0;
  for (std::size_t begin = 0; begin < order_.size(); begin += kBlock) {
    const std::size_t end = std::min(order_.size(), begin + kBlock);
    double sums[kStrands] = {}, maxima[kStrands] = {};
    std::size_t i = begin;
    for (; i + kStrands <= end; i += kStrands) {
      for (std::size_t k = 0; k < kStrands; ++k) {
        sums[k] += order_[i + k];
        maxima[k] = order_[i + k] > maxima[k] ? order_[i + k] : maxima[k];
      }
    }
    for (; i < end; ++i) {
      sums[0] += order_[i];
      maxima[0] = std::max(maxima[0], order_[i]);
    }
    for (const double strand : sums) total += strand;
    const double most_here = *std::max_element(std::begin(maxima), std::end(maxima));
    if (most_here > most) {
      most = most_here;
      most_block = begin;
    }
  }
  const auto first = order_.begin() + static_cast<std::ptrdiff_t>(most_block);
  next_ = static_cast<std::size_t>(std::find(first, order_.end(), most) - order_.begin());
  const double emitted = sum(emitted_);
  unshot_share_ = emitted > 0.0 ? total / emitted : 0.0;
}

FluxBalance ProgressiveRadiosity::balance() const {
  FluxBalance balance;
  balance.emitted = emitted_;
  balance.escaped = escaped_;
  balance.unshot = sum(unshot_);
  for (std::size_t e = 0; e < received_.size(); ++e) {
    balance.absorbed += (1.0 - reflectance_[e]) * received_[e];
  }
  return balance;
}

std::vector<glm::dvec3> ProgressiveRadiosity::irradiance() const {
  std::vector<glm::dvec3> irradiance(received_.size(), glm::dvec3(0.0));
  for (std::size_t e = 0; e < irradiance.size(); ++e) {
    if (area_[e] > 0.0) irradiance[e] = received_[e] / area_[e];
  }
  return irradiance;
}

glm::dvec3 ProgressiveRadiosity::ambient() const {
  double area = 0.0;
  glm::dvec3 reflected(0.0);
  for (std::size_t e = 0; e < area_.size(); ++e) {
    area += area_[e];
    reflected += area_[e] * reflectance_[e];
  }
  if (!(area > 0.0)) return glm::dvec3(0.0);
  return sum(unshot_) / area / (1.0 - reflected / area);
}

}  // namespace lantern
