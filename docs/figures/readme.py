#!/usr/bin/env python3
"""The two pictures of README.md: `python3 docs/figures/readme.py`, with the standard library alone.

In: the example `energy_error` and the command `vi-lab`, built by cargo, or others by `--example` and `--command`. Out:
`energy.svg`, the energy error of Kepler's problem over 800 periods beside DOP853, and `four-bar.svg`, a linkage that moves.
"""

import argparse
import csv
import math
import subprocess
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parent.parent
TEXT = "#57606a"
GRID = "#d0d7de"
FONT = 'font-family="system-ui, -apple-system, Segoe UI, Helvetica, Arial, sans-serif"'

# Methods of the example, their names in the picture, and their colours.
CURVES = [
    ("DOP853 1e-9", "DOP853", "#cf222e"),
    ("DOP853 1e-12", "DOP853", "#e16f24"),
    ("Gauss of 8 stages", "Gauss, 8 stages", "#0969da"),
    ("energy-preserving", "energy-preserving", "#1a7f37"),
]


def lab(command, *arguments):
    """What the command prints."""
    return subprocess.run([*command, *arguments], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def energy(command):
    """Energy errors against time, both logarithmic, each curve with its name and its price."""
    series, evaluations = {}, {}
    for name, rate, t, error in list(csv.reader(lab(command).splitlines()))[1:]:
        evaluations[name] = f"{float(rate):.0f} evaluations"
        if float(error) > 0:
            series.setdefault(name, []).append((float(t), float(error)))
    width, height, left, right, top, bottom = 860, 400, 66, 236, 50, 50
    low, high, start, end = -16, -4, math.log10(2 * math.pi), math.log10(1600 * math.pi)
    x_of = lambda x: left + (math.log10(x) - start) / (end - start) * (width - left - right)
    y_of = lambda y: top + (high - math.log10(y)) / (high - low) * (height - top - bottom)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" {FONT} font-size="16">',
        "<title>Relative energy error of a planet over 800 periods</title>",
        f'<rect width="{width}" height="{height}" rx="8" fill="#ffffff"/>',
        f'<text x="{left}" y="30" font-size="20" fill="#1f2328">Relative energy error of a planet, e = 0.6, over 800 periods</text>',
    ]
    for power in range(low, high + 1, 2):
        y = y_of(10.0**power)
        parts.append(f'<path d="M{left} {y:.1f}H{width - right}" stroke="{GRID}" stroke-width="1"/>')
        exponent = str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        parts.append(f'<text x="{left - 8}" y="{y + 4:.1f}" fill="{TEXT}" text-anchor="end">10{exponent}</text>')
    for periods in (1, 10, 100, 800):
        x = x_of(2 * math.pi * periods)
        parts.append(f'<path d="M{x:.1f} {height - bottom}v5" stroke="{TEXT}"/>')
        parts.append(f'<text x="{x:.1f}" y="{height - bottom + 20}" fill="{TEXT}" text-anchor="middle">{periods}</text>')
    parts.append(f'<text x="{(left + width - right) / 2}" y="{height - 10}" fill="{TEXT}" text-anchor="middle">periods; evaluations of the equations per unit of time</text>')
    for name, method, colour in CURVES:
        points = [(x, y) for x, y in series[name] if math.log10(x) >= start]
        # A running maximum is constant between its points; one point for each pixel is enough.
        kept, last = [], None
        for x, y in points:
            if last is None or x_of(x) - last >= 1.0 or (x, y) == points[-1]:
                kept.append((x_of(x), y_of(y)))
                last = x_of(x)
        path = "".join(f"{'L' if index else 'M'}{x:.1f} {y:.1f}" for index, (x, y) in enumerate(kept))
        parts.append(f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="2.5" stroke-linejoin="round"/>')
        x, y = kept[-1]
        parts.append(f'<text x="{x + 10:.1f}" y="{y:.1f}" fill="{colour}" font-weight="600">{method}</text>')
        parts.append(f'<text x="{x + 10:.1f}" y="{y + 18:.1f}" fill="{TEXT}" font-size="15">{evaluations[name]}</text>')
    return "\n".join([*parts, "</svg>\n"])


def mechanism(command):
    """A four-bar linkage over one turn of its crank, as an animation that repeats."""
    frames = 120
    text = lab(command, "run", "four-bar", "--h", "0.001", "--until", "4")
    rows = csv.DictReader(line for line in text.splitlines() if not line.startswith("#"))
    nodes = [tuple(float(row[name]) for name in ("t", "x1", "y1", "x2", "y2")) for row in rows]
    # The motion is periodic: one turn of the crank from (0, 1) and back.
    turned, angle = 0.0, math.atan2(nodes[0][2], nodes[0][1])
    for count, (_, x, y, *_) in enumerate(nodes):
        new = math.atan2(y, x)
        turned += (new - angle + math.pi) % (2 * math.pi) - math.pi
        angle = new
        if abs(turned) >= 2 * math.pi:
            break
    period = nodes[count][0]
    width, height, scale = 430, 400, 76.0
    place = lambda x, y: (100 + scale * x, 262 - scale * y)
    at = lambda k: nodes[round(count * k / frames)][1:]
    joints = [[place(x1, y1), place(x2, y2)] for x1, y1, x2, y2 in map(at, range(frames + 1))]
    middle = lambda one, other: ((one[0] + other[0]) / 2, (one[1] + other[1]) / 2)
    left, right = place(0, 0), place(3, 0)
    text_of = lambda points: " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    bars = [text_of([left, one, other, right]) for one, other in joints]
    # At half speed.
    timing = f'dur="{2 * period:.2f}s" repeatCount="indefinite"'
    animate = lambda name, values: f'<animate attributeName="{name}" values="{";".join(values)}" {timing}/>'
    def joint(points, radius, colour):
        xs, ys = [f"{x:.1f}" for x, _ in points], [f"{y:.1f}" for _, y in points]
        return f'<circle cx="{xs[0]}" cy="{ys[0]}" r="{radius}" fill="{colour}">{animate("cx", xs)}{animate("cy", ys)}</circle>'
    path = [middle(*pair) for pair in joints]
    ground = "".join(f'<path d="M{x - 14} {y + 16}h28M{x} {y}l-9 16M{x} {y}l9 16" stroke="{TEXT}" stroke-width="2" fill="none"/>' for x, y in (left, right))
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" {FONT} font-size="16">',
        "<title>A four-bar linkage, integrated in the coordinates of its joints with three constraints</title>",
        f'<rect width="{width}" height="{height}" rx="8" fill="#ffffff"/>',
        f'<polygon points="{text_of(path[:-1])}" fill="none" stroke="#e16f24" stroke-width="1.5" stroke-dasharray="3 3"/>',
        ground,
        f'<polyline points="{bars[0]}" fill="none" stroke="#1f2328" stroke-width="6" stroke-linejoin="round" stroke-linecap="round">{animate("points", bars)}</polyline>',
        joint([one for one, _ in joints], 7, "#0969da"),
        joint([other for _, other in joints], 7, "#0969da"),
        joint(path, 5, "#e16f24"),
        "".join(f'<circle cx="{x}" cy="{y}" r="6" fill="{TEXT}"/>' for x, y in (left, right)),
        f'<text x="{width / 2}" y="{height - 14}" fill="{TEXT}" text-anchor="middle">A closed loop of four bars</text>',
    ]
    return "\n".join([*parts, "</svg>\n"])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--command", nargs="+", default=["cargo", "run", "--release", "--quiet", "--"])
    parser.add_argument("--example", nargs="+", default=["cargo", "run", "--release", "--quiet", "--example", "energy_error"])
    arguments = parser.parse_args()
    for name, picture, command in [("energy", energy, arguments.example), ("four-bar", mechanism, arguments.command)]:
        path = FOLDER / f"{name}.svg"
        path.write_text(picture(command), encoding="utf-8")
        print(f"{path.relative_to(ROOT)}: {path.stat().st_size} bytes")


if __name__ == "__main__":
    main()
