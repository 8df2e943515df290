"""Runs: output, events, changes on the way, derivatives, errors, checkpoints."""

import copy
import pickle

import numpy as np
import pytest

import variational as vi


def test_shapes_and_ends(kepler):
    sol = kepler.until(1.03)
    assert sol.t[-1] == kepler.t == 1.03
    assert sol.q.shape == sol.p.shape == sol.v.shape == (22, 2)
    assert sol.q.flags.c_contiguous
    assert np.array_equal(sol["x"], sol.q[:, 0])
    assert np.array_equal(sol["dot(y)"], sol.v[:, 1])
    # Measured: 3.3e-16.
    assert np.ptp(sol.energy) < 1e-15
    assert len(kepler.steps(10, every=5)) == 3
    assert len(kepler.steps(11, every=5)) == 4
    assert len(kepler.steps(0)) == 1
    assert kepler.until(kepler.t).t.tolist() == [kepler.t]


def test_repr(kepler):
    assert repr(kepler).startswith("<Run of Kepler(")
    assert "by gauss, stages=8: t = 0, h = 0.05>" in repr(kepler)
    assert repr(kepler.until(1.0)).endswith("21 rows, t = 0 to 1>")


def test_backwards(kepler):
    q = kepler.q
    kepler.until(2.0)
    back = vi.Kepler().integrate(kepler.q, p=kepler.p, t=2.0, h=-0.05)
    # Measured: 1.8e-16.
    np.testing.assert_allclose(back.until(0.0).q[-1], q, rtol=0.0, atol=1e-15)


def test_dense_output_backwards(kepler):
    end = kepler.until(2.0)
    back = vi.Kepler().integrate(kepler.q, p=kepler.p, t=2.0, h=-0.05).until(0.0, dense=True)
    # Measured: 2.4e-11.
    np.testing.assert_allclose(back(end.t), end.y, rtol=0.0, atol=1e-10)


def test_dense_output_of_no_step(kepler):
    sol = kepler.steps(0, dense=True)
    assert np.array_equal(sol(0.0), sol.y[:, 0])
    assert sol([0.0, 0.0]).shape == (4, 2)


def test_output_at_times_keeps_the_steps(kepler):
    aside = kepler.copy()
    sol = kepler.at([0.01, 0.2, 1.234])
    assert sol.t.tolist() == [0.01, 0.2, 1.234]
    aside.steps(24)
    assert np.array_equal(kepler.q, aside.q)
    far = vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=0.05, stages=4)
    near = far.copy()
    end = far.at([2000.0]).q[-1]
    near.until(1999.0)
    # Measured: 1.1e-16.
    assert np.abs(end - near.at([2000.0]).q[-1]).max() < 1e-15


def test_a_callback_sees_each_row_and_changes_the_run():
    run = vi.Pendulum().integrate([1.0], h=0.05)
    seen = []

    def callback(run):
        seen.append(run.t)
        run.set(g=run.system.g * 1.01)

    sol = run.until(1.0, every=2, callback=callback)
    assert seen == sol.t[1:].tolist()
    assert run.system.g == pytest.approx(vi.Pendulum().g * 1.01 ** len(seen))
    stopped = run.steps(100, callback=lambda run: run.t > 1.2)
    assert run.t == pytest.approx(1.25)
    assert len(stopped) == 6

    def wrong(run):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        run.steps(10, callback=wrong)


def test_a_callback_does_not_change_the_numbers(kepler):
    aside = kepler.copy()
    assert np.array_equal(kepler.until(1.03, callback=lambda run: None).q, aside.until(1.03).q)


def test_energy_is_preserved_and_a_missing_step_is_an_exception():
    run = vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=0.005, method="energy")
    energies = [run.step().discrete_energy for _ in range(100)]
    # Measured: 0.
    assert np.ptp(energies) < 1e-15
    run = vi.DoubleWell().integrate([1.001], h=0.01, method="energy")
    with pytest.raises(vi.NoForwardStep, match="fallback=True") as caught:
        run.steps(1000)
    error = caught.value
    assert isinstance(error, vi.StepError)
    assert error.fields == {"t": error.t, "h": error.h, "excess": error.excess, "density": error.density}
    assert error.t == error.solution.t[-1] == run.t
    assert "fallback" not in error.reason
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), again.fields, str(again)) == (type(error), error.fields, str(error))
    assert len(again.solution) == len(error.solution)
    sol = run.steps(1000, on_error="return")
    assert (sol.success, sol.status) == (False, -1)
    assert sol.message == str(sol.error)
    on = vi.DoubleWell().integrate([1.001], h=0.01, method="energy", fallback=True)
    assert on.steps(1000).success


def test_a_shift_goes_on():
    run = vi.Pendulum().integrate([1.0], [6.0], h=0.01, method="energy", stages=2, shift_from=5.0)
    run.steps(500)
    assert run.shift > 0.0
    start = run.shifted_energy
    run.steps(500)
    # Measured: 0.
    assert run.shifted_energy == pytest.approx(start, rel=1e-15)
    assert vi.Pendulum().integrate([1.0], h=0.01).shift is None


def test_a_tolerance_finds_the_step():
    run = vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], tolerance=1e-9).monitor()
    run.until(20.0)
    assert 0.0 < run.h < 1.0
    # Measured: 1.7e-9 at another place than where the step was chosen.
    assert 1e-10 < run.error_estimate.estimate < 2e-9
    assert run.error_estimate.coordinate in ("x", "y")
    # The errors of all steps: more than that of one, and at most as if each had the largest.
    assert 1.0 < run.error_estimate.sum / run.error_estimate.estimate <= 20.0 / run.h + 1.0
    assert run.local_error().q.shape == (2,)


def test_steps_of_a_given_length(kepler):
    kepler.step(0.01)
    assert (kepler.t, kepler.h) == (0.01, 0.01)
    kepler.step()
    assert kepler.h == 0.05


