#!/usr/bin/python3
"""How long `tyndall reference` and Cycles (Blender's path tracer) take to the same error, on scenes that both mean alike.

    tests/bench/peers/peers.py -o out/peers
    tests/bench/peers/peers.py -o out/peers --page docs/measured/peers.md      # puts the table into the page
    tests/bench/peers/peers.py -o /tmp/p --scenes fog_box --size 48x27 --spp 8,64 --reference-spp 256 --repeats 2    # a quick look
    tests/bench/peers/peers.py -o out/peers --engines cycles          # one side alone

For each scene both programs render the same picture with two sample counts and a seed of its own for every repetition, in turns, so
that a machine that slows down slows both. Of each:

  time per sample  (t(N2) - t(N1)) / (N2 - N1), t the wall clock of the whole process: loading and building cancel out. The
                   processor's time is kept beside it; it suffers less where the machine has other work.
  variance         relmse of a picture (docs/compare.md) against the same program's own mean of many samples and another seed,
                   over 1/N + 1/M, with N and M the sample counts: per sample, relative, blind to what the other program thinks.
                   Half of the relmse between two seeds is kept beside it.
  efficiency       variance times time: seconds to a relmse of 1. Twice as much means twice as long to the same picture.

That both render the same picture is checked with the two means of many samples: their energies' ratio, and the relmse between them
beside the relmse that their noise explains.

Without Blender it says so and ends with 0; without `tyndall reference` it ends with 1. Sponza and the smoke come from
$TYNDALL_CONTENT, else ../shared/content; scenes whose files are missing are left out with a note.
"""

import argparse
import json
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import sponza_lambert  # noqa: E402  (beside this file)

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
SCENES = ["fog_box", "smoke", "sponza_fog"]
TABLE_BEGIN, TABLE_END = "<!-- table: written by tests/bench/peers/peers.py -->", "<!-- end of table -->"


class Failed(Exception):
    """What the user is told, in one sentence."""


# Programs

def run(command, log):
    """Runs a program to its end; returns seconds of wall clock and of processor time. Its output goes to the file `log`."""
    with open(log, "w") as out:
        start = time.perf_counter()
        process = subprocess.Popen([str(part) for part in command], stdout=out, stderr=subprocess.STDOUT)
        try:
            _, status, usage = os.wait4(process.pid, 0)
        except KeyboardInterrupt:
            process.terminate()
            process.wait()
            raise
        seconds = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise Failed(f"'{command[0]}' ended with {process.returncode}; what it said is in {log}")
    return seconds, usage.ru_utime + usage.ru_stime


def version_of(program):
    said = subprocess.run([program, "--version"], capture_output=True, text=True).stdout.strip()
    return said.splitlines()[0] if said else "unknown"


class Tyndall:
    """`tyndall reference`."""
    name = "Tyndall"
    key = "tyndall"

    def __init__(self, arguments):
        self.program = arguments.build / "bin/tyndall"
        self.arguments = arguments
        if not self.program.is_file():
            raise Failed(f"there is no '{self.program}'; --build names the folder of the build")
        if subprocess.run([self.program, "reference", "--help"], capture_output=True).returncode:
            raise Failed(f"'{self.program}' has no command 'reference'; build a newer one")
        self.version = version_of(self.program)

    def render(self, scene, output, spp, seed):
        return run([self.program, "reference", scene, "-o", output, "--size", self.arguments.size, "--spp", spp, "--seed", seed,
                    "--threads", self.arguments.threads, "--checkpoint", 86400, "--report", output.with_suffix(".json"), "-q"],
                   output.with_suffix(".log"))

    @staticmethod
    def says(report):
        """Seconds that the program itself counts: of sampling alone."""
        return report["render_seconds"]


class Cycles:
    """Cycles, by cycles_scene.py inside Blender, marching through grids in steps of so many voxels."""

    def __init__(self, arguments, step, with_grid):
        self.step = step
        self.key = f"cycles-{step:g}" if with_grid else "cycles"
        self.name = engine_names(arguments)[self.key]
        self.program = arguments.blender
        self.arguments = arguments

    def render(self, scene, output, spp, seed):
        output.unlink(missing_ok=True)
        log = output.with_suffix(".log")
        times = run([self.program, "-b", "--factory-startup", "-noaudio", "-P", HERE / "cycles_scene.py", "--", scene, "-o", output,
                     "--size", self.arguments.size, "--spp", spp, "--seed", seed, "--threads", self.arguments.threads,
                     "--step", self.step, "--json", output.with_suffix(".json")], log)
        if not output.is_file():  # Blender ends with 0 whatever became of the script
            raise Failed(f"Cycles wrote no '{output}'; what it said is in {log}")
        return times

    @staticmethod
    def says(report):
        """Seconds that the program itself counts: Blender's call, with synchronisation and the building of the BVH."""
        return report["seconds"]


