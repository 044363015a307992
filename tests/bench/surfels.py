#!/usr/bin/python3
"""Measures surfels against the reference and writes the tables of docs/measured/surfels.md.

    tests/bench/surfels.py [--build build/release] [--out out/bench-surfels] [--scenes NAME,...] [--qualities low,medium,high,ultra] [--spp 1024]

Scenes that need the shared content ($TYNDALL_CONTENT, else ../shared/content) are left out with a note where it is missing. References and
reports are kept in the folder --out: what is there is not made again.
"""

import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import harness  # noqa: E402
from harness import load, milliseconds, smoke_room, sponza  # noqa: E402
from tables import commit_date, machine, table  # noqa: E402

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

    def noise_of(self, scene, reference, fewer):
        """As noise(), of the one term."""
        again = self.beside(scene, "again.exr")
        if not again.exists():
            self.run("reference", scene, "-o", again, "--size", SIZE, "--spp", max(int(self.spp / fewer / 8), 16), "--seed", 1, "--terms", TERM, "--quiet")
        return self.compare(again, reference)[0] / 9

    def light(self, scene, label, *options, size=SIZE, frames=2):
        """The light of surfels alone, and the report of its last frame, in which shaders have been compiled."""
        return self.capture(scene, f"{label}.exr", "--gi", f"{TERM}=surfels", "--terms", TERM, "--frames", frames, *options, size=size)


def number(report, kind):
    return int(report[kind]["gi.surfels"])


def stage(report, *names):
    return milliseconds(report, *(f"gi.surfels.{name}" for name in names))


def all_stages(report):
    return sum(p.get("gpu_ms") or 0 for p in report["passes"] if p["status"] == "ran" and p["name"].startswith("gi.surfels."))


QUALITIES = ("low", "medium", "high", "ultra")
NOTHING_BETWEEN = ("--set", "gi.surfels.rays=none", "--set", "gi.surfels.attenuation=false")
VARIANTS = [  # of high quality
    ("every interval is asked", ("--set", "gi.surfels.rays=every")),
    ("no visibility", ("--set", "gi.surfels.visibility=false")),
    ("no attenuation", ("--set", "gi.surfels.attenuation=false")),
    ("neither", NOTHING_BETWEEN),
    ("printed", ("--set", "gi.mode=paper")),
]


def errors_table(bench, content, wanted, qualities):
    rows = []
    for name, scene, fewer in harness.chosen(scenes(content), wanted):
        path = bench.scene(name, scene)
        reference = bench.reference(path, fewer)
        noise = bench.noise_of(path, reference, fewer)
        cases = [(quality, ("--quality", quality)) for quality in qualities] + [(f"high, {label}", ("--quality", "high", *options)) for label, options in VARIANTS]
        for label, options in cases:
            print(f"  {label}", file=sys.stderr)
            key = label.replace(" ", "-").replace(",", "")
            picture, report = bench.light(path, key, *options)
            average, _ = bench.capture(path, f"{key}.average.exr", "--gi", f"{TERM}=surfels", "--terms", TERM, "--converge", "--frames", 16, *options, size=SIZE)
            rows.append([name, label, bench.errors(picture, reference), bench.errors(average, reference), f"{noise:.3f}", str(number(report, "surfels")),
                         str(number(report, "surfels_lit")), str(number(report, "pairs")), f"{stage(report, 'tessellate', 'light', 'brightness', 'list'):.0f}",
                         f"{stage(report, 'intervals'):.0f}", f"{stage(report, 'splat'):.0f}", f"{stage(report, 'collect', 'upsample'):.0f}"])
    head = ["scene", "quality", "one frame: relmse, energy", "16 frames: relmse, energy", "noise of the reference", "surfels", "lit", "pairs", "surfels, ms", "intervals, ms",
            "splats, ms", "collection, ms"]
    return table(head, rows)


