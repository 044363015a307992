#!/usr/bin/python3
"""Measures every technique on ten scenes, and what `--gi auto` chooses there, and writes docs/measured/auto.md.

    tests/bench/auto.py [--build build/release] [--out out/bench-auto] [--scenes NAME,...] [--size 256x144]

Errors are of one frame at medium quality, 96x54, against the reference pictures of the tests. Times are of processor seconds, which other work on the
machine does not change: of a second frame, in which all light is found anew. The page ends with the rows for the techniques' tables of
expectations (TechniqueInfo::expected).
"""

import json
import os
import pathlib
import re
import statistics
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import harness  # noqa: E402
from harness import MEDIA, SURFACES  # noqa: E402
from tables import ROOT, commit_date, machine, table  # noqa: E402

TECHNIQUES = ("octaves", "lpv", "vpl")
LEAST_SHARE = 0.05  # of the picture's light: the error of less says nothing
MOST_COST = 10  # times the frame with direct light alone: engine/transport/plan.cpp
ANEW = ("--set", "gi.lpv.keep=false", "--set", "gi.vpl.keep=false")


def listed_scenes():
    """Scenes of tests/images/references.txt whose reference has all terms: name, file, reference."""
    for line in (ROOT / "tests/images/references.txt").read_text().splitlines():
        words = line.split()
        if len(words) != 4 or words[0] == "#" or words[2] != "all":
            continue
        name = pathlib.Path(words[0]).name.split(".")[0]
        text = (ROOT / words[0]).read_text()
        if "@CONTENT@" in text and not harness.content_folder().is_dir():
            print(f"{name}: left out, the shared content is missing", file=sys.stderr)
            continue
        yield name, ROOT / words[0], text, words[1]


