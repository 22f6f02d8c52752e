// SPDX-License-Identifier: MIT
#include "lantern/raster/rasteriser.h"

#include "lantern/core/error.h"
#include "lantern/gl/check.h"
#include "lantern/gl/program.h"
#include "lantern/raster/interleaving.h"
#include "lantern/raster/lighting.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/shadow_maps.h"
#include "lantern/raster/stencil_shadows.h"
#include "lantern/raster/surfaces.h"
#include "lantern/raster/volume_view.h"
#include "lantern/sampling/kronecker.h"
#include "lantern/scene/surface.h"

#include <algorithm>
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

VirtualLights subset(const VirtualLights& lights, std::span<const std::uint32_t> chosen) {
  VirtualLights few;
  few.paths = lights.paths;
  few.reflectivity = lights.reflectivity;
  for (const std::uint32_t i : chosen) {
    few.position.push_back(lights.position[i]);
    few.normal.push_back(lights.normal[i]);
    few.flux.push_back(lights.flux[i]);
    few.path.push_back(lights.path[i]);
    few.bounce.push_back(lights.bounce[i]);
    few.kind.push_back(lights.kind[i]);
    few.cone.push_back(lights.cone[i]);
  }
  return few;
}

/// Lights and, for each of them, the bound on its geometry term.
struct Bounded {
  VirtualLights lights;
  std::vector<float> bounds;
};

/// Those that one of `shares` samples is dealt, as strong as all of them together.
Bounded dealt(const VirtualLights& lights, std::span<const float> bounds, std::size_t shares,
              std::size_t sample, std::size_t turn) {
  const std::vector<std::uint32_t> chosen = share_out(lights, shares, turn)[sample];
  Bounded few = {.lights = subset(lights, chosen), .bounds = {}};
  for (Rgb& flux : few.lights.flux) flux *= static_cast<float>(shares);
  if (bounds.empty()) return few;
  for (const std::uint32_t i : chosen) few.bounds.push_back(bounds[i]);
  return few;
}

/// The lights of each pixel of a tile, row by row; a tile of one pixel has them all.
std::vector<std::vector<LightGroup>> groups_of_tile(const VirtualLights& lights,
                                                    std::span<const float> bounds, float scale,
                                                    int tile, std::size_t turn) {
  if (tile == 1) return {group_lights(lights, bounds, scale)};
  std::vector<std::vector<LightGroup>> groups;
  for (const std::vector<std::uint32_t>& chosen :
       share_out(lights, static_cast<std::size_t>(tile * tile), turn)) {
    std::vector<float> few_bounds;
    for (const std::uint32_t i : chosen)
      few_bounds.push_back(bounds.empty() ? kInfinity : bounds[i]);
    groups.push_back(group_lights(subset(lights, chosen), few_bounds, scale));
  }
  return groups;
}

/// The way that is asked for or, where depth clamp is missing, the other exact one.
VolumeMethod method(VolumeMethod asked, const gl::Info& gl) {
  return asked == VolumeMethod::kExact && !gl.has(gl::kDepthClamp) ? VolumeMethod::kZFail : asked;
}

/// Where light number `i` is.
LightPoint point_of(const VirtualLights& lights, std::size_t i, float scale) {
  if (i >= lights.size()) {
    throw Error(fmt::format("there is no light {} to show the volumes of: the last is {}", i,
                            lights.size() - 1));
  }
  const auto groups =
      group_lights(subset(lights, std::array{static_cast<std::uint32_t>(i)}), {}, scale);
  if (groups.empty()) throw Error(fmt::format("light {} is black and has no volumes", i));
  return groups.front().points.front();
}

/// A picture that one draws into.
struct Target {
  gl::Texture texture;
  gl::Framebuffer framebuffer;

  Target(gl::Format format, int width, int height)
      : texture(format, width, height), framebuffer({&texture}) {}
};

/// What a tile of several pixels takes.
struct Interleaved {
  GBuffer g_buffer;  // of the whole picture
  Interleaving interleaving;