def test_an_event_in_each_turn():
    # An angle without forces turns uniformly: it is at 0.3 plus whole turns at exact times.
    Wheel = vi.System("struct Wheel { angle θ; L = dot(θ)^2 / 2; }")
    for v in (2.0, -2.0):
        run = Wheel().integrate([0.0], [v], h=0.1)
        every = vi.Event("theta", 0.3, period=2 * np.pi)
        exact = np.array([0.3 + 2 * np.pi * k for k in range(-6, 7)]) / v
        exact = np.sort(exact[(exact > 0.0) & (exact < 15.0)])
        found = run.copy().events(every, 15.0)
        np.testing.assert_allclose(found.t, exact, rtol=0.0, atol=1e-14)  # 1.8e-15
        assert (found.rising == (v > 0.0)).all()
        along, against = (vi.Event("θ", 0.3, np.copysign(1.0, v) * sign, 2 * np.pi) for sign in (1, -1))
        assert np.array_equal(run.copy().events([along, against], 15.0).t, found.t)
        assert set(run.copy().events([against, along], 15.0).which) == {1}
        # The first event, past those of the other direction.
        stops = run.copy()
        times = [stops.next_event(along, 15.0).t[0] for _ in exact]
        np.testing.assert_allclose(times, exact, rtol=0.0, atol=1e-14)  # 1.8e-15
        assert len(stops.next_event(along, 15.0)) == 0 and stops.t == 15.0
        assert len(run.next_event(against, 15.0)) == 0 and run.t == 15.0

    # Without a whole turn it is the event of the value.
    for direction in (-1, 0, 1):
        pendulum = vi.Pendulum().integrate([2.5], h=0.05)
        plain = pendulum.copy().events(vi.Event("θ", 0.2, direction), 30.0)
        turning = pendulum.copy().events(vi.Event("θ", 0.2, direction, 2 * np.pi), 30.0)
        np.testing.assert_allclose(turning.t, plain.t, rtol=0.0, atol=1e-14)  # 0
        assert np.array_equal(turning.rising, plain.rising)
    with pytest.raises(ValueError, match="period of an event must be positive"):
        vi.Pendulum().integrate([2.5], h=0.05).events(vi.Event("θ", period=0.0), 1.0)


def test_an_event_in_each_turn_of_an_expression_and_a_momentum():
    # Two wheels: the sum of their angles turns uniformly, and a constant torque makes the momentum rise uniformly.
    Wheels = vi.System("struct Wheels { angle a, b; L = dot(a)^2 / 2 + dot(b)^2; force a = 1; force b = -2; }")
    run = Wheels().integrate([0.0, 0.0], [0.5, 1.5], h=0.1)
    for direction, count in ((0, 4), (1, 4), (-1, 0)):
        found = run.copy().events(vi.Event("a + b", 0.3, direction, 2.0 * np.pi), 10.0)
        assert len(found) == count and found.rising.all()
        np.testing.assert_allclose(found["a + b"], 0.3 + 2.0 * np.pi * np.arange(len(found)), atol=1e-13)
    found = run.events(vi.Event("p_a", period=2.0), 10.0)
    np.testing.assert_allclose(found["p_a"], [2.0, 4.0, 6.0, 8.0, 10.0], atol=1e-13)
    np.testing.assert_allclose(found.t, np.arange(1.5, 10.0, 2.0), atol=1e-13)
    assert found.rising.all()


def test_several_events_of_one_search(kepler):
    def apart(t, q, v):
        return q[0] ** 2 + q[1] ** 2 - 1.0

    events = kepler.events(["y", vi.Event("dot(x)", direction=-1), vi.Period(1.0), apart], until=20.0)
    assert set(events.which) == {0, 1, 2, 3}
    assert np.all(np.diff(events.t) >= 0.0)
    # Measured: 2.2e-16, 1.1e-16 and 0.
    assert np.abs(events.of(0)["y"]).max() < 1e-15
    assert np.abs(events.of(1)["dot(x)"]).max() < 1e-15
    np.testing.assert_allclose(events.of(2).t, np.arange(1.0, len(events.of(2)) + 1), rtol=0.0, atol=1e-14)
    assert not events.of(1).rising.any()


def test_a_run_stops_at_an_event():
    run = vi.Pendulum().integrate([0.5], h=0.05)
    angle = vi.Pendulum.coordinates[0]
    impact = run.next_event(vi.Event(angle), until=10.0)
    assert len(impact) == 1
    assert run.t == impact.t[0]
    before = run.v[0]
    run.set_state(v=-0.8 * run.v)
    assert run.v[0] == pytest.approx(-0.8 * before, rel=1e-15)
    assert len(run.next_event(angle, until=run.t + 1e-3)) == 0


def test_exceptions_of_event_functions_come_out(kepler):
    def wrong(t, q, v):
        raise KeyError("mine")

    for search in (kepler.events, kepler.next_event):
        with pytest.raises(KeyError, match="mine"):
            search(wrong, until=50.0)
    with pytest.raises(vi.NonFinite):
        kepler.events(lambda t, q, v: np.nan, until=50.0)
    with pytest.raises(RuntimeError, match=r"run\.copy"):
        kepler.events(lambda t, q, v: kepler.t, until=50.0)
    assert kepler.step().t > 0.0


def changed_event(name, value):
    def event(t, q, v):
        return q[0]

    setattr(event, name, value)
    return event


