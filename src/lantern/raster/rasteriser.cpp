// SPDX-License-Identifier: MIT
#include "lantern/raster/rasteriser.h"

#include "lantern/core/error.h"
#include "lantern/gl/check.h"
#include "lantern/gl/program.h"
#include "lantern/raster/cheaper_shadows.h"
#include "lantern/raster/colour_quads.h"
#include "lantern/raster/interleaving.h"
#include "lantern/raster/light_shares.h"
#include "lantern/raster/lighting.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/shadow_maps.h"
#include "lantern/raster/stencil_shadows.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/volume_view.h"
#include "lantern/sampling/kronecker.h"
#include "lantern/scene/surface.h"

#include <array>
#include <list>
#include <optional>
#include <utility>
#include <vector>

namespace lantern {
namespace {

/// The world with those triangles alone that no ray passes through; nothing if that is all of them.
std::optional<World> solid_part(const Scene& scene, const World& world) {
  World solid = world;
  solid.triangles.clear();
  solid.materials.clear();
  for (std::size_t t = 0; t < world.size(); ++t) {
    if (has_holes(scene.materials[index(world.materials[t])])) continue;
    solid.triangles.push_back(world.triangles[t]);
    solid.materials.push_back(world.materials[t]);
  }
  if (solid.size() == world.size()) return std::nullopt;
  return solid;
}

/// The way that is asked for or, where depth clamp is missing, the other exact one.
VolumeMethod method(VolumeMethod asked, const gl::Info& gl) {
  return asked == VolumeMethod::kExact && !gl.has(gl::kDepthClamp) ? VolumeMethod::kZFail : asked;
}

/// kVolumes or kMaps.
ShadowMethod shadow_method(const RasterOptions& options, const World& casters,
                           const VirtualLights& lights) {
  if (options.shadows != ShadowMethod::kCheaper) return options.shadows;
  // Who studies volumes wants them.
  if (options.show_volumes || options.volumes != VolumeMethod::kExact) {
    return ShadowMethod::kVolumes;
  }
  return cheaper_shadows(casters, lights, options.samples_of_lights);
}

/// Where light number `i` is.
LightPoint point_of(const VirtualLights& lights, std::size_t i, float scale) {
  if (i >= lights.size()) {
    throw Error(fmt::format("there is no light {} to show the volumes of: the last is {}", i,
                            lights.size() - 1));
  }
  const std::array only{static_cast<std::uint32_t>(i)};
  const auto groups = group_lights(chosen_of(lights, {}, only).lights, {}, scale);
  if (groups.empty()) throw Error(fmt::format("light {} is black and has no volumes", i));
  return groups.front().points.front();
}

}  // namespace

struct Rasteriser::State {
  const Scene& scene;
  const World& world;
  const gl::Info& gl;
  RasterOptions options;
  ViewOptions view_options;
  gl::ShaderFiles files;
  StageTimes times;
  Surfaces surfaces;
  std::optional<World> solid;  // where some of the world has holes
  std::optional<StencilShadows> volumes;
  std::list<ShadowMaps> maps;
  std::optional<Lighting> lighting;  // or, where pixels have lights of their own,
  std::optional<Interleaving> interleaving;
  gl::Program resolve, resolve_and_add;
  std::array<QuadTarget, 2> radiance;  // the sum of some samples, and that with one more
  gl::VertexArray no_vertices;

  State(const Scene& of, const World& all, const gl::Info& info, const RasterOptions& with)
      : scene(of),
        world(all),
        gl(info),
        options(with),
        view_options{.width = with.width,
                     .height = with.height,
                     .step = with.tile,
                     .radius = all.bounds.radius(),
                     .range = gl.has(gl::kClipControl) ? ClipRange::kFarIs0 : ClipRange::kFarIs1},
        surfaces(scene, all, files),
        solid(solid_part(scene, all)),
        resolve(resolve_program(false)),
        resolve_and_add(resolve_program(true)),
        radiance{QuadTarget(quads().size()), QuadTarget(quads().size())} {}

  /// Makes what shadows are found by, once it is known of what lights.
  void choose_shadows(const VirtualLights& lights) {
    if (lighting || interleaving) return;
    const bool none_solid = solid && solid->triangles.empty();
    const bool by_maps = !none_solid && shadow_method(options, solid ? *solid : world, lights) ==
                                            ShadowMethod::kMaps;
    if (!by_maps && !none_solid) {
      volumes.emplace(world, files, method(options.volumes, gl), solid ? &*solid : nullptr);
    }
    Shadows shadows{.volumes = volumes ? &*volumes : nullptr};
    // What has holes would hide in maps what is behind it; volumes know triangles alone.
    for (const MapCasters casters : {MapCasters::kSolid, MapCasters::kWithHoles}) {
      if (casters == MapCasters::kSolid ? !by_maps : !solid) continue;
      maps.emplace_back(scene, world, surfaces, files,
                        ShadowMapOptions{.range = view_options.range, .casters = casters});
      shadows.maps.push_back(&maps.back());
    }
    if (options.tile > 1) {
      interleaving.emplace(surfaces, shadows, times, files, view_options);
    } else {
      lighting.emplace(surfaces, shadows, times, files, options.width, options.height);
    }
  }

  gl::Program resolve_program(bool add) const {
    return tile_program(files, "shaders/resolve.frag.glsl", quads().tile,
                        {{"ADD", add ? "1" : "0"}});
  }

