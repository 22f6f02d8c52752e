// SPDX-License-Identifier: MIT
#include "lantern/radiosity/form_factors.h"

#include "lantern/core/hash.h"
#include "lantern/radiosity/element_points.h"
#include "lantern/radiosity/exchange.h"
#include "lantern/radiosity/occluders.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <mutex>
#include <numeric>

namespace lantern {
namespace {

static_assert(FormFactors::kRays == kPacket && ElementPoints::kPoints == kPacket);

/// Elements along the side of what one task computes, and of what shares a list of occluders.
/// Elements in sequence lie close together, since bisection keeps the halves of a face in its
/// place.
constexpr std::size_t kBlock = 128, kTile = 16;
static_assert(kBlock % kTile == 0);

struct Range {
  std::size_t begin, end;
  std::size_t size() const { return end - begin; }
};

/// Computes the factors of one block of pairs after another.
class Assembler {
 public:
  Assembler(const World& world, const Tracer& tracer, const Patches& patches)
      : patches_(patches),
        tracer_(tracer),
        points_(world, tracer, patches),
        flat_(kFlat * static_cast<double>(world.coordinate_scale())),
        occluders_(world, flat_) {
    shapes_.reserve(patches.elements());
    for (std::size_t e = 0; e < patches.elements(); ++e) shapes_.push_back(shape_of(patches, e));
  }

  /// F between the elements of two ranges, the same or not overlapping.
  void assemble(Range rows, Range columns, float* values, FormFactorCounts& counts) const {
    const std::vector<std::uint32_t> of_block =
        occluders_.between(bounds(rows), bounds(columns), occluders_.all());
    for (std::size_t r = rows.begin; r < rows.end; r += kTile) {
      const Range tile_rows{r, std::min(r + kTile, rows.end)};
      for (std::size_t c = columns.begin; c < columns.end; c += kTile) {
        const Range tile_columns{c, std::min(c + kTile, columns.end)};
        if (tile_columns.begin < tile_rows.begin) continue;
        const std::vector<std::uint32_t> of_tile =
            occluders_.between(bounds(tile_rows), bounds(tile_columns), of_block);
        assemble_tile(tile_rows, tile_columns, of_tile, values, counts);
      }
    }
  }

 private:
  /// Positions are rounded to 2^-24 of the scene's largest coordinate; sums of a few of them to
  /// this.
  static constexpr double kFlat = 0x1p-20;

  ShapeBounds bounds(Range range) const {
    return bounds_of(std::span(shapes_).subspan(range.begin, range.size()));
  }

  void assemble_tile(Range rows, Range columns, std::span<const std::uint32_t> candidates,
                     float* values, FormFactorCounts& counts) const {
    const std::size_t n = shapes_.size();
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      for (std::size_t j = std::max(i + 1, columns.begin); j < columns.end; ++j) {
        const double exchange = exchange_of(i, j, candidates, counts);
        if (exchange == 0.0) continue;
        values[i * n + j] = static_cast<float>(exchange / patches_.exposed_area(i));
        values[j * n + i] = static_cast<float>(exchange / patches_.exposed_area(j));
      }
    }
  }

  double exchange_of(std::size_t i, std::size_t j, std::span<const std::uint32_t> candidates,
                     FormFactorCounts& counts) const {
    const double shares = patches_.exposed[i] * patches_.exposed[j];
    if (shares == 0.0) return 0.0;
    const double unoccluded = unoccluded_exchange(shapes_[i], shapes_[j], flat_);
    if (unoccluded == 0.0) return 0.0;
    if (shares == 1.0 && !occluders_.any_between(shapes_[i], shapes_[j], candidates)) {
      ++counts.open_pairs;
      return unoccluded;
    }
    ++counts.screened_pairs;
    return unoccluded * std::min(1.0, shares * visible_share(i, j, counts));
  }

  /// cos θ_i cos θ_j / r² of two points; 0 where they do not face each other.
  double weight(std::size_t i, std::size_t j, const Vec3& way) const {
    const float square = glm::dot(way, way);
    const float cosines = std::max(glm::dot(way, Vec3(shapes_[i].normal)), 0.0f) *
                          std::max(-glm::dot(way, Vec3(shapes_[j].normal)), 0.0f);
    return square > 0.0f ? static_cast<double>(cosines / (square * square)) : 0.0;
  }

  /// Where errors show: light that comes straight from an emitter, and what is close to the foot of
  /// an object, where one point counts for more than another.
  bool needs_many_rays(std::size_t i, std::size_t j) const {
    constexpr double kClose = 4.0;  // in radii
    const bool emits =
        patches_.emission[i] != glm::dvec3(0.0) || patches_.emission[j] != glm::dvec3(0.0);
    const bool at_foot = patches_.exposed[i] * patches_.exposed[j] < 1.0 &&
                         glm::distance(shapes_[i].centre, shapes_[j].centre) <
                             kClose * (shapes_[i].radius + shapes_[j].radius);
    return emits || at_foot;
  }

