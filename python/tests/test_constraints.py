"""Systems with constraints."""

import pickle
import re

import numpy as np
import pytest

import variational as vi

STARTS = {
    "AndrewsSqueezer": (
        [
            -0.0617138900142764496,
            0.0,
            0.455279819163070380,
            0.222668390165885884,
            0.487364979543842550,
            -0.222668390165885884,
            1.23054744454982119,
        ],
        [0.0] * 7,
        2e-5,
    ),
    "ChaplyginSleigh": ([0.0, 0.0, 0.0], [1.0, 0.0, 2.0], 0.01),
    "DoubleRodPendulum": ([0.6, -0.8, 1.4, -1.4], [0.0] * 4, 0.01),
    "FourBar": ([0.0, 1.0, 2.6, 2.5], [-6.0, 0.0, -5.5, -0.9], 0.005),
    "HeavyTop": ([0.8, 0.6, 0.0, 0.0], [0.0, 0.0, -6.0, 8.0], 0.005),
    "RodChain": ([0.6, -0.8] * np.arange(1, 11)[:, None], [0.0] * 20, 0.005),
    "RodPendulum": ([0.6, -0.8], [0.0, 0.0], 0.01),
    "RollingBall": ([1.0, 0.0, 1.0, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 1.5, 0.0, 0.0], 0.01),
    "RollingDisk": ([0.0, 0.0, 0.0, 1.2, 0.0], [3.0, 0.0, 0.5, 0.0, -3.0], 0.01),
    "SliderCrank": ([0.0, 0.0, 3.5], [4.0, -1.6, 0.0], 0.01),
}


def test_every_system_with_constraints_has_a_start():
    assert {name for name in vi.systems if getattr(vi, name).constraints} == set(STARTS)


@pytest.mark.parametrize(
    ("name", "stages"),
    [*((name, stages) for name in STARTS for stages in (1, 2, 3)), ("FourBar", 4), ("RodPendulum", 6)],
)
def test_constraints_hold_at_every_node(name, stages):
    system = getattr(vi, name)()
    q, v, h = STARTS[name]
    start = system.project(np.reshape(q, -1), v)
    sol = system.integrate(start.q, start.v, h=h, stages=stages).steps(50)
    assert sol.reactions.shape == (51, len(system.constraints)) and np.isfinite(sol.reactions).all()
    # Measured: at most 1.3e-14, for velocities up to 200 per second.
    assert sol.residual.max() < 5e-14


def test_the_tension_of_a_rod():
    system = vi.RodPendulum(l=0.5, m=2.0)
    assert system.constraints == ("rod",)
    sol = system.integrate([0.3, -0.4], [0.0, 0.0], h=0.01).until(1.0)
    # Tension −2 Λ l: weight along the rod and m v²/l.
    along = -2.0 * system.g * sol["y"] / 0.5
    centripetal = 2.0 * (sol.v**2).sum(axis=1) / 0.5
    assert -2.0 * sol.reactions[:, 0] * 0.5 == pytest.approx(along + centripetal, rel=1e-12)
    force = system.reaction_force(sol.t, sol.q, sol.p)
    assert force == pytest.approx(2.0 * sol.reactions * sol.q, rel=1e-13)
    run = system.integrate([0.3, -0.4], h=0.01)
    run.step()
    assert np.array_equal(run.reactions, sol.reactions[1])


