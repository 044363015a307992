#!/usr/bin/env python3
"""Makes the reference pictures that references.txt lists, those that are missing or stale, and removes all others.

Each picture's name holds a number made of everything in its scene that shows, the size and the path tracer's version, so a picture
whose scene has changed is no longer found and made again. `make references` runs this; pictures are never made by hand.

    tests/images/make_references.py [PATH OF tyndall]
"""
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIST = ROOT / "tests/images/references.txt"
FOLDER = ROOT / "tests/images/references"
CONTENT = pathlib.Path(os.environ.get("TYNDALL_CONTENT", ROOT.parent / "shared/content"))


def scene_file(name):
    """The scene to render: itself, or a copy that knows where the shared content is. None where that is missing."""
    text = (ROOT / name).read_text()
    if "@CONTENT@" not in text:
        return name
    if not CONTENT.is_dir():
        return None
    copy = ROOT / "build/references" / pathlib.Path(name).name
    copy.parent.mkdir(parents=True, exist_ok=True)
    copy.write_text(text.replace("@CONTENT@", str(CONTENT)))
    return str(copy.relative_to(ROOT))


def make(program, name, size, terms, samples):
    """Renders one picture, or finds it there; returns its file."""
    scene = scene_file(name)
    if scene is None:
        print(f"{name}: left out, the shared content is not at {CONTENT}")
        return None
    print(f"{name}: {size}, {terms}, {samples} samples a pixel", flush=True)
    run = subprocess.run([program, "reference", scene, "--size", size, "--terms", terms, "--spp", samples, "--half", "--cache", str(FOLDER.relative_to(ROOT))],
                         cwd=ROOT, stdout=subprocess.PIPE, text=True)
    if run.returncode != 0:
        sys.exit(f"make_references.py: '{name}' failed, see above")
    return (ROOT / run.stdout.strip()).resolve()


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve()) if len(sys.argv) > 1 else str(ROOT / "build/release/bin/tyndall")
    lines = [line.split() for line in LIST.read_text().splitlines() if line.strip() and not line.startswith("#")]
    made = [make(program, *line) for line in lines]
    if None in made:
        return
    for file in FOLDER.iterdir():
        if file.resolve() not in made:
            print(f"removed {file.relative_to(ROOT)}: nothing asks for it any more")
            file.unlink()


main()
