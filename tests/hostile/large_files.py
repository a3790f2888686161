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


def chunk(name, content):
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))


# Where the rows of a PNG's passes begin and how far they are apart: x, y, step in x, step in y.
WHOLE = [(0, 0, 1, 1)]
PASSES = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]


def png(size, passes, last_filter, seed=1):
    """size x size of RGB; a chunk of noise keeps it from being out of proportion. The last row has a filter of its own."""
    packer = zlib.compressobj(1)
    data = b""
    for i, (x, y, across, down) in enumerate(passes):
        width, height = (size - x + across - 1) // across, (size - y + down - 1) // down
        row = (bytes(k * 7 & 255 for k in range(100)) * (width * 3 // 100 + 1))[:width * 3]
        data += b"".join(packer.compress(b"\0" + row) for _ in range(height - 1))
        data += packer.compress((last_filter if i + 1 == len(passes) else b"\0") + row)
    data += packer.flush()
    noise = random.Random(seed).randbytes(max(0, size * size * 4 // 200 - len(data) + 1000))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, int(len(passes) > 1))) +
            chunk(b"prVt", noise) + chunk(b"IDAT", data) + chunk(b"IEND", b""))


def progressive_jpeg(size, end):
    """size x size of three components without subsampling, grey: one bit a block in each scan."""
    def segment(marker, content):
        return b"\xff" + marker + struct.pack(">H", len(content) + 2) + content
    one_code = bytes([1] + [0] * 15) + b"\0"  # a single code, 0, for the symbol 0
    blocks = ((size + 7) // 8) ** 2
    noise = b"".join(segment(b"\xfe", random.Random(i).randbytes(60000)) for i in range(size * size * 6 // 200 // 60000 + 1))
    scans = segment(b"\xda", b"\3\1\0\2\0\3\0\0\0\0") + bytes(blocks * 3 // 8 + 1)
    for component in (b"\1", b"\2", b"\3"):
        scans += segment(b"\xda", b"\1" + component + b"\0\1\x3f\0") + bytes(blocks // 8 + 1)
    return (b"\xff\xd8" + segment(b"\xdb", b"\0" + b"\1" * 64) + noise +
            segment(b"\xc2", b"\x08" + struct.pack(">HH", size, size) + b"\3\1\x11\0\2\x11\0\3\x11\0") +
            segment(b"\xc4", b"\0" + one_code) + segment(b"\xc4", b"\x10" + one_code) + scans + end)


def pictures(count):
    """One triangle whose material names so many pictures."""
    slots = ["emissiveTexture", "normalTexture", "occlusionTexture"][:count - 1]
    material = {slot: {"index": i + 1} for i, slot in enumerate(slots)}
    material["pbrMetallicRoughness"] = {"baseColorTexture": {"index": 0}}
    data = struct.pack("<9f6f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1)
    return json.dumps({
        "asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "materials": [material],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                      {"bufferView": 0, "byteOffset": 36, "componentType": 5126, "count": 3, "type": "VEC2"}],
        "bufferViews": [{"buffer": 0, "byteLength": 60}], "buffers": [{"byteLength": 60, "uri": good.data_uri(data)}],
        "textures": [{"source": i} for i in range(count)],
        "images": [{"uri": "picture%d.bin" % i} for i in range(count)]}).encode()


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
    ("map-damaged-in-its-last-row", "obj", lambda: TEXTURED, {"scene__mtl": MATERIAL, "large__png": lambda: png(9000, WHOLE, b"\7")}, False),
    ("interlaced-damaged-in-its-last-row", "gltf", lambda: pictures(1), {"picture0__bin": lambda: png(8000, PASSES, b"\7")}, False),
    ("progressive-cut-off", "gltf", lambda: pictures(1), {"picture0__bin": lambda: progressive_jpeg(6000, b"")}, False),
    ("last-of-four-damaged", "gltf", lambda: pictures(4),
     {"picture%d__bin" % i: lambda i=i: png(6000, WHOLE, b"\7" if i == 3 else b"\0", i) for i in range(4)}, False),
]
