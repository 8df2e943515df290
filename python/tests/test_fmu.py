"""Systems as co-simulation units of FMI 3.0, by FMPy."""

import zipfile
from itertools import pairwise

import numpy as np
import pytest

import variational as vi
from variational import _fmu

fmpy = pytest.importorskip("fmpy")
fmi3 = pytest.importorskip("fmpy.fmi3")
validate_fmu = pytest.importorskip("fmpy.validation").validate_fmu

CART = """
/// A pendulum on a cart.
struct Cart {
    /// Masses of the cart and of the pendulum.
    param m[2] = 1.0;
    param l = 0.5, g = 9.81;
    /// Force of the motor.
    input u = 0.0;
    coord x, θ;
    let height = -l * cos(θ);
    L = m[0] * dot(x)^2 / 2 + m[1] * (dot(x + l * sin(θ))^2 + dot(height)^2) / 2 - m[1] * g * height;
    force x = u;
}
"""
START = {"x(0)": 0.0, "θ(0)": 0.3, "dot(x)(0)": 0.0, "dot(θ)(0)": 0.0}
OUTPUTS = ["x", "θ", "dot(x)", "dot(θ)", "p_x", "p_θ", "energy"]


@pytest.fixture(scope="module")
def unit(warm_cache, tmp_path_factory):
    """The unit of a cart."""
    cart = vi.System(CART)(m=[1.0, 0.2])
    return cart.fmu(tmp_path_factory.mktemp("fmu") / "cart.fmu", [0.0, 0.3], method="gauss", stages=4, h=0.01)


@pytest.fixture(scope="module")
def begin(unit):
    """Begins the run that the unit has, of the system as cargo compiles it."""
    Cart = vi.compile(CART, methods="gauss 4")
    return lambda q=(0.0, 0.3), **of: Cart(**{"m": [1.0, 0.2], **of}).integrate(q, method="gauss", stages=4, h=0.01)


class Instance(fmi3.FMU3Slave):
    """An instance of the unit, with variables by name, and its messages."""

    def __init__(self, folder, token=None):
        description = fmpy.read_model_description(folder)
        super().__init__(
            guid=token or description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="cart",
        )
        self.numbers = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.messages = []
        self.instantiate(logMessage=lambda *of: self.messages.append(of[-1].decode()))

    def begin(self, **start):
        self.set(**start)
        self.enterInitializationMode()
        self.exitInitializationMode()
        return self

    def set(self, **values):
        self.setFloat64([self.numbers[name] for name in values], list(values.values()))

    def get(self, *names):
        return self.getFloat64([self.numbers[name] for name in names])


@pytest.fixture(scope="module")
def unpacked(unit):
    """The folder of the unit, whose instances share one library."""
    return fmpy.extract(str(unit), unit.parent)


@pytest.fixture
def instance(unpacked):
    made = []

    def make():
        made.append(Instance(unpacked))
        return made[-1]

    yield make
    for of in made:
        of.fmi3FreeInstance(of.component)


def outputs(run):
    return [*run.q, *run.v, *run.p, run.energy]


def test_the_description_is_valid(unit):
    assert validate_fmu(str(unit)) == []
    description = fmpy.read_model_description(unit)
    of = {variable.name: variable for variable in description.modelVariables}
    assert list(of) == ["time", "m[0]", "m[1]", "l", "g", "u", *START, *OUTPUTS]
    assert {name: float(of[name].start) for name in START} == START
    assert [float(of[name].start) for name in ("m[0]", "m[1]", "l", "g", "u")] == [1.0, 0.2, 0.5, 9.81, 0.0]
    assert (of["u"].causality, of["u"].description) == ("input", "Force of the motor.")
    assert (of["g"].causality, of["g"].variability) == ("parameter", "tunable")
    assert description.defaultExperiment.stepSize == "0.01"
    with zipfile.ZipFile(unit) as file:
        assert file.read("resources/definition.txt").decode() == CART


# Whole steps, the end within a step, and communication steps within one.
@pytest.mark.parametrize("interval", [0.05, 0.025, 0.003])
def test_a_simulation_is_the_run_to_the_bit(unit, begin, interval):
    start = {"m[1]": 0.5, "θ(0)": 1.0, "g": 1.62}
    found = fmpy.simulate_fmu(
        str(unit), stop_time=0.6, output_interval=interval, start_values=start, output=OUTPUTS, fmi_type="CoSimulation"
    )
    run = begin([0.0, 1.0], m=[1.0, 0.5], g=1.62)
    rows = [outputs(run)]
    times = found["time"].tolist()
    for before, after in pairwise(times):
        run.until(before + (after - before))
        rows.append(outputs(run))
    assert len(rows) == round(0.6 / interval) + 1
    assert np.array_equal(rows, [[row[name] for name in OUTPUTS] for row in found])


