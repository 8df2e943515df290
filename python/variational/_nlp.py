"""Nonlinear programs, solved by IPOPT of CasADi's wheel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ._arrays import Array

Indices = NDArray[np.intp]


class Program(Protocol):
    """min f(x) with lower <= x <= upper and row_lower <= g(x) <= row_upper: a `Transcription` of the core."""

    def row_bounds(self) -> list[tuple[float, float]]: ...

    def jacobian_pattern(self) -> tuple[list[int], list[int]]:
        """The places of the Jacobian of g in compressed columns: starts of columns, and rows."""

    def hessian_pattern(self) -> tuple[list[int], list[int]]:
        """The same of the upper half of the Hessian matrix."""

    def evaluate(self, x: Array) -> tuple[float, Array, Array, Array, Any]:
        """f, its gradient, g, and the entries of the Jacobian of g; NaN if they do not exist."""

    def hessian(self, x: Array, weight: float, multipliers: Array) -> Array:
        """The entries of the Hessian matrix of weight f + multipliers · g."""


@dataclass(frozen=True)
class Solved:
    """The last point of the solver."""

    x: Array
    cost: float
    multipliers: Array
    violations: Array
    """Of the rows, then of the bounds: by how much each is missed, or 0."""
    iterations: int
    success: bool
    status: str


def solve(program: Program, bounds: tuple[Array, Array], start: Array, options: dict[str, Any]) -> Solved:
    """Solves a program with bounds of its variables from a start. `options` are those of IPOPT."""
    try:
        import casadi
    except ImportError:
        raise ImportError("optimise needs IPOPT of casadi: pip install casadi") from None
    last: dict[str, Any] = {"x": None, "of": None}

    def at(x: Any) -> tuple[float, Array, Array, Array, Any]:
        # IPOPT requests values and derivatives one after the other.
        point = np.asarray(x, dtype=float).ravel()
        if last["x"] is None or not np.array_equal(last["x"], point):
            last.update(x=point.copy(), of=program.evaluate(point))
        return last["of"]

    size, rows = len(start), np.array(program.row_bounds()).reshape(-1, 2).T
    jacobian = casadi.Sparsity(rows.shape[1], size, *program.jacobian_pattern())
    hessian = casadi.Sparsity(size, size, *program.hessian_pattern())
    dense = casadi.Sparsity.dense
    none, vector, row, number = casadi.Sparsity(0, 0), dense(size), dense(rows.shape[1]), dense(1)
    values = _callback(casadi, "values", [vector], [number, row], lambda x: (at(x)[0], at(x)[2]))
    gradient = _callback(casadi, "gradient", [vector, none], [number, vector], lambda x, _: at(x)[:2])
    slopes = _callback(
        casadi, "jacobian", [vector, none], [row, jacobian], lambda x, _: (at(x)[2], casadi.DM(jacobian, at(x)[3]))
    )

    def curved(x: Any, _: Any, weight: Any, multipliers: Any) -> tuple[Any]:
        point, of_rows = (np.asarray(of, dtype=float).ravel() for of in (x, multipliers))
        return (casadi.DM(hessian, program.hessian(point, float(weight), of_rows)),)

    curvature = _callback(casadi, "hessian", [vector, none, number, row], [hessian], curved)
    x = casadi.MX.sym("x", size)
    f, g = values(x)
    # By default IPOPT relaxes bounds by 1e-8.
    usual = {"tol": 1e-10, "bound_relax_factor": 0.0, "max_iter": 1000, "print_level": 0, "sb": "yes"}
    settings: dict[str, Any] = {
        "grad_f": gradient,
        "jac_g": slopes,
        "hess_lag": curvature,
        # The values have no other derivatives.
        "no_nlp_grad": True,
        "print_time": False,
        "show_eval_warnings": False,
        "ipopt": {**usual, **options},
    }
    named: dict[str, Any] = {"x": x, "f": f, "g": g}
    try:
        solver = casadi.nlpsol("optimise", "ipopt", named, settings)
    except RuntimeError as error:
        # The solver is built from its options alone.
        raise ValueError(f"IPOPT does not take these options: {options}") from error
    lower, upper = bounds
    found = solver(x0=start, lbx=lower, ubx=upper, lbg=rows[0], ubg=rows[1])
    stats, point = solver.stats(), np.asarray(found["x"]).ravel()
    of_g = at(point)[2]
    missed = [np.maximum(rows[0] - of_g, of_g - rows[1]), np.maximum(lower - point, point - upper)]
    return Solved(
        point,
        float(found["f"]),
        np.asarray(found["lam_g"]).ravel(),
        np.maximum(np.concatenate(missed), 0.0),
        int(stats["iter_count"]),
        bool(stats["success"]),
        stats["return_status"].replace("_", " "),
    )


def _callback(casadi: Any, name: str, inputs: list[Any], outputs: list[Any], function: Any) -> Any:
    """A function of CasADi with these shapes."""

    class Callback(casadi.Callback):  # type: ignore[misc]
        def __init__(self) -> None:
            casadi.Callback.__init__(self)
            self.construct(name, {})

        def get_n_in(self) -> int:
            return len(inputs)

        def get_n_out(self) -> int:
            return len(outputs)

        def get_sparsity_in(self, index: int) -> Any:
            return inputs[index]

        def get_sparsity_out(self, index: int) -> Any:
            return outputs[index]

        def eval(self, arguments: Any) -> Any:
            return [casadi.DM(of) for of in function(*arguments)]

    return Callback()
