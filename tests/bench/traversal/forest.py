#!/usr/bin/env python3
"""Writes a forest: COUNT placements of one tree of 1,064 triangles on a floor, by EXT_mesh_gpu_instancing.

    forest.py COUNT FILE.glb
"""
import array
import json
import math
import random
import struct
import sys


def tree(rng):
    """A trunk of 64 triangles and 1,000 leaves, each a triangle: positions and indices of both."""
    trunk, crown = [], []
    for i in range(32):
        a, b = (2 * math.pi * k / 32 for k in (i, i + 1))
        low = [(0.12 * math.cos(x), 0.0, 0.12 * math.sin(x)) for x in (a, b)]
        high = [(0.04 * math.cos(x), 2.0, 0.04 * math.sin(x)) for x in (a, b)]
        trunk += [low[0], high[0], low[1], low[1], high[0], high[1]]
    for _ in range(1000):
        height = rng.random() ** 1.5
        reach = (1 - height) * 0.9 * math.sqrt(rng.random())
        angle = rng.uniform(0, 2 * math.pi)
        centre = (reach * math.cos(angle), 0.8 + 2.4 * height, reach * math.sin(angle))
        for _ in range(3):
            crown.append(tuple(c + rng.uniform(-0.09, 0.09) for c in centre))
    return trunk, crown


def main():
    count, path = int(float(sys.argv[1])), sys.argv[2]
    rng = random.Random(1)
    side = 2.2 * math.sqrt(count)
    chunks, views, accessors = [], [], []

    def add(values, kind, width, bounds=False):
        data = array.array("f", values)
        offset = sum(len(c) for c in chunks)
        chunks.append(data.tobytes())
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(chunks[-1])})
        accessor = {"bufferView": len(views) - 1, "componentType": 5126, "count": len(data) // width, "type": kind}
        if bounds:
            accessor["min"] = [min(data[k::width]) for k in range(width)]
            accessor["max"] = [max(data[k::width]) for k in range(width)]
        accessors.append(accessor)
        return len(accessors) - 1

    def positions(points):
        return add([x for p in points for x in p], "VEC3", 3, True)

    trunk, crown = tree(rng)
    h = side / 2 + 3
    floor = [(-h, 0, -h), (-h, 0, h), (h, 0, h), (-h, 0, -h), (h, 0, h), (h, 0, -h)]
    meshes = [{"primitives": [{"attributes": {"POSITION": positions(trunk)}, "material": 0},
                              {"attributes": {"POSITION": positions(crown)}, "material": 1}]},
              {"primitives": [{"attributes": {"POSITION": positions(floor)}, "material": 2}]}]
    columns = math.ceil(math.sqrt(count))
    places, turns, sizes = array.array("f"), array.array("f"), array.array("f")
    for i in range(count):
        places.extend(((i % columns + rng.random()) * side / columns - side / 2, 0.0,
                       (i // columns + rng.random()) * side / columns - side / 2))
        angle, size = rng.uniform(0, math.pi), rng.uniform(0.6, 1.4)
        turns.extend((0.0, math.sin(angle), 0.0, math.cos(angle)))
        sizes.extend((size, size * rng.uniform(0.8, 1.3), size))
    copies = {"TRANSLATION": add(places, "VEC3", 3), "ROTATION": add(turns, "VEC4", 4), "SCALE": add(sizes, "VEC3", 3)}

    def material(r, g, b):
        return {"pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1], "metallicFactor": 0},
                "extensions": {"KHR_materials_specular": {"specularFactor": 0}}, "doubleSided": True}

    pitch = -0.22
    gltf = {"asset": {"version": "2.0"}, "extensionsUsed": ["EXT_mesh_gpu_instancing", "KHR_materials_specular"],
            "scene": 0, "scenes": [{"nodes": [0, 1, 2]}], "meshes": meshes,
            "materials": [material(0.25, 0.16, 0.1), material(0.12, 0.35, 0.08), material(0.3, 0.26, 0.2)],
            "nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": copies}}}, {"mesh": 1},
                      {"camera": 0, "translation": [0, 9, min(side / 2, 60) + 6],
                       "rotation": [math.sin(pitch / 2), 0, 0, math.cos(pitch / 2)]}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
            "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": sum(len(c) for c in chunks)}]}
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    body = b"".join(chunks)
    with open(path, "wb") as out:
        out.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(body)))
        out.write(struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(body), 0x004E4942) + body)


if __name__ == "__main__":
    main()