  /// Of sample number `n`.
  std::vector<LightGroup> groups(const VirtualLights& lights, std::span<const float> bounds,
                                 std::size_t n) const {
    const auto of_pixels = [&](const VirtualLights& all, std::span<const float> their_bounds) {
      const float scale = world.coordinate_scale();
      const auto shares = static_cast<std::size_t>(options.tile * options.tile);
      return shares > 1 ? group_shares(all, their_bounds, scale, shares, n)
                        : group_lights(all, their_bounds, scale);
    };
    if (!options.deal_lights) return of_pixels(lights, bounds);
    const auto samples = static_cast<std::size_t>(options.samples);
    const BoundedLights mine = deal(lights, bounds, samples, n % samples, n / samples);
    return of_pixels(mine.lights, mine.bounds);
  }

  /// Of the whole picture.
  View view_of_sample(const Camera& camera, std::size_t n) const {
    ViewOptions whole = view_options;
    whole.offset = place_in_pixel(n);
    whole.step = 1;
    return make_view(camera, whole);
  }
  QuadLayout quads() const {
    return {options.tile > 1 ? options.tile : MaskedShading::kTile, options.width, options.height};
  }
  const ColourQuads& irradiance() const {
    return interleaving ? interleaving->irradiance() : lighting->shading().irradiance().colours;
  }
  const GBuffer& whole_g_buffer() const {
    return interleaving ? interleaving->g_buffer() : lighting->g_buffer();
  }

  /// Adds the radiance of sample number `n` of all pixels to that of others, unless it `is_first`.
  void draw(const Camera& camera, std::span<const LightGroup> groups, std::size_t n, bool is_first,
            const std::function<bool()>& group_done) {
    if (interleaving) {
      interleaving->draw(camera, place_in_pixel(n), groups, group_done);
    } else {
      lighting->draw(view_of_sample(camera, n), groups, group_done);
    }
    times.begin(Stage::kResolve);
    const gl::Program& program = is_first ? resolve : resolve_and_add;
    program.set("u_reflectances", 0, whole_g_buffer().reflectances);
    program.set("u_emissions", 1, whole_g_buffer().emissions);
    irradiance().set_in(program, 2);
    if (!is_first) {
      constexpr int kUnit = 2 + ColourQuads::kUnits;
      program.set("u_red_before", kUnit, radiance[0].colours.red);
      program.set("u_green_before", kUnit + 1, radiance[0].colours.green);
      program.set("u_blue_before", kUnit + 2, radiance[0].colours.blue);
    }
    radiance[1].framebuffer.bind();
    gl::draw_full_screen(no_vertices);
    std::swap(radiance[0], radiance[1]);
    times.end();
    gl::check("drawing the radiance");
  }
};

Rasteriser::Rasteriser(const Scene& scene, const World& world, const gl::Info& gl,
                       const RasterOptions& options) {
  if (!gl.has(gl::kFloatTargets)) {
    throw Error("this OpenGL cannot draw into float textures; use --backend cpu");
  }
  state_ = std::make_unique<State>(scene, world, gl, options);
}

Rasteriser::~Rasteriser() = default;

Image Rasteriser::draw(const Camera& camera, const VirtualLights& lights,
                       std::span<const float> bounds, std::size_t pass, const StopFlag& stop,
                       const std::function<void(std::size_t)>& pixels_done) {
  State& s = *state_;
  const RasterOptions& options = s.options;
  s.choose_shadows(lights);
  Image image(options.width, options.height);
  std::optional<VolumeView> volumes;
  if (options.show_volumes) {
    if (!s.volumes) throw Error("there are no shadow volumes to show: nothing solid casts any");
    volumes.emplace(s.whole_g_buffer());
  }
  std::size_t reported = 0;
  for (int sample = 0; sample < options.samples && !(sample > 0 && stop.load()); ++sample) {
    const std::size_t n =
        pass * static_cast<std::size_t>(options.samples) + static_cast<std::size_t>(sample);
    const auto groups = s.groups(lights, bounds, n);
    for (ShadowMaps& maps : s.maps) maps.keep(groups);
    std::size_t step = 0;
    s.draw(camera, groups, n, sample == 0, [&] {
      const std::size_t done = image.pixels.size() *
                               (static_cast<std::size_t>(sample) * groups.size() + ++step) /
                               (static_cast<std::size_t>(options.samples) * groups.size());
      if (pixels_done) pixels_done(done - std::exchange(reported, done));
      return !stop.load();
    });
    s.times.collect();
    glFinish();  // what is told as done is
    if (volumes) {
      volumes->add(*s.volumes, point_of(lights, *options.show_volumes, s.world.coordinate_scale()),
                   s.view_of_sample(camera, n));
    }
  }
  const std::vector<Rgb> sum = s.radiance[0].read(s.quads());
  const float share = 1.0f / static_cast<float>(options.samples);
  for (std::size_t i = 0; i < sum.size(); ++i) image.pixels[i] = share * sum[i];
  if (volumes) volumes->blend_over(image);
  return image;
}

void Rasteriser::draw_frame(const Camera& camera, const VirtualLights& lights,
                            std::span<const float> bounds, std::size_t sample) {
  state_->times.collect();
  state_->choose_shadows(lights);
  const auto groups = state_->groups(lights, bounds, sample);
  for (ShadowMaps& maps : state_->maps) maps.keep(groups);
  state_->draw(camera, groups, sample, true, [] { return true; });
}

std::map<std::string, double> Rasteriser::seconds_of_stages() {
  state_->times.collect();
  return state_->times.seconds();
}

}  // namespace lantern
