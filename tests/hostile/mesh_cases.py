"""Malformed OBJ, MTL, PLY and STL files."""
import struct
import zlib

import good_files as good
from cases import PIPE, Link, case

# OBJ and MTL. ---------------------------------------------------------------------------------------------------

SQUARE = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def obj(name, text, **others):
    case(name, text, "obj", **others)


def obj_files():
    for name, line in (("v-2", b"v 1 2"), ("v-nan", b"v 1 nan 2"), ("v-inf", b"v inf 1 2"), ("v-1e39", b"v 1e39 0 0"),
                       ("v-text", b"v a b c"), ("v-cut", b"v 0.5 1."), ("v-hex", b"v 0x10 0 0"), ("vn-2", b"vn 0 1"),
                       ("vn-nan", b"vn 0 0 nan"), ("vt-none", b"vt"), ("f-2", b"f 1 2"), ("f-none", b"f"),
                       ("f-0", b"f 0 1 2"), ("f-past", b"f 1 2 5"), ("f-before", b"f -1 -2 -5"), ("f-text", b"f a b c"),
                       ("f-2^31", b"f 1 2 2147483648"), ("f-2^63", b"f 1 2 9223372036854775808"),
                       ("f-fraction", b"f 1 2 3.5"), ("f-slashes", b"f 1/2/3/4 2 3"), ("f-vt-past", b"f 1/1 2/1 3/1"),
                       ("f-vn-past", b"f 1//9 2//9 3//9"), ("f-empty-v", b"f /1 /2 /3"), ("unknown", b"what 1 2 3"),
                       ("cut-continuation", b"f 1 2 \\"), ("not-utf8", b"\xff\xfe\xc0 1"), ("nul", b"f 1 2 \x003")):
        obj(name, SQUARE + b"f 1 2 3\n" + line + b"\n")
    obj("empty", b"")
    obj("zeros", b"\0" * 4096)
    obj("random", bytes((i * 7919 + i * i * 31) % 256 for i in range(5000)))
    obj("no-faces", SQUARE)
    obj("only-comments", b"# nothing\n" * 10)
    obj("zero-area", SQUARE + b"f 1 1 1\nf 1 2 2\nf 1 2 3\n")
    obj("all-in-one-point", b"v 1 1 1\n" * 4 + b"f 1 2 3\nf 2 3 4\n")
    obj("huge", b"v 3e38 0 0\nv 0 3e38 0\nv 0 0 -3e38\nf 1 2 3\n")
    obj("polygon-of-100000", b"".join(b"v %d %d 0\n" % (i, i % 2) for i in range(100000)) +
        b"f " + b" ".join(b"%d" % (i + 1) for i in range(100000)) + b"\n")
    obj("polygon-crosses-itself", SQUARE + b"f 1 3 2 4\nf 1 1 2 2 3 3\n")
    obj("long-line", SQUARE + b"f 1 2 3\n# " + b"x" * 3000000 + b"\nf 1 2 9\n")
    obj("cr-line-ends", SQUARE.replace(b"\n", b"\r") + b"v 0 0 0\r" * 500000 + b"f 1 2 9999999\r")
    obj("cr-and-mark", b"\xef\xbb\xbf" + SQUARE.replace(b"\n", b"\r") + b"f 1 2 5\r")
    obj("utf16", (SQUARE + b"f 1 2 3\n").decode().encode("utf-16"))
    obj("many-libraries", SQUARE + b"".join(b"mtllib %x\n" % i for i in range(100000)) + b"f 1 2 3\n")
    obj("long-number", SQUARE + b"v " + b"1" * 2000000 + b" 0 0\nf 1 2 3\n")
    obj("long-name", SQUARE + b"usemtl " + b"x" * 1000000 + b"\nf 1 2 3\n")
    obj("many-materials", SQUARE + b"".join(b"usemtl m%d\nf 1 2 3\n" % i for i in range(70000)))
    use = SQUARE + b"usemtl a\nf 1 2 3\n"
    for name, library in (("missing", b"nothere.mtl"), ("up", b"../secret.mtl"), ("absolute", b"/etc/hostname"),
                          ("folder", b"."), ("itself", b"scene.obj"), ("none", b""), ("device", b"/dev/zero")):
        obj("mtllib-" + name, b"mtllib " + library + b"\n" + use)
    for name, text in (("kd-text", b"Kd red"), ("kd-nan", b"Kd nan 0 0"), ("kd-none", b"Kd"), ("kd-negative", b"Kd -1 0 0"),
                       ("kd-above", b"Kd 7 7 7"), ("ke-huge", b"Ke 3e38 0 0"), ("ns-inf", b"Ns inf"), ("ni-text", b"Ni x"),
                       ("d-text", b"d opaque"), ("d-above", b"d 5"), ("pr-negative", b"Pr -1"), ("tf-cut", b"Tf 1e"),
                       ("map-missing", b"map_Kd nothere.png"), ("map-up", b"map_Kd ../../secret.png"),
                       ("map-absolute", b"map_Kd /etc/hostname"), ("map-device", b"map_Kd /dev/zero"),
                       ("map-folder", b"map_Kd ."), ("map-garbage", b"map_Kd garbage.png"), ("map-cut", b"map_Kd cut.png"),
                       ("map-s-text", b"map_Kd -s a b nothere.png"), ("map-options-only", b"map_Kd -s 1 -o nothere.png"),
                       ("spectral", b"Kd spectral file.rfl 1")):
        obj("mtl-" + name, b"mtllib scene.mtl\n" + use, scene__mtl=b"newmtl a\n" + text + b"\n",
            garbage__png=b"garbage", cut__png=good.png()[:40])
    def bomb(width, height, odd):  # two colours, hardly any bytes
        packer = zlib.compressobj()
        row = b"\0" * (1 + 3 * width)
        data = packer.compress(row[:-1] + odd)
        data += b"".join(packer.compress(row) for _ in range(height - 1)) + packer.flush()
        def chunk(name, content):
            return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
        return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                chunk(b"IDAT", data) + chunk(b"IEND", b""))
    obj("map-bomb", b"mtllib scene.mtl\n" + use, scene__mtl=b"newmtl a\nmap_Kd bomb.png\n", bomb__png=bomb(8000, 8000, b"\1"))
    webp = b"RIFF\x1e\0\0\0WEBPVP8L\x0a\0\0\0\x2f" + struct.pack("<I", 16382 | 16382 << 14) + b"\0" * 9
    obj("map-webp-bomb", b"mtllib scene.mtl\n" + use, scene__mtl=b"newmtl a\nmap_Kd bomb.webp\n", bomb__webp=webp)
    for name, content in (("pipe", PIPE), ("link-out", Link("../secret"))):
        obj("mtllib-is-" + name, b"mtllib scene.mtl\n" + use, scene__mtl=content)
        obj("map-is-" + name, b"mtllib scene.mtl\n" + use, scene__mtl=b"newmtl a\nmap_Kd map.png\n", map__png=content)
    obj("mtl-empty", b"mtllib scene.mtl\n" + use, scene__mtl=b"")
    obj("mtl-binary", b"mtllib scene.mtl\n" + use, scene__mtl=bytes(range(256)) * 20)
    obj("mtl-other-name", b"mtllib scene.mtl\n" + use, scene__mtl=b"newmtl b\nKd 1 1 1\n")


