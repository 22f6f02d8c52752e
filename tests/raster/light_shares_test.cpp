// SPDX-License-Identifier: MIT
// How lights are shared out, without GL.
#include "lantern/raster/light_shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace lantern {
namespace {

/// Paths as the walk leaves them: the first survive.
VirtualLights walked(const std::vector<std::size_t>& of_bounce) {
  VirtualLights lights;
  for (std::uint32_t path = 0; path < of_bounce[0]; ++path) {
    for (std::uint32_t bounce = 0; bounce < of_bounce.size() && path < of_bounce[bounce];
         ++bounce) {
      lights.path.push_back(path);
      lights.bounce.push_back(bounce);
    }
  }
  lights.position.resize(lights.path.size());
  return lights;
}

TEST(ShareOut, GivesEveryLightToOneSetAndMuchTheSameNumberToAll) {
  const VirtualLights lights = walked({100, 61, 37, 9, 2});
  const auto sets = share_out(lights, 16, 0);
  ASSERT_EQ(sets.size(), 16u);
  std::set<std::uint32_t> all;
  std::size_t most = 0, least = lights.size();
  for (const auto& set : sets) {
    all.insert(set.begin(), set.end());
    most = std::max(most, set.size());
    least = std::min(least, set.size());
  }
  EXPECT_EQ(all.size(), lights.size());
  // Each of five bounces rounds by less than one.
  EXPECT_LE(most - least, 5u);
}

TEST(ShareOut, GivesEverySetOfABounceARunOfPaths) {
  // A run of a low-discrepancy sequence is one; every 16th of its points are not: they have the
  // first four binary digits in common.
  const VirtualLights lights = walked({64, 32});
  for (const auto& set : share_out(lights, 16, 3)) {
    std::vector<std::uint32_t> first;
    for (const std::uint32_t i : set) {
      if (lights.bounce[i] == 0) first.push_back(lights.path[i]);
    }
    ASSERT_EQ(first.size(), 4u);
    EXPECT_EQ(first.back() - first.front(), 3u);
  }
}

TEST(GroupShares, GivesEveryLightOnceInRoundsThatOneBlockHolds) {
  VirtualLights lights = walked({700, 300});
  const std::size_t count = lights.size();
  lights.normal.assign(count, Vec3(0.0f, 0.0f, 1.0f));
  lights.flux.assign(count, Rgb(1.0f));
  lights.cone.assign(count, Vec2(0.0f));
  for (std::size_t i = 0; i < count; ++i) {
    lights.position[i] = Vec3(static_cast<float>(i), 0.0f, 0.0f);
    lights.kind.push_back(i % 10 == 0 ? LightKind::kPoint : LightKind::kSurface);
  }
  for (const std::size_t shares : {4u, 16u, 64u}) {
    std::multiset<float> places;
    std::map<std::size_t, std::vector<const LightGroup*>> rounds;
    const std::vector<LightGroup> groups = group_shares(lights, {}, 1.0f, shares, 5);
    for (const LightGroup& group : groups) {
      ASSERT_LT(group.share, shares);
      rounds[group.round].push_back(&group);
      for (const LightPoint& point : group.points) places.insert(point.x);
    }
    EXPECT_TRUE(std::is_sorted(groups.begin(), groups.end(),
                               [](const auto& a, const auto& b) { return a.round < b.round; }));
    ASSERT_EQ(places.size(), count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(places.count(static_cast<float>(i)), 1u);
    for (const auto& [number, round] : rounds) {
      std::set<std::size_t> seen;
      std::size_t in_round = 0;
      for (const LightGroup* group : round) {
        EXPECT_EQ(group->formula, round.front()->formula);
        EXPECT_TRUE(seen.insert(group->share).second);
        in_round += group->records.size();
      }
      EXPECT_LE(in_round, kLightsInRound) << number;
    }
  }
}

TEST(ShareOut, TurnsWithTheSample) {
  const VirtualLights lights = walked({32});
  const auto before = share_out(lights, 4, 0), after = share_out(lights, 4, 1);
  for (std::size_t set = 0; set < 4; ++set) EXPECT_EQ(before[set], after[(set + 1) % 4]);
}

}  // namespace
}  // namespace lantern