REFUSED = [
    (lambda run: setattr(run.system, "l", 5.0), AttributeError, r"run\.set\(l=…\) changes the run"),
    (lambda run: run.system.set(l=5.0, g=1.0), AttributeError, r"run\.set\(l=…, g=…\) changes the run"),
    (lambda run: setattr(run.until(1.0).system, "l", 5.0), AttributeError, r"run\.set\(l=…\)"),
    (lambda run: setattr(pickle.loads(pickle.dumps(run.until(1.0))).system, "l", 5.0), AttributeError, r"run\.set"),
    (lambda run: run.q.__setitem__(0, 5.0), ValueError, "read-only"),
    (lambda run: run.p.__setitem__(0, 5.0), ValueError, "read-only"),
    (lambda run: run.v.__setitem__(0, 5.0), ValueError, "read-only"),
    (lambda run: run.until(1.0).q.__setitem__(0, 5.0), ValueError, "read-only"),
    (lambda run: run.until(1.0).v.__setitem__(0, 5.0), ValueError, "read-only"),
    (lambda run: run.until(1.0)["θ"].__setitem__(0, 5.0), ValueError, "read-only"),
    (lambda run: pickle.loads(pickle.dumps(run.until(1.0))).q.__setitem__(0, 5.0), ValueError, "read-only"),
    (lambda run: run.at([1.0]).energy.__setitem__(0, 5.0), ValueError, "read-only"),
    (lambda run: run.events("θ", 9.0).t.__setitem__(0, 5.0), ValueError, "read-only"),
    (lambda run: setattr(run, "q", [1.0]), AttributeError, r"run\.set_state\(q=…\)"),
    (lambda run: setattr(run, "h", 0.1), AttributeError, r"run\.step\(h\)"),
    (lambda run: setattr(run, "l", 0.1), AttributeError, r"run\.set\(l=…\)"),
    (lambda run: setattr(run, "x", 0.1), AttributeError, r"run\.x cannot be assigned"),
    (lambda run: setattr(vi.Event("θ"), "terminal", True), AttributeError, r"run\.next_event"),
    (lambda run: setattr(vi.Event("θ"), "direction", 1), AttributeError, r"write Event\(…\) with it"),
    (lambda run: setattr(vi.Event("θ"), "label", "a"), AttributeError, r"write Event\(…\) with it"),
    (lambda run: setattr(run.local_error(), "q", [1.0]), AttributeError, r"LocalError\.q cannot be assigned"),
    (lambda run: setattr(run.monitor() and run.steps(99) and run.error_estimate, "t", 1.0), AttributeError, "copy()"),
    (lambda run: setattr(run.linearization(), "A", 1.0), AttributeError, r"Linearization\.A cannot"),
    (lambda run: setattr(run.until(1.0), "t", 1.0), AttributeError, r"Solution\.t cannot be assigned.*copy\(\)"),
    (lambda run: setattr(run.until(1.0), "v", 1.0), AttributeError, r"Solution\.v cannot"),
    (lambda run: setattr(run.until(1.0), "y", 1.0), AttributeError, r"Solution\.y cannot"),
    (lambda run: setattr(run.until(1.0), "label", "a"), AttributeError, "variable of your own"),
    (lambda run: setattr(pickle.loads(pickle.dumps(run.until(1.0))), "q", 1.0), AttributeError, r"Solution\.q"),
    (lambda run: setattr(run.events("θ", 9.0), "which", 1.0), AttributeError, r"Events\.which cannot"),
    (lambda run: setattr(run.system.ensemble([1.0], h=0.1, until=1.0), "q", 1.0), AttributeError, r"Ensemble\.q"),
    (lambda run: setattr(run.system.equilibrium([0.1]), "q", 1.0), AttributeError, r"Equilibrium\.q cannot"),
    (lambda run: setattr(run.system.project([0.1]), "q", 1.0), AttributeError, r"Projected\.q cannot"),
    (lambda run: setattr(run.system.explain(), "text", ""), AttributeError, r"Explanation\.text cannot"),
    (lambda run: run.events(changed_event("terminal", True), 9.0), ValueError, "event 0, `event`, .*next_event"),
    (lambda run: run.next_event(changed_event("terminal", 3), 9.0), ValueError, "k calls of next_event"),
    (lambda run: run.next_event(changed_event("terminal", False), 9.0), ValueError, r"run\.events"),
]


@pytest.mark.parametrize("index", range(len(REFUSED)))
def test_a_change_without_effect_is_refused(index):
    change, exception, words = REFUSED[index]
    with pytest.raises(exception, match=words):
        change(vi.Pendulum().integrate([1.0], h=0.1))


def test_what_belongs_to_a_run_can_be_copied():
    run = vi.Pendulum(l=2.0).integrate([1.0], h=0.1)
    mine = run.system.copy()
    mine.l = 5.0
    assert (mine.l, run.system.l) == (5.0, 2.0)
    assert run.system == pickle.loads(pickle.dumps(run.system)).set(l=2.0)
    assert run.next_event(changed_event("terminal", True), 9.0).q.shape == (1, 1)
    q = run.q.copy()
    q[0] = 0.5
    assert run.set_state(q=q, parameters={"l": 3.0}).q[0] == 0.5 and run.system.l == 3.0


def below(t, q, v):
    return q[0] < 0.0


VALUES = [
    (below, r"event 1, `below`, returned (True|False), the truth of a condition: .* q\[0\] in place of q\[0\] < 0"),
    (lambda t, q, v: bool(q[0] < 0.0), "event 1 returned (True|False)"),
    (lambda t, q, v: None, "event 1 returned None"),
    (lambda t, q, v: q, r"event 1 returned an array of shape \(2,\): return one real number"),
    (lambda t, q, v: q[:1], r"event 1 returned an array of shape \(1,\)"),
    (lambda t, q, v: [q[0]], r"event 1 returned \["),
    (lambda t, q, v: "text", "event 1 returned 'text'"),
    (lambda t, q, v: 1j, "event 1 returned 1j"),
    (lambda t, q, v: object(), "event 1 returned <object"),
    (lambda t, y: y[0], r"event 1 must be a function g\(t, q, v\), not of \(t, y\)"),
]


@pytest.mark.parametrize("index", range(len(VALUES)))
def test_events_that_are_no_number_are_refused_by_their_name(kepler, index):
    event, words = VALUES[index]
    for search in (kepler.events, kepler.next_event):
        with pytest.raises(TypeError, match=words):
            search(["y", event], until=50.0)


def test_events_of_other_numbers_are_found():
    def found(event):
        return vi.Pendulum().integrate([1.0], h=0.05).events(event, until=10.0).t

    usual = found(lambda t, q, v: q[0])
    for other in (lambda t, q, v: float(q[0]), lambda t, q, v: np.array(q[0]), lambda t, q, v: np.longdouble(q[0])):
        assert np.array_equal(found(other), usual)
    assert len(usual) == 3
    # An integer changes its sign too, within the rounding of time.
    signs = found(lambda t, q, v: int(np.sign(q[0])) or 1)
    np.testing.assert_allclose(signs, usual, rtol=0.0, atol=1e-12)


def test_parameters_change_on_the_way():
    run = vi.Pendulum().integrate([1.0], h=0.01)
    run.set(l=2.0, g=1.0)
    assert (run.system.l, run.system.g) == (2.0, 1.0)
    with pytest.raises(vi.InvalidInput):
        run.set(l=np.nan)
    with pytest.raises(TypeError, match="did you mean 'l'"):
        run.set(ll=1.0)


RUNS = [
    {"method": "fixed", "h": 0.01},
    {"method": "suzuki-4", "h": 0.01},
    {"method": "kahan-li-8", "h": 0.01},
    {"method": "splitting-4", "h": 0.01},
    {"method": "splitting-6", "h": 0.02},
    {"method": "gauss", "h": 0.05},
    {"method": "gauss", "stages": 4, "h": 0.05},
    {"method": "energy", "h": 0.01},
    {"method": "energy", "stages": 2, "h": 0.01},
    {"dtau": 0.1},
]