def test_a_start_off_the_constraints_is_refused_or_moved():
    system = vi.RodPendulum()
    with pytest.raises(vi.InconsistentStart, match=r"system\.project\(q, v\)") as caught:
        system.integrate([0.6, -0.9], [1.0, 0.0], h=0.01)
    assert caught.value.constraint == "rod"
    assert caught.value.residual == pytest.approx(0.17, rel=1e-14)
    assert caught.value.rate == pytest.approx(1.2, rel=1e-14)
    found = system.project([0.6, -0.9], [1.0, 0.0])
    length = np.hypot(0.6, 0.9)
    assert found.q == pytest.approx(np.array([0.6, -0.9]) / length, rel=1e-15)
    assert found.moved_q == pytest.approx(found.q - [0.6, -0.9], rel=1e-14)
    assert found.moved_v == pytest.approx(found.v - [1.0, 0.0], rel=1e-14)
    g, rate = system.residuals(0.0, [0.6, -0.9], [1.0, 0.0])
    assert (g[0], rate[0]) == pytest.approx((0.17, 1.2), rel=1e-14)
    system.integrate(found.q, found.v, h=0.01).step()
    with pytest.raises(vi.Singular):
        system.project([0.0, 0.0])
    # Many at once.
    q = np.array([[0.6, -0.9], [3.0, 4.0]])
    for many in (system.project(q, [1.0, 0.0]), system.assemble(q, [1.0, 0.0])):
        assert many.q.shape == many.moved_v.shape == (2, 2)
        assert np.array_equal(many.v[0], found.v) and np.array_equal(many.q[1], system.project([3.0, 4.0]).q)
    with pytest.raises(ValueError, match=r"q must have the shape \(M, 2\) or \(2,\)"):
        system.project(np.zeros((2, 3)))


def test_far_guesses_are_assembled():
    linkage, far = vi.FourBar(), [4.0, 1.8, -0.1, 6.8]
    # Near the constraints both are the same.
    near = [0.0, 1.0, 2.6, 2.5]
    for mine, theirs in zip(linkage.assemble(near), linkage.project(near), strict=True):
        assert np.array_equal(mine, theirs)
    for found in (linkage.project(far, t=2.0), linkage.assemble(far, t=2.0)):
        assert np.abs(linkage.residuals(2.0, found.q, found.v)).max() < 1e-13
    assert found.moved_q == pytest.approx(found.q - far, rel=1e-14)
    linkage.integrate(found.q, found.v, h=0.005).steps(10)
    # A bar that is too long stays open, without constraints nothing moves.
    with pytest.raises(vi.NotAssembled) as caught:
        vi.FourBar(b=100.0).assemble(near)
    assert caught.value.constraint in linkage.constraints and 0.0 < caught.value.passed < 1.0
    assert np.array_equal(vi.Kepler().assemble([0.4, 0.0]).q, [0.4, 0.0])


def test_methods_without_constraints_are_refused():
    with pytest.raises(ValueError, match='RodPendulum has constraints, which method="fixed" does not keep'):
        vi.RodPendulum().integrate([0.6, -0.8], h=0.01, method="fixed")
    with pytest.raises(ValueError, match="stages may be 1, 2, 3, 4 or 6"):
        vi.RodPendulum().integrate([0.6, -0.8], h=0.01, stages=5)


def test_the_name_of_gauss_with_constraints_in_earlier_versions():
    rod, start = vi.RodPendulum(), [0.6, -0.8]
    now, before = (rod.integrate(start, h=0.01, method=method) for method in ("gauss", "gauss-lobatto"))
    assert np.array_equal(now.steps(3).q, before.steps(3).q)
    # A pickle of an earlier version has that name.
    restart, (system, (name, stages, is_transformed), *stored) = now.__reduce__()
    assert (name, stages) == ("gauss", 3)
    again = restart(system, ("gauss-lobatto", stages, is_transformed), *stored)
    assert np.array_equal(again.step().q, now.step().q)


def test_runs_are_copied_pickled_and_changed():
    system = vi.DoubleRodPendulum()
    run = system.integrate([0.6, -0.8, 1.4, -1.4], h=0.01)
    run.steps(10)
    again = pickle.loads(pickle.dumps(run))
    assert np.array_equal(again.step().q, run.step().q)
    run.set(g=1.0)
    run.step()
    with pytest.raises(vi.InconsistentStart):
        run.set(l1=2.0)


def test_events_and_times():
    run = vi.RodPendulum().integrate([0.6, -0.8], h=0.01)
    lowest = run.next_event(vi.Event("x", direction=-1), until=10.0)
    assert abs(lowest["x"][0]) < 1e-15 and lowest.residual.max() < 1e-14
    sol = run.at([1.0, 2.0])
    assert sol.residual.max() < 1e-14 and sol.reactions.shape == (2, 1)


def test_systems_without_constraints_have_none():
    system = vi.Kepler()
    assert system.constraints == ()
    sol = system.integrate([0.4, 0.0], [0.0, 2.0], h=0.05).steps(3)
    assert sol.reactions.shape == (4, 0) and not sol.residual.any()
    same = system.project([0.4, 0.0], [0.0, 2.0])
    assert np.array_equal(same.q, [0.4, 0.0]) and not same.moved_v.any()


