"""Fits against closed forms."""

import copy
import pickle

import numpy as np
import pytest

import variational as vi

pytest.importorskip("scipy")

TIMES = np.linspace(0.3, 9.7, 40)


def oscillation(t, m, k, x0, v0):
    """x and its velocity, and their derivatives with respect to m, k, x0, v0."""
    w = np.sqrt(k / m)
    cos, sin = np.cos(w * t), np.sin(w * t)
    x, v = x0 * cos + v0 * sin / w, -x0 * w * sin + v0 * cos
    x_w = -x0 * t * sin + v0 * (t * cos / w - sin / w**2)
    v_w = -x0 * (sin + w * t * cos) - v0 * t * sin
    w_m, w_k = -0.5 * w / m, 0.5 * w / k
    slopes = [
        [x_w * w_m, x_w * w_k, cos, sin / w],
        [v_w * w_m, v_w * w_k, -w * sin, cos],
    ]
    return np.stack([x, v], axis=-1), np.moveaxis(np.array(slopes), -1, 0)


@pytest.mark.parametrize("unknowns", [["m", "x", "dot(x)"], ["k", "dot(x)"], ["k"], ["m"]])
def test_an_oscillator_against_its_closed_form(unknowns):
    true = {"m": 1.3, "k": 4.1, "x": 0.9, "dot(x)": -0.7}
    exact, slopes = oscillation(TIMES, *true.values())
    noise = 0.02 * np.random.default_rng(5).standard_normal(exact.shape)
    data = {"t": TIMES, "x": exact[:, 0] + noise[:, 0], "dot(x)": exact[:, 1] + noise[:, 1]}
    guess = {name: value * (1.05 if name in unknowns else 1.0) for name, value in true.items()}
    system = vi.HarmonicOscillator(m=guess["m"], k=guess["k"])
    found = vi.fit(system, data, unknowns, q=[guess["x"]], v=[guess["dot(x)"]], t=0.0, h=0.3)
    assert found.success and list(found.parameters) == unknowns and found.columns == ("x", "dot(x)")

    # The closed form at the values found: motion, derivatives, covariance, and a gradient that is zero.
    values = {**true, **found.parameters}
    computed, slopes = oscillation(TIMES, *values.values())
    slopes = slopes[..., [list(true).index(name) for name in unknowns]]
    measured = np.column_stack([data["x"], data["dot(x)"]])
    assert np.abs(found.residuals - (measured - computed)).max() < 1e-14  # 2.2e-15
    assert np.abs(found.jacobian - slopes).max() < 2e-13  # 1.2e-13
    matrix = slopes.reshape(-1, len(unknowns))
    squares = np.sum((measured - computed) ** 2)
    assert np.abs(matrix.T @ (measured - computed).ravel()).max() < 1e-8  # 5.8e-9
    covariance = np.linalg.inv(matrix.T @ matrix) * squares / (80 - len(unknowns))
    assert np.allclose(found.covariance, covariance, rtol=1e-9)
    assert np.allclose(list(found.errors.values()), np.sqrt(np.diag(covariance)), rtol=1e-9)
    assert found.deviation == pytest.approx(np.sqrt(squares / (80 - len(unknowns))), rel=1e-9)


