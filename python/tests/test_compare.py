"""Two models of one motion."""

import numpy as np
import pytest

import variational as vi


def test_a_rod_and_its_angle_move_alike():
    rod, angle = vi.RodPendulum(g=9.81), vi.Pendulum(g=9.81)
    phi = 1.0
    full = rod.integrate([np.sin(phi), -np.cos(phi)], h=0.01)
    reduced = angle.integrate([phi], h=0.01)
    found = vi.compare(full, reduced, 3.0, map=lambda q: (np.sin(q[0]), -np.cos(q[0])))
    assert found.columns == rod.coordinates and found.difference.shape == (201, 2)
    assert max(found.largest.values()) < 1e-10  # 2.6e-12
    assert found.until(1e-9) == np.inf and full.t == reduced.t == 0.0
    assert found.operations[1] > 0 and all(seconds > 0.0 for seconds in found.seconds)
    assert "Pendulum beside RodPendulum" in repr(found)


def test_a_dropped_term_shows():
    text = """
        struct NAME {
            coord x;
            L = dot(x)^2 / 2 - x^2 / 2 TERM;
        }
    """
    full = vi.System(text.replace("NAME", "Full").replace("TERM", "- x^4 / 40"))()
    reduced = vi.System(text.replace("NAME", "Linear").replace("TERM", ""))()
    found = vi.compare(full.integrate([0.5], h=0.02), reduced.integrate([0.5], h=0.02), 20.0, times=401)
    # The frequency of x'' = -x - x^3/10 is 1 + 3 a^2/80 to order a^4: the phase is off by 0.19 at the end.
    assert found.largest["x"] == pytest.approx(0.5 * 20.0 * 3 * 0.25 / 80, rel=0.1)  # 0.0936
    off = found.until(0.01)
    assert 2.0 < off < 6.0 and np.abs(found.difference[found.t < off]).max() <= 0.01
    assert found.operations[0] > found.operations[1]
    assert len(found.plot().lines) == 1
    with pytest.raises(AttributeError, match=r"Comparison\.t cannot be assigned"):
        found.t = found.t + 1.0


def test_wrong_arguments_are_named():
    pendulum, kepler = vi.Pendulum().integrate([1.0], h=0.1), vi.Kepler().integrate([1.0, 0.0], [0.0, 1.0], h=0.1)
    with pytest.raises(ValueError, match="no coordinate in common: give map, a function of"):
        vi.compare(kepler, pendulum, 1.0)
    with pytest.raises(ValueError, match="map must return 2 numbers"):
        vi.compare(kepler, pendulum, 1.0, map=lambda q: q)
    with pytest.raises(TypeError, match="takes two runs"):
        vi.compare(vi.Pendulum(), pendulum, 1.0)
    with pytest.raises(ValueError, match="start at different times"):
        vi.compare(pendulum, vi.Pendulum().integrate([1.0], t=1.0, h=0.1), 2.0)
