"""The mathematics of a system, for reading and for Jupyter."""

from __future__ import annotations

import re
from dataclasses import dataclass

from ._calls import unassignable


@unassignable()
@dataclass(frozen=True, eq=False, repr=False)
class Explanation:
    """The mathematics of a system."""

    title: str
    text: str
    """All of it as text."""
    sections: list[tuple[str, list[tuple[str, str]]]]
    """Titles of sections with their formulas (left, right) in LaTeX; words have an empty left side."""

    def __repr__(self) -> str:
        return self.text

    def equations(self) -> str:
        """L, the momenta, the energy and the force, in LaTeX. The step density D, a long formula, is left to `text`."""
        for _, lines in self.sections:
            rows = [f"{left} &= {right}" for left, right in lines if left and left != "D"]
            if rows:
                return "$$\\begin{aligned}" + " \\\\ ".join(rows) + "\\end{aligned}$$"
        return ""

    @property
    def operations(self) -> dict[str, int]:
        """The number of operations of each function."""
        _, _, listed = self.text.partition("\nOperations of each function\n")
        rows = (line.split() for line in listed.split("\n\n")[0].splitlines())
        return {row[0]: int(row[1]) for row in rows if len(row) == 2}

    def latex(self) -> str:
        """All formulas in LaTeX, by sections, for a document with the package amsmath."""
        parts = []
        for title, lines in self.sections:
            rows = [f"{left} &= {right}" for left, right in lines if left]
            if rows:
                body = " \\\\\n".join(rows)
                parts.append(f"\\subsection*{{{_escaped(title)}}}\n\\begin{{align*}}\n{body}\n\\end{{align*}}")
        return "\n\n".join(parts)

    def _repr_markdown_(self) -> str:
        parts = [f"### {self.title}"]
        for title, lines in self.sections:
            parts.append(f"**{title}**")
            parts += [f"$${left} = {right}$$" if left else f"- {right}" for left, right in lines]
        return "\n\n".join(parts)


def _escaped(words: str) -> str:
    """Words with the signs of LaTeX escaped."""
    return re.sub(r"[#$%&_{}]", r"\\\g<0>", words).replace("^", "\\^{}")
