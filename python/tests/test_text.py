"""Systems from text, without a compiler of Rust."""

import copy
import os
import pickle
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import variational as vi

SPRING = """
struct Spring {
    /// Stiffness.
    param k = 4.0;
    coord x;
    L = dot(x)^2 / 2 - k * x^2 / 2;
    discretize midpoint;
}
"""

# Five masses in a row, of which three more are at rest in the second text.
CHAIN = """
struct Chain {
    param k = 1.3;
    input u = 0.2;
    coord q[5]MORE;
    L = sum(i in 0..5, dot(q[i])^2) / 2 REST - k * (q[0]^2 + sum(i in 1..5, (q[i] - q[i - 1])^2)) / 2
        - sum(i in 0..5, q[i]^4) / 4 + sum(i in 1..5, dot(q[i]) * dot(q[i - 1]) * cos(q[i])) / 10;
    force q[4] = u - 0.1 * dot(q[4]);
    discretize midpoint;
}
"""
NARROW = CHAIN.replace("MORE", "").replace("REST", "")
WIDE = CHAIN.replace("MORE", ", z[3]").replace("REST", "+ sum(i in 0..3, dot(z[i])^2) / 2")


def test_a_text_is_a_class_at_once():
    Spring = vi.System(SPRING)
    assert isinstance(Spring, type) and issubclass(Spring, vi.System)
    assert Spring is vi.System(SPRING)
    assert "Stiffness." in Spring.__doc__ and Spring().k == 4.0
    sol = Spring(k=9.0).integrate([1.0], h=0.05).until(2.0)
    assert sol.q[-1, 0] == pytest.approx(np.cos(6.0), abs=1e-13)  # 1.2e-15
    assert Spring.explain(Spring()).title == "Spring"


def test_the_definition_is_as_it_was_written():
    text = "\n        struct S {\n            coord x;   // a comment\n            L = dot(x)^2;\n        }\n    "
    assert vi.System(text).definition == text
    for ready in (vi.Pendulum, vi.Kepler):
        lines = ready.definition.splitlines()
        assert lines[0].startswith("/// Plane ") and lines[-1] == "}" and "    discretize midpoint;" in lines


def test_every_method_agrees():
    Spring = vi.System(SPRING)
    assert {"fixed", "kahan-li-8", "splitting-6", "gauss", "energy"} <= {method for method, *_ in Spring.integrators}
    ends = {
        method: Spring().integrate([1.0], h=0.01, method=method).at([3.0]).q[0, 0]
        for method in ("gauss", "kahan-li-6", "kahan-li-8", "splitting-4", "splitting-6")
    }
    assert all(end == pytest.approx(np.cos(6.0), abs=1e-9) for end in ends.values()), ends  # 2.2e-10
    assert Spring().integrate([1.0], h=0.01, method="energy", stages=2).at([3.0]).q[0, 0] == pytest.approx(
        np.cos(6.0), abs=1e-9
    )


def test_a_ready_system_as_a_text_takes_the_same_steps():
    Own = vi.System(vi.DoublePendulum.definition)
    # Measured: 0, 0, 3.6e-15, 2.9e-12: the lengths of adaptive steps follow the jerk.
    for method, tolerance in {"fixed": 0.0, "energy": 0.0, "gauss": 1e-14, "adaptive": 4e-12}.items():
        runs = [cls().integrate([1.0, 0.5], h=0.01, method=method) for cls in (Own, vi.DoublePendulum)]
        one, other = [run.steps(200) for run in runs]
        assert np.abs(one.q - other.q).max() <= tolerance, method


def test_ready_texts():
    for name in ("ChargedParticle", "HarmonicOscillator", "NPendulum", "SphericalPendulum"):
        cls = getattr(vi, name)
        assert cls.__module__ == "variational" and name in vi.systems
        assert pickle.loads(pickle.dumps(cls())) == cls()
    with pytest.raises(AttributeError, match="no attribute 'NoSuchSystem'"):
        vi.NoSuchSystem


