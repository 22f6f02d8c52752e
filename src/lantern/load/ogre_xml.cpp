// SPDX-License-Identifier: MIT
#include "lantern/load/ogre_xml.h"

#include "lantern/core/file.h"
#include "lantern/load/ogre_text.h"

#include <algorithm>
#include <array>

namespace lantern {
namespace ogre {
namespace {

using tinyxml2::XMLElement;

/// Animation, levels of detail and hints to a rasteriser: no part of a scene at rest.
constexpr std::array<std::string_view, 8> kLeftOut{
    "boneassignments", "skeletonlink", "levelofdetail", "edgelists",
    "poses",           "animations",   "extremes",      "userData"};

bool is(const XMLElement& element, std::string_view name) { return element.Name() == name; }

class Reader {
 public:
  Reader(std::string_view text, const std::string& name, LoadReport& report)
      : xml_(text, name, "mesh"), report_(report) {}

  MeshFile read() {
    // Faces are checked against their vertices, so these have to be known first.
    if (const XMLElement* shared = xml_.root().FirstChildElement("sharedgeometry")) {
      mesh_.shared = geometry(*shared);
    }
    for (const XMLElement* e = xml_.root().FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (is(*e, "submeshes")) {
        submeshes(*e);
      } else if (is(*e, "submeshnames")) {
        names(*e);
      } else if (!is(*e, "sharedgeometry")) {
        leave_out(*e);
      }
    }
    xml_.findings.throw_if_any();
    return std::move(mesh_);
  }

 private:
  void leave_out(const XMLElement& element) {
    const std::string_view name = element.Name();
    if (std::find(kLeftOut.begin(), kLeftOut.end(), name) == kLeftOut.end()) {
      ++report_.unknown[fmt::format("mesh: {}", name)];
    }
  }

  Geometry geometry(const XMLElement& element) {
    Geometry result;
    const std::uint32_t vertices = xml_.count(element, "vertexcount");
    for (const XMLElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (is(*e, "vertexbuffer")) {
        vertex_buffer(*e, vertices, result);
      } else {
        leave_out(*e);
      }
    }
    if (result.positions.empty() && vertices > 0) {
      xml_.findings.add(xml_.place(element), "{} vertices without positions", vertices);
    }
    return result;
  }

  void vertex_buffer(const XMLElement& element, std::uint32_t vertices, Geometry& geometry) {
    // A buffer adds what earlier ones lack; the first set of texture coordinates is the one kept.
    const bool positions = xml_.flag(element, "positions", false) && geometry.positions.empty();
    const bool normals = xml_.flag(element, "normals", false) && geometry.normals.empty();
    const bool colours = xml_.flag(element, "colours_diffuse", false) && geometry.colours.empty();
    bool texcoords = xml_.count(element, "texture_coords", 0) > 0 && geometry.texcoords.empty();
    if (texcoords &&
        xml_.text(element, "texture_coord_dimensions_0").find("colour") != std::string::npos) {
      ++report_.unknown["mesh: texture coordinates that are colours"];
      texcoords = false;
    }

    std::uint32_t found = 0;
    for (const XMLElement* v = element.FirstChildElement(); v; v = v->NextSiblingElement()) {
      if (!is(*v, "vertex")) {
        leave_out(*v);
        continue;
      }
      ++found;
      if (positions) geometry.positions.push_back(xml_.vector(part(*v, "position")));
      if (normals) geometry.normals.push_back(xml_.vector(part(*v, "normal")));
      if (colours) geometry.colours.push_back(vertex_colour(part(*v, "colour_diffuse")));
      if (texcoords) {
        const XMLElement& t = part(*v, "texcoord");
        geometry.texcoords.emplace_back(xml_.number(t, "u"), xml_.number(t, "v", 0.0f));
      }
    }
    if (found != vertices) {
      xml_.findings.add(xml_.place(element), "the buffer has {} vertices where {} are announced",
                        found, vertices);
    }
  }

  /// A vertex that lacks a part stands in for it, which the attributes' reader then reports.
  const XMLElement& part(const XMLElement& vertex, const char* name) {
    const XMLElement* e = vertex.FirstChildElement(name);
    if (!e) xml_.findings.add(xml_.place(vertex), "the vertex has no {}", name);
    return e ? *e : vertex;
  }

