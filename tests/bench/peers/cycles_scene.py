"""Renders a Tyndall scene file with Cycles. Runs inside Blender (3.4 is what it was written for):

    blender -b --factory-startup -noaudio -P tests/bench/peers/cycles_scene.py -- SCENE.json -o out.exr \\
        --size 96x54 --spp 64 --threads 2 --seed 1 [--depth 0] [--step 1] [--json out.json] [--png out.png]

What it understands is what the peer benchmark needs, and means exactly the same thing in both renderers: planes and boxes with
Lambertian materials, glTF files as sponza_lambert.py writes them, homogeneous boxes, OpenVDB grids, Henyey-Greenstein, point
lights with or without a radius, rect lights, suns, a constant environment. Everything else is refused by its name.

Conventions. Tyndall's space is Y up, Blender's Z up: everything is turned by 90 degrees about X. Cameras and lights look along
-Z of their node in both. Colours are linear and nothing is clamped, filtered, denoised, roughened or cut off.
"""

import argparse
import json
import math
import os
import sys
import time

import bpy
import numpy
from mathutils import Matrix, Quaternion, Vector

BLENDER_FROM_TYNDALL = Matrix.Rotation(math.radians(90), 4, "X")
UNLIMITED = 1024  # bounces; the largest number Blender's settings take
MATERIAL_KEYS = {"baseColor", "specular", "doubleSided", "metallic", "roughness"}


class Refused(Exception):
    """The scene asks for something that this script does not translate."""


def refuse_unknown(what, keys, known):
    unknown = sorted(set(keys) - set(known))
    if unknown:
        raise Refused(f"{what}: '{unknown[0]}' is not translated for Cycles")


# Nodes and their places

def local_matrix(node):
    if "matrix" in node:
        m = node["matrix"]
        return Matrix([[m[4 * column + row] for column in range(4)] for row in range(4)])
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    return Matrix.LocRotScale(Vector(node.get("translation", (0, 0, 0))), Quaternion((w, x, y, z)).normalized(),
                              Vector(node.get("scale", (1, 1, 1))))


def world_matrix(node, by_name):
    """Tyndall's world from the node's space."""
    matrix = local_matrix(node)
    while "parent" in node:
        node = by_name[node["parent"]]
        matrix = local_matrix(node) @ matrix
    return matrix


def add_object(name, data, matrix):
    thing = bpy.data.objects.new(name, data)
    thing.matrix_world = BLENDER_FROM_TYNDALL @ matrix
    bpy.context.scene.collection.objects.link(thing)
    return thing


# Surfaces

