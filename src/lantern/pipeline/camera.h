// SPDX-License-Identifier: MIT
// Which camera a picture is taken with.
#pragma once

#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"
#include "lantern/trace/tracer.h"

#include <optional>
#include <string>

namespace lantern {

struct CameraChoice {
  std::string name;         // of a camera of the scene; empty: its first
  std::optional<Vec3> eye;  // with `target`, in the file's coordinates: the user's own camera
  Vec3 target{0.0f};
  Vec3 up{0.0f, 1.0f, 0.0f};          // not on one line with them
  std::optional<float> vertical_fov;  // radians; overrides that of the camera chosen
};

/// The user's own camera, else the named one, else the scene's first, else one that frames the
/// scene. Throws Error for a name that is not there.
Camera choose_camera(const Scene& scene, const World& world, const Tracer& tracer,
                     const CameraChoice& choice, float aspect);

/// A camera for a scene that has none: of views from outside along the axes and from inside across
/// the room, the one that sees most of what faces it.
Camera framing_camera(const World& world, const Tracer& tracer, float vertical_fov, float aspect);

}  // namespace lantern