def test_derivatives_of_velocities_whose_momenta_depend_on_the_coordinates():
    # Against differences of motions. The mass matrix depends on the coordinates.
    start = {"q": [1.2, 0.4], "v": [0.3, -0.5], "t": 0.0, "h": 0.05}
    names = ["m1", "l2", "θ1", "dot(θ2)"]
    times = np.linspace(0.0, 2.0, 11)
    end = vi.DoublePendulum(m1=1.1, l2=0.8).integrate(start["q"], start["v"], h=0.05).at(times)
    data = {"t": times, "dot(θ1)": end["dot(θ1)"], "θ2": end["θ2"]}
    found = vi.fit(vi.DoublePendulum(m1=1.1, l2=0.8), data, names, **start)
    assert found.deviation < 1e-12

    def moved(name, change):
        values = {"m1": 1.1, "l2": 0.8, "θ1": 1.2, "dot(θ2)": -0.5}
        values[name] += change
        system = vi.DoublePendulum(m1=values["m1"], l2=values["l2"])
        run = system.integrate([values["θ1"], 0.4], [0.3, values["dot(θ2)"]], h=0.05)
        sol = run.at(times)
        return np.column_stack([sol["dot(θ1)"], sol["θ2"]])

    for column, name in enumerate(names):
        slope = (8 * (moved(name, 5e-4) - moved(name, -5e-4)) - (moved(name, 1e-3) - moved(name, -1e-3))) / 6e-3
        assert np.abs(found.jacobian[..., column] - slope).max() < 1e-8, name  # 5.0e-9, of the differences


@pytest.mark.parametrize("columns", [["l * sin(θ)", "-l * cos(θ)"], ["p_θ"], ["dot(θ)", "m * l^2 * dot(θ)"]])
def test_measured_momenta_and_expressions(columns):
    times = np.linspace(0.0, 5.0, 40)
    motion = vi.Pendulum(l=0.7, m=1.3).integrate([1.0], [0.3], h=0.05).at(times)
    data = {"t": times, **{name: motion[name] for name in columns}}
    guess = vi.Pendulum(l=0.6, m=1.3)
    found = vi.fit(guess, data, ["l", "θ", "dot(θ)"], q=[0.9], v=[0.2], h=0.05)
    assert found.columns == tuple(columns)
    assert list(found.parameters.values()) == pytest.approx([0.7, 1.0, 0.3], rel=1e-13)  # 1.1e-15
    ends = [vi.Pendulum(l=0.7 + k, m=1.3).integrate([1.0], [0.3], h=0.05).at(times)[columns[-1]] for k in (-1e-5, 1e-5)]
    assert found.jacobian[:, -1, 0] == pytest.approx((ends[1] - ends[0]) / 2e-5, abs=1e-8)  # 4e-10


def test_errors_are_those_of_many_noisy_pendulums():
    true = vi.Pendulum(l=0.7)
    clean = true.integrate([1.0], h=0.1).at(TIMES).q[:, 0]
    random = np.random.default_rng(2)
    scores = []
    for _ in range(60):
        data = np.column_stack([TIMES, clean + 0.01 * random.standard_normal(len(TIMES))])
        found = vi.fit(vi.Pendulum(l=0.75), data, ["l", "θ"], q=[1.1], t=0.0, h=0.1)
        scores.append([(found["l"] - 0.7) / found.errors["l"], (found["theta"] - 1.0) / found.errors["θ"]])
    # Measured 0.28 and 0.14. Of 60 draws the mean has the deviation 0.13, and the mean square 0.18.
    assert np.abs(np.mean(scores, axis=0)).max() < 0.4
    assert np.abs(np.mean(np.square(scores), axis=0) - 1.0).max() < 0.6


def test_missing_values_frames_and_deviations():
    pandas = pytest.importorskip("pandas")
    exact, slopes = oscillation(TIMES, 1.0, 4.0, 1.0, 0.0)
    x, v = exact.T.copy()
    x[3], v[::2] = np.nan, np.nan
    frame = pandas.DataFrame({"t": TIMES, "x": x, "dot(x)": v})
    found = vi.fit(vi.HarmonicOscillator(k=3.8), frame, "k", q=[1.0], t=0.0, h=0.3, sigma={"x": 0.01, "dot(x)": 0.05})
    assert found["k"] == pytest.approx(4.0, rel=1e-12)
    assert np.isnan(found.residuals[3, 0]) and np.isfinite(found.residuals).sum() == 39 + 20
    weighted = (slopes[..., 1] / [0.01, 0.05])[np.isfinite(np.column_stack([x, v]))]
    assert found.covariance[0, 0] == pytest.approx(1.0 / (weighted @ weighted), rel=1e-9)