def test_pickles_hold_the_text():
    Spring = vi.System(SPRING)
    system = Spring(k=2.0)
    assert pickle.loads(pickle.dumps(Spring)) is Spring
    assert pickle.loads(pickle.dumps(system)) == system == copy.deepcopy(system)
    run = system.integrate([1.0], h=0.1)
    run.steps(7)
    again = pickle.loads(pickle.dumps(run))
    assert np.array_equal(again.steps(5).q, run.steps(5).q)
    # Another process knows the class by its text.
    code = "import pickle, sys; system = pickle.load(sys.stdin.buffer); print(repr(system))"
    found = subprocess.run([sys.executable, "-c", code], input=pickle.dumps(system), capture_output=True, check=True)
    assert found.stdout.decode().strip() == "Spring(k=2)"


class Named(vi.System(SPRING)):
    """A subclass is pickled by its name."""

    def stiffness(self):
        return self.k


def test_subclasses_are_pickled_by_name():
    assert pickle.loads(pickle.dumps(Named)) is Named
    assert pickle.loads(pickle.dumps(Named(k=2.0))).stiffness() == 2.0


def test_names_of_the_class_itself():
    for name in ("cls", "self", "_text", "_source", "_defaults", "_values"):
        S = vi.System(f"struct S {{ param {name}_ = 1.5; coord x; L = dot(x)^2 / 2 - {name}_ * x^2 / 2; }}")
        assert S.parameters == (f"{name}_",)
    for name in ("cls", "_text", "_source", "_defaults"):
        S = vi.System(f"struct S {{ param {name} = 1.5; coord x; L = dot(x)^2 / 2 - {name} * x^2 / 2; }}")
        (found,) = S.parameters
        assert pickle.loads(pickle.dumps(S(**{found: 2.0}))) == S(**{found: 2.0})
    P = vi.System("struct P { coord ϕ, φ; L = dot(ϕ)^2 / 2 + dot(φ)^2 / 2 - φ^2; }")
    assert len(set(P.coordinates)) == 2
    assert P().integrate([1.0, 2.0], h=0.1).steps(1)[P.coordinates[1]][0] == 2.0


def test_threads_get_one_class():
    texts = [SPRING.replace("Spring", f"Spring{i}") for i in range(20)]
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(8) as pool:
            for text in texts:
                assert len(set(pool.map(vi.System, [text] * 8))) == 1
    finally:
        sys.setswitchinterval(interval)


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="reads the memory from /proc")
def test_systems_that_were_made_and_dropped_take_no_memory():
    def resident():
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def use(count):
        for k in range(count):
            vi.System(SPRING)(k=4.0 + 1e-4 * k).integrate([1.0], h=0.01).step()

    use(500)
    before = resident()
    use(10_000)
    # Measured: nothing. A text that differs leaves 11 kB: its code stays.
    assert resident() - before < 4e6


def test_a_missing_clause_is_named():
    text = "struct S { coord x; L = dot(x)^2 / 2 - x^4; }"
    for options, words in (
        ({"method": "fixed", "h": 0.1}, 'no rule for method="fixed": add `discretize midpoint;`'),
        ({"method": "energy", "h": 0.1}, 'no rule for method="energy": add `discretize midpoint;`'),
        ({"dtau": 0.1}, "give h in place of dtau, or write the clause `time_scale"),
        ({"stages": 5, "h": 0.1}, "The argument methods of compile"),
    ):
        with pytest.raises(ValueError, match=words):
            vi.System(text)().integrate([1.0], **options)
    with pytest.raises(TypeError, match="argument of vi.compile"):
        vi.System(text, methods="fixed")


def test_deep_nesting_is_a_mistake():
    with pytest.raises(vi.CompileError, match="nested deeper than 100 levels"):
        vi.System("struct S { coord x; L = dot(x)^2 / 2 - " + "(" * 20000 + "x" + ")" * 20000 + "; }")


def test_mistakes_have_their_line():
    with pytest.raises(vi.CompileError, match=r"unknown name `c`(.|\n)*definition:6:\d+"):
        vi.System(SPRING.replace("k * x^2", "c * x^2"))
    with pytest.raises(vi.CompileError, match="Rust function"):
        vi.System("struct Odd { coord x; fn f(a) = crate::f; L = dot(x)^2 / 2 - f(x); }")
    with pytest.raises(TypeError, match="the text of a system"):
        vi.System()
    with pytest.raises(TypeError, match="must be a text, not int"):
        vi.System(3)


