// SPDX-License-Identifier: MIT
#include "lantern/path/light_tree.h"

#include "lantern/core/hash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lantern {
namespace {

float random(std::uint64_t& state) { return to_unit_float(hash(++state)); }

Vec3 random_point(std::uint64_t& state) {
  const float x = random(state), y = random(state);
  return 2.0f * Vec3(x, y, random(state)) - 1.0f;
}

std::vector<LightBound> some_lights(std::size_t count) {
  std::uint64_t state = 7;
  std::vector<LightBound> lights(count);
  for (LightBound& light : lights) {
    const Vec3 at = random_point(state);
    light.box.add(at);
    light.box.add(at + 0.05f * random_point(state));
    light.axis = glm::normalize(random_point(state));
    light.spread = random(state) < 0.3f ? kPi : 0.5f * random(state);
    light.strength = 0.01f + random(state);
  }
  return lights;
}

TEST(LightTree, TakesEachLightAsOftenAsItSays) {
  constexpr std::size_t kLights = 23;
  const LightTree tree(some_lights(kLights));
  std::uint64_t state = 1;
  for (int place = 0; place < 5; ++place) {
    const Vec3 point = 1.5f * random_point(state), normal = glm::normalize(random_point(state));
    std::vector<double> counts(kLights), probabilities(kLights);
    double sum = 0.0;
    for (std::uint32_t i = 0; i < kLights; ++i) {
      probabilities[i] = static_cast<double>(tree.probability(i, point, normal));
      EXPECT_GT(probabilities[i], 0.0);
      sum += probabilities[i];
    }
    // Each is a product of a few rounded quotients.
    EXPECT_NEAR(sum, 1.0, 1e-5);
    for (double& p : probabilities) p /= sum;
    // Strata of u: what is left of it must be uniform again within each choice.
    constexpr int kDraws = 100'000;
    double rest = 0.0;
    for (int i = 0; i < kDraws; ++i) {
      const float u = (static_cast<float>(i) + 0.5f) / float{kDraws};
      const LightTree::Choice choice = tree.choose(point, normal, u);
      // The same product, from the other end.
      ASSERT_FLOAT_EQ(choice.probability, tree.probability(choice.light, point, normal));
      ASSERT_GE(choice.rest, 0.0f);
      ASSERT_LT(choice.rest, 1.0f);
      rest += static_cast<double>(choice.rest) / kDraws;
      ++counts[choice.light];
    }
    // In steps of 1e-5 every share is right to one step at either end.
    for (std::size_t i = 0; i < kLights; ++i)
      EXPECT_NEAR(counts[i], probabilities[i] * kDraws, 3.0);
    EXPECT_NEAR(rest, 0.5, 1e-2);
  }
}

/// Of two lamps alike the near one is taken more often by the square of the distances, and one that
/// looks away or lies behind the surface hardly at all.
TEST(LightTree, PrefersWhatSendsMore) {
  const auto lamp = [](const Vec3& at, const Vec3& axis) {
    LightBound light;
    light.box.add(at);
    light.axis = axis;
    light.strength = 2.0f;
    return light;
  };
  const Vec3 up(0, 1, 0), origin(0.0f);
  const auto share_of_first = [&](const LightBound& a, const LightBound& b) {
    return LightTree(std::vector{a, b}).probability(0, origin, up);
  };
  EXPECT_NEAR(share_of_first(lamp({0, 1, 0}, -up), lamp({0, 3, 0}, -up)), 0.9f, 1e-5f);
  EXPECT_GT(share_of_first(lamp({0, 1, 0}, -up), lamp({0, 1, 0}, up)), 0.95f);
  EXPECT_GT(share_of_first(lamp({0, 1, 0}, -up), lamp({0, -1, 0}, up)), 0.95f);
  // At 60 degrees from the normal and 60 from the lamp's axis a quarter is left.
  const Vec3 aside(std::sqrt(0.75f), 0.5f, 0.0f);
  EXPECT_NEAR(share_of_first(lamp(up, -up), lamp(aside, -up)), 0.8f, 1e-5f);
  // A light alone and none.
  EXPECT_EQ(LightTree(std::vector{lamp(up, up)}).probability(0, origin, up), 1.0f);
  EXPECT_TRUE(LightTree(std::vector<LightBound>{}).empty());
}

TEST(LightTree, TakesLightsAtOnePlaceAndAtThePointItself) {
  const std::vector<LightBound> lights(5, [] {
    LightBound light;
    light.box.add(Vec3(1.0f));
    light.strength = 3.0f;
    return light;
  }());
  const LightTree tree(lights);
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    const float p = tree.probability(i, Vec3(1.0f), Vec3(0, 1, 0));
    EXPECT_GT(p, 0.05f);
    EXPECT_LT(p, 0.5f);
  }
}

}  // namespace
}  // namespace lantern
