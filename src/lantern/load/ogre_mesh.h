// SPDX-License-Identifier: MIT
// Ogre's mesh as both of its file formats hold it, and its way into a Scene. Lengths are those of
// the file until then; a texture coordinate's v = 0 is the picture's top, as in Lantern.
#pragma once

#include "lantern/load/load.h"
#include "lantern/load/ogre_material.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lantern::ogre {

/// The optional arrays are empty or as long as `positions`.
struct Geometry {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec2> texcoords;
  std::vector<Vec4> colours;
};

/// Numbered as in the binary format.
enum class Operation : std::uint16_t {
  kPointList = 1,
  kLineList,
  kLineStrip,
  kTriangleList,
  kTriangleStrip,
  kTriangleFan,
};

/// As the XML format spells it ("triangle_list"); none for what is no operation.
std::optional<Operation> operation_named(std::string_view name);
bool is_operation(std::uint16_t value);
bool has_triangles(Operation operation);

struct Submesh {
  std::string name;
  std::string material;
  std::optional<Geometry> own;         // none: the mesh's shared geometry
  std::vector<std::uint32_t> indices;  // none: its own vertices in their order
  Operation operation = Operation::kTriangleList;
  std::map<std::string, std::string> textures;  // alias -> picture
};

struct MeshFile {
  std::optional<Geometry> shared;
  std::vector<Submesh> submeshes;
};

/// Adds a Mesh for each submesh to the scene of `materials` and returns their ids; none for points
/// and lines, which are counted in the report. All indices must be in range. Strips and fans become
/// lists of the same orientation without the stitches; of shared vertices each mesh gets those it
/// uses, in their order in the file.
std::vector<std::optional<MeshId>> add_meshes(const MeshFile& file, Materials& materials);

/// The scene of one mesh file: an instance of each submesh.
Loaded load_mesh(const MeshFile& file, LoadReport report, const std::filesystem::path& path,
                 const LoadOptions& options);

}  // namespace lantern::ogre
