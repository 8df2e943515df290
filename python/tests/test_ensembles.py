"""Ensembles equal single runs."""

import pickle

import numpy as np
import pytest
from scipy.special import ellipk

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


def test_tables():
    pandas = pytest.importorskip("pandas")
    end = vi.Pendulum().ensemble([1.0], h=0.05, until=5.0, parameters={"l": LENGTHS}).to_dataframe()
    assert list(end.columns) == ["l", "t", "θ", "dot(θ)", "p_θ", "energy"] and end.index.name == "run"
    assert np.array_equal(end["l"], LENGTHS)
    film = vi.Kepler().ensemble([[0.4, 0.0], [0.0, 0.0]], [0.0, 2.0], h=0.1, times=[0.5, 1.0, 1.5])
    frame = film.to_dataframe()
    assert len(frame) == 6 and frame.index.tolist() == [0, 0, 0, 1, 1, 1]
    one = vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=0.1).at([0.5, 1.0, 1.5]).to_dataframe()
    pandas.testing.assert_frame_equal(frame.loc[0].reset_index(drop=True), one)
    assert frame.loc[1, "x"].isna().all()
    Masses = vi.System("struct Masses { param k[2] = 3.0; coord x; L = dot(x)^2 / 2 - (k[0] + k[1]) * x^2 / 2; }")
    many = Masses().ensemble([1.0], h=0.1, times=[1.0, 2.0], parameters={"k": [[1.0, 2.0], [3.0, 4.0]]}).to_dataframe()
    assert many["k[1]"].tolist() == [2.0, 2.0, 4.0, 4.0]
    assert len(vi.Pendulum().ensemble(np.zeros((0, 1)), h=0.01, until=1.0).to_dataframe()) == 0


def test_plots():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    film = vi.Kepler().ensemble([[0.4, 0.0], [0.5, 0.0], [0.6, 0.0]], [0.0, 1.5], h=0.1, times=[0.5, 1.0])
    above, below = film.plot()
    assert len(above.lines) == 6 and len(below.lines) == 3
    assert [text.get_text() for text in above.get_legend().get_texts()] == ["x", "y"]
    assert np.array_equal(above.lines[1].get_xydata(), np.column_stack([film.t[1], film["x"][1]]))
    assert below.get_xlabel() == "t"
    end = vi.Pendulum().ensemble([1.0], h=0.05, until=5.0, parameters={"l": LENGTHS})
    axes = end.plot(axes=plt.subplots(2)[1])
    assert np.array_equal(axes[0].lines[0].get_ydata(), end["θ"]) and axes[1].get_xlabel() == "run"
    assert np.array_equal(axes[1].lines[0].get_ydata(), end.energy)
    with pytest.raises(TypeError, match="write axes=…"):
        end.plot(ax=axes)
    plt.close("all")


def test_reactions():
    pendulum = vi.RodPendulum()
    starts = [pendulum.project([np.sin(angle), -np.cos(angle)]).q for angle in (0.5, 1.0)]
    many = pendulum.ensemble(starts, h=0.02, times=[0.5, 1.0], parameters={"m": [1.0, 2.0]})
    assert many.reactions.shape == (2, 2, 1)
    one = vi.RodPendulum(m=2.0).integrate(starts[1], h=0.02).at([0.5, 1.0])
    np.testing.assert_allclose(many.reactions[1], one.reactions, rtol=1e-13)  # 0
    assert vi.Pendulum().ensemble([1.0], h=0.1, until=1.0).reactions.shape == (1, 0)


def test_runs_end_at_their_first_event():
    lengths = np.array([0.5, 1.0, 2.0, 4.0])
    events = [vi.Event("θ", 0.0, direction=-1), lambda t, q, v: q[0] + 5.0]
    many = vi.Pendulum().ensemble([1.0], h=0.1, until=2.0, next_event=events, parameters={"l": lengths})
    quarter = ellipk(np.sin(0.5) ** 2) * np.sqrt(lengths)
    is_met = quarter < 2.0
    assert is_met.tolist() == [True, True, False, False] and many.which.tolist() == [0, 0, -1, -1]
    assert np.abs(many.t - np.where(is_met, quarter, 2.0)).max() < 1e-15  # 2.2e-16
    assert np.abs(many["θ"][is_met]).max() < 1e-15 and many.success  # 0
    single = vi.Pendulum(l=4.0).integrate([1.0], h=0.1).until(2.0)
    assert many.q[3] == single.q[-1] and many.energy[3] == single.energy[-1]
    assert pickle.loads(pickle.dumps(many)).which.tolist() == many.which.tolist()
    assert vi.Pendulum().ensemble([1.0], h=0.1, until=1.0).which is None
    # A run that fails.
    wells = vi.DoubleWell().ensemble([[1.001]] * 2, h=0.01, until=50.0, method="energy", next_event=vi.Event("q", 9.0))
    assert isinstance(wells.errors[1], vi.NoForwardStep) and np.isnan(wells.q).all() and np.isnan(wells.t).all()
    with pytest.raises(ZeroDivisionError):
        vi.Pendulum().ensemble([[1.0]] * 3, h=0.1, until=2.0, next_event=lambda t, q, v: 1 / 0)