def test_methods_of_texts_with_constraints():
    from variational._compile import _methods, _words

    assert _methods(None, "struct A { coord x, y; constraint c = x - y; }") == "gauss 3"
    assert _methods(None, "struct A { rotation R; }") == "gauss 3"
    assert _methods("gauss-lobatto 1,2", "struct A { rotation R[2]; }") == "gauss 1, 2"
    assert _methods("gauss 3; energy 1", "struct A { rotation R; }") == "gauss 3; energy 1"
    assert _words("gauss 1, 2; energy 2") == "gauss 1, 2; energy 2"
    # Names that are no clauses.
    assert _methods(None, "struct A { param rotation = 1, constraint = 2; coord x; }") == "gauss 8"
    with pytest.raises(vi.CompileError, match="the method fixed does not keep constraints"):
        _methods("fixed", "struct A { rotation R; }")
    with pytest.raises(vi.CompileError, match='energy needs its stages with constraints: write "energy 2"'):
        _methods("energy", "struct A { rotation R; }")
    with pytest.raises(vi.CompileError, match="gauss needs its stages"):
        _methods("gauss", "struct A { rotation R; }")


def test_energies_kept_on_constraints():
    pendulum = vi.RodPendulum()
    run = pendulum.integrate([0.6, -0.8], h=0.05, method="energy", shift_from=3.0)
    kept = run.shifted_energy
    sol = run.until(20.0)
    # The discrete energy with its shift is the same in every bit, the energy at the nodes oscillates.
    assert run.shifted_energy == kept and sol.residual.max() < 1e-13
    assert 1e-12 < abs(sol.energy - sol.energy[0]).max() < 1e-3
    # Another method of the same system, another order of it.
    with pytest.raises(ValueError, match='no integrator method="energy", stages=3; stages may be 1 or 2'):
        pendulum.integrate([0.6, -0.8], h=0.05, method="energy", stages=3)


def test_a_linkage_at_rest():
    pendulum = vi.DoubleRodPendulum()
    rest = pendulum.equilibrium([0.3, -0.9, 0.2, -2.1])
    assert np.abs(rest.q - [0.0, -1.0, 0.0, -2.0]).max() < 1e-14
    # The same in angles, and the weight of both masses on the upper rod: -2 Λ l.
    angles = vi.DoublePendulum().equilibrium([0.1, -0.1])
    assert np.abs(rest.frequencies - angles.frequencies).max() < 1e-14
    assert np.abs(-2.0 * rest.multipliers - [2 * 9.81, 9.81]).max() < 1e-13
    # Without constraints all directions, and no multiplier.
    assert np.array_equal(angles.directions, np.eye(2)) and angles.multipliers.shape == (0,)
    assert rest.directions.shape == (4, 2) and rest.mass.shape == (2, 2) and rest.free == (False,) * 4
    linear = pendulum.linearization(0.0, rest.q, [0.0, 0.0, 0.0, 0.0])
    # Twice zero for each rod, and the oscillations.
    rates = np.sort(np.abs(np.linalg.eigvals(linear.A).imag))
    assert np.abs(rates[4:] - np.repeat(rest.frequencies, 2)).max() < 1e-12 and rates[:4].max() < 1e-6
    with pytest.raises(vi.Singular):
        vi.RodPendulum(g=0.0).equilibrium([1.0, 0.0])


