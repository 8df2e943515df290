"""Variational integrators of mechanical systems, generated from a Lagrangian.

>>> import variational as vi
>>> pendulum = vi.Pendulum(l=0.5)
>>> sol = pendulum.integrate(q=[1.0], v=[0.0], h=0.05).until(10.0)
>>> sol.t.shape, sol.q.shape
((201,), (201, 1))

Ready systems are in `vi.systems`. `vi.compile` makes a system from the text of its Lagrangian.
"""

from __future__ import annotations

try:
    from . import _core
except ImportError as error:
    raise ImportError(
        "variational._core is missing: this is the source folder of variational. Start Python in another folder, "
        "or build it here with `maturin develop --release`"
    ) from error

from ._binding import _bind
from ._cell import load_ipython_extension
from ._compare import Comparison, compare
from ._compile import CompileError, compile, warm
from ._constraints import Projected
from ._control import Equilibrium, Linearization
from ._ensemble import Ensemble
from ._errors import *  # noqa: F403
from ._errors import __all__ as _error_names
from ._events import Event, Period
from ._explanation import Explanation
from ._fit import Fit, Unidentifiable, fit
from ._names import meant
from ._optimise import EnergyBalance, Optimum, optimise
from ._robots import Robot, from_mjcf, from_urdf
from ._rotations import quaternion_rate, rotation_matrix
from ._run import LocalError, Run
from ._solution import Events, Solution
from ._stubs import stubs
from ._system import System
from ._text import of_text

__version__ = "0.1.0"

_texts = dict(_core.texts)
systems: list[str] = sorted([*_bind(_core, globals(), __name__), *_texts])
"""Names of the ready systems."""


def __getattr__(name: str) -> type[System]:
    """A ready system that is a text: its class is made at the first access."""
    if name not in _texts:
        close = "" if name.startswith("_") else meant(name, __all__)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}{close}", name=name, obj=None)
    globals()[name] = of_text(_texts[name], module=__name__)
    return globals()[name]


__all__ = [
    "Comparison", "CompileError", "EnergyBalance", "Ensemble", "Equilibrium", "Event", "Events", "Explanation", "Fit",
    "Linearization", "LocalError", "Optimum", "Period", "Projected", "Robot", "Run", "Solution", "System",
    "Unidentifiable", "compare", "compile", "fit", "from_mjcf", "from_urdf", "load_ipython_extension", "optimise",
    "quaternion_rate", "rotation_matrix", "stubs", "systems", "warm",
    *_error_names, *systems,
]  # fmt: skip
