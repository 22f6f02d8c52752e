// SPDX-License-Identifier: MIT
// Lights as files: JSON (read back to the same bits), PLY for viewers of points, glTF with
// KHR_lights_punctual for any engine. `origin` is Scene::origin: files have the scene's own
// coordinates. Errors: Error with the file and, where known, the byte.
#pragma once

#include "lantern/lights/virtual_lights.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace lantern {

/// {"paths": N, "reflectivity": p, "lights": [{"position": [x,y,z], "normal": [x,y,z],
/// "flux": [r,g,b], "path": i, "bounce": j}, ...]}, flux in W. A light that is no surface light has
/// a "kind" of "point", "spot" (with "cone": [cos inner, cos outer]) or "directional" (its "flux"
/// is irradiance in W/m²); "normal" is then the axis or the way the light travels.
std::string to_json(const VirtualLights& lights, const Vec3& origin = Vec3(0.0f));

/// The inverse of to_json(); `name` is for messages.
VirtualLights lights_from_json(std::string_view text, const std::string& name,
                               const Vec3& origin = Vec3(0.0f));

/// ASCII points with normal, flux, path, bounce and an 8-bit colour that viewers show.
std::string to_ply(const VirtualLights& lights, const Vec3& origin = Vec3(0.0f));

/// A node per light. A Lambertian point has no counterpart in glTF; the nearest is a spot of half
/// angle 90 degrees with the same intensity on its axis. W/sr are written as candela, W/m² as lux.
std::string to_gltf(const VirtualLights& lights, const Vec3& origin = Vec3(0.0f));

/// Throws Error unless the path ends in .json, .ply or .gltf.
void require_lights_format(const std::filesystem::path& path);

/// The extension chooses.
void write_lights(const std::filesystem::path& path, const VirtualLights& lights,
                  const Vec3& origin = Vec3(0.0f));

VirtualLights read_lights(const std::filesystem::path& path, const Vec3& origin = Vec3(0.0f));

}  // namespace lantern
