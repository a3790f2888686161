"""Malformed scene files, made from good ones: every case is a small folder with one file to open."""
import copy
import json
import re
import struct
import zlib

import good_files as good
import large_files

CASES = []  # (name, {file name: content, or what makes it}); the first file is the one to open
GOOD = set()  # names of those that nothing is wrong with: they must render without a word


class Link(str):
    """A file that is a symbolic link, to this."""


PIPE = object()  # a file that is a pipe which nobody writes into


def case(name, content, extension, **others):
    files = {"scene." + extension: content}
    files.update({key.replace("__", "."): value for key, value in others.items()})
    name = re.sub(r"[^A-Za-z0-9_.+^-]", "_", name)[:60]
    CASES.append(("%s-%03d-%s" % (extension or "none", len(CASES), name), files))


# glTF: changes of the document or of its data. ------------------------------------------------------------------

DOCUMENT, DATA = good.gltf()


def edited(edit=None, data=DATA):
    document = copy.deepcopy(DOCUMENT)
    if edit is not None:
        edit(document)
    return document, data


def gltf(name, edit=None, data=DATA, **others):
    case(name, good.gltf_text(*edited(edit, data)), "gltf", **others)


def gltf_at(name, path, value):
    """One value of the document replaced; a path ends in a key or an index."""
    def edit(document):
        at = document
        for part in path[:-1]:
            at = at[part]
        at[path[-1]] = value
    gltf(name, edit)


def accessor_of(attribute, mesh=0):
    return DOCUMENT["meshes"][mesh]["primitives"][0]["attributes"][attribute]


def data_with(accessor, numbers, code="f", at=0):
    """The buffer with numbers in an accessor's place."""
    view = DOCUMENT["bufferViews"][DOCUMENT["accessors"][accessor]["bufferView"]]
    new = struct.pack("<%d%s" % (len(numbers), code), *numbers)
    start = view["byteOffset"] + at
    return DATA[:start] + new + DATA[start + len(new):]


