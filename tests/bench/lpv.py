#!/usr/bin/python3
"""Measures the light propagation volumes against the reference and writes the tables of docs/measured/lpv.md.

    tests/bench/lpv.py [--build build/release] [--out out/bench-lpv] [--scenes NAME,...] [--qualities low,medium,high,ultra] [--spp 1024]

Scenes that need the shared content ($TYNDALL_CONTENT, else ../shared/content) are left out with a note where it is missing. References and
reports are kept in the folder --out: what is there is not made again.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import harness  # noqa: E402
from harness import MEDIA, SIZE, SURFACES, milliseconds, scenes, sponza  # noqa: E402
from tables import commit_date, machine, table  # noqa: E402

# At ultra light in a cube of 64³ cells takes some 300 steps to settle: minutes a frame on llvmpipe. Of four such scenes one will do.
ULTRA = ("cornell fog, τ 2", "fog hall", "Sponza with fog")
FRAMES = 32  # averaged: a pixel of one frame has one ray, and that of a curtain with dots says little about the curtain


def capture(bench, scene, label, *options):
    """An average of frames, and the report of another picture's second frame, in which all light is found anew."""
    picture, _ = bench.capture(scene, f"{label}.average.exr", "--converge", "--frames", FRAMES, *options)
    _, report = bench.capture(scene, f"{label}.png", "--frames", 2, "--set", "gi.lpv.keep=false", *options)
    return picture, report


def errors_table(bench, content, wanted, qualities):
    head = ["scene", "technique", "surfaces: relmse, energy", "media: relmse, energy", "picture: relmse, energy", "lattices", "steps", "frame, ms",
            "maps and injection, ms", "propagation, ms", "surfaces and march, ms"]
    rows = []
    for name, scene, fewer in harness.chosen(scenes(content), wanted):
        path = bench.scene(name, scene)
        reference = bench.reference(path, fewer)
        for label, options in [("none", ["--gi", "none"]), ("octaves", ["--gi", "octaves"])] + [
                (q, ["--gi", "lpv", "--quality", q]) for q in qualities if q != "ultra" or name in ULTRA] + [
                ("paper", ["--gi", "lpv", "--quality", "high", "--set", "gi.mode=paper", "--set", "gi.lpv.steps=8"])]:
            print(f"  {label}", file=sys.stderr)
            picture, report = capture(bench, path, label, *options)
            errors = lambda terms=None: bench.errors(picture, reference, terms)
            row = [name, label if label in ("none", "octaves") else f"lpv, {label}"]
            if label in ("none", "octaves"):
                row += ["", "", errors(), "", "", f"{report['frame_ms']['median']:.0f}", "", "", ""]
            else:
                steps = {k: v for k, v in report["iterations"].items() if k.startswith("gi.lpv")}
                row += [errors(SURFACES), errors(MEDIA), errors(), str(len(steps)), " + ".join(str(v) for v in reversed(list(steps.values()))),
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
            _, report = bench.capture(path, f"{mode}{cells}.png", "--frames", 2, "--gi", "lpv", "--quality", "high", "--set", f"gi.lpv.resolution={cells}",
                                      "--set", "gi.lpv.rsmSize=256", "--set", "gi.lpv.steps=8", "--set", "gi.lpv.cascades=1", "--set", "gi.lpv.keep=false",
                                      "--set", f"gi.mode={mode}", size="1280x720")
            ms = lambda *names: f"{milliseconds(report, *names):.1f}"
            rows.append([f"{cells}, {mode}", ms("gi.rsm"), ms("gi.lpv.clear", "gi.lpv.inject", "gi.lpv.collect"), ms("gi.lpv.medium", "gi.lpv.links"),
                         ms("gi.lpv.propagate", "gi.lpv.printed"), ms("gi.lpv.resolve"), ms("gi.lpv.surfaces"), ms("gi.lpv.march", "gi.lpv.upsample")])
        p = dict(PAPER[cells])
        rows.append([f"{cells}, the paper's", "", f"{p['reflected light in'] + p['scattered light in']:.2f}", f"{p['blockers'] + p['preparation']:.2f}",
                     f"{p['eight steps']:.2f}", f"{p['copies']:.2f}", "1.7", "14"])
    return table(["cells along the hall", "maps", "injection", "blocked links, media", "eight steps", "fluence of cells", "on surfaces", "march and upsampling"], rows)


def main():
    parser = harness.parser(__doc__, "lpv", 1024)
    parser.add_argument("--scenes", default="")
    parser.add_argument("--qualities", default="low,medium,high,ultra")
    parser.add_argument("--references", action="store_true", help="render the references alone")
    arguments = parser.parse_args()
    content = harness.content_folder()
    bench = harness.Bench(arguments)
    if arguments.references:
        for name, scene, fewer in harness.chosen(scenes(content), arguments.scenes):
            bench.reference(bench.scene(name, scene), fewer)
        return
    errors = errors_table(bench, content, arguments.scenes, arguments.qualities.split(","))
    arguments.page.write_text(f"""# Light propagation volumes: error and time

This page measures the error and the frame time of `--gi lpv` by scene and quality, on {machine()} with llvmpipe; `tests/bench/lpv.py` makes it again from a release build.

Release build of {commit_date()}. A software driver rendered the frames: compare rows with each other, not with a GPU. The technique is explained in [lpv-explained.md](../techniques/lpv-explained.md); the
laws that it obeys are measured in [lpv-laws.md](lpv-laws.md).

## Error and time by scene
Pictures are averages of {FRAMES} frames of {SIZE} pixels. The reference has {arguments.spp} samples a pixel, half as many for the smoke, eight times as many for fog of τ 8, four times as many for Sponza. relmse and energy
([compare.md](../compare.md)) are given for the indirect terms on surfaces, for the indirect terms in media, and for the whole picture. "none" is direct light alone, "octaves" is the baseline, and "paper" is the printed
scheme with eight steps. Milliseconds are those of one frame that propagates all light again (`gi.lpv.keep=false`). Media and blocked links are cached, as in any scene where nothing moves.

{errors}
## The paper's configuration
Milliseconds for Sponza with fog at 1280x720, with reflective shadow maps of 256² and eight steps, beside those of Billeter, Sintorn and Assarsson 2012 (Table 1, GeForce GTX 480). The engine
caches blocked links while nothing moves, so their column has what a still scene pays. One ray is marched for 2x2 pixels (`gi.lpv.march`).

{paper_table(bench, content)}""")
    print(f"wrote {arguments.page}")


if __name__ == "__main__":
    main()