def test_coordinates_between_the_built_sizes():
    narrow, wide = vi.System(NARROW)(), vi.System(WIDE)()
    q, v = np.array([0.3, 0.2, 0.1, 0.0, -0.1]), np.array([0.0, 0.1, 0.2, 0.3, 0.4])
    full = lambda of: np.concatenate([of, np.zeros(3)])
    assert narrow.coordinates == wide.coordinates[:5]
    for method, options in (("gauss", {}), ("fixed", {}), ("energy", {"stages": 2})):
        run = narrow.integrate(q, v, h=0.05, method=method, **options)
        other = wide.integrate(full(q), full(v), h=0.05, method=method, **options)
        one, of_all = run.until(2.0, dense=True), other.until(2.0, dense=True)
        # The sums of the other text have further terms, which round differently. Lengths of steps multiply
        # that: 1.6e-7 in a gradient by energy-preserving steps.
        size = 1e-6 if method == "energy" else 1e-12

        def near(found, wanted, size=size):
            return np.abs(found - wanted).max() <= size

        assert near(one.t, of_all.t) and near(one.q, of_all.q[:, :5])
        assert near(one.p, of_all.p[:, :5]) and near(one.energy, of_all.energy)
        keep = [0, 1, 2, 3, 4, 8, 9, 10, 11, 12]
        assert near(one(1.03), of_all(1.03)[keep])
        assert near(run.linearization().A, other.linearization().A[np.ix_(keep, keep)])
        assert near(run.linearization().B, other.linearization().B[keep])
        assert near(run.local_error().q, other.local_error().q[:5])
        gradient, of_wide = run.gradient(3, q=q, wrt=["k"]), other.gradient(3, q=full(q), wrt=["k"])
        for name, value in gradient.items():
            assert near(np.ravel(value), np.ravel(of_wide[name])[: np.size(value)]), name
    for function in ("momentum", "force", "acceleration", "bias"):
        found, of_wide = (getattr(s, function)(0.0, x, w) for s, x, w in ((narrow, q, v), (wide, full(q), full(v))))
        assert np.abs(found - of_wide[:5]).max() < 1e-15, function
    assert np.abs(narrow.mass_matrix(0.0, q, v) - wide.mass_matrix(0.0, full(q), full(v))[:5, :5]).max() < 1e-15
    assert abs(narrow.energy(0.0, q, v) - wide.energy(0.0, full(q), full(v))) < 1e-15
    rest = narrow.equilibrium(0.1 * np.ones(5))
    assert np.abs(narrow.acceleration(0.0, rest.q, np.zeros(5))).max() < 1e-14
    assert rest.q.shape == (5,) and rest.mass.shape == (5, 5) and len(rest.rates) == 10
    assert np.all(np.abs(rest.rates) > 0.1) and not any(rest.free)
    run = narrow.integrate(q, v, h=0.05)
    run.set(u=0.5)
    run.set_state(q=q, v=2 * v)
    assert np.allclose(run.v, 2 * v, rtol=1e-14) and run.local_error().q.shape == (5,)
    times = run.events(lambda t, q, v: float(len(q) == len(v) == 5) * q[0], until=20.0).t
    assert len(times) > 3
    ends = narrow.ensemble(np.stack([q, 2 * q]), v, h=0.05, until=1.0).q
    assert ends.shape == (2, 5) and not np.isnan(ends).any()
    assert pickle.loads(pickle.dumps(run)).steps(3).q.shape == (4, 5)


def test_a_control_loop():
    Cart = vi.System("struct Cart { input u = 0.0; coord x; L = dot(x)^2 / 2; force x = u; }")
    run = Cart().integrate([0.0], h=0.1)
    for _ in range(10):
        run.set(u=1.0)
        run.steps(1)
    assert run.q[0] == pytest.approx(0.5, abs=1e-14)


@pytest.mark.skipif(shutil.which("cargo") is None, reason="needs cargo")
def test_native_is_the_same_system(warm_cache):
    Spring = vi.System(SPRING)
    Native = Spring.native()
    assert Native is not Spring and Native.coordinates == Spring.coordinates
    assert Native.native() is Native and Named.native() is Native
    one, other = (cls().integrate([1.0], h=0.1).steps(100) for cls in (Spring, Native))
    assert np.abs(one.q - other.q).max() < 1e-13  # 2.2e-16


