"""Systems from text."""

import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import variational as vi
from variational import _compile

DOUBLE = """
/// Two pendula, one hanging from the other.
struct Double {
    /// Length of the upper rod.
    param l1 = 1.0;
    param l2 = 1.0, m1 = 1.0, m2 = 1.0, g = 9.81;
    coord a, b;
    L = (m1 + m2) * l1^2 * dot(a)^2 / 2 + m2 * l2^2 * dot(b)^2 / 2
        + m2 * l1 * l2 * dot(a) * dot(b) * cos(a - b) + (m1 + m2) * g * l1 * cos(a) + m2 * g * l2 * cos(b);
    discretize midpoint;
}
"""
SPRING = "struct Spring {{ param k = {}; coord x; L = dot(x)^2 / 2 - k * x^2 / 2; discretize midpoint; }}"


def test_a_double_pendulum(warm_cache):
    Double = vi.compile(DOUBLE)
    assert Double.__name__ == "Double"
    assert "Length of the upper rod." in Double.__doc__
    double = Double(l1=0.7)
    run = double.integrate([1.0, 0.5], h=0.01)
    ready = vi.DoublePendulum(l1=0.7).integrate([1.0, 0.5], h=0.01)
    # Measured: 0.
    np.testing.assert_allclose(run.until(1.0).q, ready.until(1.0).q, rtol=0.0, atol=1e-14)
    again = pickle.loads(pickle.dumps(run))
    assert np.array_equal(run.step().q, again.step().q)
    assert type(again.system) is Double
    with pytest.raises(vi.StepError):
        double.integrate([1.0, 0.5], h=50.0).steps(100)


def test_a_text_changes_to_compiled_steps(warm_cache):
    Spring = vi.compile(SPRING.format(2.25), wait=False)
    slow = Spring(k=3.0).integrate([1.0], h=0.1)
    assert type(slow.system) is Spring and Spring.native(wait=False) is Spring
    Compiled = Spring.native()
    assert Spring._compiled.result(timeout=200.0) is Compiled
    spring = Spring(k=3.0)
    fast = spring.integrate([1.0], h=0.1)
    assert type(fast.system) is Compiled and fast.system.k == 3.0
    assert np.abs(fast.until(5.0).q - slow.until(5.0).q).max() < 1e-14  # 0
    # Four stages are not built.
    assert type(spring.integrate([1.0], h=0.1, stages=4).system) is Spring
    assert len(spring.ensemble([[1.0], [2.0]], h=0.1, until=1.0)) == 2
    assert np.array_equal(pickle.loads(pickle.dumps(fast)).step().q, fast.step().q)


def test_a_text_that_cannot_be_compiled_goes_on(tmp_path, monkeypatch, capfd):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("VARIATIONAL_CACHE", str(tmp_path / "cache"))
    Spring = vi.compile(SPRING.format(2.375), wait=False)
    assert isinstance(Spring._compiled.exception(timeout=60.0), vi.CompileError)
    assert type(Spring().integrate([1.0], h=0.1).system) is Spring
    for _ in range(100):
        if said := capfd.readouterr().err:
            break
        time.sleep(0.05)
    assert "Spring was not compiled, and runs by its text: cargo was not found" in said


CHAIN = """
struct Chain {
    param m[3] = 1.0;
    param k = 5.0;
    coord x[3];
    let stretch[i in 1..3] = x[i] - x[i - 1];
    L = sum(i in 0..3, m[i] * dot(x[i])^2 / 2) - k * (x[0]^2 + x[2]^2 + sum(i in 1..3, stretch[i]^2)) / 2;
}
"""