def glb_truncations():
    whole = good.glb(DOCUMENT, DATA)
    json_size = struct.unpack_from("<I", whole, 12)[0]
    boundaries = [0, 1, 4, 8, 12, 16, 20, 20 + json_size // 2, 20 + json_size, 24 + json_size, 28 + json_size]
    boundaries += [28 + json_size + view["byteOffset"] + view["byteLength"] for view in DOCUMENT["bufferViews"][:-1]]
    for at in sorted(set(boundaries)):
        case("cut-at-%d" % at, whole[:at], "glb")
        if at >= 12:  # the header's length says so too
            case("cut-and-said-%d" % at, whole[:8] + struct.pack("<I", at) + whole[12:at], "glb")


def glb_headers():
    whole = good.glb(DOCUMENT, DATA)
    json_size = struct.unpack_from("<I", whole, 12)[0]
    for name, at, value in (("version-1", 4, 1), ("version-3", 4, 3), ("length-0", 8, 0), ("length-huge", 8, 0xffffffff),
                            ("json-huge", 12, 0xffffffff), ("json-short", 12, 7), ("json-0", 12, 0),
                            ("first-is-binary", 16, 0x004E4942), ("binary-huge", 20 + json_size, 0xfffffff0),
                            ("binary-0", 20 + json_size, 0), ("binary-is-other", 24 + json_size, 0x20202020)):
        case(name, whole[:at] + struct.pack("<I", value) + whole[at + 4:], "glb")
    json_and_binary, binary = whole[12:], whole[20 + json_size:]
    def sized(name, content):
        case(name, whole[:8] + struct.pack("<I", 12 + len(content)) + content, "glb")
    sized("two-binary-chunks", json_and_binary + binary)
    sized("chunk-of-nothing", json_and_binary + b"\0" * 64)
    sized("binary-first", binary + json_and_binary[:8 + json_size])
    sized("other-chunk-second", json_and_binary[:8 + json_size] + struct.pack("<II", 4, 0x12345678) + b"abcd" + binary)
    case("more-after-the-end", whole + b"garbage" * 10, "glb")
    case("deep", whole[:12] + struct.pack("<I", 200000) + b"JSON" + b"[" * 200000, "glb")


def gltf_truncations():
    text = good.gltf_text(DOCUMENT, DATA)
    for key in DOCUMENT:
        case("cut-before-" + key, text[:text.index(b'"%s":' % key.encode())], "gltf")
    case("cut-in-base64", text[:text.index(b"base64,") + 100], "gltf")
    case("cut-last-brace", text[:-1], "gltf")


def gltf_text_faults():
    text = good.gltf_text(DOCUMENT, DATA)
    case("empty", b"", "gltf")
    case("blank", b" \n", "gltf")
    case("zeros", b"\0" * 500, "gltf")
    case("array", b"[]", "gltf")
    case("null", b"null", "gltf")
    case("deep-arrays", b"[" * 200000, "gltf")
    case("deep-arrays-closed", b"[" * 200000 + b"]" * 200000, "gltf")
    case("deep-objects", b'{"a":' * 200000, "gltf")
    case("deep-extras", text[:-1] + b',"extras":' + b"[" * 200000 + b"]" * 200000 + b"}", "gltf")
    case("not-utf8", text.replace(b"good_files.py", b"\xff\xfe\xc0"), "gltf")
    case("overlong-utf8", text.replace(b"good_files.py", b"\xc0\xaf"), "gltf")
    case("utf16", text.decode().encode("utf-16"), "gltf")
    case("utf16-without-mark", text.decode().encode("utf-16-le"), "gltf")
    case("nul", text[:50] + b"\0" + text[50:], "gltf")
    case("nul-and-more", text + b"\0garbage", "gltf")
    case("trailing-comma", text[:-1] + b",}", "gltf")
    case("two-documents", text + text, "gltf")
    case("nan-token", text.replace(b'"yfov":0.8', b'"yfov":NaN'), "gltf")
    case("number-of-2000000-digits", text.replace(b'"yfov":0.8', b'"yfov":' + b"1" * 2000000), "gltf")
    case("number-1e999", text.replace(b'"yfov":0.8', b'"yfov":1e999'), "gltf")
    case("control-character", text.replace(b"good_files.py", b"a\nb"), "gltf")
    case("many-values", b'{"asset":{"version":"2.0"},"nodes":[' + b"{}," * 400000 + b"{}]}", "gltf")
    case("many-unknown-values", b'{"asset":{"version":"2.0"},"extras":[' + b"[]," * 400000 + b"[]]}", "gltf")
    case("many-materials", b'{"asset":{"version":"2.0"},"materials":[' + b"{}," * 300000 + b"{}]}", "gltf")
    # What takes far more memory than the text.
    def filled(name, path, element):
        document = copy.deepcopy(DOCUMENT)
        at = document
        for part in path[:-1]:
            at = at[part]
        at[path[-1]] = "@"
        text = good.gltf_text(document, DATA)
        case("filled-" + name, text.replace(b'"@"', b"[" + (element + b",") * (8000000 // (len(element) + 1)) + element + b"]"), "gltf")
    filled("material-extension", ["materials", 0, "extensions", "KHR_materials_ior"], b"[]")
    filled("targets", ["meshes", 0, "primitives", 0, "targets"], b"{}")
    filled("primitives", ["meshes", 0, "primitives"], b'{"attributes":{}}')


def gltf_accessors():
    position, indices = accessor_of("POSITION"), DOCUMENT["meshes"][0]["primitives"][0]["indices"]
    for name, value in (("0", 0), ("-1", -1), ("1.5", 1.5), ("text", "4"), ("5", 5), ("2^31", 2147483647),
                        ("2^32", 4294967296), ("1e18", 1e18)):
        gltf_at("count-" + name, ["accessors", position, "count"], value)
    for name, value in (("past-end", 100000), ("2^48", 2 ** 48), ("2^63", 2 ** 63), ("-4", -4), ("1", 1)):
        gltf_at("accessor-offset-" + name, ["accessors", position, "byteOffset"], value)
    gltf_at("index-accessor-misaligned", ["accessors", indices, "byteOffset"], 1)
    view = DOCUMENT["accessors"][position]["bufferView"]
    gltf_at("view-misaligned", ["bufferViews", view, "byteOffset"], 1)
    for key, value in (("byteOffset", len(DATA)), ("byteOffset", -1), ("byteLength", 2 ** 40), ("byteLength", 0),
                       ("byteStride", 3), ("byteStride", 4), ("byteStride", 8), ("byteStride", 253), ("buffer", 1),
                       ("buffer", -1), ("buffer", "0")):
        gltf_at("view-%s-%s" % (key, value), ["bufferViews", view, key], value)
    gltf_at("view-missing", ["accessors", position, "bufferView"], 99)
    gltf_at("type-of-positions", ["accessors", position, "type"], "VEC2")
    gltf_at("type-unknown", ["accessors", position, "type"], "VEC5")
    gltf_at("component-unknown", ["accessors", position, "componentType"], 5124)
    for key in ("min", "max"):
        gltf_at(key + "-lies", ["accessors", position, key], [5, 5, 5])
        gltf_at(key + "-long", ["accessors", position, key], [0] * 17)
    gltf_at("positions-of-32-bits", ["accessors", position, "componentType"], 5125)
    gltf_at("texcoord-gap", ["meshes", 0, "primitives", 0, "attributes", "TEXCOORD_5"], accessor_of("TEXCOORD_0"))
    gltf_at("float-indices", ["accessors", indices, "componentType"], 5126)
    gltf_at("signed-indices", ["accessors", indices, "componentType"], 5122)
    gltf("index-past-vertices", data=data_with(indices, [0, 1, 9, 0, 2, 3], "H"))
    gltf("index-max", data=data_with(indices, [0xffff] * 6, "H"))
    gltf_at("indices-no-whole-triangles", ["accessors", indices, "count"], 5)
    gltf_at("attribute-count-differs", ["accessors", accessor_of("NORMAL"), "count"], 3)
    gltf_at("no-position", ["meshes", 0, "primitives", 0, "attributes"], {"NORMAL": accessor_of("NORMAL")})
    gltf_at("attributes-empty", ["meshes", 0, "primitives", 0, "attributes"], {})
    gltf_at("primitives-empty", ["meshes", 0, "primitives"], [])
    gltf_at("mode-7", ["meshes", 0, "primitives", 0, "mode"], 7)
    sparse = accessor_of("POSITION", 1)
    for name, path, value in (("count-5", ["count"], 5), ("count-0", ["count"], 0), ("count-2^31", ["count"], 2147483647),
                              ("no-indices", ["indices"], {}), ("offset", ["values", "byteOffset"], 1000),
                              ("view", ["indices", "bufferView"], 99),
                              ("type", ["indices", "componentType"], 5126)):
        gltf_at("sparse-" + name, ["accessors", sparse, "sparse"] + path, value)
    where = DOCUMENT["bufferViews"][DOCUMENT["accessors"][sparse]["sparse"]["indices"]["bufferView"]]["byteOffset"]
    sparse_count = DOCUMENT["accessors"][sparse]["sparse"]["count"]
    gltf("sparse-index-twice", data=DATA[:where] + b"\1\0" * sparse_count + DATA[where + 2 * sparse_count:])
    values = DOCUMENT["accessors"][sparse]["sparse"]["values"]["bufferView"]
    gltf_at("sparse-stride", ["bufferViews", values, "byteStride"], 16)
    gltf("sparse-index-past", data=DATA[:where] + b"\xff\xff" + DATA[where + 2:])
    def without_data(document):
        del document["accessors"][position]["bufferView"]
        document["accessors"][position]["count"] = 2147483647
    gltf("count-without-data", without_data)
    def shared(document):  # a small file that unfolds to a large one
        document["accessors"][position] = {"componentType": 5126, "count": 16000000, "type": "VEC3"}
        document["meshes"] = [{"primitives": [{"attributes": {"POSITION": position}}] * 1000}]
        document["nodes"] = [{"mesh": 0}]
        document["scenes"] = [{"nodes": [0]}]
        for key in ("skins", "animations"):
            del document[key]
    gltf("unfolds-without-data", shared)
    huge = {"componentType": 5126, "count": 16000000, "type": "VEC3"}
    def sparse_zeros(document):
        document["accessors"][sparse].update(count=16000000)
        del document["accessors"][sparse]["bufferView"]
    gltf("sparse-of-16000000", sparse_zeros)
    def copies(document):
        document["accessors"].append(huge)
        document["nodes"][3]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {"TRANSLATION": len(document["accessors"]) - 1}
    gltf("copies-without-data", copies)
    def times(document):
        document["accessors"].append(dict(huge, type="SCALAR"))
        document["animations"][0]["samplers"][0]["input"] = len(document["accessors"]) - 1
    gltf("times-without-data", times)


def gltf_numbers():
    position, nan, inf = accessor_of("POSITION"), float("nan"), float("inf")
    for name, value in (("nan", nan), ("inf", inf), ("minus-inf", -inf)):
        for attribute in ("POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"):
            gltf("%s-%s" % (attribute, name), data=data_with(accessor_of(attribute), [value], at=4))
    gltf("POSITION-huge", data=data_with(position, [3e38, -3e38, 3e38]))
    gltf("POSITION-1e30", data=data_with(position, [1e30] * 12))
    gltf("POSITION-all-equal", data=data_with(position, [1.0] * 12))
    gltf("POSITION-in-a-line", data=data_with(position, [0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3]))
    gltf("POSITION-denormal", data=data_with(position, [0, 0, 0, 1e-40, 0, 0, 1e-40, 1e-40, 0, 0, 1e-40, 0]))
    skin = DOCUMENT["skins"][0]["inverseBindMatrices"]
    gltf("inverse-bind-nan", data=data_with(skin, [nan]))
    gltf("inverse-bind-zero", data=data_with(skin, [0.0] * 32))
    times = DOCUMENT["animations"][0]["samplers"][0]["input"]
    gltf("times-nan", data=data_with(times, [nan]))
    gltf("times-twice", data=data_with(times, [1, 1]))
    gltf("times-negative", data=data_with(times, [-1, 0]))
    gltf("times-descending", data=data_with(times, [1, 0]))


def gltf_nodes():
    gltf_at("node-own-child", ["nodes", 0, "children"], [0])
    gltf_at("node-cycle", ["nodes", 1, "children"], [0])
    def cycle_aside(document):
        document["nodes"] += [{"children": [8]}, {"children": [7]}]
    gltf("node-cycle-aside", cycle_aside)
    gltf_at("node-two-parents", ["nodes", 4, "children"], [1])
    gltf_at("node-child-twice", ["nodes", 0, "children"], [1, 1])
    gltf_at("node-child-missing", ["nodes", 0, "children"], [99])
    gltf_at("node-child-negative", ["nodes", 0, "children"], [-1])
    for key in ("mesh", "camera", "skin"):
        gltf_at("node-%s-missing" % key, ["nodes", 1, key], 99)
    gltf_at("node-light-missing", ["nodes", 4, "extensions", "KHR_lights_punctual", "light"], 99)
    gltf_at("scene-missing", ["scene"], 5)
    gltf_at("scene-root-missing", ["scenes", 0, "nodes"], [99])
    gltf_at("scene-root-twice", ["scenes", 0, "nodes"], [0, 0])
    gltf_at("scene-root-has-parent", ["scenes", 0, "nodes"], [1])
    gltf_at("joint-missing", ["skins", 0, "joints"], [99])
    gltf_at("joint-twice", ["skins", 0, "joints"], DOCUMENT["skins"][0]["joints"][:1] * 2)
    gltf_at("scene-without-nodes", ["scenes", 0], {})
    gltf_at("joints-none", ["skins", 0, "joints"], [])
    gltf_at("animation-node-missing", ["animations", 0, "channels", 0, "target", "node"], 99)
    gltf_at("animation-sampler-missing", ["animations", 0, "channels", 0, "sampler"], 9)
    gltf_at("animation-path-unknown", ["animations", 0, "channels", 0, "target", "path"], "colour")
    gltf_at("animation-output-wrong", ["animations", 0, "samplers", 0, "output"], accessor_of("TEXCOORD_0"))
    gltf_at("instancing-accessor-missing",
            ["nodes", 3, "extensions", "EXT_mesh_gpu_instancing", "attributes", "TRANSLATION"], 99)


def gltf_transforms():
    zero = [0.0] * 16
    flat = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]
    for name, value in (("zero", zero), ("flat", flat), ("15-numbers", flat[:15]),
                        ("not-affine", flat[:15] + [2]), ("1e39", [1e39] + flat[1:]), ("text", ["a"] * 16)):
        def edit(document, value=value):
            document["nodes"][1] = {"mesh": 0, "matrix": value}
        gltf("matrix-" + name, edit)
    for name, value in (("zero", [0, 0, 0]), ("flat", [1, 0, 1]), ("huge", [3e38, 3e38, 3e38]), ("1e39", [1e39, 1, 1]),
                        ("tiny", [1e-38, 1e-38, 1e-38]), ("two", [1, 1])):
        gltf_at("scale-" + name, ["nodes", 1, "scale"], value)
    gltf_at("rotation-zero", ["nodes", 1, "rotation"], [0, 0, 0, 0])
    gltf_at("rotation-huge", ["nodes", 1, "rotation"], [1e38, 0, 0, 1e38])
    gltf_at("translation-huge", ["nodes", 1, "translation"], [3e38, 0, 0])
    def nested(document):
        document["nodes"] = [{"scale": [1e38] * 3, "children": [i + 1]} for i in range(20)] + [{"mesh": 0}]
        document["scenes"] = [{"nodes": [0]}]
        for key in ("skins", "animations"):
            del document[key]
    gltf("scales-overflow", nested)
    def chain(document):
        document["nodes"] = [{"children": [i + 1]} for i in range(50000)] + [{"mesh": 0, "scale": [0, 0, 0]}]
        document["scenes"] = [{"nodes": [0]}]
        for key in ("skins", "animations"):
            del document[key]
    gltf("nodes-50000-deep", chain)
    gltf_at("matrix-and-scale", ["nodes", 2, "scale"], [1, 1, 1])


def gltf_cameras():
    for name, value in (("0", 0), ("-1", -1), ("pi", 3.14159265), ("1e-30", 1e-30), ("none", None)):
        gltf_at("yfov-" + name, ["cameras", 0, "perspective", "yfov"], value)
    for name, value in (("0", 0), ("-1", -1), ("1e39", 1e39), ("past-zfar", 200)):
        gltf_at("znear-" + name, ["cameras", 0, "perspective", "znear"], value)
    gltf_at("aspect-0", ["cameras", 0, "perspective", "aspectRatio"], 0)
    gltf_at("camera-type", ["cameras", 0, "type"], "fisheye")
    gltf_at("camera-without-parameters", ["cameras", 0], {"type": "orthographic"})
    gltf_at("ymag-0", ["cameras", 1, "orthographic", "ymag"], 0)
    flat = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 3, 1]
    gltf_at("camera-singular", ["nodes", 2, "matrix"], flat)
    gltf_at("camera-far-away", ["nodes", 2, "matrix"], flat[:10] + [1, 0, 3e38, 0, 0, 1])


def gltf_files():
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


def gltf_others():
    gltf_at("required-unknown", ["extensionsRequired"], ["EXT_of_tomorrow"])
    gltf_at("required-draco", ["extensionsRequired"], ["KHR_draco_mesh_compression"])
    gltf_at("required-escape-sequence", ["extensionsRequired"], ["\x1b[2J\nheliograph: error: fake"])
    gltf_at("required-text", ["extensionsRequired"], "EXT_of_tomorrow")
    gltf_at("asset-missing", ["asset"], {})
    gltf_at("version-1", ["asset", "version"], "1.0")
    gltf_at("version-number", ["asset", "version"], 2)
    gltf_at("minimum-3", ["asset", "minVersion"], "3.0")
    gltf_at("material-missing", ["meshes", 0, "primitives", 0, "material"], 99)
    gltf_at("color-5", ["materials", 0, "pbrMetallicRoughness", "baseColorFactor"], [1] * 5)
    gltf_at("color-negative", ["materials", 0, "pbrMetallicRoughness", "baseColorFactor"], [-1, 1, 1, 1])
    gltf_at("roughness-1e30", ["materials", 0, "pbrMetallicRoughness", "roughnessFactor"], 1e30)
    gltf_at("emission-3e38", ["materials", 0, "emissiveFactor"], [3e38, 1, 1])
    gltf_at("emission-negative", ["materials", 0, "emissiveFactor"], [-1, 1, 1])
    gltf_at("alpha-mode", ["materials", 0, "alphaMode"], "GLASS")
    gltf_at("light-type", ["extensions", "KHR_lights_punctual", "lights", 0, "type"], "area")
    gltf_at("light-cones", ["extensions", "KHR_lights_punctual", "lights", 0, "spot", "innerConeAngle"], 0.6)
    gltf_at("light-intensity", ["extensions", "KHR_lights_punctual", "lights", 0, "intensity"], 1e38)
    gltf_at("wrap", ["samplers", 0, "wrapS"], 1)
    gltf_at("weights", ["meshes", 1, "weights"], [1, 2, 3])
    for key in ("accessors", "bufferViews", "meshes", "nodes", "materials", "textures", "images"):
        gltf_at(key + "-object", [key], {})
        gltf_at(key + "-null", [key, 0], None)


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


def memory():
    for name, extension, content, others, is_good in large_files.FILES:
        case("large-" + name, content, extension, **others)
        if is_good:
            GOOD.add(CASES[-1][0])


def unknown_files():
    case("scene", b"whatever", "fbx")
    case("scene", b"whatever", "")


for make in (glb_truncations, glb_headers, gltf_truncations, gltf_text_faults, gltf_accessors, gltf_numbers, gltf_nodes,
             gltf_transforms, gltf_cameras, gltf_files, gltf_others, obj_files, ply_files, stl_files, memory, unknown_files):
    make()