  Interleaved(const gl::ShaderFiles& files, const RasterOptions& options, float radius)
      : g_buffer(options.width, options.height),
        interleaving(files, options.width, options.height, options.tile, radius) {}
};

gl::Program resolve_program(const gl::ShaderFiles& files, int tile) {
  return gl::Program(files, "shaders/full_screen.vert.glsl", "shaders/resolve.frag.glsl",
                     tile > 1 ? Interleaving::definitions(tile) : std::vector<gl::Definition>());
}

}  // namespace

struct Rasteriser::State {
  const World& world;
  RasterOptions options;
  ViewOptions view_options;
  gl::ShaderFiles files;
  StageTimes times;
  Surfaces surfaces;
  std::optional<World> solid;  // where some of the world has holes
  std::optional<StencilShadows> volumes;
  std::list<ShadowMaps> maps;
  std::optional<Lighting> lighting;
  std::optional<Interleaved> interleaved;
  gl::Program resolve;
  gl::Texture irradiance;  // where every pixel has all lights
  Target radiance;
  gl::VertexArray no_vertices;

  State(const Scene& scene, const World& all, const gl::Info& gl, const RasterOptions& with)
      : world(all),
        options(with),
        view_options{.width = with.width,
                     .height = with.height,
                     .step = with.tile,
                     .radius = all.bounds.radius(),
                     .range = gl.has(gl::kClipControl) ? ClipRange::kFarIs0 : ClipRange::kFarIs1},
        surfaces(scene, all, files),
        solid(solid_part(scene, all)),
        resolve(resolve_program(files, with.tile)),
        irradiance(gl::Format::kRgba32ui, with.width, with.height),
        radiance(gl::Format::kRgba32f, with.width, with.height) {
    const bool by_maps = with.shadows == ShadowMethod::kMaps;
    const bool none_solid = solid && solid->triangles.empty();
    if (!by_maps && !none_solid) {
      volumes.emplace(all, files, method(with.volumes, gl), solid ? &*solid : nullptr);
    }
    Shadows shadows{.volumes = volumes ? &*volumes : nullptr};
    // What has holes would hide in maps what is behind it; volumes know triangles alone.
    for (const MapCasters casters : {MapCasters::kSolid, MapCasters::kWithHoles}) {
      if (casters == MapCasters::kSolid ? !by_maps || none_solid : !solid) continue;
      maps.emplace_back(scene, all, surfaces, files,
                        ShadowMapOptions{.range = view_options.range, .casters = casters});
      shadows.maps.push_back(&maps.back());
    }
    lighting.emplace(surfaces, shadows, times, files,
                     LightingOptions{.width = view_options.columns(),
                                     .height = view_options.rows(),
                                     .tells_lit = with.tile > 1});
    if (with.tile > 1) interleaved.emplace(files, with, all.bounds.radius());
  }

  /// The lights of each pixel of a tile in sample number `n`.
  std::vector<std::vector<LightGroup>> groups(const VirtualLights& lights,
                                              std::span<const float> bounds, std::size_t n) const {
    const auto of_tile = [&](const VirtualLights& all, std::span<const float> their_bounds) {
      return groups_of_tile(all, their_bounds, world.coordinate_scale(), options.tile, n);
    };
    if (!options.deal_lights) return of_tile(lights, bounds);
    const auto samples = static_cast<std::size_t>(options.samples);
    const Bounded mine = dealt(lights, bounds, samples, n % samples, n / samples);
    return of_tile(mine.lights, mine.bounds);
  }

  /// Of the whole picture.
  View view_of_sample(const Camera& camera, std::size_t n) const {
    ViewOptions whole = view_options;
    whole.offset = place_in_pixel(n);
    whole.step = 1;
    return make_view(camera, whole);
  }
  const GBuffer& whole_g_buffer() const {
    return interleaved ? interleaved->g_buffer : lighting->g_buffer();
  }

