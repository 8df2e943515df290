"""Type stubs of systems, so that editors and type checkers know their parameters."""

from __future__ import annotations

import inspect
import sys
from typing import Any

from ._errors import ABOUT, FIELDS
from ._system import System

_PACKAGE = '''\
"""Variational integrators of mechanical systems, generated from a Lagrangian."""

from typing import Any

from numpy.typing import ArrayLike, NDArray
from numpy import float64

from ._cell import load_ipython_extension as load_ipython_extension
from ._compare import Comparison as Comparison, compare as compare
from ._compile import CompileError as CompileError, compile as compile, warm as warm
from ._constraints import Projected as Projected
from ._control import Equilibrium as Equilibrium, Linearization as Linearization
from ._ensemble import Ensemble as Ensemble
from ._events import Event as Event, Period as Period
from ._explanation import Explanation as Explanation
from ._fit import Fit as Fit, Unidentifiable as Unidentifiable, fit as fit
from ._optimise import EnergyBalance as EnergyBalance, Optimum as Optimum, optimise as optimise
from ._robots import Robot as Robot, from_mjcf as from_mjcf, from_urdf as from_urdf
from ._rotations import quaternion_rate as quaternion_rate, rotation_matrix as rotation_matrix
from ._run import LocalError as LocalError, Run as Run
from ._solution import Events as Events, Solution as Solution
from ._stubs import stubs as stubs
from ._system import System as System

__version__: str
systems: list[str]

class StepError(ArithmeticError):
    """A step failed. The numbers of the failure are attributes."""

    reason: str
    fields: dict[str, Any]
    solution: Solution | None
'''

_MODULE = """\
from numpy.typing import ArrayLike, NDArray
from numpy import float64

from variational import System
"""


def stubs(module: Any = None) -> str:
    """The type stubs of a module of systems; of `variational` itself without one."""
    package = sys.modules[__package__]
    module = package if module is None else module
    parts = [_MODULE]
    if module is package:
        parts = [_PACKAGE, *(_exception(name) for name in FIELDS)]
    names = [*vars(module), *package.systems] if module is package else vars(module)
    found = {name: getattr(module, name) for name in names}
    classes = {of for of in found.values() if isinstance(of, type) and issubclass(of, System)}
    parts += [_system(cls) for cls in sorted(classes, key=lambda cls: cls.__name__) if cls is not System]
    return "\n".join(parts)


def _exception(name: str) -> str:
    bases = "StepError, ValueError" if name == "InvalidInput" else "StepError"
    fields = [f"    {field}: {kind}" for field, kind in FIELDS[name].items()]
    return "\n".join([f"class {name}({bases}):", f'    """{ABOUT[name]}"""', "", *fields, ""])


def _system(cls: type[System]) -> str:
    lines = [f"class {cls.__name__}(System):", *_quoted(cls._kind.about), ""]
    signature = []
    for name in cls.parameters:
        read, written = ("float", "float") if cls.__dict__[name].length is None else ("NDArray[float64]", "ArrayLike")
        signature.append(f"{name}: {written} = ...")
        lines += [
            "    @property",
            f"    def {name}(self) -> {read}: ...",
            f"    @{name}.setter",
            f"    def {name}(self, value: {written}) -> None: ...",
        ]
    lines.append(f"    def __init__({', '.join(['self', *(['*'] if signature else []), *signature])}) -> None: ...")
    return "\n".join([*lines, ""])


def _quoted(about: str) -> list[str]:
    """A docstring."""
    text = inspect.cleandoc(about).replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
    if not text:
        return []
    first, *rest = text.splitlines()
    lines = [f'    """{first}', *(f"    {line}".rstrip() for line in rest)]
    return [*lines, '    """'] if rest else [lines[0] + '"""']
