// SPDX-License-Identifier: MIT
#include "lantern/raster/silhouettes.h"

namespace lantern {
namespace {

constexpr std::uint32_t kSeveral = 1u << 31;  // beside the number of an edge: there are others

}  // namespace

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

/// Whether what is between these places of the chain runs along their line as the light sees it.
bool SilhouetteSimplifier::is_along(std::size_t from, std::size_t to, float distance) const {
  const Vec3& start = vertices_[chain_[from]];
  const Vec3 normal = glm::cross(light_.w * start - Vec3(light_), vertices_[chain_[to]] - start);
  const float most = distance * distance * glm::dot(normal, normal);
  for (std::size_t i = from + 1; i < to; ++i) {
    const float off = glm::dot(normal, vertices_[chain_[i]] - start);
    if (off * off > most) return false;
  }
  return true;
}

std::span<const uvec3> SilhouetteSimplifier::simplify(std::vector<VolumeEdge>& edges,
                                                      std::size_t first, float distance) {
  // Each vertex more is one more to try each time.
  constexpr std::size_t kMostBetween = 16;
  edges_.assign(edges.begin() + static_cast<std::ptrdiff_t>(first), edges.end());
  edges.resize(first);
  taken_.assign(edges_.size(), 0);
  left_out_.clear();
  link();
  for (std::size_t edge = 0; edge < edges_.size(); ++edge) {
    if (taken_[edge] != 0) continue;
    follow(edge);
    for (std::size_t from = 0, to = 1; to < chain_.size(); from = to++) {
      while (to + 1 < chain_.size() && to - from <= kMostBetween &&
             chain_[to + 1] != chain_[from] && is_along(from, to + 1, distance)) {
        left_out_.emplace_back(chain_[from], chain_[to], chain_[to + 1]);
        ++to;
      }
      edges.push_back({chain_[from], chain_[to]});
    }
  }
  return left_out_;
}

}  // namespace lantern
