// SPDX-License-Identifier: MIT
#include "lantern/bake/bake.h"

#include "lantern/bake/glb.h"
#include "lantern/bake/lightmap.h"
#include "lantern/image/tone.h"
#include "lantern/image/write.h"
#include "lantern/scene/surface.h"
#include "lantern/scene/texture.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <map>
#include <tuple>

namespace lantern {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<Vec2, 3> kCorners = {Vec2(0.0f), Vec2(1.0f, 0.0f), Vec2(0.0f, 1.0f)};

/// Whether the surface's texture stays a texture: what emits shows its own light, which a texture
/// of reflectances must not colour.
bool keeps_texture(const Material& material) {
  return material.reflectance_texture && is_black(material.emission);
}

/// The light of a vertex, times the texture where the surface keeps it.
Rgb vertex_light(const Solution& solution, std::uint32_t element, std::size_t corner) {
  const Material& material = solution.material(element);
  const Vec2 uv = kCorners[corner];
  if (!keeps_texture(material)) {
    return solution.reflected(element, uv) + solution.emitted(element, uv);
  }
  const World& surfaces = solution.surfaces();
  Rgb reflectance = material.reflectance;
  if (material.vertex_colours && !surfaces.colours.empty()) {
    const uvec3 v = surfaces.triangles[solution.patches().patch[element]];
    reflectance *= Rgb(surfaces.colours[v[static_cast<int>(corner)]]);
  }
  return reflectance * solution.irradiance(element, uv) * kInvPi;
}

/// The largest light of a vertex that is not its own, or, in a scene that reflects none, the
/// largest.
float brightest(const Solution& solution) {
  float reflected = 0.0f, any = 0.0f;
  for (std::uint32_t e = 0; e < solution.patches().elements(); ++e) {
    const bool emits = !is_black(solution.material(e).emission);
    for (std::size_t k = 0; k < 3; ++k) {
      const float light = max_component(vertex_light(solution, e, k));
      any = std::max(any, light);
      if (!emits) reflected = std::max(reflected, light);
    }
  }
  const float white = reflected > 0.0f ? reflected : any;
  return white > 0.0f ? white : 1.0f;
}

/// Vertices as glTF takes them, and the triangles of each material.
struct Arrays {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> texcoords;  // of the surface's texture
  std::vector<Vec2> places;     // in the lightmap
  std::vector<Vec4> colours;
  std::map<MaterialId, std::vector<std::uint32_t>> triangles;
};

/// The smooth normal of the surface, on the element's side.
Vec3 normal_at(const Solution& solution, const World& world, std::uint32_t element,
               std::size_t corner) {
  const Patches& patches = solution.patches();
  const PatchMesh::Face& face = patches.mesh.faces[patches.patch[element]];
  const Vec2 uv(face.places[corner]);
  const Vec3 normal = surface_at(solution.scene(), world, face.source, uv).shading_normal;
  return patches.is_front(element) ? normal : -normal;
}

/// Corners of patches share a vertex where all that it has is the same: light and normal by the
/// smooth vertex, the place by the chart.
Arrays make_arrays(const Solution& solution, const World& world, const Atlas* atlas, float scale) {
  using Key = std::tuple<bool, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
  const Patches& patches = solution.patches();
  const World& surfaces = solution.surfaces();
  Arrays arrays;
  std::map<Key, std::uint32_t> known;
  for (std::uint32_t e = 0; e < patches.elements(); ++e) {
    const std::uint32_t patch = patches.patch[e];
    const bool front = patches.is_front(e);
    std::array<std::uint32_t, 3> vertices;
    for (std::size_t k = 0; k < 3; ++k) {
      const int corner = static_cast<int>(k);
      const Vec2 texcoord = surfaces.texcoords.empty()
                                ? Vec2(0.0f)
                                : surfaces.texcoords[surfaces.triangles[patch][corner]];
      const Key key(front, patches.smooth_vertices[patch][corner], atlas ? atlas->chart[e] : 0,
                    std::bit_cast<std::uint32_t>(texcoord.x),
                    std::bit_cast<std::uint32_t>(texcoord.y));
      const auto [at, is_new] =
          known.try_emplace(key, static_cast<std::uint32_t>(arrays.positions.size()));
      vertices[k] = at->second;
      if (!is_new) continue;
      arrays.positions.emplace_back(patches.mesh.corner(patch, corner));
      arrays.normals.push_back(normal_at(solution, world, e, k));
      arrays.texcoords.push_back(texcoord);
      if (atlas) arrays.places.push_back(atlas->corners[e][k] / static_cast<float>(atlas->size));
      const Rgb light = vertex_light(solution, e, k) * scale;
      arrays.colours.emplace_back(glm::clamp(light, 0.0f, 1.0f), 1.0f);
    }
    // From behind the corners run the other way round.
    if (!front) std::swap(vertices[1], vertices[2]);
    std::vector<std::uint32_t>& triangles = arrays.triangles[surfaces.materials[patch]];
    triangles.insert(triangles.end(), vertices.begin(), vertices.end());
  }
  return arrays;
}

// ---- glTF ----

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(255.0f * std::clamp(value, 0.0f, 1.0f) + 0.5f);
}