  /// The radiance of sample number `n` of all pixels.
  void draw(const Camera& camera, std::span<const std::vector<LightGroup>> groups, std::size_t n,
            const std::function<bool()>& group_done) {
    const View view = view_of_sample(camera, n);
    if (interleaved) {
      draw_shares(camera, view, groups, n, group_done);
    } else {
      lighting->draw(view, groups[0], group_done);
      lighting->shading().copy_to(irradiance);
    }
    times.begin(Stage::kResolve);
    resolve.set("u_reflectances", 0, whole_g_buffer().reflectances);
    resolve.set("u_emissions", 1, whole_g_buffer().emissions);
    if (interleaved) {
      interleaved->interleaving.set_irradiance(resolve, 2);
    } else {
      resolve.set("u_irradiance", 2, irradiance);
    }
    radiance.framebuffer.bind();
    gl::draw_full_screen(no_vertices);
    times.end();
    gl::check("drawing the radiance");
  }

  void draw_shares(const Camera& camera, const View& view,
                   std::span<const std::vector<LightGroup>> groups, std::size_t n,
                   const std::function<bool()>& group_done) {
    GBuffer& whole = interleaved->g_buffer;
    Interleaving& interleaving = interleaved->interleaving;
    times.begin(Stage::kSurfaces);
    surfaces.draw(view, whole);
    times.end();
    std::size_t rounds = 0;
    for (const std::vector<LightGroup>& of_share : groups) {
      rounds = std::max(rounds, of_share.size());
    }
    interleaving.begin(rounds);
    ViewOptions of_share = view_options;
    of_share.offset = place_in_pixel(n);
    for (of_share.first.y = 0; of_share.first.y < options.tile; ++of_share.first.y) {
      for (of_share.first.x = 0; of_share.first.x < options.tile; ++of_share.first.x) {
        const glm::ivec2 share = of_share.first;
        const View share_view = make_view(camera, of_share);
        const std::vector<LightGroup>& lights =
            groups[static_cast<std::size_t>(share.y * options.tile + share.x)];
        times.begin(Stage::kSurfaces);
        if (volumes && volumes->needs_depth_of_view()) {
          surfaces.draw(share_view, lighting->g_buffer());
        } else {
          interleaving.split(whole, share_view, lighting->g_buffer(), lighting->takes_g_buffer());
        }
        times.end();
        std::size_t done = 0;
        lighting->light(share_view, whole, lights, [&] {
          interleaving.take(share, done, lights[done], *lighting);
          ++done;
          return group_done();
        });
        interleaving.end(share, lighting->shading());
      }
    }
    times.begin(Stage::kFilter);
    interleaving.filter(whole, view);
    times.end();
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
    std::size_t steps = 0, step = 0;
    for (const auto& of_pixel : groups) steps += of_pixel.size();
    s.draw(camera, groups, n, [&] {
      const std::size_t done = image.pixels.size() *
                               (static_cast<std::size_t>(sample) * steps + ++step) /
                               (static_cast<std::size_t>(options.samples) * steps);
      if (pixels_done) pixels_done(done - std::exchange(reported, done));
      return !stop.load();
    });
    const std::vector<float> rgba = s.radiance.framebuffer.read<float>();
    s.times.collect();
    if (volumes) {
      volumes->add(*s.volumes, point_of(lights, *options.show_volumes, s.world.coordinate_scale()),
                   s.view_of_sample(camera, n));
    }
    const float share = 1.0f / static_cast<float>(options.samples);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      image.pixels[i] += share * Rgb(rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2]);
    }
  }
  if (volumes) volumes->blend_over(image);
  return image;
}

void Rasteriser::draw_frame(const Camera& camera, const VirtualLights& lights,
                            std::span<const float> bounds, std::size_t sample) {
  state_->times.collect();
  const auto groups = state_->groups(lights, bounds, sample);
  for (ShadowMaps& maps : state_->maps) maps.keep(groups);
  state_->draw(camera, groups, sample, [] { return true; });
}

std::map<std::string, double> Rasteriser::seconds_of_stages() {
  state_->times.collect();
  return state_->times.seconds();
}

}  // namespace lantern
