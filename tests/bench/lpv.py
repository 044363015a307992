#!/usr/bin/python3
"""Measures the light propagation volumes against the reference and writes the tables of docs/benchmarks-lpv.md.

    tests/bench/lpv.py [--build build/release] [--out out/bench-lpv] [--scenes NAME,...] [--qualities low,medium,high,ultra] [--spp 1024]

Scenes that need the shared content ($TYNDALL_CONTENT, else ../shared/content) are left out with a note where it is missing. References and
reports are kept in the folder --out: what is there is not made again.
"""

import argparse
import copy
import json
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from tables import ROOT, commit_date, machine, table  # noqa: E402

SURFACES, MEDIA = "LSSE,LVSE,LXSSE,LXVSE", "LSVE,LVVE,LXSVE,LXVVE"
SIZE = "64x36"
# At ultra light in a cube of 64³ cells takes some 300 steps to settle: minutes a frame on llvmpipe. Of four such scenes one will do.
ULTRA = ("cornell fog, τ 2", "fog hall", "Sponza with fog")
FRAMES = 32  # averaged: a pixel of one frame has one ray, and that of a curtain with dots says little about the curtain


def load(path):
    return json.loads((ROOT / path).read_text())


def cornell(depth):
    """The box with fog of this optical depth from wall to wall."""
    scene = load("content/cornell_fog.scene.json")
    for node in scene["nodes"]:
        if "medium" in node:
            scale = depth / (1.99 * 0.47)
            for kind in ("scattering", "absorption"):
                node["medium"][kind] = [scale * value for value in node["medium"][kind]]
    return scene


def smoke_room(content):
    scene = load("content/cornell.scene.json")
    scene["nodes"] = [node for node in scene["nodes"] if "block" not in node["name"]]
    scene["nodes"].append({"name": "smoke", "scale": [0.012] * 3, "translation": [0, 0.15, 0],
                           "medium": {"type": "grid", "file": str(content / "vdb/smoke1.vdb"), "scattering": [12] * 3, "absorption": [1.2] * 3}})
    return scene


def sponza(content, smoke):
    text = (ROOT / "tests/scenes/sponza_fog_smoke.scene.json").read_text()
    scene = json.loads(text.replace("@CONTENT@", str(content)))
    if not smoke:
        scene["nodes"] = [node for node in scene["nodes"] if node["name"] != "smoke"]
    return scene


def scenes(content):
    """Name, scene, and how many times fewer samples its reference gets."""
    for depth in (0.5, 2, 8):
        yield f"cornell fog, τ {depth}", cornell(depth), 1 if depth < 8 else 1 / 8
    yield "fog hall", load("content/fog_hall.scene.json"), 1
    if (content / "vdb/smoke1.vdb").exists():
        yield "smoke in a room", smoke_room(content), 2
    else:
        print(f"note: '{content}' has no smoke1.vdb", file=sys.stderr)
    if (content / "sponza/Sponza.gltf").exists():
        yield "Sponza with fog", sponza(content, False), 1 / 4
    else:
        print(f"note: '{content}' has no Sponza", file=sys.stderr)


