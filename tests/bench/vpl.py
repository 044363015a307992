#!/usr/bin/python3
"""Measures virtual point lights against the reference and writes the tables of docs/benchmarks-vpl.md.

    tests/bench/vpl.py [--build build/release] [--out out/bench-lpv] [--scenes NAME,...] [--frames 48] [--spp 4096]

Scenes and references are those of lpv.py, and are kept in the same folder. Scenes that need the shared content ($TYNDALL_CONTENT, else ../shared/content)
are left out with a note where it is missing.
"""

import argparse
import json
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from lpv import MEDIA, SIZE, SURFACES, Bench, load, milliseconds, scenes  # noqa: E402
from tables import ROOT, commit_date, machine, table  # noqa: E402

FULL = ["--set", "gi.vpl.surfaces.resolution=full", "--set", "gi.vpl.march=full"]
GATHERING = ("gi.vpl.surfaces", "gi.vpl.upsampleSurfaces", "gi.vpl.march", "gi.vpl.upsample")


class VplBench(Bench):
    def picture(self, scene, label, *options):
        """A picture and its report, made anew only where it is missing."""
        path = scene.with_name(scene.name.replace(".scene.json", f".vpl.{label}.exr"))
        report = path.with_suffix(".json")
        if not report.exists():
            self.run("capture", scene, "-o", path, "--size", SIZE, "--aov", "terms", "--gi", "vpl", "--quality", "high", "--report", report, "--quiet", *options)
        return path, json.loads(report.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--out", default=ROOT / "out/bench-lpv", type=pathlib.Path)
    parser.add_argument("--scenes", default="")
    parser.add_argument("--frames", default=48, type=int)
    parser.add_argument("--spp", default=4096, type=int)
    parser.add_argument("--page", default=ROOT / "docs/benchmarks-vpl.md", type=pathlib.Path)
    arguments = parser.parse_args()
    content = pathlib.Path(os.environ.get("TYNDALL_CONTENT", ROOT.parent / "shared/content"))
    bench = VplBench(arguments)
    wanted = [w for w in arguments.scenes.split(",") if w]
    rows = []
    for name, scene, fewer in [("cornell, no fog", load("content/cornell.scene.json"), 1), *scenes(content)]:
        if wanted and not any(w in name for w in wanted):
            continue
        print(name, file=sys.stderr)
        path = bench.scene(name, scene)
        reference = bench.reference(path, fewer)
        one, report = bench.picture(path, "one", "--frames", 2)
        many, _ = bench.picture(path, "many", "--converge", "--frames", arguments.frames, *FULL)
        fog = any("medium" in node for node in scene["nodes"])
        pair = lambda picture, terms: "{:.3f}, {:.3f}".format(*bench.compare(picture, reference, terms))
        media = lambda picture: pair(picture, MEDIA) if fog else ""
        rows.append([name, pair(one, SURFACES), media(one), pair(many, SURFACES), media(many),
                     f"{milliseconds(report, *GATHERING[:2]):.0f}", f"{milliseconds(report, *GATHERING[2:]):.0f}"])
    head = ["scene", "one frame, surfaces", "one frame, media", f"{arguments.frames} frames, surfaces", f"{arguments.frames} frames, media", "surfaces, ms", "media, ms"]
    arguments.page.write_text(f"""# Virtual point lights: error and time

Made by `tests/bench/vpl.py` from a release build of {commit_date()}, on {machine()} with llvmpipe: a GPU is another world.
What the columns mean and why the numbers are what they are: [techniques/vpl.md](techniques/vpl.md).

{SIZE} pixels at high quality, against the reference ({arguments.spp} samples a pixel, half as many for the smoke and a quarter for Sponza): relmse and energy ([compare.md](compare.md)) of the
indirect terms on surfaces and of those in media. "{arguments.frames} frames": an average, every pixel and ray on its own, with new walks in each frame. Milliseconds are those of gathering in one
frame in which walks and maps are kept.

{table(head, rows)}""")
    print(f"wrote {arguments.page}")


if __name__ == "__main__":
    main()