def cycles(scene, arguments):
    """Cycles once for each step where the scene has a grid, else once: fog without detail is closed form to it."""
    if "cycles" not in arguments.engines:
        return []
    with_grid = any(node.get("medium", {}).get("type") == "grid" for node in json.loads(scene.read_text())["nodes"])
    return [Cycles(arguments, step, with_grid) for step in (arguments.steps if with_grid else arguments.steps[:1])]


def compare(program, a, b):
    """The metrics of image `a` against `b`."""
    report = a.with_name(f"compare-{a.stem}-{b.stem}.json")
    result = subprocess.run([program, "compare", a, b, "--json", report, "-q"], capture_output=True, text=True)
    if result.returncode or not report.is_file():
        raise Failed(f"comparing '{a}' with '{b}' failed: {result.stderr.strip()}")
    return json.loads(report.read_text())["metrics"]


# Scenes

def prepare(name, content, folder):
    """Writes the scene with its placeholders filled in and returns its path; None, with a note, where content is missing."""
    text = (HERE / f"scenes/{name}.scene.json").read_text()
    needed = {"smoke": "vdb/smoke1.vdb", "sponza_fog": "sponza/Sponza.gltf"}.get(name)
    if needed and not (content / needed).is_file():
        print(f"note: '{content}' has no {needed}; {name} is left out", file=sys.stderr)
        return None
    if "@LAMBERT@" in text:
        sponza_lambert.copy(content / "sponza/Sponza.gltf", folder / "lambert")
    path = folder / f"{name}.scene.json"
    path.write_text(text.replace("@CONTENT@", str(content)).replace("@LAMBERT@", str(folder / "lambert")))
    return path


# Measuring

def measure(scene, name, engines, program, arguments, say):
    """Renders everything of one scene, in turns, and returns its results."""
    low, high = arguments.spp
    folder = arguments.output
    truth = {}
    for engine in engines:
        say(f"{name}: {engine.name}, {arguments.reference_spp} samples for its mean")
        truth[engine.key] = folder / f"{name}-{engine.key}-mean.exr"
        engine.render(scene, truth[engine.key], arguments.reference_spp, arguments.seed)
    runs = {engine.key: [] for engine in engines}
    for repetition in range(arguments.repeats):
        seed = arguments.seed + 1 + repetition
        times = {}
        for spp in (low, high):
            # Who goes first changes from repetition to repetition.
            for engine in engines if repetition % 2 == 0 else engines[::-1]:
                say(f"{name}: repetition {repetition + 1} of {arguments.repeats}, {engine.name}, {spp} samples")
                output = folder / f"{name}-{engine.key}-{spp}-{seed}.exr"
                times[engine.key, spp] = engine.render(scene, output, spp, seed)
        for engine in engines:
            said = {spp: json.loads((folder / f"{name}-{engine.key}-{spp}-{seed}.json").read_text()) for spp in (low, high)}
            entry = {"seed": seed, "program_says": {str(spp): engine.says(report) for spp, report in said.items()}}
            for i, clock in enumerate(("wall", "processor")):
                t = {spp: times[engine.key, spp][i] for spp in (low, high)}
                entry[clock] = {"seconds": {str(spp): t[spp] for spp in t}, "per_sample": (t[high] - t[low]) / (high - low)}
            entry["variance"] = {str(spp): variance(program, folder / f"{name}-{engine.key}-{spp}-{seed}.exr", truth[engine.key], spp, arguments)
                                 for spp in (low, high)}
            runs[engine.key].append(entry)
    for engine in engines:
        add_pairs(program, folder, name, engine.key, runs[engine.key], high)
    result = {"engines": {key: summary(entries, high) for key, entries in runs.items()}, "runs": runs}
    for key in runs if "tyndall" in runs else ():
        if key != "tyndall":
            result["engines"][key]["ratio"] = ratio(runs["tyndall"], runs[key], high)
            result["engines"][key]["same_picture"] = same_picture(program, truth[key], truth["tyndall"], result["engines"], key, arguments)
    return result


def variance(program, image, truth, spp, arguments):
    """Relative variance of one sample: relmse against the own mean, noise of that mean accounted for."""
    return compare(program, image, truth)["relmse"] / (1 / spp + 1 / arguments.reference_spp)


