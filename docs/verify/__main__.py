"""Checks the formulas of docs/mathematics.md and docs/theory.md: `python docs/verify`, with the packages of
requirements.txt. Each statement runs twice: as the page has it, and with formulas off by a thousandth, when it must fail.
"""

import sys
import time

from mpmath import mp

import kinds
import mathematics  # noqa: F401, registers its statements
import theory  # noqa: F401


def run(page, quotes, function):
    """One line on a statement, and whether it is as it should be."""
    mp.dps = 40
    start = time.perf_counter()
    try:
        kinds.quoted(page, quotes)
        function(kinds.right)
    except kinds.Wrong as error:
        return f"WRONG    {function.__name__}: {error}", False
    try:
        function(kinds.spoilt)
    except kinds.Wrong:
        return f"{time.perf_counter() - start:6.1f} s {function.__name__}", True
    return f"BLIND    {function.__name__}: it accepts a formula off by a thousandth", False


def main():
    chosen = sys.argv[1:]
    statements = [row for row in kinds.STATEMENTS if not chosen or row[2].__name__ in chosen]
    try:
        kinds.quoted("mathematics.md", ["no page has this sentence"])
        raise SystemExit("a quote that no page has was found")
    except kinds.Wrong:
        pass
    failed = 0
    for row in statements:
        line, is_right = run(*row)
        print(f"{row[0]:15} {line}", flush=True)
        failed += not is_right
    print(f"{len(statements)} statements, {failed} wrong")
    return min(failed, 1)


if __name__ == "__main__":
    raise SystemExit(main())
