#!/usr/bin/python3
"""Checks that cycles_scene.py hands Cycles the light and the media that the scene file means, against closed forms.

    tests/bench/peers/units.py            # some 30 seconds
    tests/bench/peers/units.py --spp 4096 --threads 2

Each case is a scene file whose picture has one value: a Lambertian floor under one light, a box that absorbs in front of a uniform
sky, a slab from van de Hulst's tables. Printed are Cycles' mean, the exact value and their ratio; the exit status is 1 where one is
off by more than its tolerance. Without Blender it says so and ends with 0.
"""

import argparse
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(__file__).resolve().parent / "cycles_scene.py"
ALBEDO = 0.5
DOWN = [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]
UP = [math.sqrt(0.5), 0, 0, math.sqrt(0.5)]
STEEP = [-math.sin(math.radians(15)), 0, 0, math.cos(math.radians(15))]  # a sun whose light meets the floor at 60 degrees
FLOOR = {"name": "floor", "primitive": {"shape": "plane", "size": [40, 40]},
         "material": {"baseColor": [ALBEDO] * 3, "specular": 0, "doubleSided": True}}


def eye(height, rotation=DOWN):
    return {"name": "eye", "camera": {"type": "orthographic", "ymag": 0.01, "znear": 0.001}, "translation": [0, height, 0], "rotation": rotation}


def scene(*nodes, sky=0):
    return {"tyndall": 1, "nodes": list(nodes), "camera": "eye", "environment": {"radiance": [sky] * 3}}


def lit_floor(light, **place):
    return scene(FLOOR, eye(0.5), {"name": "light", "light": light, **place})


def slab(absorption, scattering, g, thickness, rotation=DOWN, height=4, sky=0, *more):
    fog = {"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [100, thickness, 100], "scattering": scattering,
                                     "absorption": absorption, "anisotropy": g}}
    return scene(fog, eye(height, rotation), *more, sky=sky)


def corner_form_factor(a, b, h):
    """From a surface element to a parallel rectangle a x b at height h over it, one corner right above."""
    x, y = a / h, b / h
    one, other = math.sqrt(1 + x * x), math.sqrt(1 + y * y)
    return (x / one * math.atan(y / one) + y / other * math.atan(x / other)) / (2 * math.pi)


def cases():
    """Name, scene, exact value of the green channel, tolerance (relative)."""
    floor = ALBEDO / math.pi
    for radius in (0, 0.05, 0.5):
        disk = 1 / (4 + radius * radius)  # Blender's "ball" is a disk that faces the floor; a ball would send 1 / 4
        yield (f"point light, radius {radius} m, 2 m above", lit_floor({"type": "point", "intensity": 10, "radius": radius}, translation=[0, 2, 0]),
               floor * 10 * disk, 1e-3)
    rect = {"type": "rect", "size": [0.5, 0.4], "radiance": [10, 10, 10]}
    yield "rect light", lit_floor(rect, translation=[0, 2, 0], rotation=DOWN), ALBEDO * 10 * 4 * corner_form_factor(0.25, 0.2, 2), 1e-3
    for radius in (0, 0.00465):
        yield (f"sun, radius {radius} rad", lit_floor({"type": "directional", "intensity": 20, "radius": radius}, rotation=STEEP),
               floor * 20 * 0.5, 1e-3)
    yield "sky on a floor", scene(FLOOR, eye(0.5), sky=3), ALBEDO * 3, 1e-3
    yield "sky through an absorbing box, depth 1.5", slab([0.5, 1, 2], [0, 0, 0], 0, 1.5, sky=1), math.exp(-1.5), 1e-3
    yield "sky through an absorbing box, eye inside it", slab([0.5, 1, 2], [0, 0, 0], 0, 1.5, height=0.25, sky=1), math.exp(-1), 1e-3
    yield "furnace: albedo 1, depth 2, g 0.5, uniform sky", slab([0, 0, 0], [1, 1, 1], 0.5, 2, sky=1), 1, 5e-3
    sun = {"name": "sun", "light": {"type": "directional", "intensity": math.pi}, "rotation": DOWN}
    table35 = ([0.1] * 3, [0.9] * 3, 0.75, 2)  # van de Hulst 1980, volume 2, table 35: albedo 0.9, depth 2, g 0.75
    yield "slab, reflected straight back (van de Hulst, table 35)", slab(*table35, DOWN, 4, 0, sun), 0.06180, 2e-2
    yield "slab, scattered straight on (van de Hulst, table 35)", slab(*table35, UP, -4, 0, sun), 2.40270, 2e-2


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--spp", type=int, default=256, help="samples per pixel of a 16x16 picture (256); slabs take four times as many")
    parser.add_argument("--threads", type=int, default=1)
    arguments = parser.parse_args()
    if not shutil.which(arguments.blender):
        print(f"units.py: skipped, there is no '{arguments.blender}' here (on Debian: apt install blender python3-numpy)")
        return 0
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for title, content, exact, tolerance in cases():
            (folder / "unit.scene.json").write_text(json.dumps(content))
            spp = arguments.spp * (4 if "slab" in title else 1)
            command = [arguments.blender, "-b", "--factory-startup", "-noaudio", "-P", SCRIPT, "--", folder / "unit.scene.json", "-o", folder / "unit.exr",
                       "--size", "16x16", "--spp", str(spp), "--threads", str(arguments.threads), "--json", folder / "unit.json"]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            mean = json.loads((folder / "unit.json").read_text())["mean"][1]
            bad = abs(mean / exact - 1) > tolerance
            failed += bad
            print(f"{title:56} {mean:.6f}, exact {exact:.6f}, ratio {mean / exact:.5f}{'  WRONG' if bad else ''}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