def test_arrays_of_parameters(warm_cache):
    Chain = vi.compile(CHAIN)
    chain = Chain(m=[1.0, 2.0, 3.0])
    assert chain.m.tolist() == [1.0, 2.0, 3.0]
    assert Chain().m.tolist() == [1.0, 1.0, 1.0]
    with pytest.raises(ValueError, match="read-only"):
        chain.m[0] = 1.0
    with pytest.raises(ValueError, match="m must have 3 entries"):
        chain.m = [1.0, 2.0]
    chain.m = 2.0
    assert chain.m.tolist() == [2.0, 2.0, 2.0]
    assert pickle.loads(pickle.dumps(chain)) == chain
    run = chain.integrate([0.1, 0.0, 0.0], h=0.1)
    run.set(m=[1.0, 2.0, 3.0]).set(**{"m[2]": 4.0})
    assert run.system.m.tolist() == [1.0, 2.0, 4.0]
    assert run.copy().tangent(3, ["m", "k"])["m"].shape == (6, 3)
    assert run.copy().gradient(3, q=[1.0, 0.0, 0.0], wrt=["m"])["m"].shape == (3,)
    many = chain.ensemble([0.1, 0.0, 0.0], h=0.1, until=1.0, parameters={"m": np.ones((4, 3))})
    assert many.q.shape == (4, 3)


def test_the_cache_needs_no_cargo(warm_cache, tmp_path):
    Spring = vi.compile(SPRING.format(2.0), methods="fixed")
    (tmp_path / "class.pickle").write_bytes(pickle.dumps(Spring))
    code = "import pickle, variational; print(pickle.load(open('class.pickle', 'rb'))().k)"
    environment = {**os.environ, "PATH": "", "HOME": str(tmp_path)}
    command = [sys.executable, "-c", code]
    outcome = subprocess.run(command, check=True, capture_output=True, text=True, cwd=tmp_path, env=environment)
    assert float(outcome.stdout) == 2.0
    assert pickle.loads(pickle.dumps(Spring)) is Spring
    assert "param k = 2" in Spring.definition


def test_no_rule_and_a_time_scale(warm_cache):
    motion = "coord x, y; let r = sqrt(x^2 + y^2); L = (dot(x)^2 + dot(y)^2) / 2 + 1 / r;"
    text = f"struct Planet {{ {motion} time_scale = r^(3/2); }}"
    Planet = vi.compile(text)
    assert Planet.integrators == (("gauss", 8, False), ("gauss", 8, True))
    sol = Planet().integrate([0.4, 0.0], [0.0, 2.0], dtau=0.2).until(2 * np.pi)
    # Measured: 1.9e-17.
    np.testing.assert_allclose(sol.q[-1], [0.4, 0.0], rtol=0.0, atol=1e-15)
    with pytest.raises(ValueError, match='no rule for method="fixed": add `discretize midpoint;`'):
        Planet().integrate([0.4, 0.0], h=0.1, method="fixed")


def test_a_mistake_is_reported_with_its_line(monkeypatch, tmp_path):
    monkeypatch.setenv("VARIATIONAL_CACHE", str(tmp_path))
    began = time.perf_counter()
    with pytest.raises(vi.CompileError, match="did you mean `mass`") as caught:
        vi.compile("struct O {\n    param mass = 1.0;\n    coord x;\n    L = mas * dot(x)^2 / 2;\n}")
    assert "definition:4:9" in str(caught.value)
    assert time.perf_counter() - began < 1.0
    assert not list(tmp_path.iterdir())


def test_without_cargo(monkeypatch, tmp_path):
    monkeypatch.setenv("VARIATIONAL_CACHE", str(tmp_path))
    monkeypatch.setenv("PATH", "")
    monkeypatch.setenv("HOME", str(tmp_path))
    with pytest.raises(vi.CompileError, match=r"https://rustup\.rs"):
        vi.compile(SPRING.format(3.0))


def test_a_cache_that_cannot_be_written(monkeypatch, tmp_path):
    file = tmp_path / "file"
    file.write_text("")
    monkeypatch.setenv("VARIATIONAL_CACHE", str(file))
    with pytest.raises(vi.CompileError, match="VARIATIONAL_CACHE"):
        vi.compile(SPRING.format(4.0))


def test_two_processes_at_once(warm_cache, tmp_path):
    """Both compile the same system and one of their own; one build at a time, and each library is whole."""
    code = "import sys, variational as vi\nfor k in sys.argv[1:]:\n    print(vi.compile({!r}.format(k), methods='fixed')().k)"
    command = [sys.executable, "-c", code.format(SPRING)]
    both = [
        subprocess.Popen([*command, *of], stdout=subprocess.PIPE, text=True, cwd=tmp_path)
        for of in (["5.5", "6.5"], ["5.5", "7.5"])
    ]
    outputs = [process.communicate(timeout=200)[0].split() for process in both]
    assert outputs == [["5.5", "6.5"], ["5.5", "7.5"]]


