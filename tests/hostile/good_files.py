"""Well-formed scene files, made here: what malformed ones and the fuzzers' seeds start from."""
import base64
import json
import struct
import zlib


def png(width=2, height=2, color=(200, 100, 50)):
    """An RGB PNG of one colour."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    rows = (b"\0" + bytes(color) * width) * height
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def jpeg():
    """A grey JPEG of one texel: baseline, tables of ones, a code of one length."""
    quantization = b"\xff\xdb\x00\x43\x00" + b"\x01" * 64
    frame = b"\xff\xc0\x00\x0b\x08\x00\x01\x00\x01\x01\x01\x11\x00"
    def huffman(kind):
        return b"\xff\xc4\x00\x14" + bytes([kind]) + b"\x01" + b"\0" * 15 + b"\x00"
    scan = b"\xff\xda\x00\x08\x01\x01\x00\x00\x3f\x00" + b"\x3f"
    return b"\xff\xd8" + quantization + frame + huffman(0x00) + huffman(0x10) + scan + b"\xff\xd9"


class Buffer:
    """A glTF buffer with its views and accessors."""
    def __init__(self):
        self.data = b""
        self.views = []
        self.accessors = []

    def view(self, data, **more):
        self.data += b"\0" * (-len(self.data) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **more})
        self.data += data
        return len(self.views) - 1

    def accessor(self, code, kind, rows, component, **more):
        flat = [number for row in rows for number in (row if isinstance(row, (list, tuple)) else [row])]
        view = self.view(struct.pack("<%d%s" % (len(flat), code), *flat))
        self.accessors.append({"bufferView": view, "componentType": component, "count": len(rows), "type": kind, **more})
        return len(self.accessors) - 1

    def floats(self, kind, rows, **more):
        return self.accessor("f", kind, rows, 5126, **more)


def gltf():
    """(document without buffers, binary data): every part that the importer reads, in few bytes."""
    b = Buffer()
    square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    position = b.floats("VEC3", square, min=[0, 0, 0], max=[1, 1, 0])
    normal = b.floats("VEC3", [(0, 0, 1)] * 4)
    tangent = b.floats("VEC4", [(1, 0, 0, 1)] * 4)
    texcoord = b.floats("VEC2", [(0, 1), (1, 1), (1, 0), (0, 0)])
    color = b.accessor("B", "VEC4", [(255, 128, 0, 255)] * 4, 5121, normalized=True)
    indices = b.accessor("H", "SCALAR", [0, 1, 2, 0, 2, 3], 5123)
    target = b.floats("VEC3", [(0, 0, 0.5)] * 4)
    joints = b.accessor("B", "VEC4", [(0, 1, 0, 0)] * 4, 5121)
    weights = b.floats("VEC4", [(0.5, 0.5, 0, 0)] * 4)
    inverse = b.floats("MAT4", [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)] * 2)
    times = b.floats("SCALAR", [0, 1], min=[0], max=[1])
    moves = b.floats("VEC3", [(0, 0, 0), (0, 1, 0)])
    strip = b.accessor("B", "SCALAR", [0, 1, 3, 2], 5121)
    copies = b.floats("VEC3", [(0, 0, 0), (2, 0, 0)])
    sparse_indices = b.view(struct.pack("<HH", 1, 2))
    sparse_values = b.view(struct.pack("<6f", 2, 0, 0, 2, 2, 0))
    b.accessors.append({"bufferView": b.accessors[position]["bufferView"], "componentType": 5126, "count": 4,
                        "type": "VEC3", "sparse": {"count": 2,
                        "indices": {"bufferView": sparse_indices, "componentType": 5123},
                        "values": {"bufferView": sparse_values}}})
    sparse = len(b.accessors) - 1
    image = b.view(png())
    photo = b.view(jpeg())
    texture = {"index": 0, "texCoord": 0}
    document = {
        "asset": {"version": "2.0", "generator": "good_files.py"},
        "extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform", "KHR_materials_emissive_strength",
                           "KHR_materials_ior", "KHR_materials_specular", "KHR_materials_unlit",
                           "KHR_materials_transmission", "KHR_materials_variants", "EXT_mesh_gpu_instancing"],
        "scene": 0,
        "scenes": [{"name": "all", "nodes": [0, 4]}],
        "nodes": [
            {"name": "root", "children": [1, 2, 3], "translation": [0, 0, -3]},
            {"mesh": 0, "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
            {"camera": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0.5, 3, 1]},
            {"mesh": 1, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": copies}}}},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 2], "children": [5, 6]},
            {"mesh": 2, "skin": 0, "name": "skinned"},
            {"name": "joint", "weights": [0.5]},
        ],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1, "zfar": 100}},
                    {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": position, "NORMAL": normal, "TANGENT": tangent,
                                            "TEXCOORD_0": texcoord, "COLOR_0": color},
                             "indices": indices, "material": 0,
                             "extensions": {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}}]},
            {"primitives": [{"attributes": {"POSITION": sparse}, "indices": strip, "mode": 5, "material": 1,
                             "targets": [{"POSITION": target}]}], "weights": [0.25]},
            {"primitives": [{"attributes": {"POSITION": position, "JOINTS_0": joints, "WEIGHTS_0": weights},
                             "mode": 6}]},
        ],
        "skins": [{"joints": [6, 5], "inverseBindMatrices": inverse}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                        "samplers": [{"input": times, "output": moves, "interpolation": "LINEAR"}]}],
        "materials": [
            {"name": "all", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1], "metallicFactor": 0.5,
                                                     "roughnessFactor": 0.5, "baseColorTexture":
                                                     {"index": 0, "extensions": {"KHR_texture_transform":
                                                      {"offset": [0.5, 0], "rotation": 0.3, "scale": [2, 2]}}},
                                                     "metallicRoughnessTexture": texture},
             "normalTexture": {"index": 1, "scale": 0.5}, "occlusionTexture": {"index": 1, "strength": 0.5},
             "emissiveTexture": texture, "emissiveFactor": [1, 1, 1], "alphaMode": "MASK", "alphaCutoff": 0.4,
             "doubleSided": True, "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2},
                                                 "KHR_materials_ior": {"ior": 1.4},
                                                 "KHR_materials_specular": {"specularFactor": 0.5,
                                                                            "specularTexture": texture}}},
            {"name": "other", "alphaMode": "BLEND", "extensions": {"KHR_materials_transmission":
                                                                   {"transmissionFactor": 0.5}}},
        ],
        "textures": [{"source": 0, "sampler": 0}, {"source": 1}],
        "samplers": [{"magFilter": 9728, "minFilter": 9987, "wrapS": 33071, "wrapT": 33648}],
        "images": [{"bufferView": image, "mimeType": "image/png"}, {"bufferView": photo, "mimeType": "image/jpeg"}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "color": [1, 1, 1], "intensity": 5,
                                                           "range": 10, "spot": {"innerConeAngle": 0.1,
                                                                                 "outerConeAngle": 0.5}}]},
                       "KHR_materials_variants": {"variants": [{"name": "second"}]}},
        "bufferViews": b.views,
        "accessors": b.accessors,
    }
    return document, b.data


def data_uri(data, kind="application/octet-stream"):
    return "data:%s;base64,%s" % (kind, base64.b64encode(data).decode())


def gltf_text(document, data):
    """A .gltf file with its buffer inside."""
    whole = dict(document, buffers=[{"byteLength": len(data), "uri": data_uri(data)}])
    return json.dumps(whole, separators=(",", ":")).encode()


def glb(document, data):
    whole = dict(document, buffers=[{"byteLength": len(data)}])
    text = json.dumps(whole, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    return (b"glTF" + struct.pack("<II", 2, 12 + 8 + len(text) + 8 + len(data)) +
            struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(data)) + b"BIN\0" + data)


OBJ = b"""# every statement
mtllib scene.mtl
o thing
v 0 0 0
v 1 0 0 1 0.5 0
v 1 1 0
v 0 1 0
v 0.4 0.6 0
vt 0 0
vt 1 0 0
vt 1 1
vn 0 0 1
g part
s 1
usemtl painted
f 1/1/1 2/2/1 3/3/1
usemtl lamp
f -5//-1 -3//-1 -2//-1 \\
 -1//-1