def test_a_text_with_constraints(warm_cache):
    Bead = vi.compile("""
    struct Bead {
        param g = 9.81;
        coord x, z;
        L = (dot(x)^2 + dot(z)^2) / 2 - g * z;
        constraint wire = z - x^2;
    }
    """)
    bead = Bead()
    assert bead.constraints == ("wire",) and Bead.integrators == (("gauss", 3, False),)
    sol = bead.integrate([1.0, 1.0], h=0.01).until(1.0)
    # Measured: 4.4e-16 and 1.3e-9.
    assert sol.residual.max() < 1e-15 and abs(sol.energy - sol.energy[0]).max() < 2e-9
    Twice = vi.compile("""
    struct Twice {
        coord x, y, z;
        L = (dot(x)^2 + dot(y)^2 + dot(z)^2) / 2;
        constraint ball = x^2 + y^2 + z^2 - 1;
        constraint bowl = x^2 + y^2 + z^4 - 1;
    }
    """)
    with pytest.raises(vi.Redundant) as caught:
        Twice().integrate([1.0, 0.0, 0.0], h=0.01)
    assert (caught.value.constraint, caught.value.of, caught.value.rank) == ("bowl", 2, 1)
    assert "that follow from the others, here 1 of 2, such as `bowl`" in str(caught.value)
    assert Twice().redundant([1.0, 0.0, 0.0]) == ("bowl",)
    # A compiled system keeps all, and is projected as one of its text.
    assert np.array_equal(Twice().project([1.0, 0.0, 0.0]).q, [1.0, 0.0, 0.0])
    with pytest.raises(vi.InconsistentStart, match="bowl"):
        Twice().redundant([0.6, 0.0, 0.8])
    assert bead.redundant([1.0, 1.0]) == ()
    with pytest.raises(ValueError, match="q"):
        Twice().redundant([1.0, 0.0])


DRIVEN = """
struct Belt {
    param m = 0.5, l = 0.8, g = 9.81;
    input u = 0.0;
    coord x, a;
    L = 3 * dot(x)^2 / 2 + m * (dot(x)^2 + 2 * l * cos(a) * dot(x) * dot(a) + l^2 * dot(a)^2) / 2 + m * g * l * cos(a);
    constraint drive = dot(x) - u;
}
"""


def test_a_prescribed_velocity_changes_with_the_state(warm_cache):
    belt = vi.compile(DRIVEN)()
    run = belt.integrate([0.0, 0.4], [0.0, 0.0], h=0.01)
    with pytest.raises(vi.InconsistentStart, match=r"run\.set_state\(q=at\.q, v=at\.v, parameters=dict\(u=…\)\)"):
        run.set(u=0.7)
    assert run.system.u == 0.0
    at = run.system.copy().set(u=0.7).project(run.q, run.v, t=run.t)
    run.set_state(q=at.q, v=at.v, parameters=dict(u=0.7))
    # The impulse of the drive turns the pendulum: m l² a' + m l cos(a) x' stays 0.
    np.testing.assert_allclose(run.v, [0.7, -0.7 * np.cos(0.4) / 0.8], rtol=1e-14)
    assert run.until(1.0).v[-1, 0] == pytest.approx(0.7, rel=1e-13)


def test_a_length_changes_with_the_state():
    run = vi.RodPendulum().integrate([0.6, -0.8], [0.8, 0.6], h=0.01)
    run.steps(5)
    with pytest.raises(vi.InconsistentStart):
        run.set(l=1.2)
    longer = vi.RodPendulum(l=1.2)
    found = longer.project(run.q, run.v, t=run.t)
    run.set_state(q=found.q, v=found.v, parameters={"l": 1.2})
    assert run.system == longer
    again = longer.integrate(run.q, run.v, t=run.t, h=0.01)
    run.steps(10)
    again.steps(10)
    # Measured: equal.
    assert np.abs(run.q - again.q).max() < 1e-15 and abs(np.hypot(*run.q) - 1.2) < 1e-15
    with pytest.raises(TypeError, match="did you mean 'l'"):
        run.set_state(parameters={"ll": 1.0})


RODS = """
struct Rods {
    param m = 1.5, g = 9.81, l = 1.0, c = 0.2;
    coord x, y, u, w;
    L = m / 2 * (1 + x^2 / 4) * (dot(x)^2 + dot(y)^2) + (dot(u)^2 + dot(w)^2) / 2 - g * (m * y + w);
    force u = -c * dot(u);
    constraint upper = x^2 + (y - sin(3 * t) / 10)^2 - l^2, lower = (u - x)^2 + (w - y)^2 - 1;
}
"""

CROSSING = vi.Event("x", 0.3)


ENERGY = {"method": "energy", "stages": 1, "shift": 300.0}


