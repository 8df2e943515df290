"""All systems against DOP853 and heyoka, in one run: the tables of docs/choosing.md.

In: names of systems, or none for all; the number of process starts of each program. Out: ratios of times at equal errors,
rival ÷ the best of our methods, as medians over the starts. In a start the programs run one after the other for each system,
and each counts its least time. `--write` puts the ratios into docs/rivals.json, from which `python3 docs/fill_numbers.py`
makes the tables of the pages.
"""

import argparse
import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

HERE = Path(__file__).resolve().parent
NUMBERS = HERE.parent.parent / "docs/rivals.json"
CRATE = HERE / "adaptive"
ERRORS = [1e-3, 1e-6, 1e-9, 1e-12]
# Short name, motion, and whether `heyoka_runs.py` has the system.
SYSTEMS = {
    "kepler": ("Kepler", "Kepler, e = 0.6, T = 20", True),
    "double-well": ("double well", "double well, q0 = 0.995, T = 40", True),
    "double-pendulum": ("double pendulum", "double pendulum, T = 20", True),
    "outer-solar-system": ("outer solar system", "outer solar system, 40 000 days", True),
    "fpu-chain": ("chain of 16", "chain of 16, T = 400", True),
    "pleiades": ("Pleiades", "Pleiades, seven bodies with close encounters, T = 3", True),
    "cart-double-pole": ("cart with two poles", "cart with two falling poles, T = 4", True),
    "geodesic": ("geodesic", "geodesic about a black hole, ten turns at r = 10 to 13", False),
    "beam": ("beam", "damped beam of twelve links, T = 4", False),
    "ladder": ("ladder", "driven ladder of sixteen coils, T = 80", False),
}


def runs(name, has_heyoka, folder):
    """Method, error and least seconds of every run of one start that reached the end."""
    ours = [CRATE / "target/release/adaptive", "work-precision", name, "--out", folder]
    subprocess.run(ours, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    files = [folder / "runs.csv"]
    if has_heyoka:
        subprocess.run([sys.executable, HERE / "heyoka_runs.py", name], check=True, cwd=folder, stdout=subprocess.DEVNULL)
        files.append(folder / f"{name}.csv")
    for file in files:
        with open(file, encoding="utf-8") as table:
            for row in csv.DictReader(table):
                if not row["ended"]:
                    yield row["method"], float(row["error"]), float(row["seconds, least"])


def prices(found):
    """For each error the least time of DOP853, of heyoka and of our methods, and which of ours it is."""
    rivals = {"DOP853": "dop853", "heyoka": "heyoka"}
    least = {who: [(math.inf, "")] * len(ERRORS) for who in ("ours", *rivals.values())}
    for method, error, seconds in found:
        of = least[rivals.get(method, "ours")]
        for i, bound in enumerate(ERRORS):
            if error <= bound:
                of[i] = min(of[i], (seconds, method))
    return least


def ratio(starts, rival, i):
    """The median of rival ÷ ours at an error, with two digits; empty if one of them does not reach it."""
    found = median(start[rival][i][0] / start["ours"][i][0] for start in starts)
    if not 0.0 < found < math.inf:
        return ""
    return f"{found:.0f}" if found >= 9.95 else f"{found:.1f}" if found >= 0.995 else f"{found:#.2g}"


def duration(seconds):
    """Seconds with two digits, in a suitable unit; empty if there are none."""
    if not math.isfinite(seconds):
        return ""
    unit, scale = ("µs", 1e6) if seconds < 1e-3 else ("ms", 1e3)
    return f"{float(f'{seconds * scale:.2g}'):g} {unit}"


def system(name, starts):
    """The numbers of a system."""
    short, motion, has_heyoka = SYSTEMS[name]
    times = [start["ours"][1] for start in starts]
    best = sorted(times)[len(times) // 2]
    numbers = {"name": short, "motion": motion, "ours": f"{best[1]}: {duration(best[0])}"}
    for rival in ("dop853", "heyoka") if has_heyoka else ("dop853",):
        numbers[rival] = [ratio(starts, rival, i) for i in range(len(ERRORS))]
    return numbers


def machine():
    """The processor of this machine."""
    fields = dict(line.split(":", 1) for line in Path("/proc/cpuinfo").read_text().splitlines() if ":" in line)
    entries = {key.strip(): value.strip() for key, value in fields.items()}
    widest = " with AVX-512" if "avx512f" in entries["flags"].split() else ""
    return entries["model name"].replace("(R)", "").removesuffix(" Processor") + widest


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("systems", nargs="*", choices=[*SYSTEMS, []], metavar="SYSTEM")
    parser.add_argument("--starts", type=int, default=5, help="process starts of each program (default 5)")
    parser.add_argument("--write", action="store_true", help="put the numbers into docs/rivals.json")
    arguments = parser.parse_args()
    if arguments.write and arguments.systems:
        parser.error("--write replaces all numbers, which are those of one run: leave out the names of systems")
    build = ["cargo", "build", "--release", "--manifest-path", CRATE / "Cargo.toml"]
    subprocess.run(build, check=True)
    names = arguments.systems or list(SYSTEMS)
    starts = {name: [] for name in names}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(arguments.starts):
            for name in names:
                starts[name].append(prices(runs(name, SYSTEMS[name][2], Path(folder))))
    found = {name: system(name, starts[name]) for name in names}
    for numbers in found.values():
        print(numbers["motion"], numbers["ours"], sep=" | ")
        for rival in ("dop853", "heyoka"):
            if rival in numbers:
                print(f"    {rival} ÷ ours", *numbers[rival], sep=" | ")
    if arguments.write:
        measured = f"Medians of {arguments.starts} starts ({machine()})"
        content = {"measured": measured, "systems": found}
        NUMBERS.write_text(json.dumps(content, ensure_ascii=False, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