  /// What passes between points of the exposed parts, over what would between points of the whole.
  double visible_share(std::size_t i, std::size_t j, FormFactorCounts& counts) const {
    const std::size_t packets =
        (needs_many_rays(i, j) ? FormFactors::kManyRays : FormFactors::kRays) / kPacket;
    // Point k of one goes with point k ^ shift of the other: over all shifts each with each.
    const std::size_t first = hash(i, j) % kPacket;
    double all = 0.0, seen = 0.0;
    for (std::size_t packet = 0; packet < packets; ++packet) {
      const std::size_t shift = first ^ packet;
      RayPacket rays{};
      LaneMask active{};
      double weights[kPacket];
      for (std::size_t k = 0; k < kPacket; ++k) {
        all += weight(i, j, points_.on_whole(j, k ^ shift) - points_.on_whole(i, k));
        const Vec3 from = points_.at(i, k);
        const Vec3 way = points_.at(j, k ^ shift) - from;
        weights[k] = weight(i, j, way);
        active.lane[k] = weights[k] > 0.0 ? -1 : 0;
        rays.set(static_cast<int>(k), from, way, 1.0f);
      }
      tracer_.occluded(active, rays);
      for (std::size_t k = 0; k < kPacket; ++k) {
        if (active.lane[k] == 0) continue;
        ++counts.rays;
        if (rays.far[k] >= 0.0f) seen += weights[k];
      }
    }
    return all > 0.0 ? seen / all : 0.0;
  }

  const Patches& patches_;
  const Tracer& tracer_;
  ElementPoints points_;
  double flat_;
  Occluders occluders_;
  std::vector<ElementShape> shapes_;
};

/// A number without a common divisor with `count`, near its golden section: stepping by it visits
/// every index once, and the first few are already spread over all.
std::size_t spreading_step(std::size_t count) {
  constexpr double kGolden = 0.6180339887498949;
  auto step =
      std::max<std::size_t>(1, static_cast<std::size_t>(kGolden * static_cast<double>(count)));
  while (std::gcd(step, count) != 1) ++step;
  return step;
}

}  // namespace

FormFactors::FormFactors(const World& world, const Tracer& tracer, const Patches& patches,
                         const StopFlag& stop, const AssemblyReport& report)
    : size_(patches.elements()), values_(size_ * size_, 0.0f) {
  const auto start = std::chrono::steady_clock::now();
  const Assembler assembler(world, tracer, patches);
  const std::size_t blocks = (size_ + kBlock - 1) / kBlock;
  std::vector<std::pair<std::size_t, std::size_t>> tasks;
  for (std::size_t r = 0; r < blocks; ++r) {
    for (std::size_t c = r; c < blocks; ++c) tasks.emplace_back(r, c);
  }
  const auto range = [&](std::size_t block) {
    return Range{block * kBlock, std::min((block + 1) * kBlock, size_)};
  };
  const std::size_t step = spreading_step(tasks.size());
  std::vector<FormFactorCounts> counts(tasks.size());
  std::mutex mutex;
  double done = 0.0;
  const double whole = static_cast<double>(size_) * static_cast<double>(size_);
  parallel_for(tasks.size(), 1, [&](std::size_t k) {
    if (stop.load(std::memory_order_relaxed)) return;
    const std::size_t task = k * step % tasks.size();
    const auto [r, c] = tasks[task];
    const Range rows = range(r), columns = range(c);
    assembler.assemble(rows, columns, values_.data(), counts[task]);
    if (!report) return;
    const std::lock_guard lock(mutex);
    done += (r == c ? 1.0 : 2.0) * static_cast<double>(rows.size() * columns.size()) / whole;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    report(done, elapsed.count() / done);
  });
  for (const FormFactorCounts& c : counts) {
    counts_.open_pairs += c.open_pairs;
    counts_.screened_pairs += c.screened_pairs;
    counts_.rays += c.rays;
  }
}

FormFactors::FormFactors(std::vector<float> values)
    : size_(static_cast<std::size_t>(std::llround(std::sqrt(static_cast<double>(values.size()))))),
      values_(std::move(values)) {
  assert(size_ * size_ == values_.size());
}

RowSums row_sums(const Patches& patches, const FormFactors& factors) {
  std::vector<double> sums(factors.size(), 0.0);
  parallel_for(factors.size(), kTile, [&](std::size_t i) {
    for (const float f : factors.row(i)) sums[i] += static_cast<double>(f);
  });
  RowSums result{.least = std::numeric_limits<double>::infinity()};
  double area = 0.0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double exposed = patches.exposed_area(i);
    if (exposed == 0.0) continue;
    result.least = std::min(result.least, sums[i]);
    result.most = std::max(result.most, sums[i]);
    result.mean += exposed * sums[i];
    area += exposed;
  }
  result.mean = area > 0.0 ? result.mean / area : 0.0;
  result.least = area > 0.0 ? result.least : 0.0;
  return result;
}

double reciprocity_error(const Patches& patches, const FormFactors& factors) {
  const std::size_t n = factors.size();
  const std::size_t blocks = (n + kBlock - 1) / kBlock;
  struct Sums {
    double difference = 0.0, whole = 0.0;
  };
  std::vector<Sums> sums(blocks);
  parallel_for(blocks, 1, [&](std::size_t block) {
    const std::size_t end = std::min((block + 1) * kBlock, n);
    // Column by column of blocks, so that what is read across rows stays near.
    for (std::size_t from = 0; from < end; from += kBlock) {
      for (std::size_t i = block * kBlock; i < end; ++i) {
        for (std::size_t j = from; j < std::min(from + kBlock, i); ++j) {
          const double forth = patches.exposed_area(i) * static_cast<double>(factors.row(i)[j]);
          const double back = patches.exposed_area(j) * static_cast<double>(factors.row(j)[i]);
          sums[block].difference += std::abs(forth - back);
          sums[block].whole += 0.5 * (forth + back);
        }
      }
    }
  });
  Sums all;
  for (const Sums& sum : sums) {
    all.difference += sum.difference;
    all.whole += sum.whole;
  }
  return all.whole > 0.0 ? all.difference / all.whole : 0.0;
}

}  // namespace lantern
