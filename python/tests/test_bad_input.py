"""Bad input is a Python exception that names what is wrong."""

import numpy as np
import pytest

import variational as vi

START = {"q": [0.4, 0.0], "v": [0.0, 2.0], "h": 0.05}


def begun(**options):
    return vi.Kepler().integrate(**{**START, **options})


def rod():
    return vi.RodPendulum().integrate([0.6, -0.8], h=0.05).steps(1)


def pendulum():
    return vi.Pendulum().integrate([1.0], h=0.05)


DATA = {"t": [0.0, 1.0, 2.0], "θ": [1.0, 0.5, 0.0]}


def fitted(data=DATA, unknowns="l", **options):
    return vi.fit(vi.Pendulum(), data, unknowns, **{"q": [1.0], "h": 0.05, **options})


def rod_start(start):
    return vi.RodPendulum().integrate(start, h=0.05)


def chain():
    text = "struct Chain { coord x[3]; L = sum(i in 0..3, dot(x[i])^2) / 2; }"
    return vi.System(text)().integrate([0.0, 0.0, 0.0], h=0.05).steps(1)


TABLE = [
    # Names.
    (lambda: vi.Pendulum(lenght=1.0), TypeError, "no parameter 'lenght'"),
    (lambda: vi.Pendulum(1.0), TypeError, "takes no positional arguments: give its parameters by name, m=…, l=…, g=…"),
    (lambda: vi.System(2.0), TypeError, r"must be a text, not float: System\('struct Spring"),
    (lambda: setattr(vi.Pendulum(), "lenght", 1.0), AttributeError, "lenght"),
    (lambda: vi.System(), TypeError, "vi.systems"),
    (lambda: begun(method="gaus"), ValueError, "did you mean 'gauss'"),
    (lambda: begun(method=7), ValueError, "no method 7"),
    (lambda: begun(method="lanes"), ValueError, "no method 'lanes'"),
    (lambda: begun().until(1.0)["z"], KeyError, "it has x, y"),
    (lambda: begun().until(1.0)[0], TypeError, "name of a coordinate"),
    (lambda: begun().until(1.0)["vx"], KeyError, r'the velocity of x is \\?"dot\(x\)'),
    (lambda: begun().until(1.0)["x_dot"], KeyError, r'the velocity of x is \\?"dot\(x\)'),
    (lambda: begun().until(1.0)["ẏ"], KeyError, r'the velocity of y is \\?"dot\(y\)'),
    (lambda: begun().events("dx", 1.0), KeyError, r'the velocity of x is \\?"dot\(x\)'),
    (lambda: begun().until(1.0)["energy"], KeyError, "it is the attribute .energy"),
    (lambda: rod()["rod"], KeyError, r"rod is a constraint: its reaction is reactions\[..., 0\]"),
    (lambda: rod()["Λ_rod"], KeyError, r"its reaction is reactions\[..., 0\]"),
    (lambda: chain()["x[20]"], KeyError, r"the entries of x are x\[0\] to x\[2\]"),
    (lambda: begun().events("z", 1.0), KeyError, "no coordinate 'z'"),
    (lambda: begun().until(1.0)["mu[0]"], TypeError, r"mu is one number, which has no entry 'mu\[0\]'"),
    (lambda: begun().set(**{"mi[0]": 1.0}), TypeError, r"no parameter 'mi\[0\]'; it has mu"),
    (lambda: begun().tangent(3, ["nothing"]), TypeError, "no parameter 'nothing'"),
    (lambda: begun().until(1.0, on_error="ignore"), ValueError, "on_error"),
    (lambda: begun().until(1.0, on_error="retrun"), ValueError, "did you mean 'return'"),
    (lambda: vi.Keppler, AttributeError, "did you mean 'Kepler'"),
    (lambda: vi.Kepler().simulate, AttributeError, "Kepler has no attribute 'simulate': it is called integrate"),
    (lambda: vi.Kepler().enegry, AttributeError, "did you mean 'energy'"),
    (lambda: vi.Pendulum().lenght, AttributeError, "its parameters are m, l, g"),
    (lambda: setattr(vi.Kepler(), "mi", 1.0), AttributeError, "no attribute 'mi'; its parameters are mu"),
    (lambda: vi.HarmonicOscillator().lambda_, AttributeError, "no attribute 'lambda_'"),
    (lambda: begun().untill(1.0), AttributeError, "did you mean 'until'"),
    (lambda: begun().propagate, AttributeError, "it is called until"),
    (lambda: begun().x, AttributeError, r"the coordinate is run.q\[0\]"),
    (lambda: begun().mu, AttributeError, "the parameter is run.system.mu"),
    (lambda: begun().until(1.0).y_, AttributeError, "did you mean 'y'"),
    (lambda: begun().until(1.0).df, AttributeError, "it is called to_dataframe"),
    (lambda: begun().until(1.0).x, AttributeError, r'the coordinate is \["x"\], its velocity \["dot\(x\)"\]'),
    (lambda: vi.Pendulum().integrate([1.0], h=0.1).steps(1).theta, AttributeError, r'the coordinate is \["θ"\]'),
    (lambda: begun().until(1.0).plot(ax=None), TypeError, "plot has no argument 'ax': write axes=…"),
    (lambda: begun().until(1.0).animate(framerate=10), TypeError, "write fps=…"),
    (lambda: vi.Event("x", directon=1), TypeError, "Event has no argument 'directon'.*did you mean 'direction'"),
    (lambda: vi.Period(1.0, begin=0.0), TypeError, "Period has no argument 'begin'; it has period, start"),
    (lambda: vi.compile("struct S {}", method="gauss 4"), TypeError, "did you mean 'methods'"),
    (lambda: vi.compile("struct S { coord x; L = dot(x)^2; }", methods="gaus 4"), vi.CompileError, "mean 'gauss'"),
    (lambda: vi.fit(vi.Kepler(), {}, "mu", x0=[0.4, 0.0]), TypeError, "fit has no argument 'x0': write q=…"),
    (lambda: vi.Kepler().ensemble(**START, until=1.0).enegry, AttributeError, "did you mean 'energy'"),
    (lambda: vi.Pendulum().integrate(theta=1.0, h=0.1), TypeError, r"θ is a coordinate, write q=\[…\] in the order θ"),
    (lambda: vi.Pendulum(θ=1.0), TypeError, r"θ is a coordinate, not a parameter: a run sets it, integrate\(q=…\)"),
    (lambda: begun(method="RK45"), ValueError, "no method 'RK45': leave method out for Gauss steps; Kepler has"),
    (lambda: pendulum().steps(n=10), TypeError, "steps has no argument 'n': write count=…"),
    (lambda: pendulum().until(t_end=1.0), TypeError, "until has no argument 't_end': write t=…"),
    (lambda: vi.Event("θ", terminal=True), TypeError, r"run.next_event\(event, until\) stops the run there"),
    (lambda: pendulum().tangent(3, ["θ"]), TypeError, 'θ is no parameter: .* are in the result, as "q"'),
    (lambda: pendulum().gradient(3, q=[1.0], wrt=["h"]), TypeError, r'run.tangent\(n, \["h"\]\) has it'),
    (lambda: pendulum().events("θ < 0.1", 1.0), ValueError, r'is a condition: .* such as vi.Event\("θ", 0.1\)'),
    (lambda: pendulum().events("sin(thet)", 1.0), ValueError, "the names are θ, m, l, g, those of the `let`s"),
    (lambda: pendulum().events(vi.Event("θ"), vi.Event("θ", 1.0)), TypeError, "several events as a list"),
    (lambda: pendulum().events(vi.Event(0), 1.0), TypeError, 'name of a coordinate of Pendulum, such as "θ", not 0'),
    (lambda: pendulum().events("p_x", 1.0), KeyError, "no coordinate 'p_x'"),
    (lambda: pendulum().events("θ", 1.0).jacobian("l"), ValueError, r"run.tangent\(until=t, event=…\) has those at an"),
    (lambda: list(pendulum().steps(1)), TypeError, r"rows are in the arrays .t, .q and .v: write t, q = sol.t, sol.q"),
    (lambda: vi.Pendulum().equilibrium([0.1]).eigenvalues, AttributeError, "'eigenvalues': it is called rates"),
    (lambda: vi.Pendulum().explain("gauss"), TypeError, "stages must be an integer, not 'gauss'"),
    (lambda: fitted(p0=[1.0]), TypeError, "'p0': the values of the system, q and v are the first guess"),
    (lambda: fitted(unknowns="l, θ"), ValueError, "give several as a list"),
    (lambda: fitted({"time": DATA["t"], "θ": DATA["θ"]}), ValueError, "no column \"t\", the times: rename 'time'"),
    (lambda: fitted({**DATA, "energy": DATA["θ"]}), KeyError, "no coordinate 'energy'.*leave out the column"),
    (lambda: fitted({**DATA, "theta (rad)": DATA["θ"]}), ValueError, r"the column 'theta \(rad\)' .* leave it out"),
    (lambda: fitted({**DATA, "[θ, l]": DATA["θ"]}), ValueError, r"has the shape \(2,\) in Pendulum: measure one entry"),
    (lambda: vi.Pendulum().ensemble([1.0], h=0.1, until=1.0, l=[1.0]), TypeError, r'write parameters=\{"l": …\} with'),
    (lambda: vi.Pendulum().ensemble([1.0], h=0.1, until=1.0, n_jobs=2), TypeError, "'n_jobs': write threads=…"),
    (lambda: vi.Pendulum().ensemble([1.0], h=0.1, at=[1.0]), TypeError, "'at': write times=…"),
    (lambda: vi.Pendulum().integrate([1.0], [0.0], 0.1), TypeError, "q and v by position: write p=….* h=…"),
    (lambda: pendulum().set("g", 9.81), TypeError, "set takes no arguments by position: write them by name, such as m=…"),
    (lambda: vi.Pendulum().copy(1), TypeError, "copy takes no arguments by position"),
    (lambda: pendulum().events("θ", 9.0).of("θ"), TypeError, "the index of an event must be an integer, not 'θ'"),
    (lambda: pendulum().events(("θ", 0.3), 9.0), TypeError, r"a value belongs to its event, as in vi.Event\(name, 0.3\)"),
    (lambda: rod_start(vi.RodPendulum().project([0.6, -0.8])), TypeError, "not Projected: write its .q, and its .v for v"),
    (lambda: list(pendulum()), TypeError, "not iterable"),
    # Shapes.
    (lambda: begun(q={"x": 0.4, "y": 0.0}), TypeError, "q must be a list in the order x, y, not a dict"),
    (lambda: pendulum().until([0.5, 1.0]), TypeError, r"one time, not \[0.5, 1.0\]: at\(times\) returns the states"),
    (lambda: vi.Pendulum().ensemble([1.0, 2.0], h=0.1, until=1.0), ValueError, r"q\[:, None\] has it"),
    (lambda: pendulum().steps(3).jacobian("l", of=["[θ, l]"]), ValueError, "ask for it alone, or for its entries"),
    (lambda: begun(q=[0.4]), ValueError, r"q must have 2 entries \(x, y\)"),
    (lambda: begun(q=[[0.4, 0.0]]), ValueError, "q must have 2 entries"),
    (lambda: begun(v=[]), ValueError, "v must have 2 entries"),
    (lambda: begun(v=None, p=[1.0]), ValueError, "p must have 2 entries"),
    (lambda: begun(p=[0.0, 2.0]), TypeError, "one of v and p"),
    (lambda: vi.Kepler().energy(0.0, [1.0], [1.0, 2.0]), ValueError, "last axis of q"),
    (lambda: vi.Kepler().energy(0.0, 1.0, [1.0, 2.0]), ValueError, "last axis of q"),
    (lambda: vi.Kepler().energy(0.0, np.ones((2, 2)), np.ones((3, 2))), ValueError, "do not broadcast"),
    (lambda: vi.Kepler().rhs(0.0, [1.0]), ValueError, "y must have 4 entries"),
    (lambda: begun().at([[1.0]]), ValueError, "list of times"),
    (lambda: begun().gradient(3, q=[1.0]), ValueError, "q must have 2 entries"),
    (lambda: begun().set_state(q=[1.0]), ValueError, "q must have 2 entries"),
    # Types.
    (lambda: begun(q="ab"), TypeError, "q must be real numbers"),
    (lambda: begun(q=[1.0, 1j]), TypeError, "q must be real numbers"),
    (lambda: begun(q=[[1.0], [1.0, 2.0]]), TypeError, "q must be real numbers"),
    (lambda: begun(q=[None, 1.0]), TypeError, "q must be real numbers"),
    (lambda: begun(h="0.1"), TypeError, "h must be a real number"),
    (lambda: begun(t=[0.0, 1.0]), TypeError, "t must be a real number"),
    (lambda: begun(stages=8.0), TypeError, "stages must be an integer"),
    (lambda: begun(stages=True), TypeError, "stages must be an integer"),
    (lambda: begun().steps(1.5), TypeError, "must be an integer"),
    (lambda: begun().step("x"), TypeError, "h must be a real number"),
    (lambda: begun().until("x"), TypeError, "t must be a real number"),
    (lambda: begun().until(1.0, callback=3), TypeError, "callback must be a function"),
    (lambda: begun().until(1.0, callback=lambda: None), TypeError, r"one argument, the run, not of \(\)"),
    (lambda: begun().until(1.0, callback=lambda t, y: None), TypeError, r"one argument, the run, not of \(t, y\)"),
    (lambda: begun().events("x", 1.0, callback=3), TypeError, "callback must be a function"),
    (lambda: begun().at([1.0], every=0, callback=print), ValueError, "every must be an integer from 1"),
    (lambda: begun().next_event(7, 1.0, callback=print), TypeError, "events must be"),
    (lambda: begun().events(7, 1.0), TypeError, "events must be"),
    (lambda: begun().events([7], 1.0), TypeError, "an event must be"),
    (lambda: begun().events([], 1.0), ValueError, "at least one event"),
    (lambda: begun().events(vi.Event("x", "0"), 1.0), TypeError, "at must be a real number"),
    (lambda: begun().events(vi.Event("x", direction="up"), 1.0), TypeError, "direction must be"),
    (lambda: begun().events(vi.Period(0.0), 1.0), ValueError, "period must be positive"),
    # Numbers.
    (lambda: vi.Pendulum(l=np.nan), vi.InvalidInput, "l must be finite"),
    (lambda: begun(q=[np.nan, 0.0]), vi.InvalidInput, r"q\[0\] must be finite"),
    (lambda: begun(v=[0.0, np.inf]), vi.InvalidInput, r"v\[1\] must be finite"),
    (lambda: begun(t=np.nan), vi.InvalidInput, "t must be finite"),
    (lambda: begun(h=0.0), vi.InvalidInput, "h must be finite, not zero"),
    (lambda: begun(h=np.nan), vi.InvalidInput, "h must be finite, not zero"),
    (lambda: begun(h=1e-320), vi.InvalidInput, "must be"),
    (lambda: begun(h=None, tolerance=-1.0), vi.InvalidInput, "tolerance must be between an ulp and 1"),
    (lambda: begun(h=None), TypeError, "one of h, tolerance and dtau"),
    (lambda: begun(tolerance=1e-9), TypeError, "one of h, tolerance and dtau"),
    (lambda: vi.Pendulum().integrate([1.0], dtau=0.1), ValueError, "Pendulum has no time scale: give h in place of dtau"),
    (lambda: vi.Kepler().integrate([1.0, 0.0], dtau=0.1, method="adaptive"), ValueError, 'dtau is an option of method="gauss"'),
    (lambda: vi.Pendulum().integrate([1.0], h=0.1, tolerance=1e-6), TypeError, "h and tolerance were given"),
    (lambda: begun(stages=5), ValueError, "stages may be 4 or 8"),
    (lambda: begun(stages=0), ValueError, "at least 1"),
    (lambda: begun(stages=10**30), ValueError, "no integrator"),
    (lambda: begun(method="fixed", stages=4), ValueError, "stages is an option of"),
    (lambda: begun(shift=1.0), ValueError, 'method="energy"'),
    (lambda: begun(method="energy", shift_from=-1.0), vi.InvalidInput, "shift_from must be ahead"),
    (lambda: begun(method="energy", shift_from=1e9), vi.InvalidInput, "at most 1e\\+06 steps"),
    (lambda: begun().until(-1.0), vi.InvalidInput, r"ahead of the run, which is at t = 0 with h = 0.05 \(a negative h"),
    (lambda: begun(h=-0.05).until(1.0), vi.InvalidInput, "ahead of the run, which is at t = 0 with h = -0"),
    (lambda: begun().until(np.inf), vi.InvalidInput, "t must be finite"),
    (lambda: begun().at([2.0, 1.0]), ValueError, "ascending"),
    (lambda: begun().at([-1.0]), vi.InvalidInput, "must be"),
    (lambda: begun().at([np.nan]), vi.InvalidInput, "finite"),
    (lambda: begun().events("x", np.nan), vi.InvalidInput, "until must be finite"),
    (lambda: begun().events("x", -1.0), vi.InvalidInput, "ahead"),
    (lambda: begun().step(0.0), vi.InvalidInput, "must be"),
    (lambda: begun().step(np.nan), vi.InvalidInput, "must be"),
    (lambda: begun().until(1.0, every=0), ValueError, "every must be an integer from 1"),
    (lambda: begun().steps(-1), ValueError, "from 0"),
    (lambda: begun().steps(2**64), ValueError, "from 0"),
    (lambda: begun().set_state(q=[np.nan, 0.0]), vi.InvalidInput, "finite"),
    (lambda: begun().gradient(3), TypeError, "give q or p"),
    (lambda: begun().until(1.0)(0.5), ValueError, "dense=True"),
    (lambda: begun().until(1.0, dense=True)(1.5), ValueError, "outside of the solution"),
    (lambda: begun().until(1.0, dense=True)(np.nan), vi.InvalidInput, "finite"),
    (lambda: begun().until(1.0, dense=True, callback=print), ValueError, "do not go together"),
    # Counts that do not fit into memory.
    (lambda: begun().steps(10**18), MemoryError, "every=k"),
    (lambda: begun().until(1e300), MemoryError, "every=k"),
    (lambda: begun(h=1e-12).step(0.1).until(9.0), MemoryError, "every=k"),
    (lambda: begun().steps(10**13, dense=True, every=10**13), MemoryError, "do not fit"),
    # Words of other tools.
    (lambda: begun(dt=0.1), TypeError, "integrate has no argument 'dt': write h=…"),
    (lambda: begun(t_span=(0.0, 1.0)), TypeError, r"'t_span': call until\(…\) of the run"),
    (lambda: begun(rtol=1e-9), TypeError, "'rtol': write tolerance=…"),
    (lambda: begun(qpos=[1.0, 0.0]), TypeError, "'qpos': write q=…"),
    (lambda: begun(y0=[1.0, 0.0]), TypeError, "'y0': write q=… and v=…"),
    (lambda: begun(t_eval=[1.0]), TypeError, r"'t_eval': call at\(…\) of the run"),
    (lambda: begun(events="x"), TypeError, r"'events': call events\(…\) or next_event\(…\) of the run"),
    (lambda: begun(dense_output=True), TypeError, r"call until\(…, dense=True\) of the run"),
    (lambda: begun(mu=2.0), TypeError, r"'mu': it is a parameter, write Kepler\(mu=…\)\.integrate"),
    (lambda: begun(args=(1.0,)), TypeError, "the parameters belong to the system"),
    (lambda: begun(metod="gauss"), TypeError, r"'metod' \(did you mean 'method'\?\); it has q, v, p, t, h"),
    (lambda: begun().until(1.0, dense_output=True), TypeError, "until has no argument 'dense_output': write dense=…"),
    (lambda: begun().lyapunov(until=1.0), TypeError, r"'until': it takes a number of steps.*round\(time / run\.h\)"),
    (lambda: begun().gradient(3, q=[1.0, 0.0], until=1.0), TypeError, "give one of steps and until"),
    (lambda: begun().gradient(3, q=[1.0, 0.0], t=1.0), TypeError, "the time of an event: give event"),
    (lambda: begun().steps(until=1.0), TypeError, r"'until': call until\(…\) in its place"),
    (lambda: begun().until(steps=3), TypeError, r"'steps': call steps\(…\) in its place"),
    (lambda: begun().events("x", t_end=1.0), TypeError, "'t_end': write until=…"),
    (lambda: vi.Kepler().ensemble([0.4, 0.0], h=0.1, t_span=1.0), TypeError, "ensemble has no .* write until=…"),
    (lambda: vi.Kepler().ensemble([0.4, 0.0], h=0.1, until=1.0, events="x"), TypeError, "write next_event=…"),
    (lambda: vi.Kepler().ensemble([0.4, 0.0], h=0.1, times=[1.0], next_event="x"), TypeError, "give until with next_ev"),
    (lambda: vi.Kepler().ensemble([0.4, 0.0], h=0.1, until=1.0, next_event=7), TypeError, "events must be an Event"),
    (lambda: vi.Kepler().energy(0.0, [1.0, 0.0], qvel=[0.0, 1.0]), TypeError, "'qvel': write v=…"),
    (lambda: vi.Kepler.integrate([0.4, 0.0], [0.0, 2.0], h=0.1), TypeError, r"write the parentheses.*\.integrate\(…\)"),
    (lambda: vi.Kepler.integrate(q=[0.4, 0.0], h=0.1), TypeError, "needs a system, not its class"),
    (lambda: vi.Kepler.energy(0.0, [1.0, 0.0], [0.0, 1.0]), TypeError, "energy needs a system, not its class"),
    (lambda: vi.Kepler.set(mu=2.0), TypeError, r"needs a system, not its class.*vi\.Pendulum\(\)\.set\(…\)"),
    (lambda: vi.Kepler.copy(), TypeError, "copy needs a system, not its class"),
    (lambda: vi.Kepler.explain(), TypeError, "explain needs a system, not its class"),
    (lambda: setattr(vi.Kepler, "mu", 2.0), AttributeError, r"write Kepler\(mu=…\)"),
    (lambda: setattr(vi.Kepler, "k", 2.0), AttributeError, r"no attribute 'k'; its parameters are mu.*Kepler\(…\)"),
    (lambda: setattr(type("Mine", (vi.Kepler,), {}), "mu", 2.0), AttributeError, r"write Mine\(mu=…\)"),
    # Ensembles.
    (lambda: vi.Kepler().ensemble([0.4, 0.0], h=0.1), TypeError, "one of until and times"),
    (lambda: vi.Kepler().ensemble([0.4], h=0.1, until=1.0), ValueError, r"q must have the shape \(M, 2\)"),
    (lambda: vi.Kepler().ensemble(np.ones((2, 2)), np.ones((3, 2)), h=0.1, until=1.0), ValueError, "same number"),
    (lambda: vi.Kepler().ensemble([np.nan, 0.0], h=0.1, until=1.0), vi.InvalidInput, "finite"),
    (lambda: vi.Kepler().ensemble([0.4, 0.0], h=0.1, until=1.0, parameters={"a": 1}), TypeError, "no parameter"),
    (lambda: vi.Kepler().ensemble([0.4, 0.0], h=0.1, until=1.0, threads=0), ValueError, "threads"),
    (lambda: vi.Kepler().ensemble([0.4, 0.0], h=0.1, until=1.0, stages=5), ValueError, "stages may be 4 or 8"),
    # Definitions.
    (lambda: vi.compile(3), TypeError, "must be a text"),
    (lambda: vi.compile("struct A { coord x; L = dot(x)^2; }", methods="rk4"), vi.CompileError, "no method 'rk4'"),
    (lambda: vi.compile("struct A { coord x; L = dot(x)^2; }", methods="fixed"), vi.CompileError, "discretize"),
    (lambda: vi.compile("struct A { coord x; L = dot(x)^2; }", methods="gauss 99"), vi.CompileError, "1 to 16"),
    (lambda: vi.compile("struct A { coord x; L = dot(x)^2; }", methods=" "), vi.CompileError, "no method"),
    (lambda: vi.compile(""), vi.CompileError, "error"),
    (lambda: vi.compile("struct {"), vi.CompileError, "error"),
    (lambda: vi.compile('struct A { coord x; L = "'), vi.CompileError, "error"),
]


@pytest.mark.parametrize("index", range(len(TABLE)))
def test_bad_input(index, monkeypatch, tmp_path):
    monkeypatch.setenv("VARIATIONAL_CACHE", str(tmp_path))
    call, exception, words = TABLE[index]
    with pytest.raises(exception, match=words):
        call()


def test_a_wrong_change_changes_nothing():
    p = vi.Pendulum()
    before = repr(p)
    with pytest.raises(vi.InvalidInput):
        p.set(m=3.0, l=np.inf)
    assert repr(p) == before


def test_integers_and_booleans_are_numbers():
    run = vi.Kepler().integrate(np.array([1, 0]), [0, 1], h=np.float32(0.25), t=0)
    assert run.q.tolist() == [1.0, 0.0]
    assert run.h == 0.25


def test_a_single_coordinate_may_be_a_number():
    assert vi.Pendulum().integrate(1.0, h=0.1).q.tolist() == [1.0]


def test_arguments_are_not_kept():
    q = np.array([0.4, 0.0])
    run = vi.Kepler().integrate(q, [0.0, 2.0], h=0.1)
    q[0] = 7.0
    assert run.q[0] == 0.4