def test_constraints_and_rotations():
    # A rod and a blade: three coordinates, and one at rest.
    Both = vi.System("""
        struct Both {
            param m = 1.5;
            coord x, y; angle theta;
            L = m * (dot(x)^2 + dot(y)^2) / 2 + 0.35 * dot(theta)^2 - m * 9.81 * y + 0.1 * cos(theta);
            constraint rod = x^2 + y^2 - 1.69;
            constraint spin = dot(theta) - 0.3 * y * dot(x);
        }
    """)
    assert Both.constraints == ("rod", "spin") and {method for method, *_ in Both.integrators} == {"gauss", "adaptive", "energy"}
    both = Both()
    start = both.project([1.0, -0.8, 0.3], [0.5, 0.0, 0.0])
    run = both.integrate(start.q, start.v, h=0.01)
    sol = run.until(2.0)
    assert np.abs(sol.q[:, 0] ** 2 + sol.q[:, 1] ** 2 - 1.69).max() < 1e-14  # 4.4e-16
    assert np.abs(sol.energy - sol.energy[0]).max() < 1e-9  # 3.6e-12
    assert sol.q.shape[1] == 3 and both.reaction(0.0, start.q, both.momentum(0.0, start.q, start.v)).shape == (2,)
    # The lowest place: the pendulum has ω² = g/l, and the blade no force of its own.
    Hanging = vi.System("""
        struct Hanging {
            coord x, y, z;
            L = (dot(x)^2 + dot(y)^2 + dot(z)^2) / 2 - 9.81 * y - 2 * z^2;
            constraint rod = x^2 + y^2 - 1.69;
        }
    """)
    rest = Hanging().equilibrium([0.1, -1.2, 0.2])
    assert np.allclose(rest.q, [0.0, -1.3, 0.0], atol=1e-15) and rest.mass.shape == (2, 2)
    found = np.sort(np.abs(np.imag(rest.rates)))
    assert np.allclose(found, np.sort([2.0, 2.0, np.sqrt(9.81 / 1.3), np.sqrt(9.81 / 1.3)]), rtol=1e-14)
    linear = Hanging().linearization(0.0, rest.q, np.zeros(3))
    assert linear.A.shape == (6, 6)
    # Free motion along z: it is counted once, without the coordinate at rest.
    Sliding = vi.System("""
        struct Sliding {
            coord x, y, z;
            L = (dot(x)^2 + dot(y)^2 + dot(z)^2) / 2 - 9.81 * y;
            constraint rod = x^2 + y^2 - 1.69;
        }
    """)
    rest = Sliding().equilibrium([0.1, -1.2, 0.2])
    assert tuple(rest.free) == (False, False, True) and rest.q[2] == 0.2
    assert np.sum(np.abs(rest.rates) == 0.0) == 2
    Body = vi.System("""
        struct Body {
            param J[3] = [0.2, 0.3, 0.4];
            rotation R;
            let w = rate(R);
            L = (J[0] * w[0]^2 + J[1] * w[1]^2 + J[2] * w[2]^2) / 2;
        }
    """)
    assert len(Body.coordinates) == 4 and len(Body.constraints) == 1


TABLED = """
struct Tabled {
    coord x;
    table pull(x) = "FILE" extend;
    L = dot(x)^2 / 2;
    force x = -pull(x);
}
"""


def test_tables_are_pickled_by_their_values(tmp_path):
    path = tmp_path / "pull.csv"
    text = TABLED.replace("FILE", path.as_posix())
    path.write_text("x,f\n-1,-2\n0,0\n1,2\n")
    Tabled = vi.System(text)
    end = Tabled().integrate([1.0], h=0.05).at([1.0]).q[0, 0]
    # A spring of the stiffness 2, whose table has no knots.
    assert end == pytest.approx(np.cos(np.sqrt(2.0)), abs=1e-12)  # 1.1e-15
    stored = pickle.dumps(Tabled())
    path.write_text("x,f\n-1,-3\n0,0\n1,3\n")
    Other = vi.System(text)
    assert Other is not Tabled
    assert Other().integrate([1.0], h=0.05).at([1.0]).q[0, 0] == pytest.approx(np.cos(np.sqrt(3.0)), abs=1e-12)
    with pytest.raises(vi.CompileError, match=r"pull\.csv of a table changed"):
        Tabled.native()
    path.unlink()
    again = pickle.loads(stored)
    assert type(again) is Tabled and again.integrate([1.0], h=0.05).at([1.0]).q[0, 0] == end
    with pytest.raises(vi.CompileError, match="cannot be read from its file"):
        vi.System(text)


