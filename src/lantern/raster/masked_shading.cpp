// SPDX-License-Identifier: MIT
#include "lantern/raster/masked_shading.h"

#include "lantern/gl/check.h"

#include <algorithm>
#include <cassert>
#include <span>
#include <string>
#include <utility>

namespace lantern {
namespace {

constexpr GLuint kLightsBinding = 0;

}  // namespace

MaskedShading::MaskedShading(const gl::ShaderFiles& files, int width, int height,
                             Witnesses witnesses)
    : witnesses_(witnesses),
      lights_(std::span<const LightRecord>()),
      sums_{QuadTarget(QuadLayout{kTile, width, height}.size()),
            QuadTarget(QuadLayout{kTile, width, height}.size())} {
  const bool by_mask = witnesses != Witnesses::kMaps, by_maps = witnesses != Witnesses::kMask;
  const char* shader =
      by_maps ? "shaders/shade_mapped.frag.glsl" : "shaders/shade_masked.frag.glsl";
  for (int formula = 0; formula < kLightFormulas; ++formula) {
    shade_.push_back(tile_program(
        files, shader, kTile, {{"KIND", std::to_string(formula)}, {"ASKED", by_mask ? "1" : "0"}}));
    shade_.back().set_block("Lights", kLightsBinding);
  }
}

void MaskedShading::add(const LightGroup& group, const GBuffer& g_buffer, const SeenBy& seen,
                        bool is_first) {
  assert((seen.mask != nullptr) == (witnesses_ != Witnesses::kMaps));
  assert((seen.maps != nullptr) == (witnesses_ != Witnesses::kMask));
  std::array<LightRecord, kLightsInGroup> records;
  std::copy(group.records.begin(), group.records.end(), records.begin());
  lights_.write(std::span<const LightRecord>(records));
  lights_.bind_as_uniforms(kLightsBinding);
  const gl::Program& program = shade_[static_cast<std::size_t>(group.formula)];
  program.set("u_points", 0, g_buffer.points);
  program.set("u_reflectances", 1, g_buffer.reflectances);
  program.set("u_first_lights", is_first ? 1 : 0);
  sums_[0].colours.set_in(program, 2);
  constexpr int kUnit = 2 + ColourQuads::kUnits;
  if (seen.mask) program.set("u_mask", kUnit, *seen.mask);
  if (seen.maps) {
    seen.maps->set_in(program, kUnit + 1);
  } else {
    program.set("u_count", static_cast<int>(group.records.size()));
  }
  sums_[1].framebuffer.bind();
  gl::draw_full_screen(no_vertices_);
  std::swap(sums_[0], sums_[1]);
  gl::check("shading");
}

}  // namespace lantern