std::vector<std::byte> png_of(const Texture& texture) {
  if (!texture.srgb8.empty()) return encode_png(texture.width, texture.height, texture.srgb8);
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < texture.height; ++y) {
    for (int x = 0; x < texture.width; ++x) {
      const Vec4 value = texel(texture, x, y);
      for (int c = 0; c < 3; ++c) rgba.push_back(to_byte(linear_to_srgb(value[c])));
      rgba.push_back(to_byte(value.a));
    }
  }
  return encode_png(texture.width, texture.height, rgba);
}

std::vector<std::byte> png_of(const Lightmap& map, float scale) {
  std::vector<std::uint8_t> rgba;
  rgba.reserve(4 * map.coverage.size());
  for (std::size_t i = 0; i < map.coverage.size(); ++i) {
    for (const std::uint8_t c : to_srgb8(map.radiance.pixels[i] * scale, {})) rgba.push_back(c);
    rgba.push_back(to_byte(map.coverage[i]));
  }
  return encode_png(map.radiance.width, map.radiance.height, rgba);
}

int gltf_wrap(Wrap wrap) {
  constexpr int kClampToEdge = 33071, kMirroredRepeat = 33648, kRepeat = 10497;
  return wrap == Wrap::kClamp ? kClampToEdge : wrap == Wrap::kMirror ? kMirroredRepeat : kRepeat;
}

constexpr int kLinear = 9729;

/// Returns the number of the texture.
std::size_t add_texture(Glb& glb, std::span<const std::byte> png, Wrap wrap_u, Wrap wrap_v) {
  const std::size_t image = glb.add_png(png);
  // No mip maps: coarse levels would mix neighbouring charts.
  glb.json["samplers"].push_back({{"magFilter", kLinear},
                                  {"minFilter", kLinear},
                                  {"wrapS", gltf_wrap(wrap_u)},
                                  {"wrapT", gltf_wrap(wrap_v)}});
  glb.json["textures"].push_back({{"sampler", glb.json["samplers"].size() - 1}, {"source", image}});
  return glb.json["textures"].size() - 1;
}

/// An unlit material; `colour_texture` is a glTF textureInfo or null. Returns its number.
std::size_t add_material(Glb& glb, const Material& material, const Json& colour_texture) {
  Json surface = {{"baseColorFactor", {1.0, 1.0, 1.0, material.opacity}},
                  {"metallicFactor", 0.0},
                  {"roughnessFactor", 1.0}};
  if (!colour_texture.is_null()) surface["baseColorTexture"] = colour_texture;
  Json out = {{"name", material.name},
              {"pbrMetallicRoughness", surface},
              {"extensions", {{"KHR_materials_unlit", Json::object()}}}};
  if (material.alpha_cutoff) {
    out["alphaMode"] = "MASK";
    out["alphaCutoff"] = *material.alpha_cutoff;
  } else if (material.blend) {
    out["alphaMode"] = "BLEND";
  }
  glb.json["materials"].push_back(out);
  return glb.json["materials"].size() - 1;
}

