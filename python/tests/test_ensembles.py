"""Ensembles equal single runs."""

import numpy as np
import pytest

import variational as vi

LENGTHS = np.linspace(0.5, 2.0, 33)


@pytest.mark.parametrize("threads", [None, 1, 2])
def test_an_ensemble_equals_single_runs(threads):
    many = vi.Pendulum().ensemble([1.0], [0.0], h=0.05, until=5.0, parameters={"l": LENGTHS}, threads=threads)
    assert many.q.shape == (33, 1)
    assert many.success
    for i in range(33):
        one = vi.Pendulum(l=LENGTHS[i]).integrate([1.0], h=0.05).until(5.0)
        assert many.q[i] == one.q[-1]
        assert many.v[i] == one.v[-1]
        assert many.energy[i] == one.energy[-1]


def test_states_at_times():
    q = np.linspace(0.5, 1.5, 5)[:, None]
    many = vi.Pendulum().ensemble(q, [0.3], h=0.05, times=[1.0, 2.0, 2.02])
    assert many.q.shape == many.v.shape == (5, 3, 1)
    assert many.energy.shape == many.t.shape == (5, 3)
    angle = vi.Pendulum.coordinates[0]
    assert np.array_equal(many[angle], many.q[..., 0])
    one = vi.Pendulum().integrate(q[2], [0.3], h=0.05).at([1.0, 2.0, 2.02])
    assert np.array_equal(many.q[2], one.q)


def test_a_failed_run_has_its_exception():
    many = vi.Kepler().ensemble([[0.4, 0.0], [0.0, 0.0], [0.5, 0.0]], [0.0, 2.0], h=0.1, until=1.0)
    assert [error is None for error in many.errors] == [True, False, True]
    assert isinstance(many.errors[1], vi.StepError)
    assert np.isnan(many.q[1]).all()
    assert np.isnan(many.energy[1])
    assert np.isfinite(many.energy[[0, 2]]).all()
    assert repr(many) == "<Ensemble of 3 runs of Kepler, 1 failed>"


@pytest.mark.parametrize("method", ["fixed", "energy", "kahan-li-6"])
def test_every_method(method):
    many = vi.Pendulum().ensemble([[1.0], [0.5]], h=0.01, until=1.0, method=method)
    one = vi.Pendulum().integrate([0.5], h=0.01, method=method).until(1.0)
    assert many.q[1] == one.q[-1]


def test_no_runs():
    many = vi.Pendulum().ensemble(np.zeros((0, 1)), h=0.01, until=1.0)
    assert many.q.shape == many.v.shape == (0, 1)
    assert many.success


def test_times_must_be_in_order():
    with pytest.raises(ValueError, match="times must be ascending"):
        vi.Pendulum().ensemble([1.0], h=0.1, times=[2.0, 1.0])