  Vec4 vertex_colour(const XMLElement& element) {
    const char* value = element.Attribute("value");
    const auto parts = split(value ? value : "");
    Vec4 colour(1.0f);
    bool good = parts.size() == 3 || parts.size() == 4;
    for (int c = 0; good && c < static_cast<int>(parts.size()); ++c) {
      const auto number = parse_float(parts[static_cast<std::size_t>(c)]);
      good = number.has_value();
      colour[c] = number.value_or(1.0f);
    }
    if (!good) {
      xml_.findings.add(xml_.place(element), "\"{}\" is no colour", value ? value : "");
    }
    return colour;
  }

  void submeshes(const XMLElement& parent) {
    for (const XMLElement* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (is(*e, "submesh")) {
        submesh(*e);
      } else {
        leave_out(*e);
      }
    }
  }

  void submesh(const XMLElement& element) {
    Submesh result;
    result.material = xml_.text(element, "material");
    const std::string operation = xml_.text(element, "operationtype");
    if (!operation.empty()) {
      if (const auto known = operation_named(operation)) {
        result.operation = *known;
      } else {
        xml_.findings.add(xml_.place(element), "operationtype=\"{}\" is unknown", operation);
      }
    }
    const XMLElement* own = element.FirstChildElement("geometry");
    if (!xml_.flag(element, "usesharedvertices", true)) {
      if (!own) xml_.findings.add(xml_.place(element), "the submesh has no geometry");
      result.own = own ? geometry(*own) : Geometry{};
    } else if (!mesh_.shared) {
      xml_.findings.add(xml_.place(element), "the submesh uses shared vertices; there are none");
    }
    for (const XMLElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (is(*e, "faces")) {
        if (has_triangles(result.operation)) faces(*e, result);
      } else if (is(*e, "textures")) {
        for (const XMLElement* t = e->FirstChildElement("texture"); t;
             t = t->NextSiblingElement("texture")) {
          result.textures[xml_.text(*t, "alias")] = xml_.text(*t, "name");
        }
      } else if (!is(*e, "geometry")) {
        leave_out(*e);
      }
    }
    mesh_.submeshes.push_back(std::move(result));
  }

  void faces(const XMLElement& parent, Submesh& submesh) {
    const Geometry nothing;
    const Geometry& geometry =
        submesh.own ? *submesh.own : (mesh_.shared ? *mesh_.shared : nothing);
    std::uint32_t found = 0;
    for (const XMLElement* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (!is(*e, "face")) {
        leave_out(*e);
        continue;
      }
      ++found;
      for (const char* attribute : {"v1", "v2", "v3"}) {
        // A strip or fan goes on by one vertex a face.
        if (submesh.operation != Operation::kTriangleList && !e->Attribute(attribute)) continue;
        const std::uint32_t index = xml_.count(*e, attribute);
        if (index >= geometry.positions.size()) {
          xml_.findings.add(xml_.place(*e), "the face uses vertex {} of {}", index,
                            geometry.positions.size());
        }
        submesh.indices.push_back(index);
      }
    }
    const std::uint32_t announced = xml_.count(parent, "count", found);
    if (found != announced) {
      xml_.findings.add(xml_.place(parent), "there are {} faces where {} are announced", found,
                        announced);
    }
  }

  void names(const XMLElement& parent) {
    for (const XMLElement* e = parent.FirstChildElement("submeshname"); e;
         e = e->NextSiblingElement("submeshname")) {
      const std::uint32_t i = xml_.count(*e, "index");
      if (i < mesh_.submeshes.size()) {
        mesh_.submeshes[i].name = xml_.text(*e, "name");
      } else {
        xml_.findings.add(xml_.place(*e), "names submesh {} of {}", i, mesh_.submeshes.size());
      }
    }
  }

  XmlFile xml_;
  LoadReport& report_;
  MeshFile mesh_;
};

}  // namespace

MeshFile parse_xml(std::string_view text, const std::string& name, LoadReport& report) {
  report.format = "Ogre mesh XML";
  return Reader(text, name, report).read();
}

}  // namespace ogre

Loaded load_ogre_xml(const std::filesystem::path& path, const LoadOptions& options) {
  LoadReport report;
  const ogre::MeshFile mesh = ogre::parse_xml(read_text(path), path.string(), report);
  return ogre::load_mesh(mesh, std::move(report), path, options);
}

}  // namespace lantern