def add_pairs(program, folder, name, key, entries, spp):
    """Beside it, from each two neighbouring seeds: half of their relmse, per sample."""
    for entry, other in zip(entries, entries[1:] + entries[:1] if len(entries) > 1 else []):
        a, b = (folder / f"{name}-{key}-{spp}-{e['seed']}.exr" for e in (entry, other))
        entry["variance_of_pair"] = compare(program, a, b)["relmse"] / 2 * spp


def spread(values):
    """Geometric mean, and the factor of one standard deviation around it (1 where there is a single value)."""
    if min(values) <= 0:  # a slope that noise turned round
        return {"median": statistics.median(values), "factor": None}
    logs = [math.log(v) for v in values]
    return {"median": math.exp(statistics.mean(logs)), "factor": math.exp(statistics.stdev(logs)) if len(logs) > 1 else 1.0}


def efficiencies(entries, spp, clock):
    return [entry["variance"][str(spp)] * entry[clock]["per_sample"] for entry in entries]


def summary(entries, spp):
    """What the table shows of one program: spread over the repetitions."""
    result = {clock: {"per_sample": spread([e[clock]["per_sample"] for e in entries]), "efficiency": spread(efficiencies(entries, spp, clock))}
              for clock in ("wall", "processor")}
    result["variance"] = spread([e["variance"][str(spp)] for e in entries])
    return result


def ratio(tyndall, cycles, spp):
    """Cycles' seconds to the same error over Tyndall's: repetition by repetition, since those ran side by side."""
    result = {}
    for clock in ("wall", "processor"):
        t, c = efficiencies(tyndall, spp, clock), efficiencies(cycles, spp, clock)
        result[clock] = spread([b / a for a, b in zip(t, c)])
    return result


def same_picture(program, image, truth, engines, key, arguments):
    metrics = compare(program, image, truth)
    noise = sum(engines[k]["variance"]["median"] for k in ("tyndall", key)) / arguments.reference_spp
    return {"energy": metrics["energy"], "energy_rgb": [metrics[f"energy_{c}"] for c in "rgb"], "relmse": metrics["relmse"], "relmse_of_noise": noise}


# Showing

def number(value, digits=3):
    return "–" if value is None else f"{value:.{digits}g}"


def with_spread(value, digits=3):
    factor = value["factor"]
    return number(value["median"], digits) + ("" if factor in (None, 1.0) else f" ×/÷ {factor:.2f}")


def engine_names(arguments):
    """Key and name of every row that a scene may have."""
    names = {"tyndall": "Tyndall", "cycles": "Cycles"}
    return names | {f"cycles-{step:g}": f"Cycles, steps of {step:g} voxel{'' if step == 1 else 's'}" for step in arguments.steps}


def table(results, arguments):
    head = ["scene", "program", "samples a pixel, per s", "variance of a sample", "seconds to relmse 1", "processor seconds", "Cycles / Tyndall"]
    lines = ["| " + " | ".join(head) + " |", "| --- | --- |" + " ---: |" * (len(head) - 2)]
    names = engine_names(arguments)
    for name, result in results.items():
        for key, s in result["engines"].items():
            rate = s["wall"]["per_sample"]["median"]
            last = with_spread(s["ratio"]["wall"]) if "ratio" in s else ""
            lines.append("| " + " | ".join([name, names[key], number(1 / rate if rate > 0 else None), with_spread(s["variance"]),
                                            with_spread(s["wall"]["efficiency"]), with_spread(s["processor"]["efficiency"]), last]) + " |")
    return "\n".join(lines) + "\n"


def agreement(results, arguments):
    names = engine_names(arguments)
    rows = [(name, names[key], e["same_picture"]) for name, r in results.items() for key, e in r["engines"].items() if "same_picture" in e]
    if not rows:
        return ""
    lines = ["| scene | program | energy, Cycles / Tyndall | relmse between them | of that, noise |", "| --- | --- | ---: | ---: | ---: |"]
    lines += [f"| {name} | {program} | {s['energy']:.4f} | {s['relmse']:.2e} | {s['relmse_of_noise']:.2e} |" for name, program, s in rows]
    return "\n".join(lines) + "\n"


