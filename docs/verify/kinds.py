"""Statements of a page, and the four kinds of checks.

A statement is a function of one argument, `claim`. It passes each formula of the page through `claim` and compares the
result with a derivation of its own. In a second run `claim` spoils the formulas by a thousandth: then the function has
to fail. A decorator names the page and quotes it, so that page and program cannot differ.
"""

from pathlib import Path

import sympy
from mpmath import mp, mpf

PAGES = Path(__file__).resolve().parent.parent
STATEMENTS = []


class Wrong(AssertionError):
    """A statement of a page does not hold."""


def statement(page, *quotes):
    """Registers a statement with the sentences or formulas of the page that it checks."""

    def register(function):
        STATEMENTS.append((page, quotes, function))
        return function

    return register


def quoted(page, quotes):
    """Fails if the page does not contain a quote, up to spaces."""
    text = " ".join((PAGES / page).read_text(encoding="utf-8").split())
    for quote in quotes:
        if " ".join(quote.split()) not in text:
            raise Wrong(f"{page} does not contain: {quote}")


def right(value, by=None):
    """The formula as the page has it."""
    return value


def spoilt(value, by="1/1000"):
    """The formula, off by this part of itself and of one: by default a thousandth, more for numbers of few digits."""
    part = sympy.Rational(by)
    if isinstance(value, sympy.MatrixBase):
        return value.applyfunc(lambda entry: spoilt(entry, by))
    if isinstance(value, sympy.Basic):
        return value * (1 + part) + part
    part = mpf(part.p) / part.q
    return value * (1 + part) + part


def same(found, wanted):
    """Identity: two expressions are equal for all values of their symbols."""
    difference = found - wanted
    entries = list(difference) if isinstance(difference, sympy.MatrixBase) else [difference]
    for entry in entries:
        rest = sympy.sympify(entry)
        rest = sympy.expand(rest.doit())
        if rest != 0 and sympy.simplify(rest) != 0 and sympy.expand(rest.rewrite(sympy.exp)) != 0:
            raise Wrong(f"not identical, by {rest}")


def close(found, wanted, tolerance):
    """Number: two numbers agree up to an absolute tolerance."""
    if not abs(mpf(found) - mpf(wanted)) <= mpf(tolerance):
        raise Wrong(f"{mp.nstr(mpf(found), 12)} instead of {mp.nstr(mpf(wanted), 12)}")


def limit(function, wanted, tolerance, h="1e-3"):
    """Limit: the value at h = 0 of a smooth function of h, extrapolated from h, h/2, h/4 and h/8."""
    row = [function(mpf(h) / 2**k) for k in range(4)]
    for k in range(1, 4):
        row = [(2**k * row[i + 1] - row[i]) / (2**k - 1) for i in range(len(row) - 1)]
    close(row[0], wanted, tolerance)


def holds(is_true, what):
    """Fact: a comparison of numbers."""
    if not is_true:
        raise Wrong(what)