@pytest.mark.parametrize("options", RUNS)
def test_a_run_is_pickled_bit_for_bit(options):
    run = vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], **options)
    run.steps(10)
    others = [pickle.loads(run.checkpoint()), copy.copy(run), copy.deepcopy(run), run.copy()]
    run.steps(100)
    for other in others:
        other.steps(100)
        assert np.array_equal(run.q, other.q)
        assert np.array_equal(run.p, other.p)
        assert (run.t, run.h) == (other.t, other.h)


# Rounding moves the ends of energy-preserving steps with stages, and so limits differences.
DIFFERENCES = [(options, 1e-4 if options.get("method") == "energy" else 1e-6) for options in RUNS[:-2]]
DIFFERENCES += [({"method": "energy", "stages": 2, "h": 0.05}, 1e-4), ({"dtau": 0.1}, 1e-6)]


@pytest.mark.parametrize(("options", "d"), DIFFERENCES)
def test_tangents_are_derivatives(options, d):
    def end(mu, x):
        run = vi.Kepler(mu=mu).integrate([x, 0.0], p=[0.0, 2.0], **options)
        run.steps(10)
        return np.concatenate([run.q, run.p])

    found = vi.Kepler().integrate([0.4, 0.0], p=[0.0, 2.0], **options).tangent(10, ["mu"])
    of_mu = (end(1.0 + d, 0.4) - end(1.0 - d, 0.4)) / (2 * d)
    of_x = (end(1.0, 0.4 + d) - end(1.0, 0.4 - d)) / (2 * d)
    # Measured: at most 3.0e-6, the error of the differences.
    np.testing.assert_allclose(found["mu"], of_mu, rtol=0.0, atol=5e-6)
    np.testing.assert_allclose(found["q"][:, 0], of_x, rtol=0.0, atol=5e-6)


@pytest.mark.parametrize("options", RUNS[:5])
def test_steps_of_given_length_are_symplectic(options):
    tangent = vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], **options).tangent(100)
    # Measured: at most 2.4e-14.
    assert np.linalg.det(np.hstack([tangent["q"], tangent["p"]])) == pytest.approx(1.0, abs=5e-14)


def test_long_tangents_are_products(kepler):
    """Beyond 4096 steps the derivatives are chained."""
    name = vi.Kepler.parameters[0]
    start = kepler.copy()
    whole = kepler.tangent(6000, [name])
    first = start.tangent(3000, [name])
    second = start.tangent(3000, [name])
    product = np.hstack([second["q"], second["p"]])
    # Measured: 4.9e-10, rounding after 6000 steps.
    np.testing.assert_allclose(whole["q"], product @ first["q"], rtol=1e-9)
    np.testing.assert_allclose(whole[name], product @ first[name] + second[name], rtol=1e-9)


@pytest.mark.parametrize("steps", [30, 5000])
def test_gradients_are_rows_of_tangents(kepler, steps):
    name = vi.Kepler.parameters[0]
    aside = kepler.copy()
    tangent = aside.tangent(steps, [name])
    gradient = kepler.gradient(steps, q=[1.0, 0.5], p=[0.0, 2.0], wrt=[name])
    slope = np.array([1.0, 0.5, 0.0, 2.0])
    # Measured: 2.2e-16 after 30 steps, 4.3e-12 after 5000.
    np.testing.assert_allclose(gradient["q"], slope @ tangent["q"], rtol=1e-11)
    np.testing.assert_allclose(gradient["p"], slope @ tangent["p"], rtol=1e-11)
    np.testing.assert_allclose(gradient[name], slope @ tangent[name], rtol=1e-11)
    assert np.array_equal(kepler.q, aside.q)


def test_tables_and_plots(kepler):
    pandas = pytest.importorskip("pandas")
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    sol = kepler.until(1.0)
    frame = sol.to_dataframe()
    assert isinstance(frame, pandas.DataFrame)
    assert list(frame.columns) == ["t", "x", "y", "dot(x)", "dot(y)", "p_x", "p_y", "energy"]
    above, below = sol.plot()
    assert [line.get_label() for line in above.lines] == ["x", "y"]
    assert len(below.lines) == 1


@pytest.mark.parametrize("begin", [lambda run: run, lambda run: run.step(0.02), lambda run: run.set(mu=1.1)])
def test_solutions_are_pickled_with_their_dense_output(kepler, begin):
    sol = begin(kepler).until(1.0, every=3, dense=True)
    times = np.linspace(sol.t[0], 1.0, 50)
    for again in (pickle.loads(pickle.dumps(sol)), copy.deepcopy(sol)):
        assert np.array_equal(again.q, sol.q) and again.sol is again
        assert np.array_equal(again(times), sol(times))
        assert np.array_equal(pickle.loads(pickle.dumps(again))(times), sol(times))
    plain = pickle.loads(pickle.dumps(kepler.until(2.0)))
    with pytest.raises(ValueError, match="dense=True"):
        plain(1.5)
    again = pickle.loads(pickle.dumps(sol))
    vars(again)["q"] = again.q + 1e-12
    with pytest.raises(ValueError, match="cannot be restored"):
        again(0.5)


def test_dense_output_of_a_failed_run_is_pickled():
    run = vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=0.05, method="energy", stages=3)
    sol = run.until(3.0, dense=True, on_error="return")
    again = pickle.loads(pickle.dumps(sol))
    assert not again.success and np.array_equal(again(sol.t), sol(sol.t))


def test_a_callback_may_move_the_run_beyond_the_end():
    sol = vi.Pendulum().integrate([1.0], h=0.1).until(1.0, callback=lambda run: run.until(run.t + 0.3))
    assert sol.success and sol.t[-1] <= 1.0


METHODS = [
    {"h": 0.1},
    {"method": "fixed", "h": 0.01},
    {"method": "kahan-li-6", "h": 0.05},
    {"method": "splitting-6", "h": 0.05},
    {"method": "energy", "h": 0.01},
    {"method": "energy", "stages": 2, "h": 0.05},
    {"dtau": 0.1},
]


ENDS = [{"steps": 20}, {"until": 1.234}]
ENDS += [{"until": 9.0, "event": event} for event in (vi.Event("y", 0.5), vi.Event("mu * x * dot(y)", 0.1))]