class Bench:
    def __init__(self, arguments):
        self.program = arguments.build / "bin/tyndall"
        self.out = arguments.out
        self.spp = arguments.spp
        self.out.mkdir(parents=True, exist_ok=True)

    def run(self, *command):
        return subprocess.run([self.program, *map(str, command)], check=True, capture_output=True, text=True).stdout

    def scene(self, name, scene):
        path = self.out / (re.sub(r"\W+", "-", name) + ".scene.json")
        text = json.dumps(scene)
        if not path.exists() or path.read_text() != text:
            path.write_text(text)
            for old in self.out.glob(path.name.split(".")[0] + ".*.*"):
                if old != path:
                    old.unlink()
        return path

    def reference(self, scene, fewer):
        path = scene.with_name(scene.name.replace(".scene.json", ".reference.exr"))
        if not path.exists():
            self.run("reference", scene, "-o", path, "--size", SIZE, "--spp", max(int(self.spp / fewer), 16), "--quiet")
        return path

    def capture(self, scene, label, *options):
        """A picture, and the report of another's second frame, in which all light is found anew."""
        path = scene.with_name(scene.name.replace(".scene.json", f".{label}.average.exr"))
        if not path.exists():
            self.run("capture", scene, "-o", path, "--size", SIZE, "--aov", "terms", "--converge", "--frames", FRAMES, "--quiet", *options)
        report = scene.with_name(scene.name.replace(".scene.json", f".{label}.json"))
        if not report.exists():
            self.run("capture", scene, "-o", report.with_suffix(".png"), "--size", SIZE, "--frames", 2, "--set", "gi.lpv.keep=false", "--report", report,
                     "--quiet", *options)
        return path, json.loads(report.read_text())

    def compare(self, picture, reference, terms=None, *options):
        """relmse and energy; against all of the picture where no terms are named."""
        text = self.run("compare", picture, reference, *(["--terms", terms] if terms else []), *options)
        found = dict(re.findall(r"^ *(\w+)\s+([-+.\dinfa]+)\s*$", text, re.M))
        return float(found["relmse"]), float(found["energy"])


def milliseconds(report, *names):
    return sum(p.get("gpu_ms") or 0 for p in report["passes"] if p["status"] == "ran" and p["name"] in names)


def errors_table(bench, content, wanted, qualities):
    head = ["scene", "technique", "surfaces: relmse, energy", "media: relmse, energy", "picture: relmse, energy", "lattices", "steps", "frame, ms",
            "maps and injection, ms", "propagation, ms", "look-ups, ms"]
    rows = []
    for name, scene, fewer in scenes(content):
        if wanted and not any(w in name for w in wanted):
            continue
        path = bench.scene(name, scene)
        print(name, file=sys.stderr)
        reference = bench.reference(path, fewer)
        for label, options in [("none", ["--gi", "none"]), ("octaves", ["--gi", "octaves"])] + [
                (q, ["--gi", "lpv", "--quality", q]) for q in qualities if q != "ultra" or name in ULTRA] + [
                ("paper", ["--gi", "lpv", "--quality", "high", "--set", "gi.mode=paper", "--set", "gi.lpv.steps=8"])]:
            print(f"  {label}", file=sys.stderr)
            picture, report = bench.capture(path, label, *options)
            pair = lambda terms=None: "{:.3f}, {:.3f}".format(*bench.compare(picture, reference, terms))
            row = [name, label if label in ("none", "octaves") else f"lpv, {label}"]
            if label in ("none", "octaves"):
                row += ["", "", pair(), "", "", f"{report['frame_ms']['median']:.0f}", "", "", ""]
            else:
                steps = {k: v for k, v in report["iterations"].items() if k.startswith("gi.lpv")}
                row += [pair(SURFACES), pair(MEDIA), pair(), str(len(steps)), " + ".join(str(v) for v in reversed(list(steps.values()))),
                        f"{report['frame_ms']['median']:.0f}", f"{milliseconds(report, 'gi.rsm', 'gi.lpv.clear', 'gi.lpv.inject', 'gi.lpv.collect'):.0f}",
                        f"{milliseconds(report, 'gi.lpv.inflow', 'gi.lpv.propagate', 'gi.lpv.printed', 'gi.lpv.resolve'):.0f}",
                        f"{milliseconds(report, 'gi.lpv.surfaces', 'gi.lpv.march', 'gi.lpv.upsample'):.0f}"]
            rows.append(row)
    return table(head, rows)


# Table 1 of the paper: milliseconds on a GeForce GTX 480, its rows named as in the text (transport.md, 5.4).
PAPER = {32: [("reflected light in", 0.87), ("blockers", 4.5), ("scattered light in", 0.47), ("preparation", 0.42), ("eight steps", 1.49), ("copies", 0.18)],
         64: [("reflected light in", 0.84), ("blockers", 3.9), ("scattered light in", 0.58), ("preparation", 2.96), ("eight steps", 12.3), ("copies", 1.24)]}


