"""Renders a glTF file of bench_cycles_scenes or export_assets.py with Blender Cycles, matched to what Heliograph draws.

    blender --background --factory-startup --python render_cycles.py -- FILE.gltf OUT.exr SIZE SAMPLES SEED THREADS
        [--environment LATLONG.exr] [--once]

Box filter of one pixel, no clamping, denoising, adaptive sampling or light tree; caustics on, 1024 bounces. The last line
printed, "cycles SECONDS", is the CPU time that SAMPLES samples took, start-up excluded: the tree and all
tables stay from a first picture, and the time of one of 1 sample is taken off. With --once it draws the picture and
nothing else, for measurements of the whole process.
"""

import argparse
import json
import math
import resource
import struct
import sys

import bpy
from mathutils import Matrix


def numbers(document, binary, index):
    accessor = document["accessors"][index]
    parts = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
    kind = {5126: "f", 5125: "I"}[accessor["componentType"]]
    start = document["bufferViews"][accessor["bufferView"]].get("byteOffset", 0)
    values = struct.unpack_from("<%d%s" % (accessor["count"] * parts, kind), binary, start)
    return [values[i : i + parts] for i in range(0, len(values), parts)]


def make_material(description, images):
    """A closure for what the exporters write: diffuse, mirror, glass, rough metal, emission."""
    material = bpy.data.materials.new("material")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    color = description["pbrMetallicRoughness"].get("baseColorFactor", [1, 1, 1, 1])
    texture = description["pbrMetallicRoughness"].get("baseColorTexture")
    scattering = description.get("extras", {}).get("heliograph", {}).get("scattering")
    if scattering is None:
        node = nodes.new("ShaderNodeBsdfDiffuse")
    elif scattering["model"] == "dielectric":
        node = nodes.new("ShaderNodeBsdfGlass")
        node.distribution = "SHARP"
        node.inputs["IOR"].default_value = scattering["n"][0]
    else:
        node = nodes.new("ShaderNodeBsdfGlossy")
        alpha = scattering["alpha"][0] if scattering["model"] == "conductor" else 0
        node.distribution = "GGX" if alpha > 0 else "SHARP"
        node.inputs["Roughness"].default_value = math.sqrt(alpha)
    node.inputs["Color"].default_value = color
    if texture:
        image = nodes.new("ShaderNodeTexImage")
        image.image = images[texture["index"]]
        links.new(image.outputs["Color"], node.inputs["Color"])
    surface = node.outputs[0]
    emission = description.get("emissiveFactor")
    if emission:
        strength = description["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"]
        glow = nodes.new("ShaderNodeEmission")
        glow.inputs["Color"].default_value = (*emission, 1)
        glow.inputs["Strength"].default_value = strength
        if max(color[:3]) > 0:
            both = nodes.new("ShaderNodeAddShader")
            links.new(surface, both.inputs[0])
            links.new(glow.outputs[0], both.inputs[1])
            surface = both.outputs[0]
        else:
            surface = glow.outputs[0]
    links.new(surface, nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def make_world(environment):
    world = bpy.data.worlds.new("world")
    world.color = (0, 0, 0)
    if environment:
        world.use_nodes = True
        nodes, links = world.node_tree.nodes, world.node_tree.links
        nodes.clear()
        image = nodes.new("ShaderNodeTexEnvironment")
        image.image = bpy.data.images.load(environment)
        # Blender's panoramas have Z up, Heliograph's Y.
        apart, together = nodes.new("ShaderNodeSeparateXYZ"), nodes.new("ShaderNodeCombineXYZ")
        links.new(nodes.new("ShaderNodeTexCoord").outputs["Generated"], apart.inputs[0])
        for here, there in enumerate((2, 0, 1)):
            links.new(apart.outputs[there], together.inputs[here])
        links.new(together.outputs[0], image.inputs["Vector"])
        sky = nodes.new("ShaderNodeBackground")
        links.new(image.outputs["Color"], sky.inputs["Color"])
        links.new(sky.outputs[0], nodes.new("ShaderNodeOutputWorld").inputs["Surface"])
    return world


def make_scene(file, environment):
    document = json.load(open(file))
    binary = open(file.rsplit("/", 1)[0] + "/" + document["buffers"][0]["uri"], "rb").read()
    images = [bpy.data.images.load(file.rsplit("/", 1)[0] + "/" + document["images"][t["source"]]["uri"])
              for t in document.get("textures", [])]
    for image in images:
        image.alpha_mode = "NONE"  # as glTF's opaque surfaces
    materials = [make_material(m, images) for m in document["materials"]]
    scene = bpy.context.scene
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    scene.world = make_world(environment)
    # Blender's Z is up, glTF's Y; but any frame will do, so that the file's is kept.
    for node in document["nodes"]:
        if "mesh" in node:
            for primitive in document["meshes"][node["mesh"]]["primitives"]:
                attributes = primitive["attributes"]
                corners = [i[0] for i in numbers(document, binary, primitive["indices"])]
                mesh = bpy.data.meshes.new("mesh")
                faces = [corners[i : i + 3] for i in range(0, len(corners), 3)]
                mesh.from_pydata(numbers(document, binary, attributes["POSITION"]), [], faces)
                mesh.materials.append(materials[primitive["material"]])
                if "NORMAL" in attributes:
                    for polygon in mesh.polygons:
                        polygon.use_smooth = True
                    mesh.use_auto_smooth = True
                    mesh.normals_split_custom_set_from_vertices(numbers(document, binary, attributes["NORMAL"]))
                if "TEXCOORD_0" in attributes:
                    # glTF's v runs down the image, Blender's up.
                    places = numbers(document, binary, attributes["TEXCOORD_0"])
                    layer = mesh.uv_layers.new()
                    for loop in mesh.loops:
                        u, v = places[loop.vertex_index]
                        layer.data[loop.index].uv = (u, 1 - v)
                thing = bpy.data.objects.new("object", mesh)
                thing.cycles.shadow_terminator_geometry_offset = thing.cycles.shadow_terminator_offset = 0
                scene.collection.objects.link(thing)
        else:
            perspective = document["cameras"][node["camera"]]["perspective"]
            camera = bpy.data.cameras.new("camera")
            camera.sensor_fit = "VERTICAL"
            camera.angle_y = perspective["yfov"]
            camera.clip_start = perspective["znear"]
            camera.clip_end = 1e6
            eye = bpy.data.objects.new("camera", camera)
            m = node["matrix"]
            eye.matrix_world = Matrix([m[r::4] for r in range(4)])
            scene.collection.objects.link(eye)
            scene.camera = eye
    return scene


def settings(scene, size, seed, threads):
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.threads_mode = "FIXED"
    scene.render.threads = threads
    scene.render.use_persistent_data = True
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.dither_intensity = 0
    scene.view_settings.view_transform = "Raw"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.seed = seed
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1.0
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.use_auto_tile = False
    for bounces in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, bounces + "_bounces", 1024)


def render(scene, samples, file=None):
    """CPU seconds of one picture."""
    scene.cycles.samples = samples
    if file:
        scene.render.filepath = file
    before = resource.getrusage(resource.RUSAGE_SELF)
    bpy.ops.render.render(write_still=file is not None)
    after = resource.getrusage(resource.RUSAGE_SELF)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("file")
    parser.add_argument("out")
    for number in ("size", "samples", "seed", "threads"):
        parser.add_argument(number, type=int)
    parser.add_argument("--environment")
    parser.add_argument("--once", action="store_true")
    o = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    scene = make_scene(o.file, o.environment)
    settings(scene, o.size, o.seed, o.threads)
    if o.once:
        render(scene, o.samples, o.out)
        return
    render(scene, 1)
    one = render(scene, 1)
    all_ = render(scene, o.samples, o.out)
    print("cycles %.4f" % ((all_ - one) * o.samples / (o.samples - 1)))


main()