@pytest.mark.parametrize("options", [*METHODS, {"method": "adaptive", "h": 0.1}], ids=str)
@pytest.mark.parametrize("before", [0, 3])
@pytest.mark.parametrize("end", ENDS, ids=str)
@pytest.mark.parametrize("second", ["p", "v"])
def test_the_gradient_is_that_of_the_tangent(options, before, end, second):
    def run():
        found = vi.Kepler().integrate([0.5, 0.1], [0.1, 1.6], **options)
        found.steps(before)
        return found

    if options.get("method") == "adaptive" and end == ENDS[1]:
        end = {"until": 4.321}
    slope, velocities, at_end = np.array([0.3, -0.2, 0.7, 0.5]), second == "v", run()
    given = {"q": slope[:2], second: slope[2:], "wrt": ["mu"], "velocities": velocities}
    if "event" in end:
        slope, given["t"] = np.append(slope, 0.9), 0.9
    tangent, gradient = run().tangent(wrt=["mu"], velocities=velocities, **end), at_end.gradient(**given, **end)
    for name in ("q", second, "mu"):
        # Measured: 1e-15 of the sum of sizes; 3.4e-7 of energy-preserving Gauss steps, whose length varies much with p.
        sizes = np.abs(slope) @ np.abs(tangent[name])
        assert np.all(np.abs(gradient[name] - slope @ tangent[name]) <= 1e-6 * sizes), name
    aside = run()
    aside.tangent(**end)
    assert aside.t == at_end.t and np.array_equal(aside.q, at_end.q)


OF_ENERGY = [
    {"h": 0.01},
    {"h": 0.02, "stages": 1},
    {"h": 0.05, "stages": 2, "shift": 1000.0},
]


@pytest.mark.parametrize("options", OF_ENERGY, ids=str)
def test_the_first_length_determines_the_kept_energy(options):
    def begin(h):
        return vi.Kepler().integrate([0.5, 0.1], [0.1, 1.6], method="energy", **{**options, "h": h})

    def reached(h):
        return begin(h).steps(15).y[:, -1]

    h, d = options["h"], 1e-4 * options["h"]
    run = begin(h)
    found = run.tangent(15, ["h"], velocities=True)["h"]
    difference = (8.0 * (reached(h + d) - reached(h - d)) - (reached(h + 2 * d) - reached(h - 2 * d))) / (12.0 * d)
    # Measured: 1.4e-8, rounding of the differences.
    assert np.abs(found - difference).max() < 5e-8 * np.abs(difference).max()
    # Later the kept energy determines the lengths.
    assert not run.tangent(3, ["h"])["h"].any()


@pytest.mark.parametrize(
    "options", [{"method": "energy", "h": 0.01}, {"method": "energy", "stages": 2, "h": 0.05}, {"dtau": 0.1}]
)
def test_at_the_start_the_kept_energy_varies_with_the_state(options):
    def end(p):
        return vi.Kepler().integrate([0.5, 0.1], p=p, **options).steps(20)

    p, small = np.array([0.1, 1.6]), 1e-5
    tangent = vi.Kepler().integrate([0.5, 0.1], p=p, **options).tangent(20)["p"]
    for index in range(2):
        change = small * np.eye(2)[index]
        above, below = end(p + change), end(p - change)
        difference = (np.concatenate([above.q[-1], above.p[-1]]) - np.concatenate([below.q[-1], below.p[-1]])) / (
            2 * small
        )
        scale = np.abs(tangent).max()
        assert np.abs(difference - tangent[:, index]).max() < 1e-6 * scale


@pytest.mark.parametrize("options", METHODS, ids=lambda options: "-".join(map(str, options.values())))
def test_later_derivatives_are_those_of_set(options):
    def end(mu):
        run = vi.Kepler().integrate([0.5, 0.1], [0.1, 1.6], **options)
        run.steps(3)
        run.set(mu=mu).steps(20)
        return np.concatenate([run.q, run.p])

    run = vi.Kepler().integrate([0.5, 0.1], [0.1, 1.6], **options)
    run.steps(3)
    tangent, small = run.tangent(20, ["mu"])["mu"], 1e-6
    difference = (end(1.0 + small) - end(1.0 - small)) / (2.0 * small)
    # Measured: 5.1e-11; 6.6e-8 and 3.5e-6 of energy-preserving steps.
    assert np.abs(difference - tangent).max() < 5e-6 * np.abs(tangent).max()


def test_a_callback_ends_a_run_by_true_alone():
    sol = vi.Pendulum().integrate([1.0], h=0.1).until(5.0, callback=lambda run: run.q[0] < 0.0)
    assert sol.q[-1, 0] < 0.0 and sol.t[-1] < 5.0
    sol = vi.Pendulum().integrate([1.0], h=0.1).until(1.0, callback=lambda run: run.set(g=1.0))
    assert sol.t[-1] == 1.0


def test_rows_have_the_energy_of_their_step():
    run = vi.HarmonicOscillator(k=4.0).integrate([1.0], [1.0], h=0.1)
    energies = [run.energy]

    def heavier(run):
        energies.append(run.energy)
        run.set(m=1.5 * run.system.m)

    sol = run.until(0.5, callback=heavier)
    np.testing.assert_allclose(sol.energy, energies, rtol=1e-14)
    assert len(sol.v) == len(sol.t) == 6


def test_an_exception_of_a_callback_has_the_rows_so_far():
    def fails(run):
        if run.t > 0.25:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough") as caught:
        vi.Pendulum().integrate([1.0], h=0.1).until(1.0, callback=fails)
    assert len(caught.value.solution.t) == 4


METHODS_OF_EVENTS = [
    {"h": 0.05},
    {"h": 0.05, "method": "fixed"},
    {"h": 0.01, "method": "energy"},
    {"h": 0.05, "method": "adaptive"},
]


@pytest.mark.parametrize("options", METHODS_OF_EVENTS, ids=str)
@pytest.mark.parametrize("every", [1, 7])
def test_a_callback_does_not_change_events_and_times(options, every):
    def begun():
        return vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], **options)

    seen = []
    events = ["y", vi.Event("dot(x)", 0.1, direction=1), lambda t, q, v: q[0] + 0.3]
    alone, called = begun(), begun()
    wanted, found = alone.events(events, 15.0), called.events(events, 15.0, every=every, callback=seen.append)
    assert np.array_equal(found.which, wanted.which) and np.array_equal(found.rising, wanted.rising)
    assert len(found) > 8 and isinstance(found, vi.Events) and all(run is called for run in seen)
    assert np.array_equal(found.t, wanted.t) and np.array_equal(found.q, wanted.q)
    assert np.array_equal(called.q, alone.q) and called.t == alone.t

    alone, called = begun(), begun()
    for _ in range(4):
        wanted, found = alone.next_event("y", 15.0), called.next_event("y", 15.0, every=every, callback=seen.append)
        assert found.t.tolist() == wanted.t.tolist() == [called.t]
        assert np.array_equal(found.q, wanted.q) and np.array_equal(called.q, alone.q)
    assert not len(called.next_event(vi.Event("x", 7.0), 16.0, callback=seen.append)) and called.t == 16.0

    alone, called = begun(), begun()
    times = [0.0, 0.31, 0.32, 4.0, 4.0, 9.7]
    wanted, found = alone.at(times), called.at(times, every=every, callback=seen.append)
    assert found.t.tolist() == times and np.array_equal(found.q, wanted.q)
    assert (called.t, called.q.tolist()) == (alone.t, alone.q.tolist())
    assert len(called.at([], callback=seen.append)) == 0 and called.t == alone.t