CRANKS = """
struct Cranks {
    param b = 2.0, c = 1.0, g = 9.81;
    coord x, y, u, w;
    L = (dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(w)^2) / 2 - g * (y + w);
    constraint left = x^2 + y^2 - 1, right = (u - b)^2 + w^2 - 1, coupler = (u - x)^2 + (w - y)^2 - b^2;
    constraint middle = ((x + u) / 2 - b / 2)^2 + ((y + w) / 2)^2 - c^2;
}
"""


def test_a_third_crank_is_dropped():
    Cranks = vi.System(CRANKS)
    q = [np.sin(0.5), -np.cos(0.5), 2.0 + np.sin(0.5), -np.cos(0.5)]
    with pytest.raises(vi.Redundant, match=r"start from system\.independent\(q, t=…\).*here 1 of 4, such as `middle`"):
        Cranks(g=5.0).integrate(q, h=0.01)
    kept = Cranks(g=5.0).independent(q)
    assert kept.g == 5.0 and kept.constraints == Cranks.constraints and kept.redundant(q) == ("middle",)
    run = kept.integrate(q, h=0.01)
    sol = run.steps(10_000, every=10)
    # As the pendulum of one angle, measured: 1.9e-12, and 1.8e-15 and 8.5e-14 for the constraints and the energy.
    angle = vi.System("struct A { param g = 5.0; coord a; L = dot(a)^2 + 2 * g * cos(a); }")()
    exact = angle.integrate([0.5], h=0.01, stages=8).steps(10_000, every=10)
    assert np.abs(sol["x"] - np.sin(exact["a"])).max() < 1e-11
    assert sol.residual.max() < 4e-15 and np.ptp(sol.energy) < 5e-13 and not sol.reactions[:, 3].any()
    # A system like any other.
    for again in (pickle.loads(pickle.dumps(run)), run.copy()):
        assert again.system == run.system and np.array_equal(again.step().q, run.copy().step().q)
    assert type(pickle.loads(pickle.dumps(kept))) is type(kept)
    many = kept.ensemble([q, q], h=0.01, times=[1.0, 10.0])
    assert many.success and np.abs(many.q - sol.q[[10, 100]]).max() < 1e-13
    assert abs(run.next_event("x", until=run.t + 10.0)["x"][0]) < 1e-14
    with pytest.raises(vi.DroppedConstraint):
        kept.copy().set(c=1.1).integrate(q, h=0.01)
    with pytest.raises(vi.CompileError, match="is without middle: delete these from its text"):
        kept.native()
    # Nothing to drop.
    rod = vi.RodPendulum()
    assert rod.independent([0.6, -0.8]) == rod


def test_a_planar_linkage_in_space_is_overconstrained():
    # A crank and a connecting rod, joined by hinges: the pivot holds the plane a second time.
    Space = vi.System("""
    struct Space {
        param l[2] = [1.0, 3.0], m = 1.5, g = 9.81;
        coord x[2][3];
        rotation R[2];
        let w[i in 0..2] = rate(R[i]);
        L = sum(i in 0..2, m * dot(x[i]) * dot(x[i]) / 2 - m * g * x[i][1]
            + m * l[i]^2 * (w[i][0]^2 / 100 + w[i][1]^2 + w[i][2]^2) / 24);
        let half[i in 0..2] = turn(R[i], [l[i] / 2, 0, 0]), axis = turn(R[0], [0, 0, 1]);
        constraint pivot = x[0] - half[0], upright = axis[0], level = axis[1];
        constraint pin = x[0] + half[0] - x[1] + half[1];
        constraint hinge = axis * turn(R[1], [1, 0, 0]), swing = axis * turn(R[1], [0, 1, 0]);
        constraint rail = x[1][1] + half[1][1], plane = x[1][2] + half[1][2];
    }
    """)
    assert len(Space.coordinates) == len(Space.constraints) == 14
    Plane = vi.System("""
    struct Plane {
        param l[2] = [1.0, 3.0], m = 1.5, g = 9.81;
        coord a;
        let s = l[0] * sin(a) / l[1], b = -asin(s), turn = -l[0] * cos(a) * dot(a) / l[1] / sqrt(1 - s^2);
        let v = [l[0] * sin(a) * dot(a) + l[1] * sin(b) * turn / 2, l[0] * cos(a) * dot(a) + l[1] * cos(b) * turn / 2];
        L = m * (l[0]^2 * dot(a)^2 / 6 + l[1]^2 * turn^2 / 24 + v * v / 2)
            - m * g * (3 * l[0] * sin(a) / 2 + l[1] * sin(b) / 2);
    }
    """)
    a = 0.4
    angles = np.array([a, -np.arcsin(np.sin(a) / 3.0)])
    crank, rod = np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    turns = np.stack([np.cos(angles / 2), 0.0 * angles, 0.0 * angles, np.sin(angles / 2)], axis=1)
    q = np.concatenate([crank / 2, crank + 1.5 * rod, turns.reshape(-1)])
    kept = Space().independent(q)
    sol = kept.integrate(q, h=0.01).steps(300)
    exact = Plane().integrate([a], h=0.01, stages=8).steps(300)
    angle = 2.0 * np.arctan2(sol["R[0][3]"], sol["R[0][0]"])
    # Measured: 1.6e-11, 2e-15 and 0.
    assert np.abs(np.exp(1j * (angle - exact["a"])) - 1.0).max() < 1e-10
    assert sol.residual.max() < 1e-14 and np.abs(sol.q[:, [2, 5]]).max() < 1e-14