# PLY. -----------------------------------------------------------------------------------------------------------

def ply_files():
    text = good.ply("ascii")
    header_end = text.index(b"end_header\n") + 11
    for at in [0, 3, 4] + [i + 1 for i, c in enumerate(text[:header_end - 1]) if c == 10]:
        case("header-cut-%d" % at, text[:at], "ply")
    for at in range(header_end, len(text) - 1, 23):
        case("text-cut-%d" % at, text[:at].rstrip(b"0123456789. \n") + b"\n", "ply")
    for kind in ("binary_little_endian", "binary_big_endian"):
        whole = good.ply(kind)
        start = whole.index(b"end_header\n") + 11
        for at in range(start, len(whole), 13):
            case("%s-cut-%d" % (kind, at), whole[:at], "ply")
    for old, new in ((b"ply\n", b"plx\n"), (b"ascii 1.0", b"ascii 9.0"), (b"ascii", b"binary"), (b"float x", b"complex x"),
                     (b"float x", b"float"), (b"float x", b"float q"), (b"vertex 5", b"vertex 99999999999999"),
                     (b"vertex 5", b"vertex -5"), (b"vertex 5", b"vertex"), (b"vertex 5", b"vertex 6"),
                     (b"face 2", b"face 4000000000"), (b"face 2", b"face 3"), (b"uchar int", b"float int"),
                     (b"vertex_indices", b"corners"), (b"list uchar int", b"list uchar blob"), (b"0 1 2\n", b"0 1 5\n"),
                     (b"0 1 2\n", b"0 1 -1\n"), (b"0 1 2\n", b"0 1 4294967296\n"), (b"0 1 2\n", b"0 1 0.5\n"),
                     (b"\n3 0", b"\n2 0"), (b"\n3 0", b"\n0 0"), (b"\n3 0", b"\n-1 0"), (b"\n3 0", b"\n1e9 0"),
                     (b"\n1 0 0 ", b"\nnan 0 0 "), (b"\n1 0 0 ", b"\ninf 0 0 "), (b"\n1 0 0 ", b"\n1e39 0 0 "),
                     (b"\n1 0 0 ", b"\nx 0 0 "), (b"\n1 0 0 ", b"\n3e38 0 0 "), (b"0 0 1 0.5", b"0 0 0 0.5"),
                     (b"image.png", b"../image.png"), (b"image.png", b"/dev/zero"), (b"image.png", b"nothere.png"),
                     (b"end_header", b"end_haeder"), (b"element face", b"element vertex")):
        case("%s-%s" % (old.strip().decode().replace(" ", "_"), new.strip().decode().replace(" ", "_").replace("/", "-")),
             text.replace(old, new, 1), "ply", image__png=good.png())
    case("many-elements", b"ply\nformat ascii 1.0\n" + b"".join(b"element e%d 0\n" % i for i in range(60000)) + b"end_header\n", "ply")
    case("long-fan", b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         b"property float z\nelement face 1\nproperty list uint uchar vertex_indices\nend_header\n" + b"\0" * 36 +
         struct.pack("<I", 6000000) + b"\0\1\2" * 2000000, "ply")
    case("index-of-many-digits", text.replace(b"3 0 1 2", b"3 0 1 " + b"2" * 1000000), "ply", image__png=good.png())
    case("unknown-header-line", text.replace(b"element vertex", b"made by nobody\nelement vertex", 1), "ply", image__png=good.png())
    case("property-before-element", b"ply\nformat ascii 1.0\nproperty float x\nend_header\n", "ply")
    case("no-format", b"ply\nelement vertex 0\nproperty float x\nend_header\n", "ply")
    case("no-properties", b"ply\nformat ascii 1.0\nelement vertex 1000000000000\nend_header\n", "ply")
    case("other-element-huge", b"ply\nformat ascii 1.0\nelement other 9000000000000000000\nproperty list uchar int a\nend_header\n0\n", "ply")
    case("long-header", b"ply\nformat ascii 1.0\n" + b"comment x\n" * 200000, "ply")
    case("long-number", text.replace(b"\n1 0 0 ", b"\n1" + b"0" * 100000 + b" 0 0 ", 1), "ply")
    case("not-utf8", text.replace(b"comment", b"\xff\xfe"), "ply")
    case("more-after-the-end", good.ply("binary_big_endian") + b"junk" * 10, "ply", image__png=good.png())
    case("points-only", text[:text.index(b"element face")] + b"end_header\n" + text[header_end:], "ply")
    case("zero-area", text.replace(b"3 0 1 2", b"3 0 0 0"), "ply", image__png=good.png())


