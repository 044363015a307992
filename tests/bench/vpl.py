#!/usr/bin/python3
"""Measures virtual point lights against the reference and writes the tables of docs/measured/vpl.md.

    tests/bench/vpl.py [--build build/release] [--out out/bench-lpv] [--scenes NAME,...] [--frames 32] [--spp 4096]

Scenes and references are those of lpv.py, and are kept in the same folder. Scenes that need the shared content ($TYNDALL_CONTENT, else ../shared/content)
are left out with a note where it is missing.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import harness  # noqa: E402
from harness import MEDIA, SIZE, SURFACES, cornell, load, milliseconds, scenes  # noqa: E402
from tables import ROOT, commit_date, machine, table  # noqa: E402

GATHERING = ("gi.vpl.surfaces", "gi.vpl.upsampleSurfaces", "gi.vpl.refineSurfaces"), ("gi.vpl.march", "gi.vpl.upsample", "gi.vpl.refine")
WALKS = (64, 128, 256, 512, 1024)
CANDIDATES = (1, 2, 4, 8, 16)
FINE = "512x288"  # of a single frame: outlines of the reference are averages, and so have its pixels to be; direct light at 256x144 has 0.036 of squared error in Sponza for that alone
LONGER = {"cornell fog, τ 8": 2, "smoke in a room": 2, "Sponza with fog": 4, "cloud": 2}  # times as many frames, where they are needed


def capture(bench, scene, label, *options, quality="high", size=SIZE):
    return bench.capture(scene, f"vpl.{label}.exr", "--gi", "vpl", "--quality", quality, *options, size=size)


def cloud(haze):
    """The sample's, with its file named from anywhere."""
    scene = load("content/cloud.scene.json")
    scene["nodes"] = [node for node in scene["nodes"] if haze or node["name"] != "haze"]
    for node in scene["nodes"]:
        if "file" in node.get("medium", {}):
            node["medium"]["file"] = str(ROOT / "content" / node["medium"]["file"])
    return scene


def errors_table(bench, content, wanted, frames):
    head = ["scene", "high, one frame: surfaces", "media", "picture", "ultra, frames", "surfaces", "media", "picture", "reference's own noise: surfaces", "media"]
    rows = []
    candidates = [("cornell, no fog", load("content/cornell.scene.json"), 1), *scenes(content), ("cloud", cloud(False), 1 / 4), ("cloud in haze", cloud(True), 1 / 4)]
    for name, scene, fewer in harness.chosen(candidates, wanted):
        path = bench.scene(name, scene)
        reference = bench.reference(path, fewer)
        noise = lambda terms: f"{bench.noise(path, reference, fewer, terms):.3f}"
        one, _ = capture(bench, path, "one", "--frames", 2, size=FINE)
        count = frames * LONGER.get(name, 1)
        many, _ = capture(bench, path, "many", "--converge", "--frames", count, quality="ultra")
        fog = any("medium" in node for node in scene["nodes"])
        solid = "cloud" not in name
        cells = lambda picture, *options: [bench.errors(picture, reference, terms, *options) if there else "" for terms, there in ((SURFACES, solid), (MEDIA, fog), (None, True))]
        rows.append([name, *cells(one, "--reduce"), str(count), *cells(many), noise(SURFACES) if solid else "", noise(MEDIA) if fog else ""])
    return table(head, rows)


def costs_table(bench):
    """Milliseconds of one frame in which everything is made anew, by the number of walks."""
    path = bench.scene("cornell fog, τ 2", cornell(2))
    head = ["walks", "virtual lights", "walks, ms", "maps, ms", "surfaces, ms", "media, ms", "surfaces, ns per light and square", "media, ns per light and ray"]
    width, height = map(int, SIZE.split("x"))
    rows = []
    for walks in WALKS:
        _, report = capture(bench, path, f"cost{walks}", "--frames", 2, "--set", f"gi.vpl.walks={walks}", "--set", "gi.vpl.classes=8", "--set", "gi.vpl.keep=false",
                            "--set", "gi.vpl.compensation=clamped", "--set", "gi.vpl.samples=8")
        lights = report["virtual_lights"]["gi.vpl"]
        surfaces, media = (milliseconds(report, name) for name in ("gi.vpl.surfaces", "gi.vpl.march"))
        squares = width * height / 4
        rows.append([str(walks), str(lights), f"{report['walks_ms']['gi.vpl']:.1f}", f"{report['maps_ms']['gi.vpl']:.0f}", f"{surfaces:.0f}", f"{media:.0f}",
                     f"{1e6 * surfaces / lights / squares:.0f}", f"{1e6 * media / lights / squares:.0f}"])
    return table(head, rows)


