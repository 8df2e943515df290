"""The reasons why a step fails, as exceptions of one family for all modules."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._solution import Solution


class StepError(ArithmeticError):
    """A step failed. The numbers of the failure are attributes.

    `reason` is the message without advice, `fields` has all attributes, and `solution` the rows up to the failure if
    a run was under way.
    """

    __module__ = "variational"

    reason: str
    fields: dict[str, Any]
    solution: Solution | None

    def __init__(self, message: str = "", reason: str | None = None, fields: Mapping[str, Any] | None = None):
        super().__init__(message)
        self.reason = message if reason is None else reason
        self.fields = dict(fields or {})
        self.solution = None
        self.__dict__.update(self.fields)

    def __reduce__(self):
        return (type(self), (str(self), self.reason, self.fields), {"solution": self.solution})


FIELDS: dict[str, dict[str, str]] = {
    "NoForwardStep": {"t": "float", "h": "float", "excess": "float", "density": "float"},
    "NoForwardGaussStep": {
        "t": "float", "h": "float", "stages": "int", "excess": "float", "density": "float", "shift": "float",
        "largest": "float",
    },
    "ShiftTooLarge": {
        "t": "float", "h": "float", "shift": "float", "part": "float", "size": "float", "shorter": "float",
    },
    "DegenerateStep": {"t": "float", "h": "float", "density": "float"},
    "StepRatio": {"t": "float", "previous": "float", "found": "float"},
    "LengthsLost": {"t": "float", "h": "float"},
    "StepBounds": {"t": "float", "found": "float", "h_min": "float", "h_max": "float"},
    "NotConverged": {
        "t": "float", "h": "float", "iterations": "int", "residual": "float", "residuals": "list[float]",
        "turn": "float",
    },
    "TooLong": {"t": "float", "h": "float", "longest": "float"},
    "StagesNotConverged": {
        "t": "float", "h": "float", "iterations": "int", "change": "float", "contraction": "float",
        "stiffness": "float",
    },
    "TimeScale": {"t": "float", "g": "float"},
    "NoTimeScale": {"system": "str"},
    "NotSeparable": {"system": "str"},
    "NoStepDensity": {"table": "str"},
    "NoRule": {"system": "str"},
    "RuleTooLarge": {"system": "str"},
    "HasConstraints": {"system": "str"},
    "FirstOrder": {"system": "str"},
    "Ambiguous": {"t": "float"},
    "Singular": {"t": "float", "matrix": "str"},
    "NonFinite": {"t": "float", "quantity": "str", "expression": "str | None"},
    "Undefined": {"t": "float", "function": "str", "argument": "float", "range": "list[float] | None"},
    "InconsistentStart": {"constraint": "str", "residual": "float", "rate": "float"},
    "DroppedConstraint": {"t": "float", "constraint": "str", "residual": "float"},
    "NotAssembled": {
        "t": "float",
        "constraint": "str",
        "residual": "float",
        "gap": "float",
        "passed": "float",
    },
    "InconsistentTangent": {"t": "float", "constraint": "str", "residual": "float", "impulse": "float"},
    "Redundant": {"constraint": "str", "of": "int", "rank": "int"},
    "NoEquilibrium": {"t": "float", "coordinate": "str", "force": "float"},
    "FreeMotion": {"t": "float", "coordinate": "str"},
    "CannotLeave": {"t": "float", "event": "int", "value": "float", "within": "float"},
    "NoDerivative": {"t": "float", "because": "str"},
    "UnknownParameter": {"system": "str", "parameters": "list[str]"},
    "OtherSystem": {"system": "str", "parameter": "str | None", "stored": "float", "given": "float"},
    "Tolerance": {"t": "float", "estimate": "float", "tolerance": "float"},
    "InvalidInput": {"input": "str", "allowed": "str", "value": "float"},
}  # fmt: skip
"""The exceptions, and the types of their attributes."""

ABOUT: dict[str, str] = {
    "NoForwardStep": "No energy-preserving step exists past this point.",
    "NoForwardGaussStep": "No energy-preserving step with stages exists past this point.",
    "ShiftTooLarge": "The shift of the step density outweighs the energy.",
    "DegenerateStep": "The step density vanishes, so that the step length is not determined.",
    "StepRatio": "The length of the only forward step differs too much from that of the last step.",
    "LengthsLost": "No length of an adaptive step fits the forces: they change too fast.",
    "StepBounds": "The step that solves the equations is shorter or longer than allowed.",
    "NotConverged": "The Newton iteration ended above the rounding floor.",
    "TooLong": "The step has no solution that continues those of short steps.",
    "StagesNotConverged": "The stages of a Gauss step did not converge.",
    "TimeScale": "The time scale g of dt = g dτ is not positive, not finite, or too small.",
    "NoTimeScale": "The method steps in transformed time, but the system has no time scale.",
    "NotSeparable": "The motion of the system does not split into kicks and drifts.",
    "NoStepDensity": "The method preserves the energy, but L contains a monotone table.",
    "NoRule": "The method needs a quadrature rule, but the system declares none.",
    "RuleTooLarge": "The equations of a step by the rule have too many terms, in a system of a text.",
    "HasConstraints": "The system has constraints, which the method does not keep.",
    "FirstOrder": "L is linear in the velocities: the system has no mass matrix, which the method needs.",
    "Ambiguous": "Two velocities have the same momenta.",
    "Singular": "A matrix to invert is singular.",
    "NonFinite": "A quantity is infinite or not a number.",
    "Undefined": "A table or a Rust function has no value at an argument.",
    "InconsistentStart": "A state does not satisfy a constraint.",
    "DroppedConstraint": "A dropped constraint does not hold at the end of a step.",
    "NotAssembled": "No state on the constraints was found from a guess.",
    "InconsistentTangent": "A tangent vector does not satisfy the derivatives of a constraint and of its rate.",
    "Redundant": "The constraints depend on each other at the start.",
    "NoEquilibrium": "No equilibrium was found near the guess.",
    "FreeMotion": "The stiffness is singular: a motion has no restoring force.",
    "CannotLeave": "The trajectory cannot leave the zero of an event.",
    "NoDerivative": "The step has no derivative.",
    "UnknownParameter": "The system has no parameter of the given name.",
    "OtherSystem": "The checkpoint belongs to another system, or to other parameters.",
    "Tolerance": "The error of a step exceeds the tolerance.",
    "InvalidInput": "An input is outside of its allowed range.",
}

ADVICE: dict[str, str] = {
    "NoForwardStep": "continue with fallback=True, or with {others} and h={h:.3g}{shifted}",
    "StepRatio": "continue with fallback=True, or with {others} and h={previous:.3g}{shifted}",
    "DegenerateStep": "continue with fallback=True, or with {others} and h={h:.3g}",
    "LengthsLost": 'start with a shorter h or a smaller tolerance, or use method="gauss"',
    "StepBounds": "continue with fallback=True, or with {others}",
    "NoForwardGaussStep": (
        "use shift={twice:.3e}, which exceeds the largest |D| so far, fallback=True, or {others} with h={h:.3g}"
    ),
    "ShiftTooLarge": "start with h={shorter:.1g} or shorter",
    "NotConverged": "take a step shorter than h={h:.3g}",
    "TooLong": "try h={longest:.3g}",
    "StagesNotConverged": "take a step shorter than h={h:.3g}",
    "TimeScale": "take a shorter dtau, or write a time_scale that stays well above zero",
    "NoTimeScale": "write the clause `time_scale = …;` in its definition, or use h= in place of dtau=",
    "NotSeparable": 'use method="gauss"',
    "NoStepDensity": 'make the table cubic, or use method="fixed" or "gauss"',
    "NoRule": 'add `discretize midpoint;` to its definition, or use method="gauss"',
    "RuleTooLarge": 'use method="gauss"',
    "HasConstraints": 'use method="gauss"',
    "FirstOrder": 'use method="gauss"',
    "Ambiguous": "write a Lagrangian with one branch",
    "InconsistentStart": "system.project(q, v) moves a state onto the constraints and returns by how much",
    "DroppedConstraint": "start elsewhere, or correct its lengths",
    "NotAssembled": "check lengths and anchors of `{constraint}` and its neighbours, or start from another guess",
    "InconsistentTangent": "choose changes of the start that keep the constraint",
    "Redundant": "start from system.independent(q, t=…), which drops the constraints that follow from the others, "
    "here {dependent} of {of}, such as `{constraint}`; start elsewhere if bars are in one line, where several "
    "motions may begin",
    "Undefined": "take shorter steps, or stop the run before it gets there",
    "CannotLeave": "set the velocity toward the zero to zero with run.set_state, or search without event {event}",
    "OtherSystem": "restart with the parameters of the checkpoint",
    "Tolerance": "take a shorter h, a method of higher order, or a larger tolerance",
}
"""What to do, in the words of this package."""

__all__ = ["StepError", *FIELDS]

for _name in FIELDS:
    globals()[_name] = type(
        _name,
        (StepError, ValueError) if _name == "InvalidInput" else (StepError,),
        {"__module__": "variational", "__doc__": ABOUT[_name], "__annotations__": dict(FIELDS[_name])},
    )


_ENERGY_STEPS = ("NoForwardStep", "StepRatio", "DegenerateStep", "StepBounds", "NoForwardGaussStep")
"""Failures whose advice names other methods."""


def _exception(variant: str, reason: str, fields: Mapping[str, Any]) -> StepError:
    """The exception of a failed step: Rust calls this with the name and the fields of its error."""
    message = _message(variant, reason, fields, (("gauss", 8, False), ("fixed", None, False), ("energy", 1, False)))
    return globals().get(variant, StepError)(message, reason, fields)


def advised(error: Any, cls: Any) -> Any:
    """The exception, whose advice names only integrators that the class of a system has; None for None."""
    variant = type(error).__name__
    if variant in _ENERGY_STEPS:
        error.args = (_message(variant, error.reason, error.fields, cls.integrators),)
    return error


def _message(
    variant: str, reason: str, fields: Mapping[str, Any], integrators: Iterable[tuple[str, int | None, bool]]
) -> str:
    """The reason, and what to do in a system with these integrators."""
    numbers = {**fields, "twice": 2.0 * fields.get("largest", 0.0), "h": abs(fields.get("h", 0.0))}
    numbers["dependent"] = fields.get("of", 0) - fields.get("rank", 0)
    if variant == "NotConverged" and numbers["h"] == 0.0:
        return f"{reason}; start from the momenta of a velocity, or take a shorter h"
    if variant == "Redundant" and not fields.get("rank"):
        return f"{reason}; correct its lengths, or start elsewhere"
    if variant == "Singular" and fields.get("matrix") == "mass matrix bordered by the constraints":
        return (
            f"{reason}; there the constraints depend on each other, as at a dead point with bars in one line, where "
            "several motions may begin, or a motion along them has no mass: a step may pass such a place, but none "
            "ends there; take another length or time, or run.events(…), which passes it; a mechanism with more "
            "constraints than it needs moves as system.independent(q, t=…), and system.project(q) finds such q"
        )
    if variant == "Tolerance" and not fields.get("estimate"):
        return f"{reason}; give a step length h"
    if variant not in ADVICE:
        return reason
    built = [(method, stages) for method, stages, is_transformed in integrators if not is_transformed]
    others = dict.fromkeys(method for method, _ in built if method in ("gauss", "fixed"))
    least = min((stages for method, stages in built if method == "energy" and stages), default=None)
    numbers["others"] = " or ".join(f'method="{method}"' for method in others) or "a method of compile"
    numbers["shifted"] = f"; with stages={least} and shift_from=duration, steps exist" if least else ""
    return f"{reason}; {ADVICE[variant].format_map(numbers)}"


def at_row(error: Any, row: str) -> Any:
    """The exception of a failure among many states, which names this one."""
    error.args = (f"{row}: {error.args[0]}",)
    return error


def _invalid(input: str, allowed: str, value: float) -> StepError:
    """The exception of an input that this package finds wrong."""
    message = f"{input} must be {allowed}, not {value!r}"
    return globals()["InvalidInput"](message, message, {"input": input, "allowed": allowed, "value": value})
