#!/usr/bin/env python3
"""The picture of systems of first order: `python3 docs/figures/first_order.py`, with the standard library alone.

In: the command `vi-lab`, built by cargo, or another one by `--command`. Out: `first-order.svg`, energy errors over 10⁶
steps beside those of a two-step discretization, which this program computes, and a banana orbit. It prints the errors.
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
STEPS, EVERY = 1_000_000, 1000

# The system, its step, its text in the picture, and its colour.
RUNS = [
    ("lotka-volterra", 0.4, "predators and prey", "#0969da"),
    ("point-vortices", 1.0, "four vortices", "#1a7f37"),
    ("guiding-centre", 200.0, "guiding centre", "#8250df"),
]
MIDPOINT = ("predators and prey, two-step midpoint", "#cf222e")


def rows(command, system, h, *arguments):
    """The rows of a run by Gauss steps of four stages."""
    words = [*command, "run", system, "--method", "gauss", "--stages", "4", "--h", repr(h), *arguments]
    text = subprocess.run(words, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    rows = csv.DictReader(line for line in text.splitlines() if not line.startswith("#"))
    return [{name: float(value) for name, value in row.items() if value} for row in rows]


def largest(errors):
    """Running maxima at every thousandth step, up to the last one with a logarithm."""
    found, most = [], 0.0
    try:
        for step, error in errors:
            most = max(most, error)
            if step % EVERY == 0 and step > 0:
                found.append((step, most))
    except ValueError:
        print(f"a run ends after {step} steps")
    return found


def two_steps(start, second, h):
    """Relative energy errors of predators x and prey y by L_d = h L((z0 + z1)/2, (z1 − z0)/h), from two points."""
    energy = lambda x, y: x - math.log(x) + y - 2 * math.log(y)

    def momenta(x0, y0, x1, y1):
        """−D1 L_d and D2 L_d, with L = ln(y)/x x' − H."""
        x, y, v = (x0 + x1) / 2, (y0 + y1) / 2, (x1 - x0) / h
        theta = math.log(y) / x
        of_x, of_y = -theta / x * v - 1 + 1 / x, v / (x * y) - 1 + 2 / y
        return theta - h / 2 * of_x, -h / 2 * of_y, theta + h / 2 * of_x, h / 2 * of_y

    H, (x0, y0), (x1, y1) = energy(*start), start, second
    for step in range(1, STEPS + 1):
        yield step, abs(energy(x1, y1) / H - 1)
        _, _, p, s = momenta(x0, y0, x1, y1)
        x0, y0, x1, y1 = x1, y1, 2 * x1 - x0, 2 * y1 - y0
        for _ in range(20):
            d = 1e-6
            p0, s0, *_ = momenta(x0, y0, x1, y1)
            (px, sx, *_), (py, sy, *_) = momenta(x0, y0, x1 + d, y1), momenta(x0, y0, x1, y1 + d)
            a, b, c, e = (px - p0) / d, (py - p0) / d, (sx - s0) / d, (sy - s0) / d
            det = a * e - b * c
            dx, dy = ((p - p0) * e - b * (s - s0)) / det, (a * (s - s0) - (p - p0) * c) / det
            x1, y1 = x1 + dx, y1 + dy
            if abs(dx) + abs(dy) < 1e-13:
                break


def polyline(points, colour, width=2.5):
    path = "".join(f"{'L' if index else 'M'}{x:.1f} {y:.1f}" for index, (x, y) in enumerate(points))
    return f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"/>'