def threshold_table(bench, content, wanted):
    """The paper's figure 11."""
    rows = []
    for name, scene, fewer in harness.chosen(scenes(content), wanted):
        path = bench.scene(name, scene)
        reference = bench.reference(path, fewer)
        for epsilon in (0.24, 0.12, 0.06, 0.03, 0.015):
            row = [name, f"{epsilon:g}"]
            for blur in ("true", "false"):
                picture, report = bench.light(path, f"epsilon{epsilon}.{blur}", "--quality", "high", "--set", f"gi.surfels.epsilon={epsilon}", "--set", f"gi.surfels.blur={blur}")
                row.append(bench.errors(picture, reference))
            rows.append(row + [str(number(report, "pairs")), f"{stage(report, 'splat'):.0f}"])
    return table(["scene", "ε", "with blur: relmse, energy", "without: relmse, energy", "pairs", "splats, ms"], rows)


# Table 1 of the paper: milliseconds on a GeForce GTX 770.
PAPER = {"shadow map": 0.6, "intervals": 8, "coefficients": 1.4, "surfels": 3, "splats": 20, "unshuffling": 1, "blur": 3, "sum": 0.4}


def paper_table(bench):
    """800x600, six levels, ε 0.06, about 14,000 surfels, 16 intervals, a ray for each pixel."""
    path = bench.scene("cornell fog", load("content/cornell_fog.scene.json"))
    rows = [["the paper's, GeForce GTX 770", "14000", f"{PAPER['surfels']:g}", f"{PAPER['intervals'] + PAPER['coefficients']:g}", f"{PAPER['splats']:g}",
             f"{PAPER['unshuffling'] + PAPER['blur'] + PAPER['sum']:g}"]]
    for label, options in (("printed", ("--set", "gi.mode=paper")), ("corrected, nothing between", NOTHING_BETWEEN), ("corrected", ())):
        _, report = bench.light(path, f"paper.{label.replace(' ', '-').replace(',', '')}", "--quality", "high", "--set", "gi.surfels.levels=6", "--set", "gi.surfels.epsilon=0.06",
                                "--set", "gi.surfels.size=10.6", "--set", "gi.surfels.march=full", *options, size="800x600")
        rows.append([label, str(number(report, "surfels")), f"{stage(report, 'tessellate', 'light', 'brightness', 'list'):.0f}", f"{stage(report, 'intervals'):.0f}",
                     f"{stage(report, 'splat'):.0f}", f"{stage(report, 'collect', 'upsample'):.0f}"])
    return table(["", "surfels", "surfels, ms", "intervals, ms", "splats, ms", "collection, ms"], rows)


def cost_table(bench):
    """One thing changed at a time from medium quality at 320x180."""
    path = bench.scene("cornell fog", load("content/cornell_fog.scene.json"))
    cases = [("medium, 320x180", (), "320x180"), ("160x90", (), "160x90"), ("640x360", (), "640x360")]
    cases += [(f"size {size}", ("--set", f"gi.surfels.size={size}"), "320x180") for size in (5, 3)]
    cases += [(f"{levels} levels", ("--set", f"gi.surfels.levels={levels}"), "320x180") for levels in (2, 3, 4, 5)]
    cases += [(f"{count} intervals", ("--set", f"gi.surfels.intervals={count}"), "320x180") for count in (8, 32)]
    cases += [("all pairs", ("--set", "gi.surfels.pairs=all", "--set", "gi.surfels.rays=none"), "320x180")]
    rows = []
    for label, options, size in cases:
        print(f"  {label}", file=sys.stderr)
        _, report = bench.light(path, f"cost.{label.replace(' ', '-').replace(',', '')}", *options, size=size)
        rows.append([label, str(number(report, "surfels")), str(number(report, "surfels_lit")), str(number(report, "splats")), str(number(report, "pairs")),
                     f"{stage(report, 'tessellate', 'light', 'brightness', 'list'):.0f}", f"{stage(report, 'intervals'):.0f}", f"{stage(report, 'splat'):.0f}",
                     f"{all_stages(report):.0f}"])
    return table(["", "surfels", "lit", "quads", "pairs", "surfels, ms", "intervals, ms", "splats, ms", "all, ms"], rows)


def moved(scene, step):
    """The scene with its eye this many metres to the right and ahead."""
    scene = json.loads(json.dumps(scene))
    for node in scene["nodes"]:
        if "camera" in node:
            x, y, z = node.get("translation", [0, 0, 0])
            node["translation"] = [x + step, y, z - step]
    return scene


