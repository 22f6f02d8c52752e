// SPDX-License-Identifier: MIT
#include "lantern/raster/silhouettes.h"

#include <algorithm>

namespace lantern {
namespace {

constexpr std::uint32_t kSeveral = 1u << 31;  // beside the number of an edge: there are others

}  // namespace

SilhouetteSimplifier::SilhouetteSimplifier(std::span<const Vec3> vertices, const LightPoint& light,
                                           const Vec3& eye)
    : vertices_(vertices), light_(light), eye_(eye), outgoing_(vertices.size(), 0u) {}

void SilhouetteSimplifier::link() {
  for (std::uint32_t i = 0; i < edges_.size(); ++i) {
    std::uint32_t& outgoing = outgoing_[edges_[i].from];
    const std::uint32_t known = outgoing & ~kSeveral;
    // What stands there may be left from another part.
    if (known < i && edges_[known].from == edges_[i].from) {
      outgoing |= kSeveral;
    } else {
      outgoing = i;
    }
  }
}

const VolumeEdge* SilhouetteSimplifier::next(std::uint32_t vertex) const {
  const std::uint32_t outgoing = outgoing_[vertex];
  const bool is_one = outgoing < edges_.size() && edges_[outgoing].from == vertex;
  return is_one ? &edges_[outgoing] : nullptr;
}

/// The chain from this edge on, to where others meet it, or it ends, or it began.
void SilhouetteSimplifier::follow(std::size_t edge) {
  chain_.assign({edges_[edge].from, edges_[edge].to});
  taken_[edge] = 1;
  while (chain_.back() != chain_.front()) {
    const VolumeEdge* const further = next(chain_.back());
    if (!further) return;
    std::uint8_t& taken = taken_[static_cast<std::size_t>(further - edges_.data())];
    if (taken != 0) return;
    taken = 1;
    chain_.push_back(further->to);
  }
}

/// Whether what is between these places of the chain runs along their line, for the light.
bool SilhouetteSimplifier::is_along(std::size_t from, std::size_t to,
                                    const SilhouetteTolerance& tolerance) const {
  const Vec3& start = vertices_[chain_[from]];
  const Vec3 normal = glm::cross(light_.w * start - Vec3(light_), vertices_[chain_[to]] - start);
  const float length2 = glm::dot(normal, normal);
  for (std::size_t i = from + 1; i < to; ++i) {
    const Vec3& p = vertices_[chain_[i]];
    const Vec3 from_eye = p - eye_, from_light = light_.w * p - Vec3(light_);
    float nearest2 = glm::dot(from_eye, from_eye);
    if (light_.w != 0.0f) nearest2 = std::min(nearest2, glm::dot(from_light, from_light));
    const float most2 = std::min(tolerance.distance * tolerance.distance,
                                 tolerance.angle * tolerance.angle * nearest2);
    const float off = glm::dot(normal, p - start);
    if (off * off > most2 * length2) return false;
  }
  return true;
}

std::span<const uvec3> SilhouetteSimplifier::simplify(std::vector<VolumeEdge>& edges,
                                                      std::size_t first,
                                                      const SilhouetteTolerance& tolerance) {
  edges_.assign(edges.begin() + static_cast<std::ptrdiff_t>(first), edges.end());
  edges.resize(first);
  taken_.assign(edges_.size(), 0);
  link();
  left_out_.clear();
  for (std::size_t edge = 0; edge < edges_.size(); ++edge) {
    if (taken_[edge] != 0) continue;
    follow(edge);
    for (std::size_t from = 0, to = 1; to < chain_.size(); from = to++) {
      while (to + 1 < chain_.size() && chain_[to + 1] != chain_[from] &&
             is_along(from, to + 1, tolerance)) {
        left_out_.emplace_back(chain_[from], chain_[to], chain_[to + 1]);
        ++to;
      }
      edges.push_back({chain_[from], chain_[to]});
    }
  }
  return left_out_;
}

}  // namespace lantern
