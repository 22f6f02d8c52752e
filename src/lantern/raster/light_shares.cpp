// SPDX-License-Identifier: MIT
#include "lantern/raster/light_shares.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace lantern {

BoundedLights chosen_of(const VirtualLights& lights, std::span<const float> bounds,
                        std::span<const std::uint32_t> chosen) {
  BoundedLights few;
  few.lights.paths = lights.paths;
  few.lights.reflectivity = lights.reflectivity;
  for (const std::uint32_t i : chosen) {
    few.lights.position.push_back(lights.position[i]);
    few.lights.normal.push_back(lights.normal[i]);
    few.lights.flux.push_back(lights.flux[i]);
    few.lights.path.push_back(lights.path[i]);
    few.lights.bounce.push_back(lights.bounce[i]);
    few.lights.kind.push_back(lights.kind[i]);
    few.lights.cone.push_back(lights.cone[i]);
    if (!bounds.empty()) few.bounds.push_back(bounds[i]);
  }
  return few;
}

std::vector<std::vector<std::uint32_t>> share_out(const VirtualLights& lights, std::size_t shares,
                                                  std::size_t turn) {
  std::vector<std::size_t> of_bounce;  // how many lights
  for (const std::uint32_t bounce : lights.bounce) {
    of_bounce.resize(std::max<std::size_t>(of_bounce.size(), bounce + 1));
    ++of_bounce[bounce];
  }
  std::vector<std::vector<std::uint32_t>> sets(shares);
  std::vector<std::size_t> seen(of_bounce.size(), 0), start(of_bounce.size(), turn);
  for (std::size_t b = 1; b < start.size(); ++b) start[b] = start[b - 1] + of_bounce[b - 1];
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    const std::uint32_t bounce = lights.bounce[i];
    const std::size_t run = seen[bounce]++ * shares / of_bounce[bounce];
    sets[(start[bounce] + run) % shares].push_back(i);
  }
  return sets;
}

BoundedLights deal(const VirtualLights& lights, std::span<const float> bounds, std::size_t shares,
                   std::size_t sample, std::size_t turn) {
  BoundedLights few = chosen_of(lights, bounds, share_out(lights, shares, turn)[sample]);
  for (Rgb& flux : few.lights.flux) flux *= static_cast<float>(shares);
  return few;
}

std::vector<LightGroup> group_shares(const VirtualLights& lights, std::span<const float> bounds,
                                     float coordinate_scale, std::size_t shares, std::size_t turn) {
  const std::size_t most = std::min(kLightsInGroup, kLightsInRound / shares);
  assert(most > 0);
  std::array<std::vector<std::vector<LightGroup>>, kLightFormulas> rounds;
  const auto sets = share_out(lights, shares, turn);
  for (std::size_t share = 0; share < shares; ++share) {
    const BoundedLights own = chosen_of(lights, bounds, sets[share]);
    std::array<std::size_t, kLightFormulas> round{};
    for (LightGroup& group : group_lights(own.lights, own.bounds, coordinate_scale, most)) {
      const auto formula = static_cast<std::size_t>(group.formula);
      const std::size_t number = round[formula]++;
      if (number == rounds[formula].size()) rounds[formula].emplace_back();
      group.share = share;
      rounds[formula][number].push_back(std::move(group));
    }
  }
  std::vector<LightGroup> groups;
  std::size_t number = 0;
  for (auto& of_formula : rounds) {
    for (std::vector<LightGroup>& round : of_formula) {
      for (LightGroup& group : round) {
        group.round = number;
        groups.push_back(std::move(group));
      }
      ++number;
    }
  }
  return groups;
}

}  // namespace lantern
