"""Malformed glTF and GLB files but for what they refer to."""
import copy
import struct

import good_files as good
from cases import case
from gltf_edits import DATA, DOCUMENT, accessor_of, data_with, gltf, gltf_at


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


def make():
    for part in (glb_truncations, glb_headers, gltf_truncations, gltf_text_faults, gltf_accessors, gltf_numbers, gltf_nodes,
                 gltf_transforms, gltf_cameras, gltf_others):
        part()
