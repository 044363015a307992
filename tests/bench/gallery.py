#!/usr/bin/python3
"""Renders the pictures of the README's gallery and writes its rows.

    tests/bench/gallery.py [--build build/release] [--out out/gallery] [--scenes NAME,...] [--spp 512]

Each picture is one frame of 960x540 without any setting, made by the command that stands beside it. Its error is that of the same command at 240x135 against the reference. Pictures go
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
# Name, scene, what is seen.
PICTURES = [
    ("hall", "content/demo.scene.json", "sun and sky through windows into a hazy hall"),
    ("fire", "content/campfire.scene.json", "a fire that lights its own smoke"),
    ("cloud", "content/cloud.scene.json", "a cloud and the shaft of its shadow in the haze"),
    ("box", "content/cornell_fog.scene.json", "a box full of fog"),
    ("particles", "content/particles.scene.json", "a cloud of particles"),
    ("puff", "content/smoke_puff.vdb", "a bare volume; camera, light and medium are supplied"),
]


def rows_of(page):
    """Of each picture that the page has."""
    found = re.findall(r"([^\n]+\n`[^\n]+`\n\n!\[[^\n]*\]\([^\n]*/(\w+)\.jpg\)\n)", page)
    return {name: row for row, name in found}


def main():
    parser = harness.parser(__doc__, "gallery", 512, out="gallery")
    parser.add_argument("--scenes", default="")
    arguments = parser.parse_args()
    bench = harness.Bench(arguments)
    FOLDER.mkdir(parents=True, exist_ok=True)
    (ROOT / "out").mkdir(exist_ok=True)
    readme = ROOT / "README.md"
    rows = rows_of(readme.read_text())
    for name, scene, text in harness.chosen(PICTURES, arguments.scenes):
        command = ["capture", scene, "-o", f"out/{name}.png", "--size", "960x540"]
        subprocess.run([bench.program, *command, "--quiet"], check=True, cwd=ROOT)
        subprocess.run(["convert", ROOT / f"out/{name}.png", "-quality", "90", FOLDER / f"{name}.jpg"], check=True)
        small, reference = bench.out / f"{name}.exr", bench.out / f"{name}.reference.exr"
        subprocess.run([bench.program, "capture", scene, "-o", small, "--size", "240x135", "--quiet"], check=True, cwd=ROOT)
        if not reference.exists():
            subprocess.run([bench.program, "reference", scene, "-o", reference, "--size", "240x135", "--spp", str(bench.spp), "--quiet"], check=True, cwd=ROOT)
        error, energy = bench.compare(small, reference)
        rows[name] = (f"{text[0].upper()}{text[1:]}: relmse {error:.3f}, {100 * energy:.0f} % of the reference's light.\n"
                      f"`tyndall {' '.join(command)}`\n\n![{text}](docs/images/gallery/{name}.jpg)\n")
    pattern = re.compile(re.escape(MARKS[0]) + ".*?" + re.escape(MARKS[1]), re.S)
    readme.write_text(pattern.sub(lambda _: "\n".join([MARKS[0], *(rows[name] for name, *_ in PICTURES if name in rows), MARKS[1]]), readme.read_text()))
    print("wrote README.md")


if __name__ == "__main__":
    main()