def test_a_rule_that_is_too_large():
    # 28 links: the equations of the motion fit, those of a step by the rule do not.
    Links = vi.System(
        """struct Links { coord a[28];
        let x[i in 0..28] = sum(j in 0..i + 1, sin(a[j])); let y[i in 0..28] = sum(j in 0..i + 1, cos(a[j]));
        L = sum(i in 0..28, (dot(x[i])^2 + dot(y[i])^2) / 2 + y[i]); discretize midpoint; }"""
    )
    start = np.full(28, 0.1)
    assert np.ptp(Links().integrate(start, h=0.01).steps(3).energy) < 1e-11
    with pytest.raises(vi.RuleTooLarge, match='`Links` .* too many terms.*method="gauss"'):
        Links().integrate(start, h=0.01, method="fixed")


def test_a_hamiltonian():
    declared = "param m = 1.3, k = 20.0; coord r; angle a;"
    ByH = vi.System(
        f"struct ByH {{ {declared} momentum p of r, l of a; let spring = k * (r - 1)^2 / 2;"
        " H = p^2 / (2 * m) + l^2 / (2 * m * r^2) + spring; force r = -0.1 * p / m; discretize midpoint; }"
    )
    ByL = vi.System(
        f"struct ByL {{ {declared} L = m * (dot(r)^2 + r^2 * dot(a)^2) / 2 - k * (r - 1)^2 / 2;"
        " force r = -0.1 * dot(r); discretize midpoint; }"
    )
    for options in ({}, {"method": "fixed"}, {"method": "energy"}):
        by_h, by_l = (system().integrate(q=[1.2, 0.3], p=[0.1, 0.7], h=0.01, **options).steps(50) for system in (ByH, ByL))
        # Measured: 0 and, by steps that find their length, 0.
        assert np.abs(by_h.q - by_l.q).max() < 1e-12
    sol = ByH().integrate(q=[1.2, 0.3], p=[0.1, 0.7], h=0.01).steps(50)
    assert np.allclose(sol["l"], sol.p[:, 1], rtol=1e-15, atol=0.0)
    assert np.allclose(sol["p / m"], sol.v[:, 0], rtol=1e-14, atol=1e-15)
    assert "p_r^2/(2*m) + p_a^2/(2*m*r^2)" in str(ByL().explain())
    with pytest.raises(vi.CompileError, match="`H` has no Lagrangian in closed form, which constraints need"):
        vi.System("struct Quartic { coord x, y; momentum p of x, l of y; H = p^4 + l^2; constraint c = x + y; }")


def test_a_momentum_where_an_input_changes():
    # v = (r - u)/m jumps with u and m, the momentum does not.
    Charge = vi.System("struct Charge { param m = 1.0; input u = 0.0; coord x; momentum r of x; H = (r - u)^2/(2*m); }")
    for name in ("u", "m"):
        run = Charge().integrate(q=[0.0], p=[1.0], h=0.1)
        sol = run.until(0.5, callback=lambda run, name=name: run.set(**{name: 2.0 + run.t}))
        np.testing.assert_allclose(sol["r"], 1.0, rtol=1e-15)
        np.testing.assert_allclose(sol["m * dot(x) + u"], 1.0, rtol=1e-15)
