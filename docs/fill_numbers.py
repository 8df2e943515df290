#!/usr/bin/env python3
"""Writes measured numbers into the pages: `python3 docs/fill_numbers.py`; with `--check` it fails if a page differs.

In: `numbers.toml`, `rivals.json`, and the tables that programs have written into `benchmarks.md` and `expansion.md`. Out: the
text between `<!-- number: NAME -->` and `<!-- end -->` in the pages. Standard library only.
"""

import json
import math
import re
import sys
import tomllib
from decimal import ROUND_HALF_UP, Decimal
from pathlib import Path

DOCS = Path(__file__).resolve().parent
PAGES = [DOCS.parent / "README.md", DOCS / "choosing.md", DOCS / "benchmarks.md", DOCS / "joss/paper.md"]
ERRORS = ["1e-3", "1e-6", "1e-9", "1e-12"]  # of benches/rivals/tables.py
PLACE = re.compile(r"(<!-- number: ([a-z0-9 -]+) -->)(.*?)(<!-- end -->)", re.DOTALL)


def short(value):
    """A number with no decimals from 10 on, with one below."""
    digits = "1" if value >= 9.95 else "0.1"
    return str(Decimal(str(value)).quantize(Decimal(digits), ROUND_HALF_UP))


def times(values):
    """The range of some ratios."""
    return f"{short(min(values))} to {short(max(values))}"


def rows(page, first):
    """Cells of the lines of a page that begin with this cell."""
    lines = (DOCS / page).read_text(encoding="utf-8").splitlines()
    return [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in lines if line.startswith(f"| {first} |")]


def contests():
    """Nanoseconds of each stepper of each contest in the default table of benchmarks.md."""
    text = (DOCS / "benchmarks.md").read_text(encoding="utf-8")
    table = text.split("<!-- default: begin -->")[1].split("<!-- default: end -->")[0]
    found, contest = {}, None
    for line in table.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if cells[0].startswith("**"):
            contest = found.setdefault(cells[0].strip("*"), {})
        elif contest is not None and len(cells) > 1:
            contest[cells[0]] = float(cells[1])
    return found


def table(head, body):
    """A table on lines of its own."""
    lines = [head, ["---"] * len(head), *body]
    return "\n" + "".join("| " + " | ".join(line) + " |\n" for line in lines)


def places():
    """The text of each place."""
    numbers = tomllib.loads((DOCS / "numbers.toml").read_text(encoding="utf-8"))
    ns = contests()
    fixed = {name: f"{name}, fixed step, h = 0.01" for name in ("Double well", "Kepler", "Double pendulum", "Triple pendulum")}
    energy = {name: f"{name}, energy-preserving, h0 = 0.01" for name in ("Double well", "Kepler", "Double pendulum")}
    generated, hand, dual, ensemble = "generated", "by hand, sums compensated", "Newton, dual numbers", "ensemble of 64, one core"

    def speed(label, contest, columns):
        return [label, *(short(ns[contest][column]) if column in ns[contest] else "" for column in columns)]

    columns = [generated, hand, dual, ensemble]
    gains = [ns[contest][generated] / ns[contest][ensemble] for contest in fixed.values()]
    links = {row[1]: row for row in rows("expansion.md", "links by positions")}
    bodies = {row[1]: row for row in rows("expansion.md", "bodies in space")}
    micro = lambda row: short(float(row[6])) + " µs"
    methods = numbers["methods"]
    rivals = json.loads((DOCS / "rivals.json").read_text(encoding="utf-8"))
    systems = list(rivals["systems"].values())
    against_heyoka = [system for system in systems if "heyoka" in system]
    return {
        "dop853": table(
            ["error", *(system["name"] for system in against_heyoka)],
            [[ERRORS[i], *(system["dop853"][i] for system in against_heyoka)] for i in (1, 2)],
        ),
        "rivals dop853": table(
            ["DOP853 ÷ ours", "ours, 1e-6", *ERRORS],
            [[system["motion"], system["ours"], *system["dop853"]] for system in systems],
        ),
        "rivals heyoka": table(
            ["heyoka ÷ ours", *ERRORS],
            [[system["motion"], *system["heyoka"]] for system in against_heyoka],
        ),
        "rivals machine": rivals["measured"],
        "speed": table(
            ["", "generated", "by hand", "dual numbers", "ensemble, each"],
            [
                speed("double well, fixed step", fixed["Double well"], columns),
                speed("Kepler, fixed step", fixed["Kepler"], columns),
                speed("double pendulum, energy-preserving", energy["Double pendulum"], columns),
            ],
        ),
        "cost of energy": times([ns[energy[name]][generated] / ns[fixed[name]][generated] for name in energy]),
        "cost of an ensemble": f"1/{math.floor(max(gains) + 0.5)} to 1/{math.floor(min(gains) + 0.5)}",
        "gain of an ensemble": f"{math.floor(min(gains) + 0.5)} to {math.floor(max(gains) + 0.5)}",
        **{f"cost of {name}": times(methods[name]) for name in ("gauss", "transformed gauss", "energy gauss")},
        "cost of a force": f"{min(methods['force']):.1f} to {max(methods['force']):.1f}",
        "links 40": micro(links["40"]),
        "links 80": micro(links["80"]),
        "bodies 40": micro(bodies["40"]),
        "lines of large systems": f"{links['40'][3]} and {bodies['40'][3]}",
        "build of large systems": f"{links['40'][5]} and {bodies['40'][5]} s",

    }


def main():
    check, texts, used, wrong = "--check" in sys.argv[1:], places(), set(), []
    for page in PAGES:
        old = page.read_text(encoding="utf-8")

        def filled(place):
            if place[2] not in texts:
                raise SystemExit(f"{page.name}: there is no number `{place[2]}`: {', '.join(texts)}")
            used.add(place[2])
            return place[1] + texts[place[2]] + place[4]

        new = PLACE.sub(filled, old)
        if new.count("<!-- number:") != len(PLACE.findall(new)):
            raise SystemExit(f"{page.name}: a place has no `<!-- end -->`")
        if new != old and check:
            wrong.append(page.name)
        elif new != old:
            page.write_text(new, encoding="utf-8")
    if unused := set(texts) - used:
        raise SystemExit(f"no page has the numbers {', '.join(sorted(unused))}")
    if wrong:
        raise SystemExit(f"python3 docs/fill_numbers.py changes {', '.join(wrong)}")


if __name__ == "__main__":
    main()
