"""What benchmarks of techniques share: scenes, references that are kept, captures with their reports, errors by receiver, the command line.

    bench = harness.Bench(harness.parser(__doc__, "lpv").parse_args())
    scene = bench.scene("fog hall", harness.load("content/fog_hall.scene.json"))
    picture, report = bench.capture(scene, "lpv.exr", "--gi", "lpv")
    bench.errors(picture, bench.reference(scene, 1), harness.MEDIA)
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from tables import ROOT  # noqa: E402

SURFACES, MEDIA = "LSSE,LVSE,LXSSE,LXVSE", "LSVE,LVVE,LXSVE,LXVVE"
SIZE = "64x36"


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


def parser(description, name, spp, out="bench-lpv"):
    """The options that all benchmarks have. Results are kept in out/OUT, the page is docs/measured/NAME.md."""
    made = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    made.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    made.add_argument("--out", default=ROOT / "out" / out, type=pathlib.Path)
    made.add_argument("--spp", default=spp, type=int)
    made.add_argument("--page", default=ROOT / f"docs/measured/{name}.md", type=pathlib.Path)
    return made


def content_folder():
    return pathlib.Path(os.environ.get("TYNDALL_CONTENT", ROOT.parent / "shared/content"))


def chosen(candidates, names):
    """Of scenes those whose name has one of `names` (with commas between them) in it, and says which one is at hand; all where there are no names."""
    wanted = [name for name in names.split(",") if name]
    for candidate in candidates:
        if not wanted or any(name in candidate[0] for name in wanted):
            print(candidate[0], file=sys.stderr)
            yield candidate


class Bench:
    def __init__(self, arguments):
        self.program = arguments.build / "bin/tyndall"
        self.out = arguments.out
        self.spp = arguments.spp
        self.out.mkdir(parents=True, exist_ok=True)

    def run(self, *command):
        return subprocess.run([self.program, *map(str, command)], check=True, capture_output=True, text=True).stdout

    def scene(self, name, scene):
        """The file of a scene; what was made of another one of this name is removed."""
        path = self.out / (re.sub(r"\W+", "-", name) + ".scene.json")
        text = json.dumps(scene)
        if not path.exists() or path.read_text() != text:
            path.write_text(text)
            for old in self.out.glob(path.name.split(".")[0] + ".*.*"):
                if old != path:
                    old.unlink()
        return path

    @staticmethod
    def beside(scene, name):
        return scene.with_name(scene.name.replace(".scene.json", f".{name}"))

    def reference(self, scene, fewer):
        path = self.beside(scene, "reference.exr")
        if not path.exists():
            self.run("reference", scene, "-o", path, "--size", SIZE, "--spp", max(int(self.spp / fewer), 16), "--quiet")
        return path

    def noise(self, scene, reference, fewer, terms):
        """relmse that the reference itself has: part of that between it and one of other random numbers, which has an eighth of the samples and so 8 times the noise."""
        again = self.beside(scene, "again.exr")
        if not again.exists():
            self.run("reference", scene, "-o", again, "--size", SIZE, "--spp", max(int(self.spp / fewer / 8), 16), "--seed", 1, "--terms", f"{SURFACES},{MEDIA}", "--quiet")
        return self.compare(again, reference, terms)[0] / 9

    def capture(self, scene, name, *options, size=SIZE):
        """The picture NAME and its report, rendered where one of them is missing; an EXR has the terms, too."""
        picture = self.beside(scene, name)
        report = picture.with_suffix(".json")
        if not picture.exists() or not report.exists():
            terms = ["--aov", "terms"] if picture.suffix == ".exr" else []
            self.run("capture", scene, "-o", picture, "--size", size, *terms, "--report", report, "--quiet", *options)
        return picture, json.loads(report.read_text())

    def compare(self, picture, reference, terms=None, *options):
        """relmse and energy; against all of the picture where no terms are named."""
        text = self.run("compare", picture, reference, *(["--terms", terms] if terms else []), *options)
        found = dict(re.findall(r"^ *(\w+)\s+([-+.\dinfa]+)\s*$", text, re.M))
        return float(found["relmse"]), float(found["energy"])

    def errors(self, picture, reference, terms=None, *options):
        """compare() as a table has it."""
        return pair(self.compare(picture, reference, terms, *options))


def pair(values):
    return "{:.3f}, {:.3f}".format(*values)


def milliseconds(report, *names):
    return sum(p.get("gpu_ms") or 0 for p in report["passes"] if p["status"] == "ran" and p["name"] in names)