@pytest.mark.skipif(os.name == "nt", reason="kills a process group")
def test_an_interrupted_build_is_taken_up(warm_cache, tmp_path):
    command = [sys.executable, "-c", f"import variational as vi; vi.compile({SPRING.format(8.5)!r}, methods='fixed')"]
    process = subprocess.Popen(command, start_new_session=True, cwd=tmp_path)
    time.sleep(1.5)
    if process.poll() is None:
        os.killpg(process.pid, 9)
    process.wait()
    assert vi.compile(SPRING.format(8.5), methods="fixed")().k == 8.5


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
def test_an_interrupt_ends_the_compiler_too(tmp_path):
    # In place of cargo: a process with a child, as cargo has rustc.
    cargo = tmp_path / "cargo"
    cargo.write_text(f"#!/bin/sh\nsleep 300 &\necho $! > {tmp_path}/child\nwait\n")
    cargo.chmod(0o755)
    path = f"{tmp_path}:{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, "VARIATIONAL_CACHE": str(tmp_path / "cache")}
    code = f"import variational as vi; vi.compile({SPRING.format(8.25)!r}, methods='fixed')"
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        env=environment,
        stderr=subprocess.PIPE,
        text=True,
        # A shell's background jobs ignore it.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    while not (tmp_path / "child").exists() or not (tmp_path / "child").read_text().strip():
        assert process.poll() is None
        time.sleep(0.02)
    child = int((tmp_path / "child").read_text())
    process.send_signal(signal.SIGINT)
    assert "KeyboardInterrupt" in process.communicate(timeout=60)[1]
    deadline = time.monotonic() + 60
    while is_running(child):
        assert time.monotonic() < deadline, "the child of cargo is still running"
        time.sleep(0.02)