# STL. -----------------------------------------------------------------------------------------------------------

def stl_files():
    whole = good.stl_binary()
    for at in [0, 1, 5, 40, 80, 83, 84, 85, 96, 108, 120, 132, 134, 150, 183]:
        case("cut-%d" % at, whole[:at], "stl")
    for count in (0, 1, 3, 0x7fffffff, 0xffffffff):
        case("count-%d" % count, whole[:80] + struct.pack("<I", count) + whole[84:], "stl")
    for name, value in (("nan", float("nan")), ("inf", float("inf")), ("huge", 3e38)):
        case(name, whole[:96] + struct.pack("<f", value) + whole[100:], "stl")
    case("zero-area", whole[:96] + b"\0" * 36 + whole[132:], "stl")
    text = good.stl_text()
    lines = text.split(b"\n")
    for at in range(1, len(lines) - 1):
        case("text-cut-line-%d" % at, b"\n".join(lines[:at]) + b"\n", "stl")
    for old, new in ((b"vertex 1 1 0", b"vertex 1 1"), (b"vertex 1 1 0", b"vertex 1 1 nan"), (b"vertex 1 1 0", b"vertex a b c"),
                     (b"vertex 1 1 0", b"vertex 1 1 1e39"), (b"  vertex 1 1 0\n", b""), (b"endloop", b"endlop"),
                     (b"facet normal", b"faucet normal"), (b"vertex 1 1 0", b"vertex 1 1 0\nvertex 1 1 0"),
                     (b"endsolid square", b"")):
        case("text-" + new.strip().decode().replace(" ", "_").replace("\n", "_"), text.replace(old, new, 1), "stl")
    case("text-not-utf8", text.replace(b" outer", b" \xff\xfe"), "stl")
    case("text-only-solid", b"solid", "stl")
    case("random", bytes((i * 7919 + i * i * 31) % 256 for i in range(3000)), "stl")


def make():
    for part in (obj_files, ply_files, stl_files):
        part()