def nearest(system, q, second, velocities, h, options):
    """The run from the nearest state on the constraints, of velocities or of momenta."""
    q = q if velocities else system.project(q, t=0.1).q
    at = system.project(q, second if velocities else system.velocity(0.1, q, second), t=0.1)
    return system.integrate(at.q, at.v, t=0.1, h=h, **options)


@pytest.mark.parametrize("method", [{"stages": 2}, ENERGY], ids=["gauss", "energy"])
@pytest.mark.parametrize("velocities", [False, True])
@pytest.mark.parametrize("end", ["steps", "time", "event", "top"])
def test_derivatives_are_differences_of_runs(velocities, end, method):
    if end == "top" and method is ENERGY:
        pytest.skip("the shift is for the rods")
    if end == "top":
        cls, wrt, options = vi.HeavyTop, ["m", "g"], {"steps": 20}
        q, v = [0.8, 0.6, 0.0, 0.0], [0.0, 0.0, -6.0, 8.0]
    else:
        cls, wrt = vi.System(RODS), ["m", "g", "l", "c"]
        options = {"steps": {"steps": 20}, "time": {"until": 0.517}, "event": {"until": 5.0, "event": CROSSING}}[end]
        q, v = [0.6, -0.8, 1.1, -1.7], [0.8, 0.6, 0.3, 0.2]
    n, h, by = len(q), 0.02 if end != "top" else 0.005, 1e-5
    start = cls().project(q, v, t=0.1)
    second = start.v if velocities else cls().momentum(0.1, start.q, start.v)
    run = nearest(cls(), start.q, second, velocities, h, method)
    names = [*wrt, "h"]
    found = run.tangent(wrt=names, velocities=velocities, **options)
    columns = np.column_stack([found["q"], found["v" if velocities else "p"], *(found[name] for name in names)])

    def reached(direction, change):
        step = change * np.eye(2 * n + len(wrt) + 1)[direction]
        system = cls()
        system.set(**{name: getattr(system, name) + by for name, by in zip(wrt, step[2 * n :], strict=False)})
        run = nearest(system, start.q + step[:n], second + step[n : 2 * n], velocities, h + step[-1], method)
        if end == "event":
            run.next_event(CROSSING, until=5.0)
        elif end == "time":
            run.until(0.517)
        else:
            run.steps(20)
        return np.concatenate([run.q, run.v if velocities else run.p, [run.t] if end == "event" else []])

    for direction, column in enumerate(columns.T):
        one, minus, two, minus_two = (reached(direction, part * by) for part in (1, -1, 2, -2))
        difference = (8.0 * (one - minus) - (two - minus_two)) / (12.0 * by)
        # Measured: at most 2.1e-10, rounding of the differences; 1.1e-8 for lengths that an energy determines.
        allowed = 3e-8 if method is ENERGY else 5e-10
        assert np.abs(column - difference).max() < allowed * (1.0 + np.abs(difference).max()), direction


def test_lengths_that_a_method_finds_have_no_derivative():
    run = vi.RodPendulum().integrate([0.6, -0.8], h=0.02, method="adaptive")
    with pytest.raises(ValueError, match='method="adaptive" finds the lengths of its steps'):
        run.tangent(5, ["h"])


def test_gradients_of_runs_that_keep_an_energy_on_constraints():
    system = vi.System(RODS)(l=1.2)
    start, slope = system.project([0.6, -1.0, 1.1, -1.9], [0.8, 0.6, 0.3, 0.2]), np.arange(1.0, 9.0)
    run = system.integrate(start.q, start.v, h=0.02, **ENERGY)
    for velocities, second in ((False, "p"), (True, "v")):
        tangent = run.copy().tangent(20, ["m", "l"], velocities=velocities)
        given = {"q": slope[:4], second: slope[4:]}
        gradient = run.copy().gradient(20, wrt=["m", "l"], velocities=velocities, **given)
        for name, found in gradient.items():
            assert found == pytest.approx(slope @ tangent[name], rel=1e-9, abs=1e-9), name
    run.steps(3)
    linear = run.linearization()
    tangent = run.tangent(1)
    assert np.array_equal(linear.value, np.concatenate([run.q, run.p]))
    assert np.abs(linear.A - np.column_stack([tangent["q"], tangent["p"]])).max() < 1e-11
    assert np.isfinite(run.lyapunov(100, 2)).all()


