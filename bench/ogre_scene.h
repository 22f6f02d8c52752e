// SPDX-License-Identifier: MIT
// A scene and its virtual lights as Ogre 1.12 draws them with additive stencil shadows, set up as
// one would by hand; plain colours only. Needs an X display. Errors: Ogre's exceptions, Error.
#pragma once

#include "lantern/image/image.h"
#include "lantern/lights/virtual_lights.h"
#include "lantern/scene/scene.h"
#include "lantern/scene/world.h"

#include <cstdint>
#include <memory>
#include <string>

namespace lantern {

/// How Ogre is set up.
struct OgreOptions {
  std::string render_system = "GL";  // or GL3Plus, GLES2
  bool per_pixel = false;            // light each pixel by Ogre's shaders, or each vertex
  std::uint32_t wall_pieces = 1;     // each triangle of a wall is cut into pieces x pieces
  bool extrude_in_software = false;  // volumes on the CPU, or by a vertex program
  bool floats = false;               // sum in 32-bit floats, or in 8 bits as a window has them
  float exposure = 1.0f;             // radiance is multiplied by it before 8 bits hold it
  int width = 640;
  int height = 480;
};

class OgreScene {
 public:
  /// One in a process. Objects are the connected parts of the surfaces of one material. Walls (see
  /// find_walls()) and lamps cast no shadows. GL3Plus throws at an open sheet that turns its back
  /// on a light, where Ogre has no index of a volume to write.
  OgreScene(const Scene& scene, const World& world, const Camera& camera,
            const OgreOptions& options);
  ~OgreScene();

  /// Surface lights, in place of those before: spots of 180 degrees that fade with the cosine and
  /// with 1 / distance², which is just what a Lambertian point does. Throws Error for other kinds.
  void set_lights(const VirtualLights& lights);

  /// A frame into a texture, and waits for its end.
  void draw();

  /// The last frame as radiance.
  Image picture() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lantern
