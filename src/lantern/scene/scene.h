// SPDX-License-Identifier: MIT
// The contract between loaders and everything that makes light: plain data, no file IO, no
// acceleration structure. Lengths in metres; radiance in W/(m² sr); linear Rec. 709 RGB. The front
// of a triangle is where its vertices run counter-clockwise.
#pragma once

#include "lantern/core/ids.h"
#include "lantern/core/math.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lantern {

enum class Wrap { kRepeat, kClamp, kMirror };

/// RGBA texels, row 0 at v = 0. Just one of the two vectors is filled: `srgb8` holds sRGB-encoded
/// colour with linear alpha (4 bytes a texel), `linear` holds linear floats (4 a texel).
struct Texture {
  std::string name;
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> srgb8;
  std::vector<float> linear;
  Wrap wrap_u = Wrap::kRepeat;
  Wrap wrap_v = Wrap::kRepeat;
};

/// A Lambertian surface. Both sides reflect; emission leaves the front alone unless double-sided.
struct Material {
  std::string name;
  Rgb reflectance{0.5f};                         // in [0, 1]
  std::optional<TextureId> reflectance_texture;  // multiplies `reflectance`; its alpha is opacity
  bool vertex_colours = false;                   // the mesh's colours multiply `reflectance`
  Rgb emission{0.0f};                            // radiance
  std::optional<TextureId> emission_texture;     // multiplies `emission`
  bool double_sided = false;                     // emission leaves both sides
  float opacity = 1.0f;                          // multiplies the texture's alpha
  std::optional<float> alpha_cutoff;  // opacity below it is a hole, for rays of all kinds
  bool blend = false;                 // else opacity is the share of the rays that is stopped
  Rgb specular{0.0f};                 // read and kept; nothing glossy is rendered yet
  float shininess = 0.0f;             // Phong exponent, likewise
};

/// Indexed triangles with one material. The optional arrays are empty or as long as `positions`.
struct Mesh {
  std::string name;
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec2> texcoords;  // v = 0 is the texture's first row
  std::vector<Vec4> colours;    // linear RGBA
  std::vector<uvec3> triangles;
  MaterialId material{};
};

struct Instance {
  MeshId mesh{};
  Mat4 transform{1.0f};                // mesh to world, affine
  std::optional<MaterialId> material;  // in place of the mesh's own
};

/// Pinhole. right = cross(forward, up), as the picture shows it.
struct Camera {
  std::string name;
  Vec3 eye{0.0f};
  Vec3 forward{0.0f, 0.0f, -1.0f};  // unit length
  Vec3 up{0.0f, 1.0f, 0.0f};        // not parallel to `forward`; need not be orthogonal
  float vertical_fov = 0.7f;        // radians, in (0, pi)
};

enum class PunctualKind { kPoint, kSpot, kDirectional };

/// A light without area. Point and spot: `intensity` is radiant intensity in W/sr (spot: on its
/// axis). Directional: `intensity` is the irradiance in W/m² on a surface that faces it.
struct PunctualLight {
  std::string name;
  PunctualKind kind = PunctualKind::kPoint;
  Rgb intensity{1.0f};
  Vec3 position{0.0f};
  Vec3 direction{0.0f, 0.0f, -1.0f};  // the way the light travels, unit length
  float inner_angle = 0.0f;           // spot: half angles from the axis, radians;
  float outer_angle = 0.7854f;        // full intensity inside `inner`, none outside `outer`
};

/// Radiance that arrives from infinity. With a texture: lat-long, +y up, its row 0 straight up, u =
/// 0 towards -z and growing over +x; `radiance` multiplies it.
struct Sky {
  Rgb radiance{1.0f};
  std::optional<TextureId> texture;
};

struct Scene {
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Camera> cameras;
  std::vector<PunctualLight> lights;
  std::optional<Sky> sky;
  Vec3 origin{0.0f};  // of these coordinates, in those of the file
};

}  // namespace lantern
