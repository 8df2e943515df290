"""Motions, events and dense output against scipy."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import variational as vi

STARTS = {
    "ChargedParticle": ([1.0, 0.0, 0.1], [0.0, 1.0, 0.0], 0.1),
    "DampedOscillator": ([1.0], [0.0], 0.1),
    "DoublePendulum": ([1.0, 1.0], [0.0, 0.0], 0.02),
    "DoubleWell": ([0.74], [0.0], 0.1),
    "HardDuffing": ([1.0], [0.0], 0.05),
    "HenonHeiles": ([0.0, 0.1], [0.4, 0.0], 0.2),
    "Kepler": ([0.4, 0.0], [0.0, 2.0], 0.05),
    "ParametricPendulum": ([0.5], [0.0], 0.05),
    "Pendulum": ([1.0], [0.0], 0.05),
    "SphericalPendulum": ([0.8, 0.0], [0.0, 4.0], 0.02),
}
TIMES = np.linspace(0.0, 3.0, 13)


def by_scipy(system, q, v, end, **options):
    y = np.concatenate([q, v])
    return solve_ivp(system.rhs, (0.0, end), y, method="DOP853", rtol=1e-13, atol=1e-14, **options)


@pytest.mark.parametrize("name", STARTS)
def test_motions_agree(name):
    q, v, h = STARTS[name]
    system = getattr(vi, name)()
    sol = system.integrate(q, v, h=h).at(TIMES)
    theirs = by_scipy(system, q, v, 3.0, t_eval=TIMES)
    assert sol.y.shape == theirs.y.shape
    assert (sol.success, sol.status) == (theirs.success, theirs.status)
    # Measured: 5.9e-13 for the double pendulum, with the error of scipy.
    np.testing.assert_allclose(sol.y, theirs.y, rtol=0.0, atol=2e-12)


# Errors after 3 time units: measured, and rounded up.
METHODS = [
    ("fixed", None, 1e-3, 4e-5),  # 2.9e-5
    ("suzuki-4", None, 0.01, 2e-7),  # 9.6e-8
    ("kahan-li-6", None, 0.02, 2e-8),  # 9.6e-9
    ("kahan-li-8", None, 0.05, 4e-9),  # 2.5e-9
    ("gauss", 4, 0.05, 2e-10),  # 1.5e-10
    ("gauss", 8, 0.1, 1e-12),  # 4.2e-13
    ("energy", None, 1e-3, 7e-5),  # 5.0e-5
    ("energy", 1, 1e-3, 7e-5),  # 5.0e-5
    ("energy", 2, 0.01, 2e-7),  # 1.3e-7
    ("energy", 3, 0.05, 1e-6),  # 5.7e-7
]


@pytest.mark.parametrize(("method", "stages", "h", "error"), METHODS)
def test_every_method_agrees(method, stages, h, error):
    q, v, _ = STARTS["Kepler"]
    kepler = vi.Kepler()
    options = {"fallback": True} if method == "energy" else {}
    sol = kepler.integrate(q, v, h=h, method=method, stages=stages, **options).at([3.0])
    theirs = by_scipy(kepler, q, v, 3.0)
    assert np.abs(sol.y[:, 0] - theirs.y[:, -1]).max() < error


def test_transformed_time_agrees():
    kepler = vi.Kepler()
    sol = kepler.integrate([0.1, 0.0], [0.0, 19.0**0.5], dtau=0.5).at([3.0])
    theirs = by_scipy(kepler, [0.1, 0.0], [0.0, 19.0**0.5], 3.0)
    # Measured: 1.1e-12.
    np.testing.assert_allclose(sol.y[:, 0], theirs.y[:, -1], rtol=0.0, atol=3e-12)


def test_events_agree_with_scipy_and_with_functions():
    stars, y = vi.HenonHeiles(), [0.0, 0.1, 0.4, 0.0]
    run = stars.integrate(y[:2], y[2:], h=0.2)
    by_name = run.copy().events(vi.Event("x", direction=+1), until=50.0)

    def section(t, q, v):
        return q[0]

    section.direction = 1
    by_function = run.copy().events(section, until=50.0)
    assert np.array_equal(by_name.t, by_function.t)
    assert by_name.rising.all()
    assert np.abs(by_name["x"]).max() < 1e-15

    def g(t, y):
        return y[0]

    g.direction = 1
    theirs = by_scipy(stars, y[:2], y[2:], 50.0, events=g).t_events[0]
    # Measured: 5.3e-13.
    np.testing.assert_allclose(by_name.t, theirs[theirs > 0.0], rtol=0.0, atol=2e-12)


def test_dense_output_agrees():
    q, v, h = STARTS["Kepler"]
    kepler = vi.Kepler()
    run = kepler.integrate(q, v, h=h)
    sol = run.until(3.0, dense=True)
    times = np.linspace(0.0, 3.0, 301)
    theirs = by_scipy(kepler, q, v, 3.0, dense_output=True).sol(times)
    ours = sol(times)
    assert ours.shape == theirs.shape == (4, 301)
    # Measured: 7.7e-8.
    np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=2e-7)
    assert sol(1.0).shape == (4,)
    assert sol.sol is sol
    # At the nodes it is the rows. Measured: 1e-16, and 2.6e-11 for the velocities, which are slopes of polynomials.
    q, p, v = sol.states(sol.t)
    np.testing.assert_allclose(q, sol.q, rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(p, sol.p, rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(v, sol.v, rtol=0.0, atol=1e-10)


def test_the_plots_of_scipy_work_with_y():
    sol = vi.Pendulum().integrate([1.0], h=0.05).until(1.0)
    assert sol.y.shape == (2, len(sol.t))
    assert sol.sol is None
