#!/usr/bin/env python3
"""Pictures of ten scenes by every technique at two presets: the same before and after a change of structure?

    tests/bench/pictures.py make build/release/bin/tyndall -o out/before
    tests/bench/pictures.py diff out/before out/after --tyndall build/release/bin/tyndall

`make` renders what is not in the folder yet and writes hashes.txt, a line a picture. `diff` lists the pictures whose bits differ, with relmse;
it fails where one is above --relmse (default 0: any difference)."""
import argparse, hashlib, json, os, pathlib, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared" / "content"
SCENES = {name: ROOT / "content" / f"{name}.scene.json"
          for name in ("slab", "furnace", "cornell", "cornell_fog", "campfire", "cloud", "fog_hall", "demo")}
SCENES["puff"] = ROOT / "content" / "smoke_puff.vdb"
# In these @CONTENT@ stands for the shared content.
SHARED_SCENES = {"sponza": ROOT / "tests" / "scenes" / "sponza_fog_smoke.scene.json"}
TECHNIQUES = ("none", "octaves", "lpv", "vpl")
PRESETS = ("low", "medium")


def orders(folder):
    """(name of the picture, scene, further arguments)"""
    scenes = dict(SCENES)
    if SHARED.exists():
        for name, template in SHARED_SCENES.items():
            scenes[name] = folder / f"{name}.scene.json"
            scenes[name].write_text(template.read_text().replace("@CONTENT@", str(SHARED)))
    else:
        print(f"{SHARED} is missing: without {', '.join(SHARED_SCENES)}", file=sys.stderr)
    for name, scene in scenes.items():
        for technique in TECHNIQUES:
            for preset in PRESETS:
                yield f"{name}-{technique}-{preset}", scene, ["--gi", technique, "--quality", preset]
    for name in ("cornell_fog", "campfire", "cloud"):  # averages take ways that single frames do not
        for technique in ("lpv", "vpl"):
            yield (f"{name}-{technique}-average", scenes[name],
                   ["--gi", technique, "--quality", "low", "--converge", "--frames", "2", "--set", "gi.vpl.nearPaths=1"])


def make(options):
    folder = pathlib.Path(options.output).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    lines = []
    for name, scene, further in orders(folder):  # relative, for the picture says where its scene lies
        picture = folder / f"{name}.exr"
        if options.only and options.only not in name:
            continue
        if not picture.exists():
            done = subprocess.run([pathlib.Path(options.tyndall).resolve(), "capture", os.path.relpath(scene, ROOT), "-o", picture, "--size", options.size,
                                   "--aov", "terms", "--quiet", *further], capture_output=True, text=True, cwd=ROOT)
            if done.returncode != 0:
                sys.exit(f"{name}: {done.stderr.strip()}")
        lines.append(f"{hashlib.sha256(picture.read_bytes()).hexdigest()[:32]} {name}\n")
        print(lines[-1], end="", flush=True)
    (folder / "hashes.txt").write_text("".join(lines))


def relmse(tyndall, a, b):
    with tempfile.NamedTemporaryFile(suffix=".json") as report:
        subprocess.run([tyndall, "compare", a, b, "--json", report.name], check=True, capture_output=True)
        return json.load(open(report.name))["metrics"]["relmse"]


def diff(options):
    before, after = pathlib.Path(options.before), pathlib.Path(options.after)
    same, worst = 0, 0.0
    for picture in sorted(before.glob("*.exr")):
        other = after / picture.name
        if options.only and options.only not in picture.name:
            continue
        if not other.exists():
            sys.exit(f"{other} is missing: make it first, or leave it out by --only")
        if picture.read_bytes() == other.read_bytes():
            same += 1
            continue
        error = relmse(options.tyndall, other, picture)
        if error == 0:  # what the files say of themselves differs
            same += 1
            continue
        worst = max(worst, error)
        print(f"{picture.stem}: relmse {error:.3g}")
    print(f"{same} pictures are the same to the last bit; the largest relmse of the others is {worst:.3g}")
    sys.exit(worst > options.relmse)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    maker = commands.add_parser("make", help="render what is missing")
    maker.add_argument("tyndall")
    maker.add_argument("-o", "--output", required=True)
    maker.add_argument("--size", default="64x36")
    maker.add_argument("--only", help="pictures whose name has this in it")
    maker.set_defaults(run=make)
    differ = commands.add_parser("diff", help="compare two folders")
    differ.add_argument("before")
    differ.add_argument("after")
    differ.add_argument("--tyndall", required=True)
    differ.add_argument("--only", help="pictures whose name has this in it")
    differ.add_argument("--relmse", type=float, default=0.0)
    differ.set_defaults(run=diff)
    options = parser.parse_args()
    options.run(options)


if __name__ == "__main__":
    main()