def machine():
    names = [line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
    return f"{os.cpu_count()} cores of {names[0] if names else 'an unknown processor'}"


def page_text(results, versions, arguments):
    low, high = arguments.spp
    text = f"""Made on {time.strftime("%Y-%m-%d")}, on {machine()}, load {os.getloadavg()[0]:.1f} at the end, with {" and ".join(versions)}: {arguments.size},
{low} and {high} samples a pixel, {arguments.threads} threads, {arguments.repeats} repetitions, means of {arguments.reference_spp} samples.
"×/÷" is one standard deviation over the repetitions.

{table(results, arguments)}"""
    same = agreement(results, arguments)
    return text + (f"\nThe same picture? From the means of {arguments.reference_spp} samples:\n\n{same}" if same else "")


def into_page(page, text):
    old = page.read_text()
    if TABLE_BEGIN not in old or TABLE_END not in old:
        raise Failed(f"'{page}' has no place for the table: a line '{TABLE_BEGIN}' and a line '{TABLE_END}'")
    before, rest = old.split(TABLE_BEGIN, 1)
    page.write_text(before + TABLE_BEGIN + "\n" + text + TABLE_END + rest.split(TABLE_END, 1)[1])


# Command line

def two_counts(text):
    counts = [int(n) for n in text.split(",")]
    if len(counts) != 2 or not 0 < counts[0] < counts[1]:
        raise argparse.ArgumentTypeError(f"'{text}' should be two sample counts, the smaller first, such as 8,64")
    return counts


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="folder of the pictures, results.json and table.md")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--scenes", default=",".join(SCENES), help="of " + ", ".join(SCENES))
    parser.add_argument("--engines", default="tyndall,cycles", help="tyndall, cycles or both")
    parser.add_argument("--size", default="96x54", metavar="WxH")
    parser.add_argument("--spp", type=two_counts, default=[16, 256], metavar="N1,N2", help="samples a pixel of the two runs (16,256)")
    parser.add_argument("--reference-spp", type=int, default=2048, metavar="M", help="samples a pixel of each program's own mean (2048)")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--steps", type=lambda text: [float(n) for n in text.split(",")], default=[1.0, 4.0], metavar="N,...",
                        help="Cycles' steps through a grid, in voxels: a row for each (1,4)")
    parser.add_argument("--page", type=pathlib.Path, help="Markdown page that gets the table")
    parser.add_argument("-q", "--quiet", action="store_true")
    arguments = parser.parse_args()
    arguments.scenes = arguments.scenes.split(",")
    arguments.engines = arguments.engines.split(",")
    for chosen, known in ((arguments.scenes, SCENES), (arguments.engines, ["tyndall", "cycles"])):
        wrong = [name for name in chosen if name not in known]
        if wrong:
            parser.error(f"'{wrong[0]}' is none of {', '.join(known)}")
    if arguments.repeats < 1 or arguments.threads < 1 or arguments.reference_spp < 1:
        parser.error("--repeats, --threads and --reference-spp are at least 1")
    return arguments


def main():
    arguments = parse()
    if "cycles" in arguments.engines and not shutil.which(arguments.blender):
        print(f"peers.py: skipped, there is no '{arguments.blender}' here (on Debian: apt install blender python3-numpy)")
        return 0
    try:
        tyndall = Tyndall(arguments)  # also compares the pictures
        engines = [tyndall] if "tyndall" in arguments.engines else []
        arguments.output = arguments.output.resolve()
        arguments.output.mkdir(parents=True, exist_ok=True)
        content = pathlib.Path(os.environ.get("TYNDALL_CONTENT", ROOT.parent / "shared/content")).resolve()
        versions = [tyndall.version] + ([version_of(arguments.blender)] if "cycles" in arguments.engines else [])
        results = {}
        for name in arguments.scenes:
            scene = prepare(name, content, arguments.output)
            if scene:
                say = (lambda text: None) if arguments.quiet else (lambda text: print(text, file=sys.stderr, flush=True))
                results[name] = measure(scene, name, engines + cycles(scene, arguments), tyndall.program, arguments, say)
                print(table({name: results[name]}, arguments) + agreement({name: results[name]}, arguments), flush=True)
        if not results:
            print("peers.py: skipped, the files of every scene asked for are missing")
            return 0
        settings = {key: str(value) if isinstance(value, pathlib.Path) else value for key, value in vars(arguments).items()}
        report = {"machine": machine(), "versions": versions, "settings": settings, "scenes": results}
        (arguments.output / "results.json").write_text(json.dumps(report, indent=2))
        text = page_text(results, versions, arguments)
        (arguments.output / "table.md").write_text(text)
        if arguments.page:
            into_page(arguments.page, text)
        print(text)
        return 0
    except Failed as failure:
        print(f"peers.py: {failure}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