ARM = """
struct Arm {
    param m[2] = 1.0;
    input tau[2] = 0.0;
    coord x, y;
    L = (m[0] * dot(x)^2 + m[1] * dot(y)^2) / 2;
    force x = tau[0];
    force y = tau[1];
}
"""


def test_a_solution_has_expressions_of_the_language():
    text = """struct Arm {
        param m = 1.3, l[2] = [0.9, 0.4]; input u = 0.0;
        coord θ; angle ψ;
        table drag(v) = [(-9, -2.0), (0, 0.0), (9, 2.0)] linear extend;
        let r = [l[0] * sin(θ), -l[0] * cos(θ)];
        let w = r + l[1] * [sin(ψ), -cos(ψ)];
        L = m * (dot(r) * dot(r) + dot(w) * dot(w)) / 2 - 9.81 * m * (r[1] + w[1]);
        force θ = u - drag(dot(θ));
    }"""
    arm = vi.System(text)(m=1.7)
    run = arm.integrate([0.6, -0.3], [0.4, 1.1], h=0.02)
    sol = run.until(0.4, every=2, callback=lambda run: run.set(u=run.t))
    θ, ψ, dθ, dψ = sol["θ"], sol["ψ"], sol["dot(θ)"], sol["dot(ψ)"]
    w = np.stack([0.9 * np.sin(θ) + 0.4 * np.sin(ψ), -0.9 * np.cos(θ) - 0.4 * np.cos(ψ)], axis=-1)
    rate = np.stack(
        [0.9 * np.cos(θ) * dθ + 0.4 * np.cos(ψ) * dψ, 0.9 * np.sin(θ) * dθ + 0.4 * np.sin(ψ) * dψ], axis=-1
    )
    assert sol["w"].shape == (11, 2) and np.abs(sol["w"] - w).max() < 1e-15  # 2.3e-16
    assert np.abs(sol["dot(w)"] - rate).max() < 2e-15  # 8.9e-16
    # Numbers are those of the run, an input from each row on.
    assert np.abs(sol["m * w[1] + u * t"] - (1.7 * w[:, 1] + sol["u"] * sol.t)).max() < 2e-15  # 4.5e-16
    assert np.abs(sol["drag(dot(θ))"] - 2.0 / 9.0 * dθ).max() < 1e-15  # 5.6e-17
    assert np.abs(sol["[[θ, 1], [0, ψ^2]]"][:, 1, 1] - ψ**2).max() < 1e-15
    at = arm.evaluate("m * norm(w)", 0.0, sol.q, sol.v)
    assert np.abs(at - 1.7 * np.linalg.norm(w, axis=1)).max() < 2e-15  # 4.5e-16
    other = arm.copy().set(m=2.0)
    assert np.array_equal(other.evaluate("m * norm(w)", sol), other.evaluate("m * norm(w)", sol.t, sol.q, sol.v))
    with pytest.raises(TypeError, match="needs t, q and v, or a solution"):
        arm.evaluate("norm(w)", 0.0, [0.0, 0.0])
    one = arm.evaluate("norm(w)", 0.0, [0.0, 0.0], [0.0, 0.0])
    assert isinstance(one, float) and one == pytest.approx(1.3, abs=1e-15)
    many = arm.ensemble(h=0.02, until=0.1, q=[[0.6, -0.3], [0.1, 0.2], [0.3, 0.3]], parameters={"m": [1.0, 2.0, 3.0]})
    assert np.abs(many["m * θ"] - np.array([1.0, 2.0, 3.0]) * many["θ"]).max() < 1e-15
    assert not sol["w"].flags.writeable
    chain = vi.System("struct Chain { coord x[3]; L = sum(i in 0..3, dot(x[i])^2 - x[i]^2) / 2; }")()
    steps = chain.integrate([0.1, 0.2, 0.3], h=0.1).steps(4)
    assert np.array_equal(steps["x"], steps.q) and np.array_equal(steps["dot(x)"], steps.v)
    with pytest.raises(KeyError, match="Arm has no coordinate 'z'"):
        sol["z"]
    with pytest.raises(ValueError, match="unknown name `z`\n --> expression:1:7"):
        sol["w[0] +z"]
    with pytest.raises(ValueError, match="a vector of 2 and a number cannot be added\\n --> expression:1:5"):
        arm.evaluate("w + 1", 0.0, [0.0, 0.0], [0.0, 0.0])
    with pytest.raises(TypeError, match="an expression is a text"):
        arm.evaluate(1.0, 0.0, [0.0, 0.0], [0.0, 0.0])


def test_a_run_has_values_by_name():
    arm = vi.System("""struct Arm {
        param m[2] = 1.5; input u = 0.2;
        coord x, y;
        let r = [x, y];
        L = m[0] * dot(r) * dot(r) / 2 - m[1] * r * r;
        force x = u;
    }""")()
    run = arm.integrate([0.3, 0.1], [0.5, 0.0], h=0.1).step()
    run.set(u=0.7)
    assert run["x"] == run.q[0] and run["dot(y)"] == run.v[1] and run["p_x"] == run.p[0]
    assert run["u"] == 0.7 and run["m"].tolist() == [1.5, 1.5]
    assert run["r"].tolist() == run.q.tolist() and run["u * x"] == 0.7 * run.q[0]
    with pytest.raises(KeyError, match="Arm has no coordinate 'z'"):
        run["z"]


