"""The time of a sweep against the number of cores.

In: the command `vi-lab` and a scene with a table [sweep]. Out: NAME.csv and NAME.svg, elapsed time for 1, 2, 3, 4, 6, 8 … cores up to those at hand, of threads in one
process (RAYON_NUM_THREADS) and of processes of one thread (--shard, then merge), each the least of several rounds. All tables have to be the same bytes, else it
ends with an error.
"""

import argparse
import csv
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import matplotlib.pyplot as plt

# The same numbers give the same bytes.
plt.rcParams["svg.hashsalt"] = "cores"


def counts(most):
    """1, 2, 3, 4, 6, 8, 12 … up to all cores."""
    steps = {factor * 2**k for factor in (1, 3) for k in range(most.bit_length())}
    return sorted({n for n in steps if n <= most} | {most})


def elapsed(commands, threads):
    environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
    start = time.perf_counter()
    for together in commands:
        processes = [
            subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            for command in together
        ]
        # All are waited for before one that failed ends the program.
        words = [process.communicate()[1] for process in processes]
        for process, said in zip(processes, words):
            if process.returncode != 0:
                sys.exit(f"{' '.join(process.args)}\n{said}")
    return time.perf_counter() - start


def by_threads(program, scene, table, count):
    return elapsed([[[program, "sweep", scene, "-o", table]]], count)


def by_processes(program, scene, table, count):
    shards = [[program, "sweep", scene, "-o", table, "--shard", f"{i}/{count}"] for i in range(count)]
    return elapsed([shards, [[program, "merge", f"{table}.part", "-o", table]]], 1)


WAYS = {"threads of one process": by_threads, "processes of one thread, merged": by_processes}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="target/release/vi-lab")
    parser.add_argument("--scene", default="scenes/pendulum-cores.toml")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--most", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--out", type=Path, default=Path("cores"))
    arguments = parser.parse_args()
    program, scene = os.path.abspath(arguments.program), os.path.abspath(arguments.scene)
    seconds, first = {}, None
    for _ in range(arguments.rounds):
        for count in counts(arguments.most):
            for name, way in WAYS.items():
                with tempfile.TemporaryDirectory() as folder:
                    table = os.path.join(folder, "study.csv")
                    taken = way(program, scene, table, count)
                    content = Path(table).read_bytes()
                first = first or content
                if content != first:
                    sys.exit(f"{count} {name}: another table")
                seconds[name, count] = min(taken, seconds.get((name, count), taken))
    with arguments.out.with_suffix(".csv").open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["way", "cores", "seconds"])
        table.writerows([name, count, f"{taken:.3f}"] for (name, count), taken in seconds.items())
    draw(seconds, arguments.out.with_suffix(".svg"))


def draw(seconds, file):
    figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
    one = seconds[next(iter(WAYS)), 1]
    for name, marker in zip(WAYS, "os"):
        points = [(count, taken) for (way, count), taken in seconds.items() if way == name]
        axes.plot(*zip(*points), marker=marker, label=name)
    cores = sorted({count for _, count in seconds})
    axes.plot(cores, [one / count for count in cores], "k:", label="time of one thread ÷ cores")
    axes.set(xscale="log", yscale="log", xlabel="cores", ylabel="elapsed time, seconds")
    axes.set_xticks(cores, [str(count) for count in cores])
    axes.minorticks_off()
    times = sorted(seconds.values())
    ticks = [times[0], one] if times[0] < 0.9 * one else [one]
    axes.set_yticks(ticks, [f"{tick:.2f}" for tick in ticks])
    axes.legend()
    figure.savefig(file, metadata={"Date": None})


if __name__ == "__main__":
    main()
