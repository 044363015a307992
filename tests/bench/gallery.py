#!/usr/bin/python3
"""Renders the pictures of the README's gallery and writes its rows.

    tests/bench/gallery.py [--build build/release] [--out out/gallery] [--scenes NAME,...] [--spp 1024]

Each picture is 960x540, made by the command that stands beside it. Its error is that of the same command at 240x135 against the reference. Pictures go
to docs/images/gallery as JPEG (by ImageMagick); the rows go between the two marks in README.md.
"""

import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import harness  # noqa: E402
from tables import ROOT  # noqa: E402

FOLDER = ROOT / "docs/images/gallery"
MARKS = "<!-- gallery -->", "<!-- /gallery -->"
# Name, scene, further options, what is seen.
PICTURES = [
    ("hall", "content/demo.scene.json", [], "sun and sky through windows into a hazy hall, one frame"),
    ("fire", "content/campfire.scene.json", ["--converge", "--frames", "16"], "a fire that lights its own smoke, 16 frames"),
    ("cloud", "content/cloud.scene.json", ["--converge", "--frames", "16"], "a cloud over a landscape, 16 frames"),
    ("box", "content/cornell_fog.scene.json", [], "a box full of fog, one frame"),
    ("particles", "content/particles.scene.json", ["--converge", "--frames", "16"], "a cloud of particles, 16 frames"),
    ("puff", "content/smoke_puff.vdb", [], "a bare volume, one frame"),
]


def main():
    parser = harness.parser(__doc__, "gallery", 1024, out="gallery")
    parser.add_argument("--scenes", default="")
    arguments = parser.parse_args()
    bench = harness.Bench(arguments)
    FOLDER.mkdir(parents=True, exist_ok=True)
    rows = []
    for name, scene, options, text in harness.chosen(PICTURES, arguments.scenes):
        command = ["capture", scene, "-o", f"out/gallery/{name}.png", "--size", "960x540", *options]
        subprocess.run([bench.program, *command, "--quiet"], check=True, cwd=ROOT)
        subprocess.run(["convert", ROOT / f"out/gallery/{name}.png", "-quality", "90", FOLDER / f"{name}.jpg"], check=True)
        small, reference = bench.out / f"{name}.exr", bench.out / f"{name}.reference.exr"
        subprocess.run([bench.program, "capture", scene, "-o", small, "--size", "240x135", *options, "--quiet"], check=True, cwd=ROOT)
        if not reference.exists():
            subprocess.run([bench.program, "reference", scene, "-o", reference, "--size", "240x135", "--spp", str(bench.spp), "--quiet"], check=True, cwd=ROOT)
        error, energy = bench.compare(small, reference)
        rows.append(f"![{text}](docs/images/gallery/{name}.jpg)\n\n{text[0].upper()}{text[1:]}: relmse {error:.3f}, {100 * energy:.0f} % of the reference's light.\n"
                    f"`tyndall {' '.join(command)}`\n")
    readme = ROOT / "README.md"
    pattern = re.compile(re.escape(MARKS[0]) + ".*?" + re.escape(MARKS[1]), re.S)
    readme.write_text(pattern.sub(lambda _: "\n".join([MARKS[0], *rows, MARKS[1]]), readme.read_text()))
    print("wrote README.md")


if __name__ == "__main__":
    main()
