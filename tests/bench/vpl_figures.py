#!/usr/bin/python3
"""Makes the figures of Engelhardt, Novák and Dachsbacher 2010 with virtual point lights: pictures in out/vpl-figures, tables in docs/measured/vpl-figures.md.

    tests/bench/vpl_figures.py [--build build/release] [--out out/vpl-figures] [--seeds 2] [--spp 4096]

Scenes are those of lpv.py. Those that need the shared content ($TYNDALL_CONTENT, else ../shared/content) are left out with a note where it is missing.
"""

import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import harness  # noqa: E402
from harness import MEDIA, SIZE, SURFACES, cornell, pair, smoke_room, sponza  # noqa: E402
from tables import commit_date, machine, table  # noqa: E402

FULL = {"surfaces.resolution": "full", "march": "full"}
WALKS = [32, 64, 128, 256, 512, 1024, 2048]
CONNECTIONS = 256  # of a ray with 256 walks: one point that gathers all of them, or 64 that gather every 64th
PAPER_LIGHTS = 1290  # in Sponza


class Figures(harness.Bench):
    def __init__(self, arguments):
        super().__init__(arguments)
        self.seeds = arguments.seeds

    def frame(self, scene, label, settings, seed=0):
        """One frame: its file, and its report."""
        path = self.beside(scene, f"{label}.{seed}.exr")
        options = [o for key, value in {**FULL, **settings}.items() for o in ("--set", f"gi.vpl.{key}={value}")]
        common = ["--size", SIZE, "--gi", "vpl", "--quality", "high", "--seed", seed, "--quiet", *options]
        self.run("capture", scene, "-o", path, "--aov", "terms", "--report", path.with_suffix(".json"), *common)
        if seed == 0:
            self.run("capture", scene, "-o", path.with_suffix(".png"), *common)
        return path, json.loads(path.with_suffix(".json").read_text())

    def errors(self, scene, reference, label, settings, *receivers):
        """relmse and energy for each of the receivers' terms: means over seeds. A picture of the first one, and of where it is off."""
        sums = [[0, 0] for _ in receivers]
        for seed in range(self.seeds):
            path, _ = self.frame(scene, label, settings, seed)
            if seed == 0:
                self.run("compare", path, reference, "--terms", receivers[-1], "--heatmap", path.with_suffix(".error.png"), "--heatmap-metric", "signed")
            for sum_, terms in zip(sums, receivers):
                for i, value in enumerate(self.compare(path, reference, terms)):
                    sum_[i] += value / self.seeds
        return sums


def bounds(figures, scene, reference):
    rows = []
    for clamp in (0.25, 0.5, 1, 2, 4):
        modes = [figures.errors(scene, reference, f"{mode}-{clamp}", {"compensation": mode, "clamp": clamp}, MEDIA)[0] for mode in ("clamped", "closed", "traced")]
        rows.append([f"{clamp}", *map(pair, modes)])
    return table(["clamp", "clamped", "closed", "traced"], rows)


def strategies(figures, scene, reference):
    """Noise of walks is most of one frame's: the second column has that of the points alone, against many points with the same walks."""
    whole = [figures.frame(scene, "all", {"samples": 256, "classes": 4, "walks": 256}, seed)[0] for seed in range(figures.seeds)]
    rows = []
    for classes in (1, 2, 4, 8, 16, 32, 64):
        label = f"classes-{classes}"
        samples = CONNECTIONS * classes // 256
        found = figures.errors(scene, reference, label, {"samples": samples, "classes": classes, "walks": 256}, MEDIA)[0]
        same = [figures.compare(all_.with_name(all_.name.replace(".all.", f".{label}.")), all_, MEDIA)[0] for all_ in whole]
        rows.append([f"{samples}", f"1/{classes}", pair(found), f"{sum(same) / len(same):.4f}"])
    return table(["points on a ray", "part of the walks at each", "against the reference: relmse, energy", "against all of the same walks: relmse"], rows)


def slope(errors):
    """Of log error over log walks, by least squares."""
    x, y = [math.log(w) for w in WALKS], [math.log(e) for e in errors]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def walks(figures, scene, reference):
    found = [figures.errors(scene, reference, f"walks-{w}", {"walks": w}, SURFACES, MEDIA) for w in WALKS]
    rows = [[f"{w}", *map(pair, f)] for w, f in zip(WALKS, found)]
    rows.append(["slope", *(f"{slope([f[i][0] for f in found]):.2f}" for i in (0, 1))])
    return table(["walks", "surfaces: relmse, energy", "media: relmse, energy"], rows)