def test_gradients_and_exponents_with_constraints():
    system = vi.System(RODS)()
    start = system.project([0.6, -0.8, 1.1, -1.7], [0.8, 0.6, 0.3, 0.2])
    run, weights = system.integrate(start.q, start.v, h=0.02), np.arange(1.0, 9.0)
    found = run.copy().gradient(50, q=weights[:4], p=weights[4:], wrt=["m", "l"])
    tangent = run.copy().tangent(50, ["m", "l"])
    for name in ("q", "p", "m", "l"):
        assert found[name] == pytest.approx(weights @ tangent[name], rel=1e-12)
    # A double pendulum of rods and one of angles: volumes stay, and both are chaotic.
    rods = vi.DoubleRodPendulum().integrate([1.0, 0.0, 2.0, 0.0], h=0.01)
    exponents = rods.lyapunov(5000, 4)
    assert rods.t == pytest.approx(50.0) and abs(exponents.sum()) < 1e-2 and exponents[0] > 0.5  # 3.9e-3
    angles = vi.DoublePendulum().integrate([np.pi / 2, np.pi / 2], h=0.01, stages=4).lyapunov(5000, 4)
    assert abs(angles.sum()) < 1e-14 and angles[0] > 0.5  # 1.1e-16
    with pytest.raises(vi.InvalidInput, match="less 2 for each holonomic constraint"):
        rods.lyapunov(1, 5)


def test_ends_of_derivatives():
    run = vi.RodPendulum().integrate([0.6, -0.8], h=0.01)
    with pytest.raises(TypeError, match="give one of steps and until"):
        run.tangent()
    with pytest.raises(TypeError, match="give until with an event"):
        run.tangent(3, event="x")
    with pytest.raises(TypeError, match=r'such as vi\.Event\("x", 0\.0\)'):
        run.tangent(until=1.0, event=lambda t, q, v: q[0])
    with pytest.raises(ValueError, match="no event before t = 0.1"):
        run.tangent(until=0.1, event="x")
    assert run.t == 0.0


def test_one_of_many_states_is_named():
    rod = vi.RodPendulum()
    q = [[0.6, -0.8], [3.0, 4.0], [0.0, 0.0]]
    with pytest.raises(vi.Singular, match="^state 2: ") as caught:
        rod.project(q)
    assert not caught.value.reason.startswith("state")
    with pytest.raises(vi.InconsistentStart, match="^state 1: "):
        rod.acceleration(0.0, q, [0.0, 0.0])
    with pytest.raises(vi.InconsistentStart, match=r"^state \(0, 1\): "):
        rod.acceleration(0.0, [q], [0.0, 0.0])
    with pytest.raises(vi.InconsistentStart, match="^the state does not"):
        rod.acceleration(0.0, q[1], [0.0, 0.0])
    for none in (rod.project(np.zeros((0, 2))), rod.assemble(np.zeros((0, 2)))):
        assert [of.shape for of in none] == [(0, 2)] * 4


@pytest.mark.parametrize("system", [vi.Kepler, vi.DoubleRodPendulum, vi.DoublePendulum])
def test_gradients_have_velocities(system):
    q, v, h = STARTS.get(system.__name__, ([0.4, 0.1], [0.3, 2.0], 0.01))
    run, n, wrt = system().integrate(q, v, h=h), len(q), list(system.parameters)
    slope = np.arange(1.0, 2 * n + 1)
    tangent = run.copy().tangent(20, wrt, velocities=True)
    gradient = run.gradient(20, q=slope[:n], v=slope[n:], wrt=wrt, velocities=True)
    assert run.t == pytest.approx(20 * h) and list(gradient) == list(tangent) == ["q", "v", *wrt]
    for name, found in gradient.items():
        # Measured: 1.1e-14.
        assert np.abs(found - slope @ tangent[name]).max() < 2e-14 * max(1.0, np.abs(found).max()), name
    for wrong in ({"p": slope[:n], "velocities": True}, {"v": slope[:n]}):
        with pytest.raises(TypeError, match="velocities=True"):
            run.gradient(3, **wrong)
    with pytest.raises(TypeError, match="give q or v"):
        run.gradient(3, velocities=True)


