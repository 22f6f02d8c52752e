// SPDX-License-Identifier: MIT
#include "lantern/raster/light_round.h"

#include "lantern/raster/colour_quads.h"
#include "lantern/raster/light_shares.h"

#include <cstddef>
#include <string>

namespace lantern {
namespace {

constexpr GLuint kLightsBinding = 0;

}  // namespace

LightRound::LightRound(const gl::Texture& depth, int shares)
    : masks(depth),
      lights_of(gl::Format::kRg32ui, shares, 1),
      lights(std::span<const LightRecord>()) {}

void LightRound::hold(std::span<const LightGroup> groups) {
  std::vector<LightRecord> records;
  std::vector<std::uint32_t> first_and_count(2 * static_cast<std::size_t>(lights_of.width()));
  for (const LightGroup& group : groups) {
    first_and_count[2 * group.share] = static_cast<std::uint32_t>(records.size());
    first_and_count[2 * group.share + 1] = static_cast<std::uint32_t>(group.records.size());
    records.insert(records.end(), group.records.begin(), group.records.end());
  }
  records.resize(kLightsInRound);
  formula = groups.front().formula;
  lights.write(std::span<const LightRecord>(records));
  lights_of.write(std::span<const std::uint32_t>(first_and_count));
}

std::vector<gl::Program> LightRound::programs(const gl::ShaderFiles& files, const char* fragment,
                                              int tile, const std::vector<gl::Definition>& more) {
  std::vector<gl::Program> programs;
  for (int formula = 0; formula < kLightFormulas; ++formula) {
    std::vector<gl::Definition> definitions = more;
    definitions.push_back({"KIND", std::to_string(formula)});
    definitions.push_back({"LIGHTS", std::to_string(kLightsInRound)});
    programs.push_back(tile_program(files, fragment, tile, definitions));
    programs.back().set_block("Lights", kLightsBinding);
  }
  return programs;
}

const gl::Program& LightRound::use(const std::vector<gl::Program>& programs, bool is_first) const {
  const gl::Program& program = programs[static_cast<std::size_t>(formula)];
  lights.bind_as_uniforms(kLightsBinding);
  program.set("u_masks", 0, masks.mask);
  program.set("u_lights_of", 1, lights_of);
  program.set("u_first_round", is_first ? 1 : 0);
  return program;
}

}  // namespace lantern