def test_bounds():
    exact, _ = oscillation(TIMES, 1.0, 4.0, 1.0, 0.0)
    data = {"t": TIMES, "x": exact[:, 0]}
    options = {"q": [1.0], "t": 0.0, "h": 0.3}
    at = vi.fit(vi.HarmonicOscillator(k=3.8), data, ["k", "x"], bounds={"k": (0.0, 3.9)}, **options)
    assert at["k"] == pytest.approx(3.9) and np.isnan(at.errors["k"]) and at.errors["x"] > 0.0
    assert "no standard error" in repr(at)
    inside = vi.fit(vi.HarmonicOscillator(k=3.8), data, ["k"], bounds={"k": (0.0, 9.0)}, **options)
    assert inside["k"] == pytest.approx(4.0, rel=1e-12)
    with pytest.raises(ValueError, match=r"first guess k = 3\.8 is outside of its bounds 5 to 6"):
        vi.fit(vi.HarmonicOscillator(k=3.8), data, ["k"], bounds={"k": (5.0, 6.0)}, **options)


def test_an_input_that_changes_with_the_data():
    Cart = vi.System("struct Cart { param m = 1.0; input u = 0.0; coord x; L = m * dot(x)^2 / 2; force x = u; }")
    t = np.arange(0.0, 2.0, 0.1)
    u = np.sin(5.0 * t)
    # Constant forces between the times: x and v in closed form, for the mass 2.5.
    x, v = [0.0], [0.0]
    for force in u[:-1]:
        x.append(x[-1] + 0.1 * v[-1] + 0.005 * force / 2.5)
        v.append(v[-1] + 0.1 * force / 2.5)
    found = vi.fit(Cart(), {"t": t, "u": u, "x": x, "dot(x)": v}, ["m"], q=[0.0], h=0.05)
    assert found["m"] == pytest.approx(2.5, rel=1e-11)
    assert np.allclose(found.solution["dot(x)"], v, atol=1e-14)
    assert np.allclose(found.solution.energy, 1.25 * np.square(v), atol=1e-14)


def test_entries_of_arrays():
    Masses = vi.System("""
    struct Masses { param k[2] = 3.0; coord x[2];
        L = (dot(x[0])^2 + dot(x[1])^2) / 2 - (k[0]*x[0]^2 + k[1]*x[1]^2) / 2;
    }
    """)
    sol = Masses(k=[2.5, 3.5]).integrate([1.0, 0.5], h=0.1).at(TIMES)
    data = np.column_stack([sol.t, sol.q])
    both = vi.fit(Masses(), data, "k", q=[1.0, 0.5], t=0.0, h=0.1, bounds={"k": (1.0, 9.0)})
    assert both.parameters == pytest.approx({"k[0]": 2.5, "k[1]": 3.5}, rel=1e-12)
    assert np.allclose(both.system.k, [2.5, 3.5], rtol=1e-12)
    one = vi.fit(Masses(k=[2.5, 3.0]), data, ["k[1]"], q=[1.0, 0.5], t=0.0, h=0.1)
    assert one.parameters == pytest.approx({"k[1]": 3.5}, rel=1e-12)


def test_what_the_data_do_not_determine():
    sol = vi.Pendulum(l=0.7).integrate([1.0], h=0.1).at(TIMES)
    data = {"t": TIMES, "θ": sol["θ"]}
    with pytest.raises(vi.Unidentifiable, match="do not depend on m"):
        vi.fit(vi.Pendulum(), data, ["m"], q=[1.0], t=0.0, h=0.1)
    with pytest.raises(vi.Unidentifiable, match="do not determine l, g separately") as caught:
        vi.fit(vi.Pendulum(l=0.75), data, ["l", "g"], q=[1.0], t=0.0, h=0.1)
    # Only g/l acts on the motion.
    direction = caught.value.direction
    assert direction["g"] / direction["l"] == pytest.approx(vi.Pendulum().g / 0.7, rel=0.1)
    assert caught.value.change < 1e-13
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.direction == direction and str(again) == str(caught.value)


