"""Systems whose L is linear in the velocities, and Hamiltonians without an L in closed form."""

import pickle

import numpy as np
import pytest

import variational as vi

Vortices = vi.System("""
struct Vortices {
    param k[4] = [1.0, 1.5, -0.7, 0.4], s = 0.2;
    coord y[4], x[4];
    let r2[i in 0..4][j in 0..4] = (x[i] - x[j])^2 + (y[i] - y[j])^2;
    L = sum(i in 0..4, k[i] * x[i] * dot(y[i])) - s * sum(i in 0..4, x[i] * y[i])
        + sum(i in 0..4, sum(j in 0..i, k[i] * k[j] * ln(r2[i][j]))) / (4 * pi);
}
""")
START = [0.1, 1.2, -0.9, 0.3, 0.4, -0.3, 0.7, 1.5]
# A driven oscillator, by its equations of first and of second order.
First = vi.System("""
struct First {
    input u = 0.0;
    coord x, p;
    L = p * dot(x) - (x^2 + p^2) / 2;
    force x = u;
}
""")
Second = vi.System("struct Second { input u = 0.0; coord x; L = dot(x)^2 / 2 - x^2 / 2; force x = u; }")


def run(**change):
    return Vortices(**change).integrate(q=START, h=0.2, stages=4)


def test_velocities_and_momenta_follow_from_coordinates():
    vortices = Vortices()
    sol = run().until(4.0)
    # y' = −x-slope of H over k, by differences of coordinates.
    fine = vortices.integrate(q=START, h=0.01, stages=4).until(0.02)
    assert np.allclose(sol.v[0], (-3 * fine.q[0] + 4 * fine.q[1] - fine.q[2]) / 0.02, atol=1e-3)
    assert np.array_equal(sol.p[0], vortices.momentum(0.0, START, np.zeros(8)))
    assert np.array_equal(vortices.integrate(q=START, v=np.ones(8), h=0.2, stages=4).until(4.0).q, sol.q)
    assert np.array_equal(vortices.integrate(q=START, p=sol.p[0], h=0.2, stages=4).until(4.0).q, sol.q)
    with pytest.raises(vi.InvalidInput, match="a momentum must be that of L at the coordinates"):
        vortices.integrate(q=START, p=np.zeros(8), h=0.2)
    with pytest.raises(ValueError, match='has no mass matrix, which method="energy" needs'):
        vortices.integrate(q=START, h=0.2, method="energy")
    assert np.ptp(sol.energy) < 1e-8


def test_a_run_has_what_all_runs_have():
    sol = run().until(4.0, dense=True)
    assert np.allclose(sol["k[1] * x[1]"], 1.5 * sol.q[:, 5])
    again = pickle.loads(pickle.dumps(sol))
    assert np.array_equal(again(1.23)[0], sol(1.23)[0])
    events = run().events([vi.Event("x[0]")], until=4.0)
    assert len(events) > 0 and np.max(np.abs(events.q[:, 4])) < 1e-13
    stepped = run()
    stepped.set(**{"k[0]": 1.3})
    assert stepped.p[0] == pytest.approx(1.3 * START[4], abs=1e-15)
    assert "equations of first order" in str(Vortices().explain())


@pytest.mark.parametrize("has_velocities", [False, True])
def test_derivatives_are_those_of_differences(has_velocities):
    found = run().tangent(until=3.0, wrt=["s"], velocities=has_velocities)
    by = 1e-4
    end = lambda q, **change: Vortices(**change).integrate(q=q, h=0.2, stages=4).until(3.0).q[-1]
    for entry in range(8):
        move = by * np.eye(8)[entry]
        difference = (end(START + move) - end(START - move)) / (2 * by)
        assert np.allclose(found["q"][:8, entry], difference, atol=2e-6)
    difference = (end(START, s=0.2 + by) - end(START, s=0.2 - by)) / (2 * by)
    assert np.allclose(found["s"][:8], difference, atol=2e-6)


def test_a_hamiltonian_has_its_momenta_as_coordinates():
    Quartic = vi.System("struct Quartic { coord x; momentum l of x; H = l^4 / 4 + x^2 / 2; }")
    quartic = Quartic()
    sol = quartic.integrate(q=[0.3, 0.8], h=0.1, stages=8).until(5.0)
    assert np.array_equal(sol["l"], sol.q[:, 1])
    assert np.allclose(sol.v[:, 0], sol["l"] ** 3) and np.allclose(sol.v[:, 1], -sol.q[:, 0])
    assert np.ptp(sol.energy) < 1e-12


def test_optimal_control():
    pytest.importorskip("casadi")
    options = {"steps": 12, "duration": 2.0, "cost": "u^2", "inputs": {"u": (-5.0, 5.0)}, "stages": 4}
    first = vi.optimise(First(), start={"x": 1.0, "p": 0.0}, end={"x": 0.0, "p": 0.0}, **options)
    second = vi.optimise(Second(), start=([1.0], [0.0]), end=([0.0], [0.0]), **options)
    assert first.success and second.success
    assert first.cost == pytest.approx(second.cost, rel=1e-7)
    with pytest.raises(ValueError, match='the coordinates alone are a state: write start={"x": …}'):
        vi.optimise(First(), start=([1.0, 0.0], [0.0, 0.0]), end={"x": 0.0}, **options)
    for bound in ({"start": {"x": 1.0, "p_x": 0.3}}, {"start": {"x": 1.0, "p": 0.0}, "bounds": {"p_x": (-0.2, 0.3)}}):
        with pytest.raises(ValueError, match="p_x follows from the coordinates"):
            vi.optimise(First(), end={"x": 0.0}, **bound, **options)
    # The momentum at the end is that of the motion.
    by_momentum = vi.optimise(First(), start={"x": 1.0, "p": 0.0}, end={"x": 0.0, "p_x": 0.0}, **options)
    assert by_momentum.cost == pytest.approx(first.cost, rel=1e-9)
