"""glTF files whose buffers and images are missing, lead elsewhere or are malformed."""
import json
import struct
import zlib

import good_files as good
from cases import PIPE, Link, case
from gltf_edits import DATA, DOCUMENT, gltf, gltf_at


def make():
    def image(uri):
        def edit(document):
            document["images"][0] = {"uri": uri}
        return edit
    def buffer_uri(uri, length=len(DATA)):
        document = dict(DOCUMENT, buffers=[{"byteLength": length, "uri": uri}])
        return json.dumps(document).encode()
    escapes = [("up", "../secret"), ("up-inside", "a/../../secret"), ("encoded", "%2e%2e/secret"),
               ("encoded-slash", "..%2fsecret"), ("absolute", "/etc/hostname"), ("http", "http://localhost/x"),
               ("file", "file:///etc/hostname"), ("nul", "a%00b"), ("empty", ""), ("folder", "."), ("device", "/dev/zero"),
               ("backslash", "..\\secret"), ("missing", "nothere.bin")]
    for name, uri in escapes:
        gltf("image-" + name, image(uri))
        case("buffer-" + name, buffer_uri(uri), "gltf")
    for name, content in (("pipe", PIPE), ("link-out", Link("../secret")), ("link-absolute", Link("/etc/hostname")),
                          ("link-device", Link("/dev/zero")), ("link-itself", Link("other.bin")),
                          ("link-nowhere", Link("nothere"))):
        gltf("image-" + name, image("other.bin"), other__bin=content)
        case("buffer-" + name, buffer_uri("other.bin"), "gltf", other__bin=content)
    for name, content in (("pipe", PIPE), ("link-device", Link("/dev/zero")), ("link-itself", Link("scene.gltf"))):
        case("scene-is-" + name, content, "gltf")
    case("buffer-short", buffer_uri("short.bin"), "gltf", short__bin=DATA[:-8])
    case("buffer-longer-than-file", buffer_uri("data.bin", 2 ** 40), "gltf", data__bin=DATA)
    for name, uri in (("no-comma", "data:application/octet-stream;base64"), ("garbage", good.data_uri(DATA)[:-20] + "!?*"),
                      ("one-over", "data:;base64,AAAAA"), ("plain", "data:,hello"),
                      ("empty", "data:;base64,")):
        case("base64-" + name, buffer_uri(uri), "gltf")
    case("buffer-without-uri", json.dumps(dict(DOCUMENT, buffers=[{"byteLength": len(DATA)}])).encode(), "gltf")
    case("buffer-length-0", buffer_uri(good.data_uri(DATA), 0), "gltf")
    whole = good.png(8, 8)
    def header(width, height):
        data = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
        return whole[:16] + data + struct.pack(">I", zlib.crc32(b"IHDR" + data)) + whole[33:]
    pictures = {"garbage": b"no image at all", "empty": b"", "cut": whole[:-20], "cut-in-header": whole[:20],
                "checksum": whole[:40] + b"\xff" + whole[41:], "huge": header(100000, 100000),
                "zero": header(0, 8), "2^31": header(2 ** 31, 8), "jpeg-cut": good.jpeg()[:40],
                "jpeg-magic": b"\xff\xd8\xff", "png-magic": b"\x89PNG\r\n\x1a\n"}
    for name, content in pictures.items():
        gltf("picture-" + name, image("picture.png"), picture__png=content)
    def chunk(name, content):
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
    def filled(width, height, interlace):  # two colours, hardly any bytes
        packer = zlib.compressobj()
        rows = 3 * width * height + height if interlace == 0 else 3 * width * height + 2 * height
        data = b"".join(packer.compress(b"\0" * (1 << 20)) for _ in range(rows >> 20))
        data += packer.compress(b"\0" * (rows % (1 << 20) - 1) + b"\1") + packer.flush()
        return (whole[:8] + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, interlace)) +
                chunk(b"IDAT", data[:-6]) + chunk(b"IEND", b""))
    text = zlib.compress(b"x" * 7900000)
    comments = chunk(b"zTXt", b"Comment\0\0" + text) * 60 + chunk(b"iTXt", b"Comment\0\1\0\0\0" + text) * 60
    ones = b"\xff\xc4\x00\x14%c\x01" + b"\0" * 16
    def jpeg(frame, scan):  # 16000 x 16000 of three components
        return (b"\xff\xd8\xff\xdb\x00\x43\x00" + b"\x01" * 64 + b"\xff" + frame + b"\x00\x11\x08" +
                struct.pack(">HH", 16000, 16000) + b"\x03\x01\x11\x00\x02\x11\x00\x03\x11\x00" + ones % 0 + ones % 16 +
                b"\xff\xda\x00" + scan + b"\0" * 20000 + b"\xff\xd9")
    bombs = {"interlaced.png": filled(10000, 10000, 1), "wide.png": filled(1000000, 64, 0),
             "comments.png": whole[:33] + comments + chunk(b"IDAT", zlib.compress(b"\0" * 200)[:-6]) + chunk(b"IEND", b""),
             "progressive.jpg": jpeg(b"\xc2", b"\x0c\x03\x01\x00\x02\x00\x03\x00\x00\x00\x00"),
             "scan-each.jpg": jpeg(b"\xc0", b"\x08\x01\x01\x00\x00\x3f\x00")}
    for name, content in bombs.items():
        gltf("picture-" + name, image("picture.bin"), picture__bin=content)
    def typed(document):
        document["images"][0] = {"uri": "picture.png", "mimeType": "image/jpeg"}
    gltf("picture-of-other-type", typed, picture__png=whole)
    def twofold(document):
        document["images"][0] = {"uri": "picture.png", "bufferView": 0}
    gltf("picture-twofold", twofold, picture__png=whole)
    gltf_at("image-view-missing", ["images", 0, "bufferView"], 99)
    gltf_at("image-nothing", ["images", 0], {})
    gltf_at("texture-source-missing", ["textures", 0, "source"], 99)
    gltf_at("texture-missing", ["materials", 0, "normalTexture", "index"], 99)
    gltf_at("texcoord-missing", ["materials", 0, "pbrMetallicRoughness", "baseColorTexture", "texCoord"], 7)
