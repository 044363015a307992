#!/usr/bin/python3
"""Copies a glTF model and makes every surface of it Lambertian and flat, so that two renderers can agree on what it is.

    tests/bench/peers/sponza_lambert.py ../shared/content/sponza/Sponza.gltf out/

The copy keeps positions, triangles, texture coordinates, base colours and alpha masks. It leaves out normals and tangents
(glTF: then the triangles are flat), normal and metallic-roughness maps; it sets metallic 0, roughness 1 and, by KHR_materials_specular,
specular 0, and shows both sides of everything. Renderers differ in how they treat interpolated normals, bump maps and layered
materials; about a flat Lambertian triangle there is nothing to differ in.
"""

import argparse
import json
import pathlib
import shutil
import sys


def lambertian(material):
    """The material with nothing left but base colour and alpha mask."""
    base = material.get("pbrMetallicRoughness", {})
    kept = {key: base[key] for key in ("baseColorFactor", "baseColorTexture") if key in base}
    result = {
        "pbrMetallicRoughness": {**kept, "metallicFactor": 0.0, "roughnessFactor": 1.0},
        "extensions": {"KHR_materials_specular": {"specularFactor": 0.0}},
        "doubleSided": True,
    }
    for key in ("name", "alphaMode", "alphaCutoff"):
        if key in material:
            result[key] = material[key]
    return result


def copy(source, folder):
    """Writes the Lambertian copy of `source` as `folder`/<name>_lambert.gltf, with the files it needs, and returns its path."""
    source, folder = pathlib.Path(source), pathlib.Path(folder)
    gltf = json.loads(source.read_text())
    folder.mkdir(parents=True, exist_ok=True)
    gltf["materials"] = [lambertian(material) for material in gltf["materials"]]
    gltf["extensionsUsed"] = sorted(set(gltf.get("extensionsUsed", [])) | {"KHR_materials_specular"})
    for mesh in gltf["meshes"]:
        for primitive in mesh["primitives"]:
            wanted = ("POSITION", "TEXCOORD_0")
            primitive["attributes"] = {key: value for key, value in primitive["attributes"].items() if key in wanted}
    files = {buffer["uri"] for buffer in gltf["buffers"]}
    files |= keep_base_colour_images(gltf)
    for name in files:
        shutil.copyfile(source.parent / name, folder / name)
    result = folder / f"{source.stem.lower()}_lambert.gltf"
    result.write_text(json.dumps(gltf))
    return result


def keep_base_colour_images(gltf):
    """Drops textures and images that no material uses any more, renumbers the rest and returns their files."""
    slots = [material["pbrMetallicRoughness"]["baseColorTexture"] for material in gltf["materials"]
             if "baseColorTexture" in material["pbrMetallicRoughness"]]
    kept_textures = sorted({slot["index"] for slot in slots})
    textures = [gltf["textures"][i] for i in kept_textures]
    kept_images = sorted({texture["source"] for texture in textures})
    for slot in slots:
        slot["index"] = kept_textures.index(slot["index"])
    for texture in textures:
        texture["source"] = kept_images.index(texture["source"])
    gltf["textures"] = textures
    gltf["images"] = [gltf["images"][i] for i in kept_images]
    return {image["uri"] for image in gltf["images"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", type=pathlib.Path, help="a .gltf with its buffers and images in files beside it")
    parser.add_argument("folder", type=pathlib.Path, help="where the copy goes")
    arguments = parser.parse_args()
    if not arguments.source.is_file():
        sys.exit(f"sponza_lambert.py: there is no '{arguments.source}'")
    print(copy(arguments.source, arguments.folder))


if __name__ == "__main__":
    main()