PARALLEL = """
struct Parallel {
    param b = 2.0, c = 1.0, g = 9.81;
    coord x1, y1, x2, y2;
    L = (dot(x1)^2 + dot(y1)^2 + dot(x2)^2 + dot(y2)^2) / 2 - g * (y1 + y2);
    constraint left = x1^2 + y1^2 - 1;
    constraint right = (x2 - b)^2 + y2^2 - 1;
    constraint coupler = (x2 - x1)^2 + (y2 - y1)^2 - b^2;
    constraint middle = ((x1 + x2) / 2 - b / 2)^2 + ((y1 + y2) / 2)^2 - c^2;
}
"""


def test_dropped_constraints_are_shown():
    parallel, q = vi.System(PARALLEL)(), [0.6, -0.8, 2.6, -0.8]
    kept = parallel.independent(q)
    assert parallel.dropped == () and "without" not in repr(parallel) + type(parallel).__doc__
    assert kept.dropped == ("middle",) and repr(kept) == "Parallel(b=2, c=1, g=9.81) without middle"
    assert "Dropped, since they follow from the others: middle." in type(kept).__doc__
    assert pickle.loads(pickle.dumps(kept)).dropped == ("middle",)
    run = kept.integrate(q, h=0.01)
    assert "without middle" in repr(run)


def test_redundant_constraints_are_chosen_on_all_of_them():
    parallel, guess = vi.System(PARALLEL)(), [0.5, -0.7, 2.7, -0.9]
    for of in (parallel.redundant, parallel.independent):
        with pytest.raises(vi.InconsistentStart, match=r"system\.project\(q, v\)") as caught:
            of(guess)
        assert caught.value.constraint == "left" and caught.value.residual == pytest.approx(-0.26, rel=1e-14)
    for find in (parallel.project, parallel.assemble):
        start = find(guess)
        assert parallel.redundant(start.q) == ("middle",)
        kept = parallel.independent(start.q)
        # Measured: equal.
        assert start.q == pytest.approx(kept.project(guess).q, abs=1e-15)
        assert np.abs(parallel.residuals(0.0, start.q, start.v)).max() < 1e-15
    # A state on the constraints stays, and lengths that contradict each other have none.
    assert np.abs(parallel.project([0.6, -0.8, 2.6, -0.8]).moved_q).max() < 1e-15
    with pytest.raises((vi.NotAssembled, vi.Singular)):
        parallel.copy().set(c=1.1).project(guess)
    with pytest.raises(vi.Singular, match=r"moves as system\.independent\(q, t=…\)"):
        parallel.acceleration(0.0, start.q, start.v)


def test_dropped_constraints_leave_exponents():
    q = [0.6, -0.8, 2.6, -0.8]
    kept = vi.System(PARALLEL)().independent(q)
    exponents = kept.integrate(q, h=0.01).lyapunov(5000, 2)
    text = PARALLEL.replace(", c = 1.0", "").replace(PARALLEL[PARALLEL.index("    constraint middle") : -2], "")
    two = vi.System(text)().integrate(q, h=0.01)
    # The same rows, and volumes stay: over the time 50 the sum is 0.016.
    assert exponents == pytest.approx(two.lyapunov(5000, 2), abs=1e-12) and abs(exponents.sum()) < 2e-2
    with pytest.raises(vi.InvalidInput, match="number of Lyapunov exponents"):
        kept.integrate(q, h=0.01).lyapunov(1, 3)


def test_runs_with_a_fallback_name_steps_with_derivatives():
    kept = vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=0.05, method="energy", fallback=True)
    with pytest.raises(vi.NoDerivative, match="take steps without one"):
        kept.tangent(1)


def test_a_stored_state_off_the_constraints_is_refused_in_words_of_python():
    run = vi.RodPendulum().integrate([0.6, -0.8], h=0.01)
    restart, (system, integrator, stored) = run.__reduce__()
    assert stored.count("[0.6,-0.8]") >= 1
    with pytest.raises(ValueError, match="does not satisfy the constraint `rod`: residual 1.7") as caught:
        restart(system, integrator, stored.replace("[0.6,-0.8]", "[0.6,-0.9]"))
    assert not re.search("::|&", str(caught.value))


