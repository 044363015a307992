#!/usr/bin/python3
"""Measures what docs/measured/frame-times.md shows, and writes it.

    tests/bench/tables.py [--build build/release] [--frames 4]

Scenes: an empty one, Sponza, Sponza with media (the last two where the shared content is: $TYNDALL_CONTENT, else
../shared/content). Every number comes from the report of `tyndall capture`: GPU times are the driver's timestamps, frame
times the clock of a whole frame, the first one left out.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIZES = ["640x360", "1280x720"]

EYE = {"name": "eye", "camera": {"type": "perspective"}}


def scenes(folder, content):
    """Name and scene file of each row."""
    yield "empty", write(folder, "empty", {"tyndall": 1, "nodes": [EYE], "camera": "eye"})
    if not (content / "sponza" / "Sponza.gltf").exists():
        print(f"note: '{content}' has no Sponza; only the empty scene is measured", file=sys.stderr)
        return
    text = (ROOT / "tests/scenes/sponza_fog_smoke.scene.json").read_text()
    media = json.loads(text.replace("@CONTENT@", str(content)))
    clear = dict(media, nodes=[node for node in media["nodes"] if "medium" not in node])
    yield "Sponza", write(folder, "sponza", clear)
    yield "Sponza with fog and smoke", write(folder, "media", media)


def write(folder, name, scene):
    path = folder / f"{name}.scene.json"
    path.write_text(json.dumps(scene))
    return path


def measure(program, scene, size, frames, folder, *more):
    report = folder / "report.json"
    subprocess.run([program, "capture", scene, "-o", folder / "out.png", "--size", size, "--frames", str(frames),
                    "--report", report, "--gi", "none", "--quiet", *more], check=True)
    return json.loads(report.read_text())


def cell(value):
    return "" if value is None else f"{value:.1f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def summary(results):
    head = ["scene", "size", "frame, ms", "95 %, ms", "first picture after, ms", "GPU memory, MiB", "resident, MiB"]
    rows = [[name, size, cell(r["frame_ms"]["median"]), cell(r["frame_ms"]["p95"]), cell(r["startup_ms"]), cell(r["gpu_bytes"] / 2**20),
             cell(r["peak_rss_bytes"] / 2**20)] for (name, size), r in results.items()]
    return table(head, rows)


def passes(results, size):
    """One row a pass, one column a scene; a pass that did not run shows its status."""
    columns = {name: {p["name"]: p for p in r["passes"]} for (name, s), r in results.items() if s == size}
    names = list(dict.fromkeys(n for column in columns.values() for n in column))
    def entry(p):
        if p is None:
            return ""
        return cell(p.get("gpu_ms")) if p["status"] == "ran" else p["status"]
    return table(["pass"] + list(columns), [[f"`{n}`"] + [entry(c.get(n)) for c in columns.values()] for n in names])


def cost_of_no_media(program, scene, frames, folder):
    """The median frame of a scene without media, over the same with no term of media asked for: 1 where they cost nothing."""
    whole, surfaces = [], []
    for _ in range(3):  # in turns, so that a machine that slows down slows both
        whole.append(measure(program, scene, "640x360", frames, folder)["frame_ms"]["median"])
        surfaces.append(measure(program, scene, "640x360", frames, folder, "--terms", "LE,LSE")["frame_ms"]["median"])
    return statistics.median(whole) / statistics.median(surfaces), max(surfaces) / min(surfaces)


def machine():
    names = [line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
    return f"{os.cpu_count()} cores of {names[0] if names else 'an unknown processor'}"


def commit_date():
    git = subprocess.run(["git", "-C", ROOT, "log", "-1", "--format=%cs"], capture_output=True, text=True)
    return git.stdout.strip() or "unknown"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--frames", default=4, type=int)
    parser.add_argument("--output", default=ROOT / "docs/measured/frame-times.md", type=pathlib.Path)
    arguments = parser.parse_args()
    program = arguments.build / "bin/tyndall"
    content = pathlib.Path(os.environ.get("TYNDALL_CONTENT", ROOT.parent / "shared/content"))
    results = {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for scene, path in scenes(folder, content):
            if "fog" not in scene:
                without_media = path
            for size in SIZES:
                print(f"{scene} at {size}", file=sys.stderr)
                results[scene, size] = measure(program, path, size, arguments.frames, folder)
        ratio, noise = cost_of_no_media(program, without_media, arguments.frames, folder)
    any_report = next(iter(results.values()))
    text = f"""# Frame times

This page measures milliseconds per pass, start-up time and memory with direct light and single scattering, on {machine()}
with {any_report["gl"]["renderer"]} ({any_report["gl"]["version"]}, {any_report["backend"]}); `tests/bench/tables.py` makes it again from a release build.

Release build of {commit_date()}, {arguments.frames} frames of each scene. A software driver rendered them: compare passes and scenes with each other, not with a GPU.

## Frames, start-up, memory
The median and the 95th percentile leave out the first frame, in which shaders are compiled. "First picture after" is the time from the
start of the program to the first picture. It includes loading, compiling and the first frame.

{summary(results)}
## Cost of the media passes in a scene without media
The last scene without media takes {ratio:.3f} times as long with all terms as with surface terms alone (`--terms LE,LSE`). Three runs of the
latter differ by a factor of {noise:.3f}.

"""
    for size in SIZES:
        text += f"## Milliseconds per pass at {size}\nA word in place of a number is the state of a pass that did not run in the last frame.\n\n{passes(results, size)}\n"
    arguments.output.write_text(text)
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    main()
