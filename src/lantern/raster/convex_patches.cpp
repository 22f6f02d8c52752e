// SPDX-License-Identifier: MIT
#include "lantern/raster/convex_patches.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace lantern {
namespace {

/// A patch that grows from one triangle, whose front or back is outside.
class Growing {
 public:
  Growing(const World& world, float rounding) : world_(world), rounding_(rounding) {}

  void start(std::uint32_t triangle, std::uint32_t side) {
    members_.clear();
    add(triangle, plane_of(triangle, side), side);
  }

  /// Adds the triangle, with this side outside, if all stays convex.
  bool take(std::uint32_t triangle, std::uint32_t side) {
    const Vec4 plane = plane_of(triangle, side);
    if (!(glm::dot(Vec3(plane), Vec3(plane)) > 0.0f)) return false;
    for (const Member& member : members_) {
      if (!is_behind(member.plane, triangle) || !is_behind(plane, member.triangle)) return false;
    }
    add(triangle, plane, side);
    return true;
  }

  struct Member {
    std::uint32_t triangle, side;
    Vec4 plane;  // all of the patch is on its negative side
  };
  const std::vector<Member>& members() const { return members_; }

  bool is_flat() const {
    return std::all_of(members_.begin(), members_.end(), [&](const Member& member) {
      return is_behind(-members_[0].plane, member.triangle);
    });
  }

 private:
  void add(std::uint32_t triangle, const Vec4& plane, std::uint32_t side) {
    members_.push_back({triangle, side, plane});
  }
  Vec4 plane_of(std::uint32_t triangle, std::uint32_t side) const {
    const Vec3 area = world_.area_vector(triangle);
    if (!has_area(area)) return Vec4(0.0f);
    const Vec3 normal = glm::normalize(side == kFrontIsOutside ? area : -area);
    return Vec4(normal, -glm::dot(normal, world_.positions[world_.triangles[triangle].x]));
  }
  bool is_behind(const Vec4& plane, std::uint32_t triangle) const {
    const uvec3 t = world_.triangles[triangle];
    const auto distance = [&](std::uint32_t v) {
      return glm::dot(Vec3(plane), world_.positions[v]) + plane.w;
    };
    return std::max(distance(t.x), std::max(distance(t.y), distance(t.z))) <= rounding_;
  }

  const World& world_;
  float rounding_;
  std::vector<Member> members_;
};

/// Whether two triangles run along the edge that they share in opposite directions, as neighbours
/// do whose fronts are on the same side.
bool turn_alike(const World& world, std::uint32_t a, int corner, std::uint32_t b) {
  const Vec3 from = world.positions[world.triangles[a][corner]];
  const Vec3 to = world.positions[world.triangles[a][(corner + 1) % 3]];
  for (int i = 0; i < 3; ++i) {
    if (world.positions[world.triangles[b][i]] == to &&
        world.positions[world.triangles[b][(i + 1) % 3]] == from) {
      return true;
    }
  }
  return false;
}

}  // namespace

ConvexPatches find_convex_patches(const World& world,
                                  std::span<const std::array<std::uint32_t, 3>> neighbours) {
  // Each triangle is compared with all of its patch: large worlds have smaller patches.
  constexpr std::size_t kLargest = 512, kComparisons = 1u << 25;
  const std::size_t largest =
      std::clamp<std::size_t>(kComparisons / std::max<std::size_t>(world.size(), 1), 1, kLargest);
  // Planes are as exact as shadow rays start off surfaces.
  const float rounding = 0x1p-18f * world.coordinate_scale();
  Growing front(world, rounding), back(world, rounding);
  ConvexPatches result;
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  result.patch_of.assign(world.size(), kNone);
  result.sides.assign(world.size(), kFrontIsOutside | kBackIsOutside);
  std::vector<std::uint32_t> tried_for(world.size(), 0);
  std::uint32_t attempt = 0;
  const auto grow = [&](Growing& patch, std::uint32_t seed, std::uint32_t seed_side) {
    ++attempt;
    patch.start(seed, seed_side);
    tried_for[seed] = attempt;
    if (!has_area(world.area_vector(seed))) return;
    for (std::size_t i = 0; i < patch.members().size(); ++i) {
      const Growing::Member member = patch.members()[i];
      for (int corner = 0; corner < 3; ++corner) {
        if (patch.members().size() >= largest) return;
        const std::uint32_t next = neighbours[member.triangle][static_cast<std::size_t>(corner)];
        if (next == kNoTriangle || result.patch_of[next] != kNone) continue;
        if (std::exchange(tried_for[next], attempt) == attempt) continue;
        const bool alike = turn_alike(world, member.triangle, corner, next);
        patch.take(next, alike ? member.side : member.side ^ 3u);
      }
    }
  };
  for (std::uint32_t seed = 0; seed < world.size(); ++seed) {
    if (result.patch_of[seed] != kNone) continue;
    grow(front, seed, kFrontIsOutside);
    grow(back, seed, kBackIsOutside);
    const Growing& larger = back.members().size() > front.members().size() ? back : front;
    const bool flat = larger.is_flat();
    const auto patch = static_cast<std::uint32_t>(result.patches.size());
    result.patches.push_back({static_cast<std::uint32_t>(result.order.size()),
                              static_cast<std::uint32_t>(larger.members().size())});
    for (const Growing::Member& member : larger.members()) {
      result.order.push_back(member.triangle);
      result.patch_of[member.triangle] = patch;
      if (!flat) result.sides[member.triangle] = member.side;
    }
  }
  return result;
}

}  // namespace lantern
