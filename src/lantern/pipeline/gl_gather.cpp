// SPDX-License-Identifier: MIT
#include "lantern/pipeline/gl_gather.h"

#include "lantern/gather/term_bound.h"
#include "lantern/gl/context.h"
#include "lantern/pipeline/raster_options.h"
#include "lantern/raster/rasteriser.h"

namespace lantern {

struct GlGather::State {
  const RenderJob& job;
  const Emitters& emitters;
  gl::Context context;
  Rasteriser rasteriser;

  State(const RenderJob& with, const Emitters& all)
      : job(with),
        emitters(all),
        context({.api = {}, .device = with.options.gl_device}),
        rasteriser(with.scene, with.world, context.info(), raster_options(with.options)) {}
};

GlGather::GlGather(const RenderJob& job, const Emitters& emitters)
    : state_(std::make_unique<State>(job, emitters)) {}

GlGather::~GlGather() = default;

Image GlGather::gather(const VirtualLights& lights, std::size_t pass,
                       const std::function<void(std::size_t)>& pixels_done) {
  const RenderJob& job = state_->job;
  const TermBound bound(job.scene, job.world, state_->emitters, lights, job.options.bound);
  return state_->rasteriser.draw(job.camera, lights, bound.of_lights(lights, job.tracer), pass,
                                 job.stop, pixels_done);
}

std::map<std::string, double> GlGather::seconds_of_stages() {
  return state_->rasteriser.seconds_of_stages();
}

}  // namespace lantern
