"""Mass matrices, linearizations and equilibria, against formulas by hand and the exponential of the linear motion."""

import numpy as np
import pytest
import scipy.linalg

import variational as vi

CART = """
struct Cart {
    param M = 1.3; param m = 0.4; param l = 0.7; param g = 9.81; param c = 0.2;
    input u = 0.0;
    coord x, a;
    L = (M + m) * dot(x)^2 / 2 + m * l * dot(x) * dot(a) * cos(a) + m * l^2 * dot(a)^2 / 2 + m * g * l * cos(a);
    force x = u;
    force a = -c * dot(a);
}
"""
M, m, LENGTH, g, c = 1.3, 0.4, 0.7, 9.81, 0.2


@pytest.fixture(scope="module")
def cart(warm_cache):
    return vi.compile(CART)


def mass(a):
    coupling = m * LENGTH * np.cos(a)
    return np.array([[M + m, coupling], [coupling, m * LENGTH**2]])


def test_mass_matrix_and_bias(cart):
    assert cart.inputs == ("u",) and "u" in cart.parameters
    system, a, rate, u = cart(u=0.5), 0.6, 1.7, 0.5
    q, v = np.array([0.3, a]), np.array([-0.2, rate])
    # Measured: 0; below 2.3e-16 for the bias and the acceleration, 5.6e-16 for the force.
    np.testing.assert_allclose(system.mass_matrix(0.0, q, v), mass(a), rtol=3e-16)
    bias = [-m * LENGTH * rate**2 * np.sin(a) - u, m * g * LENGTH * np.sin(a) + c * rate]
    np.testing.assert_allclose(system.bias(0.0, q, v), bias, rtol=5e-16)
    acceleration = system.acceleration(0.0, q, v)
    np.testing.assert_allclose(acceleration, np.linalg.solve(mass(a), -np.array(bias)), rtol=1e-15)
    needed = system.inverse_dynamics(0.0, q, v, acceleration + np.array([1.0, 2.0]))
    np.testing.assert_allclose(needed, mass(a) @ [1.0, 2.0], rtol=2e-15)
    # Many points at once.
    many = np.stack([q, q + 0.1, q - 0.2])
    assert system.mass_matrix(0.0, many, v).shape == (3, 2, 2)
    np.testing.assert_array_equal(system.mass_matrix(0.0, many, v)[1], system.mass_matrix(0.0, many[1], v))
    np.testing.assert_array_equal(system.bias(0.0, many, v)[2], system.bias(0.0, many[2], v))


def linear():
    """A and B of (q, v) at rest, where the pendulum hangs."""
    stiffness, damping = np.diag([0.0, m * g * LENGTH]), np.diag([0.0, c])
    inverse = np.linalg.inv(mass(0.0))
    a = np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ stiffness, -inverse @ damping]])
    return a, np.concatenate([np.zeros((2, 1)), inverse @ [[1.0], [0.0]]])


def test_linearization_of_the_motion(cart):
    found = cart().linearization(0.0, [0.3, 0.0], [0.0, 0.0])
    a, b = linear()
    # Measured: 5.6e-17 and 2.3e-16, of entries up to 18.
    np.testing.assert_allclose(found.A, a, atol=4e-15)
    np.testing.assert_allclose(found.B, b, atol=1e-15)
    np.testing.assert_array_equal(found.value, np.zeros(4))


def test_linearization_of_a_step(cart):
    h = 0.1
    run = cart().integrate(q=[0.3, 0.0], h=h, method="gauss", stages=8)
    before = run.q
    found = run.linearization()
    # The flow of the linear motion, with p = M v: exp of [[A, B], [0, 0]] h.
    a, b = linear()
    exact = scipy.linalg.expm(h * np.block([[a, b], [np.zeros((1, 5))]]))
    to_p = scipy.linalg.block_diag(np.eye(2), mass(0.0))
    # Measured: 3.4e-16 and 7.0e-17.
    np.testing.assert_allclose(found.A, to_p @ exact[:4, :4] @ np.linalg.inv(to_p), atol=1e-15)
    np.testing.assert_allclose(found.B, to_p @ exact[:4, 4:], atol=3e-16)
    np.testing.assert_array_equal(found.value, [0.3, 0.0, 0.0, 0.0])
    np.testing.assert_array_equal(run.q, before)


def test_equilibrium(cart):
    found = cart(c=0.0).equilibrium([0.3, 0.2])
    assert found.q[0] == 0.3 and abs(found.q[1]) < 1e-16 and found.free == (True, False)
    # Measured: 2.3e-16.
    np.testing.assert_allclose(found.frequencies, [np.sqrt(g / LENGTH * (M + m) / M)], rtol=1e-15)
    damped = cart().equilibrium([0.3, 0.2])
    expected = np.linalg.eigvals(linear()[0])
    # Measured: 2.3e-16.
    of = [max(abs(rate) for rate in rates if rate.imag > 1.0) for rates in (damped.rates, expected)]
    np.testing.assert_allclose(of[0], of[1], rtol=2e-15)
    assert all(rate.real < 0.0 for rate in damped.rates if rate.imag > 1.0)


@pytest.fixture(scope="module")
def arm(warm_cache):
    return vi.compile("""
struct Arm {
    param k = 2.0;
    input τ[2] = 0.0;
    coord q[2];
    L = dot(q[0])^2 / 2 + dot(q[1])^2 + k * cos(q[0] - q[1]);
    force q[0] = τ[0] - τ[1];
    force q[1] = τ[1];
}
""")


def test_arrays_of_inputs(arm):
    assert arm.inputs == ("τ",)
    found = arm().linearization(0.0, [0.1, 0.4], [0.0, 0.0])
    np.testing.assert_allclose(found.B, [[0.0, 0.0], [0.0, 0.0], [1.0, -1.0], [0.0, 0.5]], atol=1e-16)
    assert vi.Pendulum.inputs == ()
    assert vi.Pendulum().linearization(0.0, [0.1], [0.0]).B.shape == (2, 0)


def test_mistakes(cart, arm):
    # Both angles may turn together.
    with pytest.raises(vi.FreeMotion):
        arm().equilibrium([0.1, 0.2])
    with pytest.raises(vi.NoEquilibrium):
        vi.Kepler().equilibrium([1.0, 0.0])
    with pytest.raises(ValueError, match="guess must have 2 entries"):
        cart().equilibrium([0.1])
    with pytest.raises(ValueError, match="last axis of a"):
        cart().inverse_dynamics(0.0, [0.0, 0.0], [0.0, 0.0], [1.0])
    with pytest.raises(ValueError, match="v must have 2 entries"):
        cart().linearization(0.0, [0.1, 0.2], [0.0])
    assert np.isnan(vi.Kepler().bias(0.0, [0.0, 0.0], [0.0, 0.0])).all()
