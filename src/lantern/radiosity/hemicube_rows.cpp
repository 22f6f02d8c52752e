// SPDX-License-Identifier: MIT
#include "lantern/radiosity/hemicube_rows.h"

#include "lantern/core/hash.h"
#include "lantern/core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lantern {
namespace {

/// An item that is nothing: the ray left the scene. kNoElement is what it says, a side that light
/// was not thought to come to.
constexpr std::uint32_t kEscaped = kNoElement - 1;

/// Hemicubes drawn together, so that threads have enough to do and buffers stay small.
constexpr std::size_t kBatch = 16;
/// Packets that a thread draws without looking up.
constexpr std::size_t kGrain = 32;

/// Coarser than this a hemicube's pixels say little about the angle of a surface.
constexpr int kCoarsest = 16;

/// Points tried on an element before it is taken for wholly covered.
constexpr std::uint64_t kTries = 64;

/// Centres, of elements and below it of their parts, are not part of any sequence of points.
constexpr std::uint64_t kCentre = ~std::uint64_t{0};

/// Barycentric weights of the second and third corner. [Roberts 2018, The Unreasonable
/// Effectiveness of Quasirandom Sequences: R2 and its fold onto a triangle]
glm::dvec2 triangle_point(std::uint64_t number, const glm::dvec2& shift) {
  constexpr double kPlastic = 1.32471795724474602596;
  const auto n = static_cast<double>(number);
  const glm::dvec2 u =
      glm::fract(shift + n * glm::dvec2(1.0 / kPlastic, 1.0 / (kPlastic * kPlastic)));
  return u.x + u.y < 1.0 ? u : 1.0 - u;
}

std::vector<Hemicube> halved(int resolution) {
  std::vector<Hemicube> cubes{Hemicube(resolution)};
  while (resolution % (2 * Hemicube::kResolutionStep) == 0 && resolution / 2 >= kCoarsest) {
    cubes.emplace_back(resolution /= 2);
  }
  return cubes;
}

}  // namespace

HemicubeRows::HemicubeRows(const World& world, const Tracer& tracer, const Patches& patches,
                           const HemicubeOptions& options)
    : tracer_(tracer),
      patches_(patches),
      locator_(patches.mesh, world.size()),
      scale_(world.coordinate_scale()),
      seed_(options.seed),
      painter_(options.painter),
      cubes_(halved(options.resolution)),
      items_(kBatch * cubes_.front().size()),
      sums_(kBatch) {
  area_vectors_.reserve(world.size());
  for (std::uint32_t t = 0; t < world.size(); ++t) area_vectors_.push_back(world.area_vector(t));
}

HemicubeView HemicubeRows::view(std::uint32_t element, const glm::dvec3& position,
                                std::uint64_t turn) const {
  const std::uint64_t key = hash(seed_, element, turn);
  HemicubeView view(Vec3(position), Vec3(patches_.element_normal(element)),
                    2.0f * kPi * to_unit_float(key), scale_);
  view.shift = Vec2(to_unit_float(hash(key, 1)), to_unit_float(hash(key, 2))) - 0.5f;
  return view;
}

HemicubeView HemicubeRows::view_from_centre(std::uint32_t element) const {
  return view(element, patches_.centre[patches_.patch[element]], kCentre);
}

HemicubeView HemicubeRows::view_from_point(std::uint32_t element, std::uint64_t number) const {
  const std::uint64_t key = hash(seed_, element);
  const glm::dvec2 uv =
      triangle_point(number, {to_unit_float(hash(key, 0)), to_unit_float(hash(key, 1))});
  return view_at(element, uv, number);
}

/// At barycentric weights of the second and third corner.
HemicubeView HemicubeRows::view_at(std::uint32_t element, const glm::dvec2& weights,
                                   std::uint64_t turn) const {
  const std::uint32_t patch = patches_.patch[element];
  const glm::dvec3 a = patches_.mesh.corner(patch, 0), b = patches_.mesh.corner(patch, 1),
                   c = patches_.mesh.corner(patch, 2);
  return view(element, a + weights.x * (b - a) + weights.y * (c - a), turn);
}

/// The element that a ray met, or one of the items that are none.
std::uint32_t HemicubeRows::item(const Hit& hit, const Vec3& direction) const {
  if (!hit) return kEscaped;
  const bool front = glm::dot(area_vectors_[hit.triangle], direction) < 0.0f;
  return patches_.element_at(locator_.at(hit.triangle, hit.uv), front);
}

void HemicubeRows::draw(const Hemicube& cube, std::span<const HemicubeView> views) {
  if (painter_ && &cube == &cubes_.front()) {
    paint(cube, views);
    return;
  }
  parallel_for(views.size() * cube.packets(), kGrain, [&](std::size_t i) {
    const HemicubeView& view = views[i / cube.packets()];
    const std::size_t packet = i % cube.packets();
    std::array<Hit, kPacket> hits;
    cube.draw(tracer_, view, packet, hits.data());
    for (std::size_t lane = 0; lane < kPacket; ++lane) {
      const Vec3 direction = cube.direction(view, packet * kPacket + lane);
      items_[i * kPacket + lane] = item(hits[lane], direction);
    }
  });
}

