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

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "cores"
import matplotlib.pyplot as plt


def counts(most):
    return [n for n in range(1, most + 1) if n < 4 or n == most or n & (n - 1) == 0 or n % 3 == 0 and (n // 3) & (n // 3 - 1) == 0]


def elapsed(commands, threads):
    environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
    start = time.perf_counter()
    for together in commands:
        processes = [subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for command in together]
        if any(process.wait() for process in processes):
            sys.exit(f"failed: {together[0]}")
    return time.perf_counter() - start


def by_threads(program, scene, table, count):
    return elapsed([[[program, "sweep", scene, "-o", table]]], count)


def by_processes(program, scene, table, count):
    shards = [[program, "sweep", scene, "-o", table, "--shard", f"{i}/{count}"] for i in range(count)]
    parts = [f"{table}.{i}-of-{count}.part" for i in range(count)]
    return elapsed([shards, [[program, "merge", *parts, "-o", table]]], 1)


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