usemtl nowhere
f 1 2 3 4
l 1 2
p 1
"""

MTL = b"""newmtl painted
Ka 1 1 1
Kd 0.5 0.25 0.125
Ks 0.2 0.2 0.2
Ns 30
Ni 1.5
d 0.5
illum 2
map_Kd -s 2 2 -o 0.5 0.5 -clamp on image.png
map_bump -bm 0.5 image.png
map_d image.png
norm image.png

newmtl lamp
Kd 0 0 0
Ke 5 5 5
Tf 1 1 1
illum 7
Pr 0.5
Pm 0.25
Pc 1
Pcr 0.1
aniso 0.1
anisor 0.2
map_Pr image.png
"""

PLY_VERTICES = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.25, 0)]
PLY_FACES = [(0, 1, 2), (0, 1, 4, 2, 3)]


def ply(kind):
    """ascii, binary_little_endian or binary_big_endian."""
    header = ("ply\nformat %s 1.0\ncomment TextureFile image.png\nelement vertex %d\n"
              "property float x\nproperty float y\nproperty float z\n"
              "property float nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty float v\n"
              "property uchar red\nproperty uchar green\nproperty uchar blue\n"
              "element face %d\nproperty list uchar int vertex_indices\nend_header\n"
              % (kind, len(PLY_VERTICES), len(PLY_FACES))).encode()
    if kind == "ascii":
        body = "".join("%g %g %g 0 0 1 0.5 0.5 255 128 0\n" % v for v in PLY_VERTICES)
        body += "".join("%d %s\n" % (len(f), " ".join(map(str, f))) for f in PLY_FACES)
        return header + body.encode()
    order = ">" if kind == "binary_big_endian" else "<"
    body = b"".join(struct.pack(order + "8f3B", *v, 0, 0, 1, 0.5, 0.5, 255, 128, 0) for v in PLY_VERTICES)
    body += b"".join(struct.pack("%sB%di" % (order, len(f)), len(f), *f) for f in PLY_FACES)
    return header + body


STL_FACETS = [((0, 0, 0), (1, 0, 0), (1, 1, 0)), ((0, 0, 0), (1, 1, 0), (0, 1, 0))]


def stl_text():
    text = "solid square\n"
    for facet in STL_FACETS:
        text += "facet normal 0 0 1\n outer loop\n"
        text += "".join("  vertex %g %g %g\n" % corner for corner in facet)
        text += " endloop\nendfacet\n"
    return (text + "endsolid square\n").encode()


def stl_binary(title=b"solid but binary"):
    body = b"".join(struct.pack("<3f", 0, 0, 1) + b"".join(struct.pack("<3f", *c) for c in facet) + b"\0\0"
                    for facet in STL_FACETS)
    return title.ljust(80, b"\0") + struct.pack("<I", len(STL_FACETS)) + body