class Bench(harness.Bench):
    def file_of(self, source, text):
        if "@CONTENT@" not in text:
            return source
        path = self.out / source.name
        path.write_text(text.replace("@CONTENT@", str(harness.content_folder())))
        return path

    def reference_of(self, scene, size):
        """The picture that `make references` keeps, with all terms."""
        found = self.run("reference", os.path.relpath(scene, ROOT), "--size", size, "--terms", "all", "--spp", 1, "--half", "--quiet",
                         "--cache", ROOT / "tests/images/references").strip()
        return ROOT / found

    def processor_seconds(self, *command):
        process = subprocess.Popen([self.program, *map(str, command)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            sys.exit(f"{' '.join(map(str, command))}: exit status {process.returncode}")
        return usage.ru_utime + usage.ru_stime

    def layers(self, picture):
        """Terms that it has, alone or as part of a sum: "LSSE+LVSE"."""
        return {term for layer in re.findall(r"^layer '([\w+]+)'", self.run("info", picture), re.M) for term in layer.split("+")}

    def share(self, reference, terms):
        """Part of the reference's light that these terms have."""
        means = dict(re.findall(r"^layer '([\w()]+)': .*mean ([-+.\de]+)", self.run("info", reference), re.M))
        return sum(float(means.get(term, 0)) for term in terms.split(",")) / float(means["(main)"])

    def measure(self, name, scene, reference, gi, size):
        """Kept in a file: whole, on surfaces and in media (relmse, energy), seconds a frame, what it said."""
        kept = self.out / f"{name}-{gi}-{size}.json"
        if kept.exists():
            return json.loads(kept.read_text())
        picture, report = self.out / f"{name}-{gi}.exr", self.out / f"{name}-{gi}.report.json"
        common = ["--gi", gi, "--quality", "medium", "--quiet", *ANEW]
        self.run("capture", scene, "-o", picture, "--size", "96x54", "--aov", "terms", "--report", report, *common)
        timed = ["capture", scene, "-o", self.out / "timed.png", "--size", size, *common]
        self.processor_seconds(*timed)  # shaders are compiled
        one, two = self.processor_seconds(*timed), self.processor_seconds(*timed, "--frames", 2)
        said = json.loads(report.read_text())
        result = {"seconds": two - one, "technique": said["technique"], "why": said["why"], "missing": said["missing"],
                  "whole": self.compare(picture, reference)}
        layers = self.layers(picture) & self.layers(reference)
        for receiver, terms in (("surfaces", SURFACES), ("media", MEDIA)):
            rendered = [term for term in terms.split(",") if term in said["claims"] and term in layers]
            result[receiver] = self.compare(picture, reference, ",".join(rendered)) if rendered else (1, 0)
        kept.write_text(json.dumps(result))
        return result


def main():
    parser = harness.parser(__doc__, "auto", 0, out="bench-auto")
    parser.add_argument("--scenes", default="")
    parser.add_argument("--size", default="256x144")
    arguments = parser.parse_args()
    bench = Bench(arguments)
    rows, choices, by_kind = [], [], {}
    for name, source, text, size in harness.chosen(listed_scenes(), arguments.scenes):
        scene = bench.file_of(source, text)
        reference = bench.reference_of(scene, size)
        found = {gi: bench.measure(name, scene, reference, gi, arguments.size) for gi in ("none", *TECHNIQUES, "auto")}
        base = found["none"]["seconds"]
        shares = {"surfaces": bench.share(reference, SURFACES), "media": bench.share(reference, MEDIA)}
        kind = found["auto"]["why"].rsplit(" for ", 1)[-1]
        for gi, r in found.items():
            cost = r["seconds"] / base
            rows.append([name, gi, harness.pair(r["whole"]), "" if gi == "none" else harness.pair(r["surfaces"]),
                         "" if gi == "none" else harness.pair(r["media"]), f"{1000 * r['seconds']:.0f}", f"{cost:.1f}"])
            columns = by_kind.setdefault((gi, kind), ([], [], []))
            columns[0].append(cost)
            for column, receiver in ((1, "surfaces"), (2, "media")):
                if shares[receiver] >= LEAST_SHARE:
                    columns[column].append(r[receiver][0])
        quick = {gi: found[gi] for gi in TECHNIQUES if found[gi]["seconds"] <= MOST_COST * base} or {gi: found[gi] for gi in TECHNIQUES}
        best = min(quick, key=lambda gi: quick[gi]["whole"][0])
        auto = found["auto"]
        choices.append([name, auto["technique"], f"{auto['whole'][0]:.4f}", f"{1000 * auto['seconds']:.0f}", f"{auto['seconds'] / base:.1f}",
                        best, f"{quick[best]['whole'][0]:.4f}", f"{auto['whole'][0] / quick[best]['whole'][0]:.2f}"])
    expectations = [[gi, kind, *(f"{statistics.median(column):.2g}" if column else "" for column in columns)]
                    for (gi, kind), columns in sorted(by_kind.items()) if gi in TECHNIQUES]
    arguments.page.write_text(f"""# What `--gi auto` chooses

This page measures error and time of every technique on ten scenes, at medium quality, in one frame. Made by `tests/bench/auto.py` from a release build of
{commit_date()}, on {machine()} with llvmpipe.

`auto` chooses, for surfaces and for media, the technique with the least error that was measured in scenes of the kind, among those whose frame takes at most
{MOST_COST} times one with direct light alone. Each technique's table is below; the programs say what was chosen and why.

## The choice
relmse of the whole picture (96x54, one frame) against the reference; milliseconds of processor time a frame at {arguments.size}, and over that of direct light alone.

{table(["scene", "auto", "relmse", "ms", "cost", "best quick one", "its relmse", "ratio"], choices)}
## Every technique
relmse and energy of the whole picture, and of those terms on surfaces and in media that the technique computes.

{table(["scene", "technique", "picture", "surfaces", "media", "ms", "cost"], rows)}
## By kind of scene
Medians, for `TechniqueInfo::expected`; of errors where the terms have a twentieth of the picture's light or more.

{table(["technique", "kind of scene", "cost", "error on surfaces", "error in media"], expectations)}""")
    print(f"wrote {arguments.page}")


if __name__ == "__main__":
    main()
