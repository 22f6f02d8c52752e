// SPDX-License-Identifier: MIT
// (Scene, VirtualLights) -> Image by GL: the surfaces into a G-buffer, which lights each pixel sees
// as bits of a mask, 32 lights shaded at a time. Needs a current gl::Context. [Keller 1997, with
// the accumulation buffer's 8 bits replaced by floats]
#pragma once

#include "lantern/core/parallel.h"
#include "lantern/gl/info.h"
#include "lantern/image/image.h"
#include "lantern/lights/virtual_lights.h"
#include "lantern/raster/shadow_method.h"
#include "lantern/raster/volume_method.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace lantern {

struct RasterOptions {
  int width = 512;
  int height = 512;
  int samples = 1;  // per pixel and pass
  int tile = 1;     // tile x tile pixels share the lights; 1: every sample against all of them
  ShadowMethod shadows = ShadowMethod::kVolumes;
  // How many samples are drawn with the shadows of the same lights, which tells kCheaper by the
  // first of them: maps are kept, volumes are drawn each time.
  std::size_t samples_of_lights = 1;
  // The samples of a pixel deal the lights out among them, each takes its own with the flux of all:
  // edges are smoothed at the price of drawing the surfaces again. [Keller 1997]
  bool deal_lights = false;
  VolumeMethod volumes = VolumeMethod::kExact;
  std::optional<std::size_t> show_volumes;  // those of this light, over the picture
};

class Rasteriser {
 public:
  /// Keeps references to `scene`, `world` and `gl`. Throws Error where GL lacks what is needed.
  Rasteriser(const Scene& scene, const World& world, const gl::Info& gl,
             const RasterOptions& options);
  ~Rasteriser();

  /// The picture of one pass. `bounds` on the geometry term: one for each light, or none. Ends
  /// early, with the lights that were done by then, once `stop` is set; calls `pixels_done` with
  /// numbers that sum up to the pixels of the picture. Throws Error if the light whose volumes are
  /// to be shown is not there.
  Image draw(const Camera& camera, const VirtualLights& lights, std::span<const float> bounds,
             std::size_t pass, const StopFlag& stop,
             const std::function<void(std::size_t)>& pixels_done = {});

  /// One sample of each pixel, number `sample` of all, that stays on the GPU: what a viewer shows.
  void draw_frame(const Camera& camera, const VirtualLights& lights, std::span<const float> bounds,
                  std::size_t sample);

  /// Of the GPU for all that was drawn by now, by stage; see StageTimes::seconds().
  std::map<std::string, double> seconds_of_stages();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lantern