void HemicubeRows::paint(const Hemicube& cube, std::span<const HemicubeView> views) {
  painted_.resize(cube.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    painter_->draw(cube, views[v], painted_);
    parallel_for(cube.size(), kGrain * kPacket, [&](std::size_t i) {
      items_[v * cube.size() + i] = item(painted_[i], cube.direction(views[v], i));
    });
  }
}

/// A hemicube that sees nothing but the inside of a solid stands on a part of the element that the
/// solid covers, and does not count.
void HemicubeRows::add(const Hemicube& cube, std::size_t number, Sum& sum) const {
  const auto items = std::span(items_).subspan(number * cube.size(), cube.size());
  if (std::all_of(items.begin(), items.end(), [](std::uint32_t i) { return i == kNoElement; })) {
    return;
  }
  sum.of_element.resize(patches_.elements());
  for (std::size_t i = 0; i < items.size(); ++i) {
    const double delta = cube.delta()[i];
    if (items[i] >= kEscaped) {
      sum.escaped += delta;
      continue;
    }
    double& factor = sum.of_element[items[i]];
    if (factor == 0.0) sum.met.push_back(items[i]);
    factor += delta;
  }
  ++sum.hemicubes;
}

void HemicubeRows::add_uncovered_point(const Hemicube& cube, std::uint32_t element,
                                       std::uint64_t first, Sum& sum) {
  for (std::uint64_t number = first; number < first + kTries && sum.hemicubes == 0; ++number) {
    const HemicubeView view = view_from_point(element, number);
    draw(cube, {&view, 1});
    add(cube, 0, sum);
  }
}

/// The mean of the sum's hemicubes; all escapes from what is wholly covered.
void HemicubeRows::take(Sum& sum, FormFactorRow& row) const {
  const double scale = sum.hemicubes > 0 ? 1.0 / static_cast<double>(sum.hemicubes) : 0.0;
  row.elements = std::move(sum.met);
  row.factors.resize(row.elements.size());
  for (std::size_t i = 0; i < row.elements.size(); ++i) {
    double& factor = sum.of_element[row.elements[i]];
    row.factors[i] = factor * scale;
    factor = 0.0;
  }
  row.escaped = sum.hemicubes > 0 ? sum.escaped * scale : 1.0;
  sum.met.clear();
  sum.escaped = 0.0;
  sum.hemicubes = 0;
}

void HemicubeRows::from_centres(std::size_t first, std::span<FormFactorRow> rows) {
  const Hemicube& cube = cubes_.front();
  std::vector<HemicubeView> views;
  for (std::size_t begin = 0; begin < rows.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, rows.size() - begin);
    views.clear();
    for (std::size_t i = 0; i < count; ++i) {
      views.push_back(view_from_centre(static_cast<std::uint32_t>(first + begin + i)));
    }
    draw(cube, views);
    parallel_for(count, 1, [&](std::size_t i) { add(cube, i, sums_[i]); });
    for (std::size_t i = 0; i < count; ++i) {
      if (sums_[i].hemicubes == 0) {
        add_uncovered_point(cube, static_cast<std::uint32_t>(first + begin + i), 0, sums_[i]);
      }
      take(sums_[i], rows[begin + i]);
    }
  }
}

void HemicubeRows::from_parts(std::uint32_t element, int divisions, FormFactorRow& row) {
  std::vector<HemicubeView> views;
  // Rows of triangles that stand on their sides, and between them those that stand on their tips.
  for (int y = 0; y < divisions; ++y) {
    for (int x = 0; x < 2 * (divisions - y) - 1; ++x) {
      const double third = x % 2 == 0 ? 1.0 / 3.0 : 2.0 / 3.0;
      const glm::dvec2 centre = (glm::dvec2(x / 2, y) + third) / static_cast<double>(divisions);
      views.push_back(view_at(element, centre, kCentre - 1 - views.size()));
    }
  }
  const Hemicube& cube = cubes_.front();
  Sum& sum = sums_.front();
  for (std::size_t begin = 0; begin < views.size(); begin += kBatch) {
    const auto batch = std::span(views).subspan(begin, std::min(kBatch, views.size() - begin));
    draw(cube, batch);
    for (std::size_t i = 0; i < batch.size(); ++i) add(cube, i, sum);
  }
  if (sum.hemicubes == 0) add_uncovered_point(cube, element, 0, sum);
  take(sum, row);
}

void HemicubeRows::from_points(std::uint32_t element, const Points& points, FormFactorRow& row) {
  const Hemicube& cube = cubes_[points.cube];
  const std::uint64_t end = points.first + points.count;
  Sum& sum = sums_.front();
  std::vector<HemicubeView> views;
  for (std::uint64_t begin = points.first; begin < end; begin += kBatch) {
    views.clear();
    for (std::uint64_t number = begin; number < std::min(end, begin + kBatch); ++number) {
      views.push_back(view_from_point(element, number));
    }
    draw(cube, views);
    for (std::size_t i = 0; i < views.size(); ++i) add(cube, i, sum);
  }
  if (sum.hemicubes == 0) add_uncovered_point(cube, element, end, sum);
  take(sum, row);
}

}  // namespace lantern