def errors(curves, width, height):
    """Running maxima of energy errors against steps, both logarithmic."""
    left, right, top, bottom, low, high = 66, 270, 50, 50, -14, 0
    x_of = lambda step: left + (math.log10(step) - 3) / 3 * (width - left - right)
    y_of = lambda error: top + (high - math.log10(error)) / (high - low) * (height - top - bottom)
    digits = lambda power: str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    parts = [f'<text x="{left}" y="30" font-size="20" fill="#1f2328">Largest relative energy error of systems of first order</text>']
    for power in range(low, high + 1, 2):
        y = y_of(10.0**power)
        parts.append(f'<path d="M{left} {y:.1f}H{width - right}" stroke="{GRID}"/>')
        parts.append(f'<text x="{left - 8}" y="{y + 4:.1f}" fill="{TEXT}" text-anchor="end">10{digits(power)}</text>')
    for power in (3, 4, 5, 6):
        x = x_of(10.0**power)
        parts.append(f'<path d="M{x:.1f} {height - bottom}v5" stroke="{TEXT}"/>')
        parts.append(f'<text x="{x:.1f}" y="{height - bottom + 20}" fill="{TEXT}" text-anchor="middle">10{digits(power)}</text>')
    parts.append(f'<text x="{(left + width - right) / 2}" y="{height - 10}" fill="{TEXT}" text-anchor="middle">steps</text>')
    for text, colour, points in curves:
        # One point for each pixel is enough.
        kept = []
        for step, error in points:
            if not kept or x_of(step) - kept[-1][0] >= 1.0 or step == points[-1][0]:
                kept.append((x_of(step), y_of(error)))
        parts.append(polyline(kept, colour))
        x, y = kept[-1]
        parts.append(f'<text x="{x + 10:.1f}" y="{y + 5:.1f}" fill="{colour}" font-weight="600">{text}</text>')
    return parts


def orbit(nodes, left, width, height):
    """The path of the guiding centre through a section of the torus: nodes of the whole run, as dots."""
    scale = 560.0
    place = lambda row: (left + width / 2 + scale * row["r"] * math.cos(row["θ"]), height / 2 - scale * row["r"] * math.sin(row["θ"]))
    dots = "".join(f"M{x:.1f} {y:.1f}h0" for x, y in map(place, nodes))
    x = left + width / 2
    return [
        f'<circle cx="{x}" cy="{height / 2}" r="{scale * 0.3}" fill="none" stroke="{GRID}"/>',
        f'<path d="M{x - 5} {height / 2}h10M{x} {height / 2 - 5}v10" stroke="{TEXT}"/>',
        f'<path d="{dots}" stroke="{RUNS[2][3]}" stroke-width="2.5" stroke-linecap="round"/>',
        f'<text x="{x}" y="{height - 10}" fill="{TEXT}" text-anchor="middle">guiding centre, 10⁶ steps</text>',
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--command", nargs="+", default=["cargo", "run", "--release", "--quiet", "--"])
    command = parser.parse_args().command
    curves, found = [], {}
    for system, h, text, colour in RUNS:
        found[system] = rows(command, system, h, "--steps", str(STEPS), "--every", str(EVERY))
        H = found[system][0]["H"]
        points = largest((EVERY * k, abs(row["H"] / H - 1)) for k, row in enumerate(found[system]))
        curves.append((text, colour, points))
    h = 0.125
    first, second = rows(command, "lotka-volterra", h, "--steps", "1")
    point = lambda row: (row["predators"], row["prey"])
    curves.append((*MIDPOINT, largest(two_steps(point(first), point(second), h))))
    for text, _, points in curves:
        print(f"{text}: " + ", ".join(f"{error:.2e} in {step} steps" for step, error in points if math.log10(step) % 1 == 0))
    width, height = 1160, 400
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" {FONT} font-size="16">',
        "<title>Energy errors of systems of first order over a million steps</title>",
        f'<rect width="{width}" height="{height}" rx="8" fill="#ffffff"/>',
        *errors(curves, 800, height),
        *orbit(found["guiding-centre"], 780, 380, height),
    ]
    (FOLDER / "first-order.svg").write_text("\n".join([*parts, "</svg>\n"]), encoding="utf-8")


if __name__ == "__main__":
    main()
