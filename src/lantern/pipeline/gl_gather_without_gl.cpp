// SPDX-License-Identifier: MIT
#include "lantern/core/error.h"
#include "lantern/pipeline/gl_gather.h"

namespace lantern {

struct GlGather::State {};

GlGather::GlGather(const RenderJob&, const Emitters&) {
  throw Error("no usable OpenGL: built without it (LANTERN_WITH_GL)");
}

GlGather::~GlGather() = default;

Image GlGather::gather(const VirtualLights&, std::size_t, const std::function<void(std::size_t)>&) {
  return {};
}

std::map<std::string, double> GlGather::seconds_of_stages() { return {}; }

}  // namespace lantern