def test_a_trial_that_fails_shortens_the_step():
    Well = vi.System("struct Well { param k = 4.0; coord x; L = dot(x)^2 / 2 + ln(x + k); }")
    sol = Well(k=0.4).integrate([0.0], h=0.05).at(TIMES)
    data, options = {"t": TIMES, "x": sol["x"]}, {"q": [0.0], "t": 0.0, "h": 0.05}
    # From k = 4 the first trial is k = 0, where the start has no force.
    with pytest.raises(vi.StepError):
        vi.fit(Well(k=0.0), data, "k", **options)
    assert vi.fit(Well(k=4.0), data, "k", **options)["k"] == pytest.approx(0.4, rel=1e-12)  # 2.8e-16


def test_a_parameter_of_a_constrained_system():
    true = vi.RodPendulum(g=9.6).integrate([0.6, -0.8], h=0.05).at(TIMES)
    data = {"t": TIMES, "x": true["x"], "dot(y)": true.v[:, 1]}
    found = vi.fit(vi.RodPendulum(), data, "g", q=[0.6, -0.8], t=0.0, h=0.05)
    assert found["g"] == pytest.approx(9.6, rel=1e-9)  # 1.4e-10, of steps of other lengths
    # Against differences of motions.
    ends = [vi.RodPendulum(g=found["g"] + by).integrate([0.6, -0.8], h=0.05).at(TIMES) for by in (1e-4, -1e-4)]
    plus, minus = (np.column_stack([end["x"], end.v[:, 1]]) for end in ends)
    assert np.abs(found.jacobian[..., 0] - (plus - minus) / 2e-4).max() < 5e-8  # 2.3e-8, of the differences


@pytest.mark.parametrize("name, value", [("g", 9.5), ("l", 1.05)])
def test_a_start_on_constraints_against_the_fit_in_an_angle(name, value):
    """The start x = l sin θ, dot(x) = l cos θ dot(θ) and a parameter of a rod, which are functions of the angle."""
    from scipy.optimize import least_squares

    Angle = vi.System("struct Angle { param l = 1.0, g = 9.81; angle a; L = l^2 * dot(a)^2 / 2 + l * g * cos(a); }")

    def path(values):
        of, x, speed = values
        system = Angle(**{name: of})
        angle = np.arcsin(x / system.l)
        run = system.integrate([angle], [speed / (system.l * np.cos(angle))], h=0.02)
        angles = run.at(TIMES - TIMES[0]).q[:, 0]
        return system.l * np.column_stack([np.sin(angles), -np.cos(angles)])

    noise = 0.01 * np.random.default_rng(7).standard_normal((len(TIMES), 2))
    measured = path([value, 0.6, 0.4]) + noise
    data, rod = {"t": TIMES, "x": measured[:, 0], "y": measured[:, 1]}, vi.RodPendulum(l=1.0, g=9.81)
    # The guess is off the rod.
    found = vi.fit(rod, data, [name, "x", "dot(x)"], q=[0.5, -0.8], v=[0.3, 0.3], h=0.02, stages=6)
    options = {"x_scale": "jac", "xtol": 1e-14, "ftol": 1e-14, "gtol": 1e-14, "jac": "3-point"}
    other = least_squares(lambda values: (path(values) - measured).ravel(), [value, 0.6, 0.4], **options)
    # Measured: 2.0e-9 and 2.7e-8, of the differences.
    assert list(found.parameters.values()) == pytest.approx(other.x, rel=1e-7)
    covariance = np.linalg.inv(other.jac.T @ other.jac) * 2.0 * other.cost / (2 * len(TIMES) - 3)
    assert found.covariance == pytest.approx(covariance, rel=1e-6)
    assert found.solution.q[0, 0] == pytest.approx(found["x"], rel=1e-12)
    assert found.solution.v[0, 0] == pytest.approx(found["dot(x)"], rel=1e-9)
    assert np.abs(found.system.residuals(TIMES[0], found.solution.q[0], found.solution.v[0])).max() < 1e-14