def test_an_expression_is_an_event():
    kepler = vi.Kepler(mu=1.2)
    run = kepler.integrate(q=[0.4, 0.0], v=[0.0, 2.0], h=0.05)
    by_text, by_function = run.copy(), run.copy()
    found = by_text.events(vi.Event("norm([x, y])", 0.6, direction=-1), 30.0)
    wanted = by_function.events(lambda t, q, v: 0.6 - np.hypot(*q), 30.0)
    assert len(found) > 3 and np.abs(found.t - wanted.t[wanted.rising]).max() < 1e-13  # 1.8e-15
    assert np.abs(np.hypot(*found.q.T) - 0.6).max() < 1e-14  # 2.2e-16
    # A text alone crosses zero, in the names of the system and with the numbers of the run.
    apsis = run.copy().next_event("mu * (x * dot(x) + y * dot(y))", 30.0)
    assert abs(np.sum(apsis.q * apsis.v)) < 1e-14 and len(apsis) == 1
    changed = run.copy()
    changed.set(mu=1.0)
    at = changed.next_event(vi.Event("mu * x", 0.2), 30.0)
    assert at["x"] == pytest.approx(0.2, abs=1e-14)
    with pytest.raises(KeyError, match="Kepler has no coordinate 'z'"):
        run.next_event("z", 1.0)
    with pytest.raises(ValueError, match=r"'\[x, y\]' has the shape \(2,\)"):
        run.next_event("[x, y]", 1.0)
    with pytest.raises(ValueError, match="unknown name `z`\n --> expression:1:5"):
        run.events(vi.Event("x + z"), 1.0)
    with pytest.raises(ValueError, match="there is no event before t = 0.2"):
        run.tangent(until=0.2, event="x + y")
    momentum = run.next_event(vi.Event("p_y", 0.5), 30.0)
    assert momentum.p[0, 1] == momentum["p_y"][0] == pytest.approx(0.5, abs=1e-14)


def test_a_solution_has_the_inputs_of_its_steps():
    arm = vi.System(ARM)()
    run = arm.integrate([0.0, 0.0], h=0.1)
    sol = run.until(1.0, every=2, callback=lambda run: run.set(**{"tau[1]": run.t}))
    # Each row has the input of the steps from it on: dot(y) grows by that times 0.2.
    given = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
    assert np.abs(sol["tau[1]"] - given).max() < 1e-15  # 1.1e-16
    assert np.abs(np.diff(sol["dot(y)"]) - 0.2 * given[:-1]).max() < 1e-15  # 2.8e-16
    assert np.array_equal(sol["tau"], np.column_stack([np.zeros(6), sol["tau[1]"]]))
    assert sol["m"].tolist() == [[1.0, 1.0]] * 6 and not sol["m"].flags.writeable
    again = pickle.loads(pickle.dumps(sol))
    assert np.array_equal(again["tau"], sol["tau"]) and sol.system.tau[1] == 0.0
    frame = sol.to_dataframe()
    assert frame.columns[-2:].tolist() == ["tau[0]", "tau[1]"]
    assert np.array_equal(frame["tau[1]"], sol["tau[1]"])
    # The columns are measurements for a fit, which reads inputs in the same way.
    found = vi.fit(arm.copy().set(m=[1.0, 3.0]), frame[["t", "y", "tau[1]"]], ["m[1]"], q=[0.0, 0.0], h=0.1)
    assert found["m[1]"] == pytest.approx(1.0, abs=1e-12)
    assert np.array_equal(found.solution["tau[1]"], sol["tau[1]"])
    # Events have the inputs of the step in which they are.
    run = arm.integrate([0.0, 0.0], [1.0, 1.0], h=0.1)
    found = run.events(vi.Event("x", 0.55), 1.0, callback=lambda run: run.set(**{"tau[1]": run.t}))
    assert found["tau[1]"] == pytest.approx(0.5, abs=1e-15) and found["x"] == pytest.approx(0.55, abs=1e-15)
    many = arm.ensemble([0.0, 0.0], [1.0, 1.0], h=0.1, times=[0.5, 1.0], parameters={"tau[1]": [0.0, 1.0, 2.0]})
    assert many["tau"].shape == (3, 2, 2) and many["tau[1]"].tolist() == [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]
    assert many["y"][:, 1] == pytest.approx([1.0, 1.5, 2.0], abs=1e-14)
    assert many.to_dataframe()["tau[1]"].loc[2].tolist() == [2.0, 2.0]


def test_entries_of_arrays_have_names():
    arm = vi.System(ARM)(**{"m[1]": 3.0})
    assert arm.m.tolist() == [1.0, 3.0]
    run = arm.integrate([0.0, 0.0], [1.0, 1.0], h=0.1)
    whole, entry = run.copy().tangent(3, ["m"]), run.copy().tangent(3, ["m[1]"])
    assert np.array_equal(entry["m[1]"], whole["m"][:, 1])
    run.set_state([1.0, 2.0], [3.0, 4.0], parameters={"m[0]": 2.0})
    assert (run.q.tolist(), run.v.tolist(), run.p.tolist()) == ([1.0, 2.0], [3.0, 4.0], [6.0, 12.0])
    with pytest.raises(TypeError, match=r"m has no entry 'm\[2\]': its entries are m\[0\] to m\[1\]"):
        run.set(**{"m[2]": 1.0})
    Matrix = vi.System("struct Matrix { param K[2][2] = 1.0; coord x[2]; L = dot(x) * dot(x) / 2 - x * (K * x) / 2; }")
    assert Matrix(**{"K[1][0]": 5.0}).K.tolist() == [[1.0, 1.0], [5.0, 1.0]]


def test_output_times_that_steps_outgrow():
    start = {"q": [0.1, 0.0], "v": [0.0, 19**0.5], "dtau": 8.368 / 15}
    end = 300 * 2 * np.pi
    at, until = vi.Kepler().integrate(**start).at([end]), vi.Kepler().integrate(**start).until(end)
    # Measured: 2e-11, of an orbit with e = 0.9 after 300 periods.
    np.testing.assert_allclose(at.q[-1], until.q[-1], rtol=0.0, atol=1e-9)


def test_errors_are_measured_after_output_times():
    run = vi.Pendulum().integrate([1.0], h=0.1).monitor()
    run.at([10.0])
    assert run.error_estimate is None
    run.steps(40)
    assert run.error_estimate.estimate < 1e-12


def test_short_periods_and_numbers_that_cannot_be_stored_are_refused():
    with pytest.raises(ValueError, match="at least four steps, here 2"):
        vi.Pendulum().integrate([1.0], h=0.5).events(vi.Period(0.05), 3.02)
    with pytest.raises(ValueError, match="is not finite"):
        vi.DoubleWell().integrate([1e150], [0.1], h=0.1).checkpoint()


def test_a_failed_change_leaves_the_run():
    run = vi.Pendulum().integrate([1.0], h=0.1)
    run.step(0.03)
    with pytest.raises(vi.Singular):
        run.set(l=0.0)
    assert run.h == 0.03 and run.system.l == 1.0


