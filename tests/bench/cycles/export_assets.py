#!/usr/bin/env python3
"""Textured assets as glTF files that Heliograph and Cycles can say exactly: export_assets.py ASSETS FOLDER

Writes FOLDER/helmet.gltf and fox.gltf from ASSETS/gltf/FlightHelmet and Fox.glb, with their base colour textures: the
meshes in world space (the fox as modelled, without its skin) of Lambertian surfaces, and a camera.
"""
import json
import math
import pathlib
import shutil
import struct
import sys

PARTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}
FORMATS = {5121: ("B", 1), 5123: ("H", 2), 5125: ("I", 4), 5126: ("f", 4)}


class Asset:
    def __init__(self, path):
        self.folder = path.parent
        data = path.read_bytes()
        if data[:4] == b"glTF":
            length = struct.unpack_from("<I", data, 12)[0]
            self.document, self.binary = json.loads(data[20 : 20 + length]), data[28 + length :]
        else:
            self.document = json.loads(data)
            self.binary = (self.folder / self.document["buffers"][0]["uri"]).read_bytes()

    def values(self, index):
        accessor = self.document["accessors"][index]
        view = self.document["bufferViews"][accessor["bufferView"]]
        parts, (code, size) = PARTS[accessor["type"]], FORMATS[accessor["componentType"]]
        step = view.get("byteStride", parts * size)
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return [struct.unpack_from(f"<{parts}{code}", self.binary, start + i * step) for i in range(accessor["count"])]

    def save_image(self, index, path):
        image = self.document["images"][index]
        if "uri" in image:
            shutil.copyfile(self.folder / image["uri"], path)
        else:
            view = self.document["bufferViews"][image["bufferView"]]
            start = view.get("byteOffset", 0)
            path.write_bytes(self.binary[start : start + view["byteLength"]])


class Written:
    """A glTF file whose accessors are each a tight view of their own, of floats or 32-bit indices."""

    def __init__(self):
        self.binary = bytearray()
        self.document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
                         "materials": [], "textures": [], "images": [], "accessors": [], "bufferViews": [],
                         "extensionsUsed": ["KHR_materials_specular"]}

    def add(self, values, kind, code):
        accessor = {"bufferView": len(self.document["bufferViews"]), "count": len(values), "type": kind,
                    "componentType": 5126 if code == "f" else 5125}
        if kind == "VEC3":
            accessor["min"] = [min(v[i] for v in values) for i in range(3)]
            accessor["max"] = [max(v[i] for v in values) for i in range(3)]
        start = len(self.binary)
        for value in values:
            self.binary += struct.pack(f"<{PARTS[kind]}{code}", *value)
        self.document["bufferViews"].append({"buffer": 0, "byteOffset": start, "byteLength": len(self.binary) - start})
        self.document["accessors"].append(accessor)
        return len(self.document["accessors"]) - 1

    def add_node(self, node):
        self.document["scenes"][0]["nodes"].append(len(self.document["nodes"]))
        self.document["nodes"].append(node)

    def add_camera(self, low, high):
        """From the right, a little above, with the whole box in sight."""
        centre = [(a + b) / 2 for a, b in zip(low, high)]
        radius = math.dist(low, high) / 2
        back = (0.5, 0.25, math.sqrt(1 - 0.3125))
        right = (back[2] / math.hypot(back[0], back[2]), 0.0, -back[0] / math.hypot(back[0], back[2]))
        up = tuple(back[(i + 1) % 3] * right[(i + 2) % 3] - back[(i + 2) % 3] * right[(i + 1) % 3] for i in range(3))
        yfov = 0.7
        eye = [c + radius / math.sin(yfov / 2) * b for c, b in zip(centre, back)]
        self.document["cameras"] = [{"type": "perspective", "perspective": {"yfov": yfov, "aspectRatio": 1.0,
                                                                             "znear": 1e-3 * radius}}]
        self.add_node({"camera": 0, "matrix": [*right, 0, *up, 0, *back, 0, *eye, 1]})

    def save(self, path):
        binary = path.with_suffix(".bin")
        binary.write_bytes(self.binary)
        self.document["buffers"] = [{"uri": binary.name, "byteLength": len(self.binary)}]
        path.write_text(json.dumps(self.document))


def export(asset, path):
    out = Written()
    images = {}
    for material in asset.document["materials"]:
        texture = asset.document["textures"][material["pbrMetallicRoughness"]["baseColorTexture"]["index"]]
        source = texture["source"]
        if source not in images:
            images[source] = len(images)
            name = f"{path.stem}-{images[source]}.png"
            asset.save_image(source, path.with_name(name))
            out.document["images"].append({"uri": name})
            out.document["textures"].append({"source": images[source]})
        out.document["materials"].append({
            "doubleSided": True, "extensions": {"KHR_materials_specular": {"specularFactor": 0}},
            "pbrMetallicRoughness": {"baseColorTexture": {"index": images[source]}, "metallicFactor": 0}})
    low, high = [math.inf] * 3, [-math.inf] * 3
    for mesh in asset.document["meshes"]:
        for primitive in mesh["primitives"]:
            given = primitive["attributes"]
            positions = asset.values(given["POSITION"])
            indices = asset.values(primitive["indices"]) if "indices" in primitive else [(i,) for i in range(len(positions))]
            attributes = {"POSITION": out.add(positions, "VEC3", "f"),
                          "TEXCOORD_0": out.add(asset.values(given["TEXCOORD_0"]), "VEC2", "f")}
            if "NORMAL" in given:
                attributes["NORMAL"] = out.add(asset.values(given["NORMAL"]), "VEC3", "f")
            out.add_node({"mesh": len(out.document["meshes"])})
            out.document["meshes"].append({"primitives": [{"attributes": attributes, "material": primitive["material"],
                                                           "indices": out.add(indices, "SCALAR", "I")}]})
            low = [min(a, *(p[i] for p in positions)) for i, a in enumerate(low)]
            high = [max(a, *(p[i] for p in positions)) for i, a in enumerate(high)]
    out.add_camera(low, high)
    out.save(path)


def main():
    assets, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    export(Asset(assets / "gltf/FlightHelmet/FlightHelmet.gltf"), folder / "helmet.gltf")
    export(Asset(assets / "gltf/Fox.glb"), folder / "fox.gltf")


if __name__ == "__main__":
    main()