def test_inputs_and_parameters_change_the_next_step(instance, begin):
    cart, run = instance().begin(), begin()
    for step in range(20):
        values = {"u": float(np.sin(step)), "l": 0.5 + 0.01 * (step // 10)}
        cart.set(**values)
        # Outputs are those of the state until the step.
        assert cart.get(*OUTPUTS) == outputs(run)
        run.set(**values)
        cart.doStep(0.1 * step, 0.1)
        run.until(0.1 * step + 0.1)
        assert cart.get("time", *OUTPUTS) == [run.t, *outputs(run)]
    assert abs(run.q[0]) > 0.1


def test_instances_states_and_reset(instance):
    first, second = instance().begin(), instance().begin(**{"θ(0)": 2.0})

    def steps(of, begins, count=5):
        rows = []
        for step in range(begins, begins + count):
            of.doStep(0.025 * step, 0.025)
            rows.append(of.get(*OUTPUTS))
        return rows

    alone = steps(first, 0, 10)
    first.reset()
    first.begin()
    together = []
    for step in range(10):
        together += steps(first, step, 1)
        steps(second, step, 1)
    assert together == alone
    first.reset()
    first.begin()
    steps(first, 0)
    state = first.getFMUState()
    stored = first.serializeFMUState(state)
    assert steps(first, 5) == alone[5:]
    first.setFMUState(state)
    assert steps(first, 5) == alone[5:]
    first.freeFMUState(state)
    # Another instance continues from the stored state.
    state = second.deserializeFMUState(stored)
    second.setFMUState(state)
    second.freeFMUState(state)
    assert steps(second, 5) == alone[5:]
    with pytest.raises(fmpy.fmi1.FMICallException):
        second.deserializeFMUState(stored[:-1])
    assert "the stored state is not of this unit" in second.messages[-1]


def refused(instance, message, function, *arguments):
    with pytest.raises(fmpy.fmi1.FMICallException) as caught:
        function(*arguments)
    assert caught.value.status == 3  # fmi3Error
    assert message in instance.messages[-1]


def test_errors_are_statuses_with_messages(instance, unpacked):
    cart = instance()
    refused(cart, "the first step follows the initialization", cart.doStep, 0.0, 0.1)
    refused(cart, "must be finite", cart.setFloat64, [cart.numbers["g"]], [np.nan])
    refused(cart, "cannot be set", cart.setFloat64, [cart.numbers["energy"]], [1.0])
    refused(cart, "there is no variable with the reference 99", cart.getFloat64, [99])
    refused(cart, "the unit does not have fmi3GetInt32", cart.getInt32, [1])
    cart.set(l=0.0)
    cart.enterInitializationMode()
    refused(cart, "singular", cart.exitInitializationMode)
    cart.reset()
    cart.begin()
    refused(cart, "until the initialization ends", cart.setFloat64, [cart.numbers["θ(0)"]], [1.0])
    cart.doStep(0.0, 0.1)
    refused(cart, "the step begins at 0.5, but the unit is at 0.1", cart.doStep, 0.5, 0.1)
    # No step of 0.01 follows such a pendulum.
    cart.set(g=1e12)
    refused(cart, "step", cart.doStep, 0.1, 0.1)
    cart.reset()
    cart.begin()
    cart.doStep(0.0, 0.1)
    with pytest.raises(Exception, match="Failed to instantiate"):
        Instance(unpacked, token="another")


def test_names_of_the_text_come_first():
    """Two variables of a unit have two names."""
    text = "struct Twice { param energy = 1.0, p_x = 2.0; coord x; L = p_x * dot(x)^2 / 2 - energy * x^2; }"
    names = [of["name"] for of in _fmu._variables(vi.System(text)(), np.zeros(1), np.zeros(1))]
    assert names == ["time", "energy", "p_x", "x(0)", "dot(x)(0)", "x", "dot(x)", "p_x_", "energy_"]


def test_what_cannot_be_a_unit(tmp_path, monkeypatch):
    monkeypatch.setenv("VARIATIONAL_CACHE", str(tmp_path))
    cart, path = vi.System(CART)(), tmp_path / "cart.fmu"
    with pytest.raises(TypeError, match="give one of h, tolerance and dtau"):
        cart.fmu(path)
    with pytest.raises(vi.InvalidInput, match="h must be positive for an FMU"):
        cart.fmu(path, h=-0.01)
    with pytest.raises(ValueError, match="has no integrator"):
        cart.fmu(path, h=0.01, stages=5)
    with pytest.raises(ValueError, match="q must have 2 entries"):
        cart.fmu(path, [0.0], h=0.01)
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        cart.fmu(tmp_path / "none" / "cart.fmu", h=0.01)
    assert not path.exists()