ROD = {"system": vi.RodPendulum(), "q": [0.6, -0.8]}

MISTAKES = [
    ({"parameters": ["kk"]}, ValueError, "no parameter or start value 'kk' .did you mean 'k'"),
    ({"parameters": []}, ValueError, "at least one unknown"),
    ({"parameters": [3]}, TypeError, "unknowns must be names, not 3"),
    ({"data": {"x": TIMES}}, ValueError, 'no column "t"'),
    ({"data": {"t": TIMES, "y": TIMES}}, KeyError, "no coordinate 'y'"),
    ({"data": {"t": TIMES}}, ValueError, "no column of a coordinate"),
    ({"data": {"t": TIMES, "x": TIMES[1:]}}, ValueError, "column 'x' has the shape"),
    ({"data": np.zeros((4, 3))}, ValueError, "columns t, x, not the shape"),
    ({"data": {"t": TIMES[::-1], "x": TIMES}}, ValueError, "ascending"),
    ({"data": {"t": TIMES[:1], "x": TIMES[:1]}, "parameters": ["k", "m"]}, ValueError, "2 unknowns need"),
    ({"t": 1.0}, ValueError, "is before the start"),
    ({"bounds": {"m": (0, 1)}}, ValueError, "'m' of bounds is not an unknown"),
    ({"bounds": {"k": (2, 1)}}, ValueError, "two ascending numbers"),
    ({"bounds": [0, 1]}, TypeError, "bounds must be a dict"),
    ({"sigma": {"y": 1.0}}, ValueError, "'y' of sigma is no measured column"),
    ({"sigma": 0.0}, ValueError, "sigma of x must be positive"),
    ({"h": -0.1}, ValueError, "h must be positive"),
    ({"method": "energy"}, ValueError, "steps of other lengths"),
    ({"system": vi.HarmonicOscillator}, TypeError, "fit needs a system"),
    (ROD | {"parameters": ["x", "y"]}, ValueError, "the constraints determine some of x, y by the others"),
    (ROD | {"parameters": ["dot(x)", "dot(y)"]}, ValueError, r"determine some of dot\(x\), dot\(y\) by the others"),
]


@pytest.mark.parametrize("index", range(len(MISTAKES)))
def test_mistakes(index):
    change, error, message = MISTAKES[index]
    data = {"t": TIMES, "x": np.cos(TIMES)}
    given = {"system": vi.HarmonicOscillator(), "data": data, "parameters": ["k"], "q": [1.0], "t": 0.0, "h": 0.1}
    with pytest.raises(error, match=message):
        vi.fit(**{**given, **change})


def test_a_fit_is_pickled_and_read():
    exact, _ = oscillation(TIMES, 1.0, 4.0, 1.0, 0.0)
    noise = 0.01 * np.random.default_rng(3).standard_normal(len(TIMES))
    found = vi.fit(vi.HarmonicOscillator(k=3.8), {"t": TIMES, "x": exact[:, 0] + noise}, ["k"], q=[1.0], t=0.0, h=0.3)
    assert repr(found).splitlines()[0] == "Fit of HarmonicOscillator to 40 values of x:"
    assert "k = " in repr(found) and " ± 0.00" in repr(found)
    for again in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
        assert again.parameters == found.parameters and np.array_equal(again.covariance, found.covariance)
    with pytest.raises(KeyError, match="no unknown 'm'"):
        found["m"]
    with pytest.raises(ValueError, match="read-only"):
        found.residuals[0] = 0.0
    with pytest.raises(AttributeError, match=r"Fit\.errors cannot be assigned"):
        found.errors = {}