def paper_table(bench, content):
    """The paper's configuration: Sponza at 1280x720, a map of 256², cubic lattices, eight steps."""
    if not (content / "sponza/Sponza.gltf").exists():
        return "Sponza is missing.\n"
    path = bench.scene("paper", sponza(content, False))
    rows = []
    for cells in (32, 64):
        for mode in ("paper", "corrected"):
            target = path.with_name(f"paper.{mode}{cells}.json")
            if not target.exists():
                bench.run("capture", path, "-o", target.with_suffix(".png"), "--size", "1280x720", "--frames", 2, "--gi", "lpv", "--quality", "high",
                          "--set", f"gi.lpv.resolution={cells}", "--set", "gi.lpv.rsmSize=256", "--set", "gi.lpv.steps=8", "--set", "gi.lpv.cascades=1",
                          "--set", "gi.lpv.keep=false", "--set", f"gi.mode={mode}", "--report", target, "--quiet")
            report = json.loads(target.read_text())
            ms = lambda *names: f"{milliseconds(report, *names):.1f}"
            rows.append([f"{cells}, {mode}", ms("gi.rsm"), ms("gi.lpv.clear", "gi.lpv.inject", "gi.lpv.collect"), ms("gi.lpv.medium", "gi.lpv.links"),
                         ms("gi.lpv.propagate", "gi.lpv.printed"), ms("gi.lpv.resolve"), ms("gi.lpv.surfaces"), ms("gi.lpv.march", "gi.lpv.upsample")])
        p = dict(PAPER[cells])
        rows.append([f"{cells}, the paper's", "", f"{p['reflected light in'] + p['scattered light in']:.2f}", f"{p['blockers'] + p['preparation']:.2f}",
                     f"{p['eight steps']:.2f}", f"{p['copies']:.2f}", "1.7", "14"])
    return table(["cells along the hall", "maps", "injection", "blockers, media", "eight steps", "light of cells", "on surfaces", "march and upsampling"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--out", default=ROOT / "out/bench-lpv", type=pathlib.Path)
    parser.add_argument("--scenes", default="")
    parser.add_argument("--qualities", default="low,medium,high,ultra")
    parser.add_argument("--spp", default=1024, type=int)
    parser.add_argument("--page", default=ROOT / "docs/benchmarks-lpv.md", type=pathlib.Path)
    parser.add_argument("--references", action="store_true", help="render the references alone")
    arguments = parser.parse_args()
    content = pathlib.Path(os.environ.get("TYNDALL_CONTENT", ROOT.parent / "shared/content"))
    bench = Bench(arguments)
    if arguments.references:
        for name, scene, fewer in scenes(content):
            print(name, file=sys.stderr)
            bench.reference(bench.scene(name, scene), fewer)
        return
    errors = errors_table(bench, content, [w for w in arguments.scenes.split(",") if w], arguments.qualities.split(","))
    arguments.page.write_text(f"""# Light propagation volumes: error and time

Made by `tests/bench/lpv.py` from a release build of {commit_date()}, on {machine()} with llvmpipe: a GPU is another world.
What the columns mean and why the numbers are what they are: [techniques/lpv.md](techniques/lpv.md).

## Error and time by scene
{SIZE} pixels, averages of {FRAMES} frames, against the reference ({arguments.spp} samples a pixel, half as many for the smoke, eight times as many for fog of τ 8, four times for Sponza). relmse and energy are those of [compare.md](compare.md):
of the indirect terms on surfaces, of those in media, and of the whole picture. "none" has direct light alone, "octaves" is the baseline, "paper" the printed scheme with eight steps.
Milliseconds are those of a frame in which all light is found anew (`gi.lpv.keep=false`), but not media and blockers, which are kept while nothing moves.

{errors}
## The paper's configuration
Sponza with fog at 1280x720, reflective shadow maps of 256², eight steps (Billeter, Sintorn and Assarsson 2012, Table 1, on a GeForce GTX 480). Milliseconds; blockers are kept while nothing
moves, so that their column has what a still scene pays. Light in media is marched for squares of 2x2 pixels (`gi.lpv.march`).

{paper_table(bench, content)}""")
    print(f"wrote {arguments.page}")


if __name__ == "__main__":
    main()
