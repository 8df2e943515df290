"""Animations: the frames show the motion."""

import numpy as np
import pytest

import variational as vi

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


@pytest.fixture(autouse=True)
def _closed_figures():
    yield
    plt.close("all")


def shown(animation, frame):
    """The path, the line, and the text of a frame."""
    animation._draw_frame(frame)
    path, bars = animation._fig.axes[0].lines
    return np.array(path.get_data()), np.array(bars.get_data()), animation._fig.axes[0].texts[0].get_text()


def test_frames_are_at_a_constant_distance_in_time():
    # Long steps, and the last one shorter.
    sol = vi.Pendulum().integrate([2.0], h=0.3).until(2.05, dense=True)
    animation = sol.animate(lambda q: [(0.0, 0.0), (np.sin(q[0]), -np.cos(q[0]))], trace=1, fps=10.0, speed=0.5)
    assert animation._interval == 100.0
    frames = list(animation.new_frame_seq())
    assert len(frames) == 42
    for frame in (0, 7, 41):
        path, bars, text = shown(animation, frame)
        angle = sol(min(0.05 * frame, 2.05))[0]
        np.testing.assert_allclose(bars, [[0.0, np.sin(angle)], [0.0, -np.cos(angle)]], rtol=0.0, atol=1e-14)  # 0
        np.testing.assert_array_equal(path[:, -1], bars[:, 1])
        assert path.shape == (2, 1 + 4 * frame) and text == f"t = {0.05 * frame:.2f}"
    # The frame contains the whole motion, with equal scales.
    axes = animation._fig.axes[0]
    assert axes.get_aspect() == 1.0
    assert axes.get_xlim()[0] < np.sin(sol.q).min() and axes.get_xlim()[1] > np.sin(sol.q).max()


def test_backwards_and_gaps():
    sol = vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], t=1.0, h=-0.1).until(0.0, dense=True)
    _, axes = plt.subplots()
    animation = sol.animate(lambda q: [(0, 0), (np.nan, 0), q], axes=axes)
    assert animation._fig is axes.figure
    for frame in (0, 25):
        path, bars, _ = shown(animation, frame)
        np.testing.assert_allclose(bars[:, 2], sol(1.0 - 0.04 * frame)[:2], rtol=0.0, atol=1e-14)  # 0
        assert np.isnan(bars[0, 1]) and path.size == 0


def started(name):
    system = getattr(vi, name)()
    if name == "RodChain":
        return system, system.assemble([x for i in range(10) for x in (i + 1.0, 0.0)]).q
    guess = {"FourBar": [0.0, 1.0, 2.5, 2.5], "SliderCrank": [1.0, -0.3, 3.0], "RodPendulum": [1.0, 0.0]}
    guess["DoubleRodPendulum"] = [1.0, 0.0, 2.0, 0.0]
    if name in guess:
        return system, system.assemble(guess[name]).q
    return system, np.linspace(0.5, 1.5, len(system.coordinates))


# The distances of consecutive points are the lengths of the rods.
RODS = {
    "Pendulum": "l",
    "DoublePendulum": "l1 l2",
    "NPendulum": "l l l l",
    "RodPendulum": "l",
    "DoubleRodPendulum": "l1 l2",
    "RodChain": " ".join(["l"] * 10),
    "FourBar": "a b c",
    "SliderCrank": "r l",
}


@pytest.mark.parametrize("name", RODS)
def test_rods_of_ready_systems_keep_their_lengths(name):
    system, q = started(name)
    sol = system.integrate(q, h=0.01).until(0.2, dense=True)
    animation = sol.animate(fps=20.0)
    lengths = [getattr(system, rod) for rod in RODS[name].split()]
    for frame in range(5):
        _, bars, _ = shown(animation, frame)
        np.testing.assert_allclose(np.linalg.norm(np.diff(bars), axis=0), lengths, rtol=0.0, atol=1e-14)  # 1.8e-15


def test_bodies_of_ready_systems():
    sol = vi.ThreeBody().integrate([1.0, -1.0, 0.0, 0.2, -0.2, 0.0], h=0.01).until(0.2, dense=True)
    _, bars, _ = shown(sol.animate(), 5)
    np.testing.assert_allclose(bars[:, ::2].ravel(), sol(0.2)[:6], rtol=0.0, atol=1e-14)  # 0
    orbit = vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=0.1).until(1.0, dense=True)
    path, bars, _ = shown(orbit.animate(), 25)
    np.testing.assert_allclose(path[:, -1], orbit.q[-1], rtol=0.0, atol=1e-14)  # 0
    assert bars[:, 0].tolist() == [0.0, 0.0]


def test_an_animation_is_saved(tmp_path):
    pillow = pytest.importorskip("PIL.Image")
    sol = vi.Pendulum().integrate([2.0], h=0.05).until(0.2, dense=True)
    sol.animate(fps=25.0).save(tmp_path / "motion.gif", writer="pillow", dpi=30)
    with pillow.open(tmp_path / "motion.gif") as image:
        assert image.n_frames == 6 and image.info["duration"] == 40


def test_mistakes():
    sol = vi.Pendulum().integrate([2.0], h=0.05).until(0.2, dense=True)
    for given, error, words in (
        ({"points": 3}, TypeError, "points must be a function of q"),
        ({"points": lambda t, q: q}, TypeError, "a function of one argument, the coordinates q"),
        ({"points": lambda q: [1.0, 2.0]}, ValueError, "pairs"),
        ({"points": lambda q: [(np.nan, np.nan)]}, ValueError, "no finite point"),
        ({"trace": 2}, ValueError, "one of 2 points"),
        ({"fps": 0.0}, ValueError, "fps must be positive"),
        ({"speed": -1.0}, ValueError, "speed must be positive"),
    ):
        with pytest.raises(error, match=words):
            sol.animate(**given)
    with pytest.raises(ValueError, match="dense=True"):
        vi.Pendulum().integrate([2.0], h=0.05).until(0.2).animate()
    with pytest.raises(ValueError, match="two rows or more"):
        vi.Pendulum().integrate([2.0], h=0.05).steps(0, dense=True).animate()
    with pytest.raises(TypeError, match="HenonHeiles has no drawing of its own: give points"):
        vi.HenonHeiles().integrate([0.0, 0.1], h=0.1).until(1.0, dense=True).animate()
    # A system of the same name may have other coordinates.
    own = vi.System("struct Pendulum { coord x; L = dot(x)^2 / 2 - x^2 / 2; }")
    with pytest.raises(TypeError, match="Pendulum has no drawing"):
        own().integrate([1.0], h=0.1).until(1.0, dense=True).animate()