def choice_table(bench, content):
    """The same number of lights gathered, chosen among more and more."""
    found = [(name, scene, fewer) for name, scene, fewer in scenes(content) if name in ("cornell fog, τ 8", "Sponza with fog")]
    head = ["scene", "candidates", "lights a frame", "walks, ms", "choice, ms", "maps, ms", "gathering, ms", "surfaces: relmse", "media: relmse", "", "as many walks, all gathered: ms", "surfaces: relmse", "media: relmse"]
    rows = []
    for name, scene, fewer in found:
        path = bench.scene(name, scene)
        reference = bench.reference(path, fewer)
        base = ["--converge", "--frames", 8, "--set", "gi.vpl.march=quarter"]
        for n in CANDIDATES:
            chosen, report = capture(bench, path, f"choice{n}", *base, "--set", f"gi.vpl.candidates={n}")
            gathered = sum(milliseconds(report, *names) for names in GATHERING)
            of = lambda key, r: r[key]["gi.vpl"]
            row = [name, str(n), str(of("virtual_lights", report)), f"{of('walks_ms', report):.1f}", f"{of('choice_ms', report):.0f}", f"{of('maps_ms', report):.0f}", f"{gathered:.0f}",
                   *(f"{bench.compare(chosen, reference, terms)[0]:.4f}" for terms in (SURFACES, MEDIA)), ""]
            if n <= 4:
                every, report = capture(bench, path, f"every{n}", *base, "--set", f"gi.vpl.walks={256 * n}", "--set", "gi.vpl.candidates=1", "--set", "gi.vpl.classes=8")
                total = sum(milliseconds(report, *names) for names in GATHERING) + of("walks_ms", report) + of("maps_ms", report)
                row += [f"{total:.0f}", *(f"{bench.compare(every, reference, terms)[0]:.4f}" for terms in (SURFACES, MEDIA))]
            else:
                row += ["", "", ""]
            rows.append(row)
    return table(head, rows)


def modes_table(bench, content, wanted):
    """The method as printed beside the corrected one: averages of 16 frames at medium quality."""
    rows = []
    candidates = [("cornell, no fog", load("content/cornell.scene.json"), 1), ("cornell fog, τ 2", cornell(2), 1), ("cornell fog, τ 8", cornell(8), 8), ("cloud", cloud(False), 1 / 4)]
    for name, scene, fewer in harness.chosen(candidates, wanted):
        path = bench.scene(name, scene)
        reference = bench.reference(path, fewer)
        row = [name]
        for mode in ("corrected", "paper"):
            picture, _ = capture(bench, path, f"mode.{mode}", "--converge", "--frames", 16, "--set", f"gi.mode={mode}", quality="medium")
            row += [bench.errors(picture, reference, SURFACES) if name != "cloud" else "", bench.errors(picture, reference, MEDIA) if name != "cornell, no fog" else ""]
        rows.append(row)
    return table(["scene", "corrected: surfaces", "media", "as printed: surfaces", "media"], rows)


def main():
    parser = harness.parser(__doc__, "vpl", 4096)
    parser.add_argument("--scenes", default="")
    parser.add_argument("--frames", default=32, type=int)
    parser.add_argument("--modes", action="store_true", help="print the table of gi.mode, and measure nothing else")
    arguments = parser.parse_args()
    content = harness.content_folder()
    bench = harness.Bench(arguments)
    modes = modes_table(bench, content, arguments.scenes)
    if arguments.modes:
        return print(modes)
    errors = errors_table(bench, content, arguments.scenes, arguments.frames)
    costs, choice = costs_table(bench), choice_table(bench, content)
    arguments.page.write_text(f"""# Virtual point lights: error and time

This page measures the error, the cost and the choice of lights of `--gi vpl`, on {machine()} with llvmpipe; `tests/bench/vpl.py` makes it again from a release build.

Release build of {commit_date()}. A software driver rendered the frames: compare rows with each other, not with a GPU. The technique is explained in [vpl-explained.md](../techniques/vpl-explained.md); the paper's
figures are in [vpl-figures.md](vpl-figures.md), the laws that it obeys in [vpl-laws.md](vpl-laws.md).

## Error
relmse and energy ([compare.md](../compare.md)) of the indirect terms on surfaces, of the indirect terms in media, and of the whole picture. The reference has {SIZE} pixels and {arguments.spp} samples a pixel, half as many for the smoke,
eight times as many for fog of τ 8, four times as many for Sponza and the cloud.

- One frame is rendered at {FINE} pixels, and averages of 8x8 of them are compared (`tyndall compare --reduce`). A frame of {SIZE} has one sample a pixel: its aliased outlines alone are a squared error of 0.05.
- Ultra is an average of frames of {SIZE} with new walks in each.
- The reference's own noise is measured against a second reference with another seed. An error below it cannot be distinguished from 0.

{errors}
## As printed and corrected
Averages of 16 frames of {SIZE} at medium quality with `gi.mode` `corrected` and `paper`; relmse and energy as above.

{modes}
## Cost
One frame of the box with fog, τ 2, at high quality. Walks and maps are made again in this frame. Media are gathered at 8 points a ray, one walk in 8 at each, without compensation. Each phase takes time in proportion to the number of lights.

{costs}
## Choice
Averages of 8 frames with the lights of 256 walks, chosen from `gi.vpl.candidates` times as many walks. In the columns on the right all lights of the candidates are gathered instead. Milliseconds are those of one frame.

{choice}""")
    print(f"wrote {arguments.page}")


if __name__ == "__main__":
    main()