def is_running(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    # An ended process stays in the table until its parent has asked for it.
    status = Path(f"/proc/{process}/stat")
    return not status.exists() or status.read_text().rpartition(")")[2].split()[0] != "Z"


def test_vectors_a_table_of_a_file_and_an_input(warm_cache, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    definition = """
    struct Glider {
        param m = 2.0, g = 9.81;
        input thrust = 1.5;
        coord r[2];
        table drag(v) = "drag.csv" extend;
        let v = dot(r);
        L = m * v * v / 2 - m * g * r[1];
        force r = [thrust, m * g] - drag(norm(v)) * v;
        discretize midpoint;
    }
    """
    with pytest.raises(vi.CompileError, match=r"the table `drag` cannot be read from its file"):
        vi.compile(definition, methods="fixed")
    (tmp_path / "drag.csv").write_text("v,drag\n0,0.5\n1,0.5\n2,0.5\n9,0.5\n")
    Glider = vi.compile(definition, methods="fixed")
    assert Glider.coordinates == ("r[0]", "r[1]")

    def speed(cls):
        return cls().integrate([0.0, 0.0], [1.0, 0.0], h=0.01, method="fixed").until(2.0)["dot(r[0])"][-1]

    # m v' = thrust - v/2, by hand; fixed steps of order 2.
    assert abs(speed(Glider) - (3.0 - 2.0 * np.exp(-0.25 * 2.0))) < 1e-5
    (tmp_path / "drag.csv").write_text("v,drag\n0,0\n1,0\n2,0\n9,0\n")
    # A pickle keeps the values that its tables had.
    stored = pickle.dumps(Glider(m=3.0))
    Changed = vi.compile(definition, methods="fixed")
    assert Changed is not Glider
    assert abs(speed(Changed) - 2.5) < 1e-12
    again = pickle.loads(stored)
    assert type(again) is Glider and again.m == 3.0
    assert pickle.loads(pickle.dumps(Changed)) is Changed
    # From the cache, and without it not at all.
    monkeypatch.setattr(_compile, "_loaded", {})
    assert speed(type(pickle.loads(stored))) == speed(Glider)
    monkeypatch.setattr(_compile, "_loaded", {})
    monkeypatch.setenv("VARIATIONAL_CACHE", str(tmp_path / "empty"))
    with pytest.raises(ValueError, match=r"other values when it was pickled: .*drag\.csv changed or is missing"):
        pickle.loads(stored)


def run_clean(cache):
    environment = {**os.environ, "VARIATIONAL_CACHE": str(cache)}
    command = [sys.executable, "-m", "variational", "clean"]
    outcome = subprocess.run(command, capture_output=True, text=True, cwd=cache.parent, env=environment)
    return outcome.returncode, outcome.stderr


def test_clean_deletes_only_what_the_package_has_made(tmp_path, monkeypatch):
    # A folder of the user, which the variable names.
    thesis = tmp_path / "precious" / "thesis"
    thesis.mkdir(parents=True)
    (thesis / "results.csv").write_text("data\n")
    status, message = run_clean(tmp_path / "precious")
    assert status == 1 and "error: there are no compiled systems to delete in" in message and "thesis" in message
    assert (thesis / "results.csv").read_text() == "data\n"
    # The same with a cache in it, as `compile` begins it.
    monkeypatch.setenv("VARIATIONAL_CACHE", str(tmp_path / "precious"))
    monkeypatch.setattr(_compile, "_cargo", fails)
    with pytest.raises(vi.CompileError, match="no cargo here"):
        vi.compile(SPRING.format(9.5), methods="fixed")
    (folder,) = (path for path in (tmp_path / "precious").iterdir() if path.name != "thesis")
    assert (folder / "workspace" / "Cargo.toml").exists()
    (tmp_path / "precious" / "link").symlink_to(folder, target_is_directory=True)
    status, message = run_clean(tmp_path / "precious")
    assert status == 0 and "variational did not make link, thesis" in message
    assert sorted(path.name for path in (tmp_path / "precious").iterdir()) == ["link", "thesis"]
    assert (thesis / "results.csv").read_text() == "data\n"
    # Nothing else: the folder goes too. Without a cache there is nothing to do.
    monkeypatch.setenv("VARIATIONAL_CACHE", str(tmp_path / "new"))
    with pytest.raises(vi.CompileError, match="no cargo here"):
        vi.compile(SPRING.format(9.5), methods="fixed")
    for _ in range(2):
        assert run_clean(tmp_path / "new") == (0, "")
        assert not (tmp_path / "new").exists()


def fails(*arguments):
    raise vi.CompileError("no cargo here")


@pytest.mark.skipif(os.name == "nt", reason="modes and owners of Unix")
def test_a_library_that_others_can_write_is_not_loaded(warm_cache, tmp_path, monkeypatch):
    Spring = vi.compile(SPRING.format(2.0), methods="fixed")
    library = _compile._built(_compile._digest(*Spring._source[:2], Spring._source[2]))
    assert library.stat().st_mode & 0o777 == 0o644
    (tmp_path / "cache").mkdir(mode=0o755)
    old = os.umask(0)
    try:
        with monkeypatch.context() as other:
            other.setenv("VARIATIONAL_CACHE", str(tmp_path / "cache"))
            other.setattr(_compile, "_cargo", fails)
            with pytest.raises(vi.CompileError, match="no cargo here"):
                vi.compile(SPRING.format(9.5), methods="fixed")
    finally:
        os.umask(old)
    (folder,) = (tmp_path / "cache").iterdir()
    planted = folder / "modules" / library.name
    planted.write_bytes(library.read_bytes())
    planted.chmod(0o644)
    monkeypatch.setenv("VARIATIONAL_CACHE", str(tmp_path / "cache"))

    def load():
        monkeypatch.setattr(_compile, "_loaded", {})
        return vi.compile(SPRING.format(2.0), methods="fixed")

    assert load()().k == 2.0
    for path in (planted, planted.parent, folder, tmp_path / "cache"):
        mode = path.stat().st_mode & 0o777
        path.chmod(mode | 0o002)
        with pytest.raises(vi.CompileError, match=rf"{path.name} can be written by other users \(mode {mode | 2:o}\)"):
            load()
        path.chmod(mode)
    # As a folder for temporary files.
    (tmp_path / "cache").chmod(0o1777)
    assert load()().k == 2.0
    if os.geteuid() == 0:
        for path in (planted, planted.parent, folder):
            os.chown(path, 65534, -1)
            with pytest.raises(vi.CompileError, match=rf"{path.name} belongs to another user, 65534"):
                load()
            os.chown(path, 0, -1)
        assert load()().k == 2.0


def test_a_rust_function_needs_a_crate():
    with pytest.raises(vi.CompileError, match=r"(?s)`cl` is a Rust function.*vi-lab new NAME --python"):
        vi.compile("struct S { coord x; fn cl(a) = crate::aero::cl; L = dot(x)^2/2 - cl(x); }")
    with pytest.raises(vi.CompileError, match="`g` is a Rust function"):
        vi.compile("struct S { coord x; fn g(a) = std ::convert::identity; L = dot(x)^2/2 - g(x); }")
    with pytest.raises(vi.CompileError, match="a text alone has no attributes with code"):
        vi.compile('#[doc = include_str!("/etc/hostname")] struct S { coord x; L = dot(x)^2/2 - x; }')


def test_methods_that_do_not_fit_are_refused():
    with pytest.raises(vi.CompileError, match="the method splitting does not fit this system"):
        vi.compile("struct S { coord x; L = (1 + x^2)*dot(x)^2/2 - x^2; }", methods="splitting")
    with pytest.raises(vi.CompileError, match="the method energy needs the rule midpoint"):
        vi.compile("struct S { coord x; L = dot(x)^2/2 - x^2; discretize trapezoidal; }", methods="energy")


def test_functions_that_call_each_other_end_with_a_message():
    chain = " ".join(f"fn f{i + 1}(a) = f{i}(a) + 1;" for i in range(3200))
    with pytest.raises(vi.CompileError, match="inside each other"):
        vi.compile(f"struct S {{ coord x; fn f0(a) = a^2; {chain} L = dot(x)^2/2 - f3200(x); }}")
    with pytest.raises(vi.CompileError, match="nested deeper"):
        vi.compile(f"struct S {{ coord x; L = dot(x)^2/2 - {'(' * 50_000}x{')' * 50_000}; }}")


BODIES = """
struct Bodies {
    const N = 4;
    param m[N] = [1.0, 0.3, 0.2, 0.1], G = 0.8;
    coord r[N][3];
    let v = dot(r);
    L = sum(i in 0..N, m[i] * v[i] * v[i]) / 2
        + sum(i in 0..N, j in 0..i, G * m[i] * m[j] / norm(r[i] - r[j]));
}
"""


def test_bodies_in_space_against_dop853(warm_cache):
    from scipy.integrate import solve_ivp

    Bodies = vi.compile(BODIES)
    m, g = np.array([1.0, 0.3, 0.2, 0.1]), 0.8
    r = np.array([[0.0, 0.1, 0.0], [1.5, 0.0, 0.2], [-0.4, 2.5, -0.3], [0.5, -1.1, 3.5]])
    v = np.array([[0.0, -0.05, 0.0], [0.1, 0.8, 0.0], [-0.6, 0.0, 0.1], [0.2, 0.4, 0.2]])

    def rate(_, y):
        r, v = y.reshape(2, 4, 3)
        d = r[:, None] - r[None]
        distance = np.linalg.norm(d, axis=-1) + np.eye(4)
        return np.concatenate([v.ravel(), (-g * (m[None, :, None] * d / distance[..., None] ** 3).sum(1)).ravel()])

    exact = solve_ivp(rate, (0.0, 6.0), np.concatenate([r.ravel(), v.ravel()]), "DOP853", rtol=1e-13, atol=1e-13)
    end = Bodies().integrate(r.ravel(), v.ravel(), h=0.02).until(6.0)
    error = np.abs(end.q[-1] - exact.y[:12, -1]).max()
    # Measured: 1.1e-12.
    assert error < 3e-12
