#!/usr/bin/python3
"""Measures surfels against the reference and writes the tables of docs/measured/surfels.md.

    tests/bench/surfels.py [--build build/release] [--out out/bench-surfels] [--scenes NAME,...] [--qualities low,medium,high,ultra] [--spp 1024]

Scenes that need the shared content ($TYNDALL_CONTENT, else ../shared/content) are left out with a note where it is missing. References and
reports are kept in the folder --out: what is there is not made again.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import harness  # noqa: E402
from harness import load, smoke_room, sponza  # noqa: E402

SIZE = "160x90"
TERM = "LSVE"


def red_wall():
    """A sunlit red wall with thin fog before it."""
    matt = lambda r, g, b: {"baseColor": [r, g, b], "specular": 0, "doubleSided": True}
    return {"tyndall": 1, "name": "red wall beside fog", "nodes": [
        {"name": "wall", "primitive": {"shape": "plane", "size": [4, 4]}, "material": matt(0.8, 0.05, 0.05), "translation": [-1, 1, 0],
         "rotation": [0, 0, -0.707106781, 0.707106781]},
        {"name": "sun", "light": {"type": "directional", "intensity": 10}, "rotation": [-0.2, 0.55, 0, 0.8]},
        {"name": "fog", "medium": {"type": "homogeneous", "shape": "box", "size": [1.5, 2, 2], "scattering": [0.3] * 3, "absorption": [0.02] * 3}, "translation": [0, 1, 0]},
        {"name": "eye", "camera": {"type": "perspective", "yfov": 0.8}, "translation": [0.6, 1, 4]}],
        "camera": "eye", "exposure": {"ev100": 0}}


def cloud_over_floor():
    """The puff of content/ over a floor that a lamp lights."""
    return {"tyndall": 1, "name": "cloud over a lit floor", "nodes": [
        {"name": "floor", "primitive": {"shape": "plane", "size": [8, 8]}, "material": {"baseColor": [0.7, 0.6, 0.3], "specular": 0}},
        {"name": "lamp", "light": {"type": "spot", "intensity": 60, "outerConeAngle": 0.7, "innerConeAngle": 0.5}, "translation": [1.5, 3, 1], "rotation": [-0.62, 0.2, 0.15, 0.74]},
        {"name": "cloud", "scale": [0.012] * 3, "translation": [0, 0.5, 0],
         "medium": {"type": "grid", "file": str(harness.content_folder() / "vdb/smoke1.vdb"), "scattering": [12] * 3, "absorption": [0.5] * 3, "anisotropy": 0.4}},
        {"name": "eye", "camera": {"type": "perspective", "yfov": 0.7}, "translation": [0, 1.2, 4.5]}],
        "camera": "eye", "exposure": {"ev100": 0}}


def scenes(content):
    """Name, scene, and how many times fewer samples its reference gets."""
    yield "red wall beside fog", red_wall(), 1
    yield "cornell fog", load("content/cornell_fog.scene.json"), 1
    if (content / "vdb/smoke1.vdb").exists():
        yield "smoke in a room", smoke_room(content), 1
        yield "cloud over a lit floor", cloud_over_floor(), 1
    else:
        print(f"note: '{content}' has no smoke1.vdb", file=sys.stderr)
    if (content / "sponza/Sponza.gltf").exists():
        yield "Sponza with fog", sponza(content, False), 1 / 4
    else:
        print(f"note: '{content}' has no Sponza", file=sys.stderr)


class Bench(harness.Bench):
    def reference(self, scene, fewer):
        path = self.beside(scene, "reference.exr")
        if not path.exists():
            self.run("reference", scene, "-o", path, "--size", SIZE, "--spp", max(int(self.spp / fewer), 16), "--terms", TERM, "--quiet")
        return path


if __name__ == "__main__":
    arguments = harness.parser(__doc__, "surfels", 512, "bench-surfels")
    arguments.add_argument("--scenes", default="")
    arguments = arguments.parse_args()
    bench = Bench(arguments)
    for name, scene, fewer in harness.chosen(scenes(harness.content_folder()), arguments.scenes):
        bench.reference(bench.scene(name, scene), fewer)
