#!/usr/bin/env python3
"""Writes the fuzzers' seeds and dictionaries.   tests/fuzz/seeds.py FOLDER"""
import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "hostile"))
import good_files as good

folder = pathlib.Path(sys.argv[1])


def seed(target, name, content):
    (folder / target).mkdir(parents=True, exist_ok=True)
    (folder / target / name).write_bytes(content)


def dictionary(target, words):
    lines = ["\"" + re.sub(r'(["\\])', r"\\\1", word) + "\"" for word in sorted(set(words))]
    (folder / (target + ".dict")).write_text("\n".join(lines) + "\n")


document, data = good.gltf()
seed("gltf", "everything", good.gltf_text(document, data))
seed("glb", "everything", good.glb(document, data))
# One part of the whole each: short inputs are what a fuzzer changes best.
for mesh in range(len(document["meshes"])):
    small = {"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}],
             "meshes": [{"primitives": [{"attributes": document["meshes"][mesh]["primitives"][0]["attributes"]}]}],
             "accessors": document["accessors"], "bufferViews": document["bufferViews"]}
    seed("gltf", "mesh%d" % mesh, good.gltf_text(small, data))
    seed("glb", "mesh%d" % mesh, good.glb(small, data))
seed("gltf", "empty", b'{"asset":{"version":"2.0"}}')
seed("gltf", "nodes", b'{"asset":{"version":"2.0"},"nodes":[{"children":[1]},{"scale":[1,2,3]}]}')
seed("obj", "scene", good.OBJ)
seed("obj", "polygon", b"v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 1 0\nv 0 2 0\nf 1 2 3 4 5\n")
seed("mtl", "scene", good.MTL)
for kind in ("ascii", "binary_little_endian", "binary_big_endian"):
    seed("ply", kind, good.ply(kind))
seed("ply", "strips", b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                      b"element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
seed("stl", "text", good.stl_text())
seed("stl", "binary", good.stl_binary())
seed("image", "png", good.png())
seed("image", "jpeg", good.jpeg())

words = re.findall(r'"[A-Za-z0-9_]+"', json.dumps(document))
dictionary("gltf", words + ["1e30", "-1", "1e-40", "4294967295", "9999999999"])
dictionary("glb", words + ["glTF", "JSON", "BIN"])
dictionary("obj", ["usemtl ", "mtllib ", "f ", "v ", "vt ", "vn ", "o ", "g ", "s ", "l ", "//", "/", "-1", "nan", "1e39"])
dictionary("mtl", [line.split()[0] + " " for line in good.MTL.decode().split("\n") if line] +
           ["-s ", "-o ", "-t ", "-mm ", "-bm ", "-clamp ", "-imfchan ", "-halo ", "spectral ", "painted", "lamp"])
dictionary("ply", ["element ", "property ", "list ", "vertex", "face", "tristrips", "vertex_indices", "char", "uchar",
                   "short", "ushort", "int", "uint", "float", "double", "end_header", "ascii",
                   "binary_little_endian", "binary_big_endian", "comment TextureFile "])
dictionary("stl", ["solid", "facet normal ", "outer loop", "vertex ", "endloop", "endfacet", "endsolid"])
dictionary("image", ["IHDR", "IDAT", "IEND"])
