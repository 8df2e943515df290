"""Exceptions: one class for each variant of the typed error, with its fields."""

import pickle
import re

import pytest

import variational as vi
from variational import _core
from variational._errors import ABOUT, ADVICE, FIELDS, _exception

TYPES = {
    "f64": "float",
    "u32": "int",
    "usize": "int",
    "&'static str": "str",
    "f32": "float",
    "Option<&'static str>": "str | None",
    "&'static [&'static str]": "list[str]",
    "Residuals": "list[float]",
    "Option<[f64; 2]>": "list[float] | None",
}


def declared():
    """The variants of `StepError` in the source of the library."""
    text = dict(_core.sources())["vi-core/src/error.rs"]
    body = text[text.index("pub enum StepError {") :]
    body = body[: body.index("\n}\n")]
    variants = re.findall(r"^    (\w+) \{\n(.*?)^    \},", body, re.MULTILINE | re.DOTALL)
    fields = {name: re.findall(r"^        (\w+): (.*),$", inner, re.MULTILINE) for name, inner in variants}
    return {name: {field: TYPES[kind] for field, kind in inner} for name, inner in fields.items()}


def test_there_is_a_class_for_each_variant():
    assert declared() == FIELDS
    assert set(ABOUT) == set(FIELDS)
    assert set(ADVICE) <= set(FIELDS)
    for name in FIELDS:
        cls = getattr(vi, name)
        assert issubclass(cls, vi.StepError)
        assert issubclass(cls, ValueError) == (name == "InvalidInput")
    assert issubclass(vi.StepError, ArithmeticError)


@pytest.mark.parametrize("name", FIELDS)
def test_advice_has_words_of_python(name):
    values = {
        "float": 0.5,
        "int": 3,
        "str": "x",
        "str | None": None,
        "list[str]": ["x"],
        "list[float]": [1.0],
        "list[float] | None": None,
    }
    error = _exception(name, "the reason", {field: values[kind] for field, kind in FIELDS[name].items()})
    assert type(error) is getattr(vi, name)
    assert error.reason == "the reason"
    assert not re.search(r"with_|::|FixedStep|EnergyPreserving", str(error))
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.reason, again.fields) == (str(error), error.reason, error.fields)


FAILURES = {
    "NonFinite": lambda: vi.Kepler().integrate([0.0, 0.0], h=0.1).steps(1),
    "Singular": lambda: vi.Pendulum(m=0.0).integrate([1.0], h=0.1),
    "StagesNotConverged": lambda: vi.Pendulum().integrate([1.0], [50.0], h=50.0).steps(3),
    "NotConverged": lambda: vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=0.5, method="fixed").steps(100),
    "NoForwardStep": lambda: vi.DoubleWell().integrate([1.001], h=0.01, method="energy").steps(1000),
    "NoForwardGaussStep": lambda: (
        vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=0.05, method="energy", stages=3).until(3.0)
    ),
    "StepRatio": lambda: vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=0.02, method="energy", stages=3).until(3.0),
    "InvalidInput": lambda: vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=0.1).until(-1.0),
}


ROD = {"q": [0.6, -0.8], "h": 0.05, "method": "energy", "stages": 2}
OF_METHODS = {
    "a run": lambda: vi.RodPendulum().integrate(**ROD).until(5.0),
    "a step": lambda: [run.step() for run in [vi.RodPendulum().integrate(**ROD)] for _ in range(100)],
    "times": lambda: vi.RodPendulum().integrate(**ROD).at([5.0]),
    "events": lambda: vi.RodPendulum().integrate(**ROD).events("x", 5.0),
    "a callback": lambda: vi.RodPendulum().integrate(**ROD).until(5.0, callback=lambda run: None),
}


@pytest.mark.parametrize("name", OF_METHODS)
def test_advice_names_methods_of_the_system(name):
    with pytest.raises(vi.StepError, match=r'or (with )?method="gauss"') as caught:
        OF_METHODS[name]()
    assert "fixed" not in str(caught.value)


def test_advice_of_an_ensemble_names_methods_of_the_system():
    rods = vi.RodPendulum().ensemble(**ROD, until=5.0)
    assert 'method="gauss"' in str(rods.errors[0]) and "fixed" not in str(rods.errors[0])
    well = vi.DoubleWell().ensemble([1.001], h=0.01, method="energy", until=10.0)
    assert 'method="fixed" or method="gauss" and h=' in str(well.errors[0])
    assert "stages=1 and shift_from=duration" in str(well.errors[0])


@pytest.mark.parametrize("name", FAILURES)
def test_fields_have_their_types(name):
    with pytest.raises(getattr(vi, name)) as caught:
        FAILURES[name]()
    types = {"float": float, "int": int, "str": str, "str | None": (str, type(None)), "list[float]": list}
    assert list(caught.value.fields) == list(FIELDS[name])
    for field, kind in FIELDS[name].items():
        value = getattr(caught.value, field)
        assert isinstance(value, types[kind]), field
        assert value == caught.value.fields[field]


def test_a_dead_point_names_what_passes_it():
    dead_point = _exception("Singular", "the reason", {"t": 0.5, "matrix": "mass matrix bordered by the constraints"})
    assert "run.events(…), which passes it" in str(dead_point)
    assert str(_exception("Singular", "the reason", {"t": 0.5, "matrix": "mass matrix"})) == "the reason"


def test_a_step_beyond_a_table_has_its_numbers():
    Slow = vi.System("""struct Slow {
        coord x;
        table drag(v) = [(0, 0), (1, 1), (2, 3)];
        L = dot(x)^2 / 2 + x;
        force x = -drag(dot(x)) / 10;
    }""")
    with pytest.raises(
        vi.Undefined, match=r"`drag\(dot\(x\)\)` is given for 0 to 2.*take shorter steps, or stop"
    ) as raised:
        Slow().integrate([0.0], h=0.1).until(10.0)
    assert raised.value.range == [0.0, 2.0] and raised.value.argument > 2.0 and raised.value.t > 2.0
