// SPDX-License-Identifier: MIT
// What a light costs by OpenGL at 640x480, in CPU time of the whole process (Mesa draws on the CPU)
// and over that of one unshadowed, blended full-screen pass: the best of five runs, each of which
// shades by the masks that it drew. Maps are shaded in frames as they are.
//   raster_bench SCENE|balls [--lights PATHS]      balls: the tests' room of 64, 480 triangles each
#include "lantern/gl/context.h"
#include "lantern/lights/emitters.h"
#include "lantern/lights/walk.h"
#include "lantern/load/load.h"
#include "lantern/pipeline/camera.h"
#include "lantern/pipeline/stopwatch.h"
#include "lantern/raster/lighting.h"
#include "lantern/raster/masked_shading.h"
#include "lantern/raster/raster_lights.h"
#include "lantern/raster/shadow_maps.h"
#include "lantern/raster/stencil_shadows.h"
#include "lantern/raster/surfaces.h"
#include "lantern/scene/surface.h"
#include "lantern/trace/embree.h"

#include "tests/raster/raster_scenes.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <functional>

namespace {

using namespace lantern;

constexpr int kWidth = 640, kHeight = 480;

/// Milliseconds of the best of a few runs.
double cost(const std::function<void()>& work) {
  double best = 1e30;
  for (int run = 0; run < 5; ++run) {
    const double start = processor_seconds();
    work();
    glFinish();
    best = std::min(best, processor_seconds() - start);
  }
  return 1e3 * best;
}

constexpr const char* kUnshadowed = R"(
#include "shaders/lights.glsl"
#include "shaders/octahedral.glsl"
#include "shaders/texel.glsl"
uniform highp usampler2D u_points;
uniform highp usampler2D u_reflectances;
uniform int u_light;
layout(location = 0) out vec4 o_irradiance;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uvec4 bits = texel_of(u_points, at);
  Point p;
  p.position = uintBitsToFloat(bits.xyz);
  p.shading = unpack_unit(texel_of(u_reflectances, at).w);
  p.geometric = unpack_unit(bits.w);
  o_irradiance = vec4(irradiance_from(u_lights[u_light], p), 1.0);
}
)";

}  // namespace

int main(int argc, char** argv) {
  CLI::App app;
  std::string path;
  std::size_t paths = 128;
  app.add_option("scene", path)->required();
  app.add_option("--lights", paths);
  CLI11_PARSE(app, argc, argv);

  const Scene scene = path == "balls" ? test::room_of_balls(16, 16) : load_scene(path).scene;
  const World world = make_world(scene);
  const auto tracer = make_embree_tracer(scene, world);
  const Emitters emitters(scene, world);
  const Camera camera =
      choose_camera(scene, world, *tracer, {}, static_cast<float>(kWidth) / kHeight);
  WalkOptions walk_with;
  walk_with.paths = paths;
  walk_with.reflectivity = mean_reflectivity(scene, world);
  const VirtualLights lights = walk(scene, world, *tracer, emitters, walk_with);
  const auto groups = group_lights(lights, {}, world.coordinate_scale());

  const gl::Context context;
  gl::FileTexts texts = gl::embedded_files();
  texts["unshadowed"] = kUnshadowed;
  const gl::ShaderFiles files(texts);
  const gl::Program unshadowed(files, "shaders/full_screen.vert.glsl", "unshadowed",
                               {{"KIND", "0"}});
  const Surfaces surfaces(scene, world, files);
  ShadowMaps maps(scene, world, surfaces, files, {});
  unshadowed.set_block("Lights", 0);
  StencilShadows shadows(world, files, VolumeMethod::kExact);
  MaskedShading shading(files, kWidth, kHeight, Witnesses::kMask);
  StageTimes times;
  GBuffer g_buffer(kWidth, kHeight);
  gl::Texture mask(gl::Format::kRgba8, kWidth, kHeight);
  gl::Framebuffer mask_framebuffer({&mask}, &g_buffer.depth);
  gl::Texture sum(gl::Format::kRgba32f, kWidth, kHeight);
  gl::Framebuffer sum_framebuffer({&sum});
  gl::VertexArray none;
  gl::Buffer block(std::span<const LightRecord>(groups[0].records));
  const View view =
      make_view(camera, {.width = kWidth, .height = kHeight, .radius = world.bounds.radius()});
  surfaces.draw(view, g_buffer);
  const auto count = static_cast<double>(lights.size());

  const auto with_block = [&](const LightGroup& group) {
    std::vector<LightRecord> records = group.records;
    records.resize(kLightsInGroup);
    block.write(std::span<const LightRecord>(records));
    block.bind_as_uniforms(0);
  };
  const double blend = cost([&] {
    sum_framebuffer.bind();
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    for (const LightGroup& group : groups) {
      with_block(group);
      unshadowed.set("u_points", 0, g_buffer.points);
      unshadowed.set("u_reflectances", 1, g_buffer.reflectances);
      for (std::size_t i = 0; i < group.records.size(); ++i) {
        unshadowed.set("u_light", static_cast<int>(i));
        gl::draw_full_screen(none);
      }
    }
    glDisable(GL_BLEND);
  });
  const double volumes = cost([&] {
    for (const LightGroup& group : groups) {
      shadows.draw(group.points, view, mask_framebuffer, times);
    }
  });
  const double both = cost([&] {
    for (const LightGroup& group : groups) {
      shadows.draw(group.points, view, mask_framebuffer, times);
      shading.add(group, g_buffer, {.mask = &mask}, &group == &groups.front());
    }
  });
  const double map_drawing = cost([&] {
    maps.keep({});
    for (const LightGroup& group : groups) maps.draw(group, world.bounds, times);
  });
  // Whole frames but for the resolve: surfaces are drawn in a hundredth of the time.
  Lighting lighting(surfaces, {.volumes = nullptr, .maps = {&maps}}, times, files, kWidth, kHeight);
  const double map_shading = cost([&] { lighting.draw(view, groups, [] { return true; }); });
  const EdgeList list(world, find_walls(world));
  double edges = 0;
  const double preparing = cost([&] {
    edges = 0;
    for (const LightGroup& group : groups) {
      for (const LightPoint& light : group.points) {
        edges += static_cast<double>(list.volumes(light, camera.eye).edges.size());
      }
    }
  });
  fmt::print("{} lights, {} triangles, {:.1f} quads a light; ms of CPU a light:\n", lights.size(),
             world.size(), edges / count);
  fmt::print("unshadowed, blended  {:.3f}\n", blend / count);
  fmt::print("volumes              {:.3f}  (of it on the CPU anyway {:.3f})\n", volumes / count,
             preparing / count);
  fmt::print("shading              {:.3f}\n", (both - volumes) / count);
  fmt::print("stencil / unshadowed {:.2f}\n", both / blend);
  fmt::print("maps, drawing        {:.3f}\n", map_drawing / count);
  fmt::print("maps, shading        {:.3f}\n", map_shading / count);
}
