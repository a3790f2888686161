"""Files of which a loader could take many times their size."""
import json
import random
import struct
import zlib

import good_files as good

CORNERS = b"1 2 3 4 5 "  # of a polygon, two bytes each


def nodes(last):
    """400,000 nodes of 40 bytes."""
    data = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    head = {"asset": {"version": "2.0"}, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": good.data_uri(data)}]}
    rows = b",".join(b'{"mesh":0,"translation":[%d,%d,1]}' % (i % 100, i // 100) for i in range(400000))
    return json.dumps(head).encode()[:-1] + b',"nodes":[' + rows + last + b"]}"


def ply(index, faces, corners):
    """Faces of as many corners with indices of one or two bytes."""
    header = ("ply\nformat binary_little_endian 1.0\nelement vertex 256\nproperty float x\nproperty float y\nproperty float z\n"
              "element face %d\nproperty list uint %s vertex_indices\nend_header\n" % (faces, index)).encode()
    vertices = b"".join(struct.pack("<3f", i % 16, i // 16, i * i % 97) for i in range(256))
    cycle = b"".join(bytes([i] if index == "uchar" else [i, 0]) for i in range(250))
    width = 1 if index == "uchar" else 2
    row = struct.pack("<I", corners) + (cycle * (corners // 250 + 1))[:corners * width]
    return header + vertices + row * faces


def obj(faces, fives):
    vertices = b"".join(b"v %d %d %d\n" % (i % 16, i // 16, i * i % 97) for i in range(256))
    return vertices + (b"f " + CORNERS * fives + b"\n") * faces


def png(last_filter):
    """9000 x 9000 from 1.7 MB; a chunk of noise keeps it from being out of proportion."""
    def chunk(name, content):
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
    size = 9000
    row = bytes(i * 7 & 255 for i in range(100)) * (size * 3 // 100)
    packer = zlib.compressobj(1)
    data = b"".join(packer.compress(b"\0" + row) for _ in range(size - 1)) + packer.compress(last_filter + row) + packer.flush()
    noise = random.Random(1).randbytes(max(0, size * size * 4 // 200 - len(data) + 1000))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0)) +
            chunk(b"prVt", noise) + chunk(b"IDAT", data) + chunk(b"IEND", b""))


TEXTURED = b"mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n"
MATERIAL = b"newmtl a\nmap_Kd large.png\n"
# (name, extension, makes the content, {other file: content}, whether nothing is wrong with it)
FILES = [
    ("nodes-400000", "gltf", lambda: nodes(b""), {}, True),
    ("nodes-400000-cycle", "gltf", lambda: nodes(b',{"children":[400000]}'), {}, False),
    ("nodes-400000-no-mesh", "gltf", lambda: nodes(b',{"mesh":1}'), {}, False),
    ("faces-of-bytes", "ply", lambda: ply("uchar", 150000, 255), {}, False),
    ("faces-of-two-bytes", "ply", lambda: ply("ushort", 90000, 255), {}, False),
    ("face-of-40000000", "ply", lambda: ply("uchar", 1, 40000000), {}, False),
    ("polygons", "obj", lambda: obj(75000, 51), {}, False),
    ("polygon-of-15000000", "obj", lambda: obj(1, 3000000), {}, False),
    ("map-damaged-in-its-last-row", "obj", lambda: TEXTURED, {"scene__mtl": MATERIAL, "large__png": lambda: png(b"\7")}, False),
]
