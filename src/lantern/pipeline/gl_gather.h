// SPDX-License-Identifier: MIT
// The gather of instant radiosity by GL, pass after pass; in builds without GL an Error.
#pragma once

#include "lantern/image/image.h"
#include "lantern/lights/emitters.h"
#include "lantern/lights/virtual_lights.h"
#include "lantern/pipeline/render_job.h"

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace lantern {

class GlGather {
 public:
  /// Keeps references to both. Throws Error where no GL is usable or it lacks what is needed, and
  /// for scenes that its shadows cannot do.
  GlGather(const RenderJob& job, const Emitters& emitters);
  ~GlGather();

  /// See Rasteriser::draw().
  Image gather(const VirtualLights& lights, std::size_t pass,
               const std::function<void(std::size_t)>& pixels_done);

  /// See Rasteriser::seconds_of_stages().
  std::map<std::string, double> seconds_of_stages();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lantern