def empty_material(name):
    """A material without nodes, and its node tree, node factory and output."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    return material, tree, tree.nodes.new("ShaderNodeOutputMaterial")


def lambert(name, colour):
    material, tree, output = empty_material(name)
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*colour[:3], 1)
    diffuse.inputs["Roughness"].default_value = 0
    tree.links.new(diffuse.outputs["BSDF"], output.inputs["Surface"])
    return material


def primitive_material(node):
    source = node.get("material", {})
    refuse_unknown(f"material of '{node['name']}'", source, MATERIAL_KEYS)
    if source.get("specular", 1) != 0 or source.get("metallic", 0) != 0:
        raise Refused(f"material of '{node['name']}': only Lambertian ones (\"specular\": 0) mean the same in both renderers")
    return lambert(node["name"], source.get("baseColor", (1, 1, 1)))


def add_primitive(node, matrix):
    shape = node["primitive"]["shape"]
    size = node["primitive"].get("size", (1, 1, 1))
    if shape == "plane":
        if not node.get("material", {}).get("doubleSided"):
            raise Refused(f"'{node['name']}': a plane has to be doubleSided, Cycles shows both sides")
        x, z = size[0] / 2, size[-1] / 2
        vertices, faces = [(-x, 0, z), (x, 0, z), (x, 0, -z), (-x, 0, -z)], [(0, 1, 2, 3)]
    elif shape == "box":
        vertices, faces = box(size)
    else:
        raise Refused(f"'{node['name']}': the shape '{shape}' is not translated (interpolated normals differ)")
    mesh = bpy.data.meshes.new(node["name"])
    mesh.from_pydata(vertices, [], faces)
    mesh.materials.append(primitive_material(node))
    add_object(node["name"], mesh, matrix)


def box(size):
    x, y, z = (extent / 2 for extent in size)
    vertices = [(sx * x, sy * y, sz * z) for sx in (-1, 1) for sy in (-1, 1) for sz in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return vertices, faces


# glTF, as far as sponza_lambert.py writes it

class Gltf:
    """A flat, Lambertian glTF model with its buffers and images in files."""

    def __init__(self, path):
        self.folder = os.path.dirname(path)
        with open(path) as file:
            self.json = json.load(file)
        self.buffers = [numpy.fromfile(os.path.join(self.folder, b["uri"]), dtype=numpy.uint8) for b in self.json["buffers"]]
        self.images = {}
        self.materials = [self.material(i) for i in range(len(self.json["materials"]))]

    def accessor(self, index):
        """Values as rows of an array; packed accessors only."""
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        kind = {5121: numpy.uint8, 5123: numpy.uint16, 5125: numpy.uint32, 5126: numpy.float32}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        if view.get("byteStride", width * numpy.dtype(kind).itemsize) != width * numpy.dtype(kind).itemsize:
            raise Refused(f"accessor {index}: interleaved vertices are not translated")
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        values = self.buffers[view["buffer"]][start:start + accessor["count"] * width * numpy.dtype(kind).itemsize]
        return values.view(kind).reshape(-1, width)

    def image(self, index):
        """The picture in linear floats: Cycles would interpolate 8-bit sRGB before it decodes it, and so darken edges."""
        if index not in self.images:
            file = bpy.data.images.load(os.path.join(self.folder, self.json["images"][index]["uri"]))
            file.colorspace_settings.name = "Non-Color"
            file.alpha_mode = "CHANNEL_PACKED"
            width, height = file.size
            pixels = numpy.empty(width * height * 4, dtype=numpy.float32)
            file.pixels.foreach_get(pixels)
            rgb = pixels.reshape(-1, 4)[:, :3]
            rgb[:] = numpy.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
            linear = bpy.data.images.new(f"linear {index}", width, height, alpha=True, float_buffer=True)
            linear.colorspace_settings.name = "Non-Color"
            linear.alpha_mode = "CHANNEL_PACKED"
            linear.pixels.foreach_set(pixels)
            bpy.data.images.remove(file)
            self.images[index] = linear
        return self.images[index]

    def material(self, index):
        source = self.json["materials"][index]
        base = source["pbrMetallicRoughness"]
        if base.get("metallicFactor", 1) != 0 or source["extensions"]["KHR_materials_specular"]["specularFactor"] != 0:
            raise Refused(f"material {index} is not Lambertian; sponza_lambert.py makes it so")
        factor = base.get("baseColorFactor", (1, 1, 1, 1))
        material = lambert(f"material {index}", factor)
        if "baseColorTexture" not in base:
            return material
        tree = material.node_tree
        diffuse = next(node for node in tree.nodes if node.type == "BSDF_DIFFUSE")
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = self.image(self.json["textures"][base["baseColorTexture"]["index"]]["source"])
        texture.interpolation, texture.extension = "Linear", "REPEAT"
        tint = tree.nodes.new("ShaderNodeVectorMath")
        tint.operation = "MULTIPLY"
        tint.inputs[1].default_value = factor[:3]
        tree.links.new(texture.outputs["Color"], tint.inputs[0])
        tree.links.new(tint.outputs["Vector"], diffuse.inputs["Color"])
        if source.get("alphaMode", "OPAQUE") == "MASK":
            mask(tree, texture.outputs["Alpha"], diffuse, source.get("alphaCutoff", 0.5) / factor[3])
        elif source.get("alphaMode", "OPAQUE") != "OPAQUE":
            raise Refused(f"material {index}: the alpha mode '{source['alphaMode']}' is not translated")
        return material

    def add(self, name, matrix):
        nodes = self.json["scenes"][self.json.get("scene", 0)]["nodes"]
        for index in nodes:
            self.add_node(name, self.json["nodes"][index], matrix)

    def add_node(self, name, node, matrix):
        matrix = matrix @ local_matrix(node)
        if "mesh" in node:
            add_object(name, self.mesh(node["mesh"]), matrix)
        for child in node.get("children", ()):
            self.add_node(name, self.json["nodes"][child], matrix)

    def mesh(self, index):
        """All primitives of a mesh as one Blender mesh, flat shaded, texture coordinates turned upside down."""
        positions, corners, uvs, materials, first = [], [], [], [], 0
        for primitive in self.json["meshes"][index]["primitives"]:
            p = self.accessor(primitive["attributes"]["POSITION"])
            c = self.accessor(primitive["indices"]).ravel().astype(numpy.int32)
            uv = self.accessor(primitive["attributes"]["TEXCOORD_0"])[c]
            positions.append(p)
            corners.append(c + first)
            uvs.append(numpy.stack([uv[:, 0], 1 - uv[:, 1]], axis=1))
            materials.append(numpy.full(len(c) // 3, primitive["material"], dtype=numpy.int32))
            first += len(p)
        positions, corners, uvs, materials = map(numpy.concatenate, (positions, corners, uvs, materials))
        mesh = bpy.data.meshes.new(f"mesh {index}")
        mesh.vertices.add(len(positions))
        mesh.vertices.foreach_set("co", positions.ravel())
        mesh.loops.add(len(corners))
        mesh.loops.foreach_set("vertex_index", corners)
        mesh.polygons.add(len(materials))
        mesh.polygons.foreach_set("loop_start", numpy.arange(0, len(corners), 3, dtype=numpy.int32))
        mesh.polygons.foreach_set("loop_total", numpy.full(len(materials), 3, dtype=numpy.int32))
        mesh.uv_layers.new(name="uv").data.foreach_set("uv", uvs.astype(numpy.float32).ravel())
        for material in self.materials:
            mesh.materials.append(material)
        mesh.polygons.foreach_set("material_index", materials)
        mesh.update(calc_edges=True)
        return mesh


def mask(tree, alpha, surface, cutoff):
    """A hole where alpha is below the cutoff."""
    kept = tree.nodes.new("ShaderNodeMath")
    kept.operation = "GREATER_THAN"
    kept.inputs[1].default_value = cutoff
    tree.links.new(alpha, kept.inputs[0])
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(kept.outputs["Value"], mix.inputs["Fac"])
    tree.links.new(tree.nodes.new("ShaderNodeBsdfTransparent").outputs["BSDF"], mix.inputs[1])
    tree.links.new(surface.outputs["BSDF"], mix.inputs[2])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(mix.outputs["Shader"], output.inputs["Surface"])


# Media

def medium_material(name, medium, density_attribute):
    """Scatter and absorption nodes: sigma_s = colour * density, sigma_a = (1 - colour) * density, both per metre."""
    material, tree, output = empty_material(name)
    attribute = None
    if density_attribute:
        attribute = tree.nodes.new("ShaderNodeAttribute")
        attribute.attribute_name = density_attribute
    both = tree.nodes.new("ShaderNodeAddShader")
    for i, (kind, key) in enumerate((("ShaderNodeVolumeScatter", "scattering"), ("ShaderNodeVolumeAbsorption", "absorption"))):
        coefficient = medium.get(key, (0, 0, 0))
        most = max(coefficient)
        share = [c / most if most else 0 for c in coefficient]
        node = tree.nodes.new(kind)
        node.inputs["Color"].default_value = (*(share if key == "scattering" else [1 - c for c in share]), 1)
        node.inputs["Density"].default_value = most
        if key == "scattering":
            node.inputs["Anisotropy"].default_value = medium.get("anisotropy", 0)
        if attribute:
            product = tree.nodes.new("ShaderNodeMath")
            product.operation = "MULTIPLY"
            product.inputs[1].default_value = most
            tree.links.new(attribute.outputs["Fac"], product.inputs[0])
            tree.links.new(product.outputs["Value"], node.inputs["Density"])
        tree.links.new(node.outputs["Volume"], both.inputs[i])
    tree.links.new(both.outputs["Shader"], output.inputs["Volume"])
    material.cycles.volume_sampling = "MULTIPLE_IMPORTANCE"
    material.cycles.volume_interpolation = "LINEAR"
    material.cycles.homogeneous_volume = not density_attribute
    return material


def add_medium(node, matrix, step):
    medium = node["medium"]
    name = node["name"]
    refuse_unknown(f"medium '{name}'", medium, {"type", "shape", "size", "scattering", "absorption", "anisotropy", "phase", "file", "grid"})
    if medium.get("phase", "henyey-greenstein") != "henyey-greenstein":
        raise Refused(f"medium '{name}': Cycles knows Henyey-Greenstein alone")
    if medium["type"] == "grid":
        return add_grid(name, medium, matrix, step)
    if medium["type"] != "homogeneous" or medium["shape"] != "box":
        raise Refused(f"medium '{name}': only boxes and grids are translated")
    vertices, faces = box(medium.get("size", (1, 1, 1)))
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    mesh.materials.append(medium_material(name, medium, None))
    add_object(name, mesh, matrix)
    return None


def add_grid(name, medium, matrix, step):
    """An OpenVDB file as a volume object, marched in steps of `step` voxels; returns what was set, for the report."""
    volume = bpy.data.volumes.new(name)
    volume.filepath = medium["file"]
    if not volume.grids.load():
        raise Refused(f"medium '{name}': {volume.grids.error_message}")
    grid = volume.grids[medium.get("grid", "density")]
    volume.materials.append(medium_material(name, medium, grid.name))
    volume.render.precision = "FULL"
    volume.render.clipping = 0
    volume.render.space = "WORLD"  # coefficients per metre of the world, whatever the object's scale
    voxel = min((matrix @ grid.matrix_object).to_scale())
    volume.render.step_size = step * voxel
    # OpenVDB's samples lie at the corners of the index lattice; Blender 3.4 shows them half a voxel farther along each axis
    # (measured: without this the best match is shifted by 0.5 voxels in x, y and z).
    back = Matrix.Translation(grid.matrix_object.to_3x3() @ Vector((-0.5, -0.5, -0.5)))
    add_object(name, volume, matrix @ back)
    return {"voxel_m": voxel, "step_m": step * voxel}


# Lights

def add_light(node, matrix):
    """Blender's units, measured by units.py: a point light of P watts has P / 4 pi candela, an area light P / 4 A nits, a sun P lux.

    A radius makes Blender's point light a disk that faces whoever looks: I / (d^2 + r^2) where Tyndall's ball sends I / d^2.
    """
    source, name = node["light"], node["name"]
    refuse_unknown(f"light '{name}'", source, {"type", "color", "intensity", "radius", "size", "radiance"})
    kind = source["type"]
    if kind not in ("point", "directional", "rect"):
        raise Refused(f"light '{name}': the type '{kind}' is not translated")
    light = bpy.data.lights.new(name, {"point": "POINT", "directional": "SUN", "rect": "AREA"}[kind])
    light.color = source.get("color", (1, 1, 1))
    if kind == "point":
        light.energy = 4 * math.pi * source.get("intensity", 1)
        light.shadow_soft_size = source.get("radius", 0)
    elif kind == "directional":
        light.energy = source.get("intensity", 1)
        light.angle = 2 * source.get("radius", 0)
    else:
        scale = matrix.to_scale()
        size = source.get("size", (1, 1))
        light.shape = "RECTANGLE"
        light.size, light.size_y = size[0] * scale.x, size[1] * scale.y
        strongest = max(source["radiance"])
        light.energy = 4 * light.size * light.size_y * strongest
        light.color = [c / strongest for c in source["radiance"]]
    light.cycles.cast_shadow = True
    light.cycles.max_bounces = UNLIMITED
    thing = add_object(name, light, Matrix.LocRotScale(matrix.to_translation(), matrix.to_quaternion(), None))
    thing.visible_camera = False  # Tyndall's lights light, and are not seen themselves


def set_environment(scene, environment):
    refuse_unknown("environment", environment, {"radiance"})
    world = bpy.data.worlds.new("environment")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*environment.get("radiance", (0, 0, 0)), 1)
    background.inputs["Strength"].default_value = 1
    world.cycles.max_bounces = UNLIMITED
    scene.world = world


def add_camera(scene, node, matrix):
    source = node["camera"]
    camera = bpy.data.cameras.new(node["name"])
    if source["type"] == "orthographic":
        camera.type = "ORTHO"
        camera.sensor_fit = "VERTICAL"
        camera.ortho_scale = 2 * source.get("ymag", 1)
    else:
        camera.sensor_fit = "VERTICAL"
        camera.angle_y = source.get("yfov", 0.8)
    # Cycles' rays, and so its media, begin at the near plane; Tyndall's media begin at the camera. Nothing may be nearer than znear.
    camera.clip_start, camera.clip_end = 1e-6, 1e6
    scene.camera = add_object(node["name"], camera, Matrix.LocRotScale(matrix.to_translation(), matrix.to_quaternion(), None))


# All together

def build(path, step):
    """Fills an empty Blender with the scene of the file and returns notes for the report."""
    with open(path) as file:
        source = json.load(file)
    refuse_unknown(path, source, {"tyndall", "name", "nodes", "camera", "environment", "exposure", "settings"})
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    by_name = {node["name"]: node for node in source["nodes"]}
    notes = {}
    for node in source["nodes"]:
        matrix = world_matrix(node, by_name)
        if "gltf" in node:
            Gltf(os.path.join(os.path.dirname(path), node["gltf"])).add(node["name"], matrix)
        if "primitive" in node:
            add_primitive(node, matrix)
        if "light" in node:
            add_light(node, matrix)
        if "medium" in node:
            note = add_medium(node, matrix, step)
            if note:
                notes[node["name"]] = note
        if "camera" in node and node["name"] == source["camera"]:
            add_camera(scene, node, matrix)
    set_environment(scene, source.get("environment", {}))
    return notes


def configure(scene, arguments):
    """Plain path tracing: nothing clamped, nothing cut off, box filter, linear floats."""
    width, height = (int(n) for n in arguments.size.lower().split("x"))
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.threads_mode, render.threads = "FIXED", arguments.threads
    render.use_persistent_data = False
    render.use_compositing = render.use_sequencer = False
    render.use_file_extension = False
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_mode = "RGB"
    render.image_settings.color_depth = "32"
    render.image_settings.exr_codec = "ZIP"
    cycles.device = "CPU"
    cycles.samples, cycles.seed = arguments.spp, arguments.seed
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.time_limit = 0
    cycles.use_auto_tile = False
    cycles.auto_scrambling_distance = False
    cycles.scrambling_distance = 1
    cycles.use_guiding = False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
    cycles.film_exposure = 1
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.use_fast_gi = False
    depth = UNLIMITED if arguments.depth < 0 else arguments.depth
    for name in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces", "volume_bounces"):
        setattr(cycles, name, depth)
    cycles.transparent_max_bounces = UNLIMITED
    cycles.min_light_bounces = cycles.min_transparent_bounces = 0
    cycles.volume_step_rate = 1
    cycles.volume_max_steps = 65536
    scene.view_settings.view_transform = "Standard"


def mean_of(path):
    """Mean of each channel of an EXR file."""
    image = bpy.data.images.load(path)
    pixels = numpy.empty(image.size[0] * image.size[1] * 4, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    return [float(v) for v in pixels.reshape(-1, 4)[:, :3].astype(numpy.float64).mean(axis=0)]


def render(scene, arguments):
    """Renders, writes the files and returns the seconds from the start of Cycles' synchronisation to its last sample."""
    start = time.perf_counter()
    bpy.ops.render.render()
    seconds = time.perf_counter() - start
    result = bpy.data.images["Render Result"]
    result.save_render(arguments.output, scene=scene)
    if arguments.png:
        scene.render.image_settings.file_format = "PNG"
        scene.render.image_settings.color_depth = "8"
        scene.view_settings.exposure = arguments.exposure
        result.save_render(arguments.png, scene=scene)
    return seconds