def test_the_jacobian_of_a_solution_on_constraints():
    system = vi.System(RODS)()
    start, times = system.project([0.6, -0.8, 1.1, -1.7], [0.8, 0.6, 0.3, 0.2]), [0.0, 0.31, 1.0]
    run = system.integrate(start.q, start.v, h=0.02)
    found = run.copy().at(times).jacobian(["l", "x"], of=["w", "dot(w)"])
    for row, t in zip(found, times, strict=True):
        tangent = run.copy().tangent(wrt=["l"], until=t, velocities=True)
        expected = np.column_stack([tangent["l"], tangent["q"][:, 0]])[[3, 7]]
        assert np.array_equal(row, expected)


def test_matrices_and_velocities_of_rotations():
    R, ω = np.array([0.5, -0.1, 0.7, 0.5]), np.array([0.3, -2.0, 5.0])
    top = vi.HeavyTop()
    sol = top.integrate(R, vi.quaternion_rate(R, ω), h=0.005, stages=6).until(0.5)
    # Measured: 6.7e-16.
    assert np.abs(sol["rate(R)"][0] - ω).max() < 5e-15
    matrices = vi.rotation_matrix(sol["R"])
    assert np.array_equal(sol["R"], sol.q) and np.array_equal(sol["dot(R)"], sol.v)
    for column, axis in enumerate(np.eye(3).tolist()):
        # Measured: 3.3e-16.
        assert np.abs(matrices[..., column] - sol[f"turn(R, {axis})"]).max() < 2e-15
    assert (top.angles, top.rotations) == ((), ("R",)) and vi.Kepler.rotations == ()
    rotation = pytest.importorskip("scipy.spatial.transform").Rotation
    found = sol.as_rotation("R")
    # Measured: 4.5e-16.
    assert isinstance(found, rotation) and np.abs(found.as_matrix() - matrices).max() < 5e-15
    with pytest.raises(ValueError, match='name one of the rotations, "R", not \'R\\[0\\]\''):
        sol.as_rotation("R[0]")
    spin = np.einsum("kij,kj->ki", matrices, sol["rate(R)"])
    # Measured: 4.4e-15 and 4.4e-16.
    assert np.abs(spin - sol["spin(R)"]).max() < 5e-14
    assert np.abs(vi.quaternion_rate(sol["R"], ω)[0] - sol.v[0]).max() < 5e-15
    with pytest.raises(KeyError, match="R is a constraint: its reaction"):
        sol["Λ_R"]
    with pytest.raises(ValueError, match="of R must be the 4 entries"):
        vi.rotation_matrix(ω)
    with pytest.raises(ValueError, match="of ω must be the 3 axes"):
        vi.quaternion_rate(R, R)
    with pytest.raises(ValueError, match="unit quaternions: divide"):
        vi.rotation_matrix([2.0, 1.0, 0.0, 0.0])
    with pytest.raises(ValueError, match="unit quaternions: divide"):
        vi.quaternion_rate(np.zeros(4), ω)
    with pytest.raises(ValueError, match="R and ω do not broadcast"):
        vi.quaternion_rate(np.full((5, 4), 0.5), np.ones((4, 3)))
    assert vi.quaternion_rate(R, np.ones((6, 3))).shape == (6, 4)


def test_derivatives_at_an_event_of_an_expression():
    event = vi.Event("x * dot(x)", -0.3)

    def begin(angle, length=1.0):
        start = [length * np.sin(angle), -length * np.cos(angle)]
        return vi.RodPendulum(l=length).integrate(start, h=0.02)

    def end(*start):
        run = begin(*start)
        run.next_event(event, 5.0)
        return np.concatenate([run.q, run.v, [run.t]])

    found = begin(1.0).tangent(until=5.0, event=event, wrt=["l"], velocities=True)
    step = 1e-5
    by_angle = (end(1.0 + step) - end(1.0 - step)) / (2.0 * step)
    by_length = (end(1.0, 1.0 + step) - end(1.0, 1.0 - step)) / (2.0 * step)
    # Measured: 1.8e-10 and 4.6e-11, of the differences.
    assert np.abs(found["q"] @ [np.cos(1.0), np.sin(1.0)] - by_angle).max() < 1e-9
    assert np.abs(found["l"] - by_length).max() < 1e-9