def paper_row(figures, name, scene, reference, settings):
    _, report = figures.frame(scene, "paper", settings)
    surfaces, media = figures.errors(scene, reference, "paper", settings, SURFACES, MEDIA)
    return [name, str(settings["walks"]), f"{report['virtual_lights']['gi.vpl']:.0f}", pair(surfaces), pair(media), f"{report['frame_ms']['median']:.0f}"]


def papers(figures, content):
    rows = []
    if (content / "sponza/Sponza.gltf").exists():
        scene = figures.scene("Sponza with fog", sponza(content, False))
        _, report = figures.frame(scene, "search", {"walks": 256})
        count = max(1, round(256 * PAPER_LIGHTS / report["virtual_lights"]["gi.vpl"]))
        rows.append(paper_row(figures, "Sponza with fog", scene, figures.reference(scene, 4), {"walks": count}))
    else:
        print(f"note: '{content}' has no Sponza", file=sys.stderr)
    if (content / "vdb/smoke1.vdb").exists():
        scene = figures.scene("smoke in a room", smoke_room(content))
        rows.append(paper_row(figures, "smoke in a room", scene, figures.reference(scene, 2), {"walks": 500, "depthSide": 64}))
    return table(["scene", "walks", "virtual lights", "surfaces: relmse, energy", "media: relmse, energy", "first frame, ms"], rows)


def main():
    parser = harness.parser(__doc__, "vpl-figures", 4096, out="vpl-figures")
    parser.add_argument("--seeds", default=2, type=int)
    arguments = parser.parse_args()
    content = harness.content_folder()
    figures = Figures(arguments)
    fog = figures.scene("cornell fog, τ 2", cornell(2))
    truth = figures.reference(fog, 1)
    print("bounds", file=sys.stderr)
    compensation = f"Fog in a box, τ 2:\n\n{bounds(figures, fog, truth)}"
    if (content / "vdb/smoke1.vdb").exists():
        smoke = figures.scene("smoke in a room", smoke_room(content))
        compensation += f"\nSmoke in a room:\n\n{bounds(figures, smoke, figures.reference(smoke, 2))}"
    else:
        print(f"note: '{content}' has no smoke1.vdb", file=sys.stderr)
    print("strategies", file=sys.stderr)
    subsets = strategies(figures, fog, truth)
    print("walks", file=sys.stderr)
    counts = walks(figures, fog, truth)
    print("the paper's scenes", file=sys.stderr)
    scenes = papers(figures, content)
    arguments.page.write_text(f"""# Virtual point lights: the paper's figures

This page measures the paper's figures (Engelhardt, Novák and Dachsbacher 2010) with `--gi vpl`, on {machine()} with llvmpipe; `tests/bench/vpl_figures.py` makes it again from a release build.

Release build of {commit_date()}. The script also writes the pictures, and heat maps of the error in media (blue: too dark, red: too bright), into `out/vpl-figures`. The terms are explained in
[vpl-explained.md](../techniques/vpl-explained.md).

Each row is one frame of {SIZE} pixels in which every pixel and ray gathers on its own, with 256 walks unless the table says otherwise. The tables give relmse and energy ([compare.md](../compare.md)), means over {arguments.seeds} seeds, against a
reference of {arguments.spp} samples a pixel (half as many for the smoke, a quarter as many for Sponza).

## Clamping and compensation
Light in media, by compensation and `gi.vpl.clamp` (the clamping distance over the mean distance between lights): figure 7 of the paper, the error with compensation and without.

{compensation}
## Points along a ray and interleaved subsets
Light in media of fog in a box. A ray has {CONNECTIONS} connections to walks in every row: few points that gather all walks, or many points that each gather a subset (figure 4).

{subsets}
## Walks and error
Fog in a box. Noise of the walks alone would have the slope -1 in log error over log walks. The error of clamping shrinks as lights come closer together; the noise of the points along a ray stays.

{counts}
## The paper's scenes
Sponza with fog has as many lights as in the paper; the smoke has 500 walks. Optical depth from a light to a point comes from maps of 64² directions by 16 distances, where the paper marches 64 steps.

{scenes}""")
    print(f"wrote {arguments.page}")


if __name__ == "__main__":
    main()