def parse(argv):
    parser = argparse.ArgumentParser(prog="cycles_scene.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("-o", "--output", required=True, help="EXR, linear, 32-bit floats")
    parser.add_argument("--size", default="96x54", metavar="WxH")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--depth", type=int, default=-1, help="scatterings after the first: 0 is direct light alone (-1: no limit)")
    parser.add_argument("--step", type=float, default=1, help="step of the march through a grid, in voxels (1, Blender's own)")
    parser.add_argument("--json", help="seconds and mean colour go there")
    parser.add_argument("--png", help="the picture to look at")
    parser.add_argument("--exposure", type=float, default=0, help="stops, for the PNG alone")
    return parser.parse_args(argv)


def main():
    arguments = parse(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else ["--help"])
    for name in ("scene", "output", "json", "png"):
        if getattr(arguments, name):
            setattr(arguments, name, os.path.abspath(getattr(arguments, name)))
    notes = build(arguments.scene, arguments.step)
    scene = bpy.context.scene
    configure(scene, arguments)
    seconds = render(scene, arguments)
    report = {"seconds": seconds, "spp": arguments.spp, "seed": arguments.seed, "threads": arguments.threads,
              "blender": bpy.app.version_string, "mean": mean_of(arguments.output), "media": notes}
    if arguments.json:
        with open(arguments.json, "w") as file:
            json.dump(report, file)
    print("cycles_scene.py: " + json.dumps(report))


if __name__ == "__main__":
    try:
        main()
    except Refused as refusal:
        print(f"cycles_scene.py: {refusal}", file=sys.stderr)
        sys.exit(2)
