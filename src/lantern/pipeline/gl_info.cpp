// SPDX-License-Identifier: MIT
#include "lantern/pipeline/gl_info.h"

#include "lantern/gl/context.h"
#include "lantern/gl/devices.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace lantern {

std::string describe_gl() {
  const gl::Context context;
  const gl::Info& info = context.info();
  std::string out;
  const auto line = [&](const std::string& key, const std::string& value) {
    out += fmt::format("{:<20}{}\n", key, value);
  };
  line("vendor", info.vendor);
  line("renderer", info.renderer);
  line("version", fmt::format("{} {}.{} ({})", info.es ? "OpenGL ES" : "OpenGL", info.major,
                              info.minor, info.version));
  line("shading language", info.glsl);
  line("found on", context.place());
  const std::vector<std::string> devices = gl::devices();
  for (std::size_t i = 0; i < devices.size(); ++i) line(fmt::format("device {}", i), devices[i]);
  for (const gl::Feature& f : info.features) line(f.name, f.by.empty() ? "no" : f.by);
  for (const gl::Limit& l : info.limits) line(l.name, std::to_string(l.value));
  return out;
}

std::string describe_gl_as_json() {
  using Json = nlohmann::json;
  const gl::Context context;
  const gl::Info& info = context.info();
  Json out = {{"vendor", info.vendor},         {"renderer", info.renderer},
              {"version", info.version},       {"es", info.es},
              {"major", info.major},           {"minor", info.minor},
              {"shading_language", info.glsl}, {"found_on", context.place()},
              {"devices", gl::devices()},      {"features", Json::object()},
              {"limits", Json::object()}};
  for (const gl::Feature& f : info.features) {
    out["features"][f.name] = f.by.empty() ? Json() : Json(f.by);
  }
  for (const gl::Limit& l : info.limits) out["limits"][l.name] = l.value;
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lantern