def motion_table(bench, content):
    """How much light changes from frame to frame, beside how much it changes with other random numbers; over the mean."""
    rows = []
    chosen = {"cornell fog": 0.004, "Sponza with fog": 0.01}
    for name, scene, _ in scenes(content):
        if name not in chosen:
            continue
        for blur in ("true", "false"):
            frames = [bench.light(bench.scene(f"{name} moved {i}", moved(scene, i * chosen[name])), f"moved.{blur}", "--set", f"gi.surfels.blur={blur}")[0] for i in range(5)]
            still = bench.scene(f"{name} moved 0", moved(scene, 0.0))
            seeds = [bench.light(still, f"seed{seed}.{blur}", "--set", f"gi.surfels.blur={blur}", "--seed", seed)[0] for seed in range(1, 4)]
            # The relative difference of two pictures, as compare's relmse has it: |v - r|² over r² + 0.01 m².
            rms = lambda pairs: (sum(bench.compare(a, b)[0] for a, b in pairs) / len(pairs)) ** 0.5
            rows.append([name, "with blur" if blur == "true" else "without", f"{chosen[name] * 1000:g}", f"{rms(list(zip(frames[1:], frames))):.3f}",
                         f"{rms([(seeds[0], seeds[1]), (seeds[1], seeds[2]), (seeds[0], seeds[2])]):.3f}"])
    return table(["scene", "", "step, mm", "from frame to frame", "from seed to seed"], rows)


def main():
    parser = harness.parser(__doc__, "surfels", 3000, "bench-surfels")
    parser.add_argument("--scenes", default="")
    parser.add_argument("--qualities", default=",".join(QUALITIES))
    parser.add_argument("--references", action="store_true", help="render the references alone")
    arguments = parser.parse_args()
    content = harness.content_folder()
    bench = Bench(arguments)
    if arguments.references:
        for name, scene, fewer in harness.chosen(scenes(content), arguments.scenes):
            bench.reference(bench.scene(name, scene), fewer)
        return
    errors = errors_table(bench, content, arguments.scenes, arguments.qualities.split(","))
    arguments.page.write_text(f"""# Surfels: error and time

This page measures the error and the time of `--gi LSVE=surfels` by scene and quality, on {machine()} with llvmpipe; `tests/bench/surfels.py` makes it again from a release build.

Release build of {commit_date()}. A software driver rendered the frames: compare rows with each other, not with a GPU. The technique is explained in [surfels-explained.md](../techniques/surfels-explained.md).

## Error and time by scene
Light that surfaces scatter into media (`LSVE`) in pictures of {SIZE} pixels, against references of {arguments.spp} samples a pixel, four times as many for Sponza. relmse and energy ([compare.md](../compare.md)) are given for
one frame and for the average of 16; the noise of the reference is its own relmse. "lit" surfels are those that reflect light; "pairs" are those of a surfel and a ray that one of its shells reaches. The rows below
"ultra" change one thing of high quality: what lies between a surfel and a ray's intervals is asked for every one of them, not asked for at all, or in part; "printed" has the paper's equations.

{errors}
## The threshold
As in the paper's figure 11: ε at high quality, in one frame.

{threshold_table(bench, content, arguments.scenes)}
## The paper's configuration
Milliseconds for a box with fog at 800x600, with six levels, ε 0.06, 16 intervals and a ray for each pixel, beside the paper's Table 1. Its column for intervals has the coefficients too, that for the collection
unshuffling, blur and sum; ours for surfels has their light too.

{paper_table(bench)}
## What it costs
Of the box with fog, one thing changed at a time. Pairs at a level follow from ε alone: smaller surfels have smaller shells.

{cost_table(bench)}
## A moving camera
How much the picture changes from one frame to the next while the eye moves, and how much it changes from one seed to another in a frame that stands still: the square root of relmse. What moves in the picture changes
it too.

{motion_table(bench, content)}""")
    print(f"wrote {arguments.page}")


if __name__ == "__main__":
    main()