def test_derivatives_do_not_depend_on_idle_calls():
    def tangent(before):
        run = vi.Kepler().integrate([0.4, 0.1], p=[0.0, 2.0], dtau=0.1)
        before(run)
        return run.tangent(5)["q"]

    plain = tangent(lambda run: None)
    for before in (lambda run: run.steps(0), lambda run: run.set(mu=1.0), lambda run: run.set_state()):
        np.testing.assert_allclose(tangent(before), plain, rtol=1e-12)


@pytest.mark.parametrize("method, stages", [("fixed", None), ("suzuki-4", None), ("gauss", 4), ("energy", 1)])
@pytest.mark.parametrize("velocities", [False, True])
@pytest.mark.parametrize("event", [None, vi.Event("x", 0.1), vi.Event("x + l * sin(a)", 0.1), vi.Event("p_x", 0.2)])
def test_derivatives_to_a_time_and_an_event(method, stages, velocities, event):
    Cart = vi.System("""
    struct Cart {
        param m = 1.3, l = 0.7, g = 9.81;
        coord x;
        angle a;
        L = dot(x)^2 / 2 + m * ((dot(x) + l * cos(a) * dot(a))^2 + (l * sin(a) * dot(a))^2) / 2 + m * g * l * cos(a)
            - 2 * x^2;
        discretize midpoint;
    }
    """)
    second = "v" if velocities else "p"
    start = np.array([0.2, 1.0, 0.5, -0.3])
    if not velocities:
        start[2:] = Cart().momentum(0.0, start[:2], start[2:])
    until, shift = (1.234, 5.0)[event is not None], 3000.0 if method == "energy" else None

    def begin(change):
        moved, system = start + change[:4], Cart(l=0.7 + change[4])
        return system.integrate(moved[:2], **{second: moved[2:]}, h=0.03, method=method, stages=stages, shift=shift)

    def end(change):
        run = begin(change)
        run.until(until) if event is None else run.next_event(event, until)
        return np.concatenate([run.q, getattr(run, second), [] if event is None else [run.t]])

    found = begin(np.zeros(5)).tangent(wrt="l", until=until, event=event, velocities=velocities)
    columns = np.column_stack([found["q"], found[second], found["l"]])
    for axis, column in zip(1e-4 * np.eye(5), columns.T, strict=True):
        difference = (8.0 * (end(axis) - end(-axis)) - (end(2.0 * axis) - end(-2.0 * axis))) / 12e-4
        # Measured: 1.4e-12.
        assert np.abs(column - difference).max() < 4e-12 * (1.0 + np.abs(columns).max())


@pytest.mark.parametrize("options", [*METHODS, {"method": "adaptive", "h": 0.1}], ids=str)
def test_the_jacobian_of_a_solution_is_made_of_tangents(options):
    times = [0.0, 0.37, 1.1, 1.1, 4.2]
    run = vi.Kepler().integrate([0.5, 0.1], [0.1, 1.6], **options)
    aside, sol = run.copy(), run.at(times)
    found = sol.jacobian(["mu", "dot(y)", "x"])
    assert found.shape == (5, 4, 3)
    for row, t in zip(found, times, strict=True):
        tangent = aside.copy().tangent(wrt=["mu"], until=t, velocities=True)
        expected = np.column_stack([tangent["mu"], tangent["v"][:, 1], tangent["q"][:, 0]])
        assert np.array_equal(row, expected)
    assert np.array_equal(sol.jacobian("mu", of="dot(x)"), found[:, 2, :1])
    assert np.array_equal(sol.jacobian("mu", of=["y", "x"]), found[:, [1, 0], :1])


def test_the_jacobian_of_momenta_and_expressions():
    text = "struct Top { param m = 1.3, k = 2.0; coord r, θ; L = m * (dot(r)^2 + r^2 * dot(θ)^2) / 2 - k * r^2; }"
    top, times = vi.System(text)(), np.array([0.0, 0.7, 2.0])

    def at(m=1.3, r=1.1):
        return top.copy().set(m=m).integrate([r, 0.2], [0.1, 0.8], h=0.05).at(times)

    sol, step = at(), 1e-4
    for name in ("p_θ", "m * r^2", "[r * cos(θ), m * dot(r)]", "p_r"):
        found = sol.jacobian(["m", "r"], of=name)
        for column, unknown in enumerate({"m": 1.3, "r": 1.1}.items()):
            ends = [at(**{unknown[0]: unknown[1] + k * step})[name] for k in (-2, -1, 1, 2)]
            difference = (8.0 * (ends[2] - ends[1]) - (ends[3] - ends[0])) / (12.0 * step)
            assert np.abs(found[..., column] - difference).max() < 2e-11  # 2.6e-12
    # The momentum of an angle without a force stays: θ-independent, it is m r² dot(θ) of the start.
    assert sol.jacobian("m", of="p_θ")[:, 0] == pytest.approx(1.1**2 * 0.8, abs=1e-13)
    several = sol.jacobian(["r", "m"], of=["θ", "p_r", "m * r^2"])
    assert several.shape == (3, 3, 2) and np.array_equal(several[:, 2], sol.jacobian(["r", "m"], of="m * r^2"))


def test_least_squares_with_the_jacobian_of_a_solution():
    optimize = pytest.importorskip("scipy.optimize")
    times = np.linspace(0.0, 8.0, 60)
    measured = vi.DampedOscillator(k=4.3, c=0.21).integrate([1.0], h=0.1).at(times)["x"]

    def motion(values):
        return vi.DampedOscillator(k=values[0], c=values[1]).integrate([1.0], h=0.1).at(times)

    found = optimize.least_squares(
        lambda values: motion(values)["x"] - measured,
        [4.0, 0.1],
        lambda values: motion(values).jacobian(["k", "c"], of="x"),
        **dict.fromkeys(("xtol", "ftol", "gtol"), 1e-15),
    )
    assert found.x == pytest.approx([4.3, 0.21], rel=1e-12)


def test_solutions_without_a_run_have_no_jacobian(kepler):
    rows = [
        kepler.until(1.0, callback=lambda run: None),
        kepler.events("y", until=5.0),
        pickle.loads(pickle.dumps(kepler.until(6.0))),
    ]
    for sol in rows:
        with pytest.raises(ValueError, match="without a callback and not unpickled: take it again"):
            sol.jacobian("mu")
    sol = kepler.until(7.0)
    with pytest.raises(ValueError, match="no parameter or start value 'nu'"):
        sol.jacobian("nu")
    with pytest.raises(KeyError, match="z"):
        sol.jacobian("mu", of="z")