/// A scene of one mesh, moved to where the file that was loaded had it.
void add_scene(Glb& glb, const char* name, const Json& primitives, const Vec3& origin) {
  glb.json["meshes"].push_back({{"name", name}, {"primitives", primitives}});
  Json node = {{"name", name}, {"mesh", glb.json["meshes"].size() - 1}};
  if (origin != Vec3(0.0f)) node["translation"] = {origin.x, origin.y, origin.z};
  glb.json["nodes"].push_back(node);
  glb.json["scenes"].push_back({{"name", name}, {"nodes", {glb.json["nodes"].size() - 1}}});
}

/// What the primitives of both scenes share: accessors by attribute, and indices by material.
struct Accessors {
  Json attributes;
  std::map<MaterialId, std::size_t> indices;
};

Accessors add_geometry(Glb& glb, const Arrays& arrays) {
  Accessors accessors;
  accessors.attributes["POSITION"] = glb.add(std::span(arrays.positions), true);
  accessors.attributes["NORMAL"] = glb.add(std::span(arrays.normals));
  accessors.attributes["TEXCOORD_0"] = glb.add(std::span(arrays.texcoords));
  if (!arrays.places.empty()) {
    accessors.attributes["TEXCOORD_1"] = glb.add(std::span(arrays.places));
  }
  for (const auto& [material, triangles] : arrays.triangles) {
    accessors.indices[material] = glb.add_indices(triangles);
  }
  return accessors;
}

void add_vertex_scene(Glb& glb, const Scene& scene, const Arrays& arrays,
                      const Accessors& accessors) {
  Json attributes = accessors.attributes;
  attributes["COLOR_0"] = glb.add(std::span(arrays.colours));
  std::map<TextureId, std::size_t> textures;
  Json primitives = Json::array();
  for (const auto& [id, indices] : accessors.indices) {
    const Material& material = scene.materials[index(id)];
    Json colour_texture;
    if (keeps_texture(material)) {
      const TextureId used = *material.reflectance_texture;
      const Texture& texture = scene.textures[index(used)];
      if (!textures.contains(used)) {
        textures[used] = add_texture(glb, png_of(texture), texture.wrap_u, texture.wrap_v);
      }
      colour_texture = {{"index", textures[used]}};
    }
    primitives.push_back({{"attributes", attributes},
                          {"indices", indices},
                          {"material", add_material(glb, material, colour_texture)}});
  }
  add_scene(glb, "vertex colours", primitives, scene.origin);
}

void add_lightmap_scene(Glb& glb, const Scene& scene, const Accessors& accessors,
                        const Lightmap& map, float scale) {
  const std::size_t texture = add_texture(glb, png_of(map, scale), Wrap::kClamp, Wrap::kClamp);
  Json primitives = Json::array();
  for (const auto& [id, indices] : accessors.indices) {
    Material material = scene.materials[index(id)];
    material.opacity = 1.0f;  // the lightmap's alpha holds it
    const Json colour_texture = {{"index", texture}, {"texCoord", 1}};
    primitives.push_back({{"attributes", accessors.attributes},
                          {"indices", indices},
                          {"material", add_material(glb, material, colour_texture)}});
  }
  add_scene(glb, "lightmap", primitives, scene.origin);
}

}  // namespace

Baked bake(const Solution& solution, const World& world, const Atlas* atlas,
           const BakeOptions& options) {
  assert(options.vertex_colours || atlas);
  const Scene& scene = solution.scene();
  Baked baked;
  baked.radiance_of_white = brightest(solution) * std::exp2(-options.exposure);
  const float scale = 1.0f / baked.radiance_of_white;
  const Arrays arrays = make_arrays(solution, world, atlas, scale);
  baked.vertices = arrays.positions.size();
  baked.triangles = solution.patches().elements();

  Glb glb;
  glb.json["extensionsUsed"] = {"KHR_materials_unlit"};
  glb.json["asset"]["extras"] = {{"method", options.made_by},
                                 {"radiance_of_white", baked.radiance_of_white}};
  glb.json["scene"] = 0;
  const Accessors accessors = add_geometry(glb, arrays);
  if (options.vertex_colours) add_vertex_scene(glb, scene, arrays, accessors);
  if (atlas) {
    add_lightmap_scene(glb, scene, accessors, make_lightmap(solution, *atlas), scale);
  }
  baked.file = glb.bytes();
  return baked;
}

}  // namespace lantern
