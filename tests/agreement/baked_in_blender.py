# SPDX-License-Identifier: MIT
# Run by Blender (-b --python FILE -- BAKED.glb): what it imports of a baked file has the colours and
# the lightmap's coordinates that the file has. Exits 77 where Blender has no numpy to import with.
import json
import struct
import sys

try:
    import numpy
except ModuleNotFoundError:
    sys.exit(77)
numpy.bool = bool  # Debian 12's importer uses the name that its numpy has dropped

import bpy


class Glb:
    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20 : 20 + length])
        self.binary = data[20 + length + 8 :]

    def floats(self, accessor):
        """The rows of an accessor of floats."""
        accessor = self.json["accessors"][accessor]
        assert accessor["componentType"] == 5126
        view = self.json["bufferViews"][accessor["bufferView"]]
        width = {"VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", 4 * width)
        return [
            struct.unpack_from(f"<{width}f", self.binary, start + i * stride)
            for i in range(accessor["count"])
        ]


def encoded(linear):
    """sRGB, clipped to [0, 1]."""
    c = min(max(linear, 0.0), 1.0)
    return 12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055


def check(condition, message):
    if not condition:
        print("FAILED:", message)
        sys.exit(1)


def main(path):
    glb = Glb(path)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path)
    for mesh in glb.json["meshes"]:
        attributes = mesh["primitives"][0]["attributes"]
        places = glb.floats(attributes["POSITION"])
        lightmap = glb.floats(attributes["TEXCOORD_1"])
        colours = glb.floats(attributes["COLOR_0"]) if "COLOR_0" in attributes else None
        found = bpy.data.objects[mesh["name"]].data
        check(len(found.vertices) == len(places), "the number of vertices")
        check(len(found.uv_layers) == 2, "both sets of coordinates")
        check(len(found.color_attributes) == (1 if colours else 0), "one set of colours")
        brightest = 0.0
        for loop in found.loops:
            vertex = loop.vertex_index
            x, y, z = places[vertex]  # its z is up
            moved = found.vertices[vertex].co - type(found.vertices[vertex].co)((x, -z, y))
            check(moved.length < 1e-5, "the place of a vertex")
            u, v = found.uv_layers[1].data[loop.index].uv  # whose origin is below
            check(
                abs(u - lightmap[vertex][0]) + abs(1.0 - v - lightmap[vertex][1]) < 1e-5,
                "the coordinates in the lightmap",
            )
            if not colours:
                continue
            seen = found.color_attributes[0].data[loop.index].color
            for channel in range(3):
                difference = encoded(seen[channel]) - encoded(colours[vertex][channel])
                check(abs(difference) <= 1.0 / 255.0, "a colour, which Blender keeps in 8 bits")
                brightest = max(brightest, seen[channel])
        check(not colours or brightest > 0.9, "colours up to white")
    check([tuple(i.size) for i in bpy.data.images] == [(256, 256)], "the lightmap")


main(sys.argv[-1])
