"""Systems: parameters, functions, mathematics."""

import copy
import importlib.metadata
import inspect
import pickle

import numpy as np
import pytest

import variational as vi


def test_there_are_thirtyone_systems():
    assert len(vi.systems) == 31
    assert all(isinstance(getattr(vi, name)(), vi.System) for name in vi.systems)


def test_parameters():
    p = vi.Pendulum(l=0.5)
    assert (p.l, p.m) == (0.5, 1.0)
    p.l = 2.0
    assert p.set(m=3.0) is p
    assert repr(p) == f"Pendulum(m=3, l=2, g={p.g:g})"
    assert list(inspect.signature(vi.Pendulum).parameters) == list(p.parameters)
    assert "Parameters\n----------\nm : float, default 1.0" in vi.Pendulum.__doc__


def test_functions():
    p = vi.Pendulum(l=2.0)
    q, v = [0.3], [2.0]
    energy = p.momentum(0.0, q, v)[0] * v[0] - p.lagrangian(0.0, q, v)
    assert p.energy(0.0, q, v) == pytest.approx(energy, rel=1e-15)
    assert p.velocity(0.0, q, p.momentum(0.0, q, v)) == pytest.approx(v, rel=1e-15)
    assert p.acceleration(0.0, q, v) == pytest.approx(-p.g / 2.0 * np.sin(0.3), rel=1e-15)
    assert p.force(0.0, q, v) == 0.0


def test_functions_broadcast():
    p = vi.Kepler()
    q = np.random.default_rng(1).normal(size=(5, 3, 2))
    assert p.energy(0.0, q, [0.1, 0.2]).shape == (5, 3)
    assert p.momentum(np.zeros((3,)), q, np.ones((3, 2))).shape == (5, 3, 2)
    assert p.energy(0.0, q, [0.1, 0.2])[4, 1] == p.energy(0.0, q[4, 1], [0.1, 0.2])
    assert p.energy(np.zeros((0,)), np.zeros((0, 2)), np.zeros((0, 2))).shape == (0,)
    # Views without contiguous entries.
    assert p.energy(0.0, q[:, 0, ::-1], [0.1, 0.2]).shape == (5,)
    assert isinstance(p.energy(0.0, q[0, 0], [0.1, 0.2]), float)


def test_equality_copies_and_pickles():
    p = vi.Pendulum(l=0.5)
    for other in (copy.copy(p), copy.deepcopy(p), p.copy(), pickle.loads(pickle.dumps(p))):
        assert other == p
        other.l = 2.0
        assert other != p
    assert p != vi.Kepler()
    with pytest.raises(TypeError):
        hash(p)


def test_names_are_identifiers():
    names = [name for system in vi.systems for name in getattr(vi, system).parameters]
    assert all(name.isidentifier() for name in names)
    # A word of Python.
    assert "lambda" not in names
    assert "lambda_" in names


def test_mathematics():
    p = vi.Pendulum()
    assert p._repr_latex_().startswith("$$")
    assert r"\dot{" in p._repr_latex_()
    explanation = p.explain()
    assert explanation.title == "Pendulum"
    assert "L = " in repr(explanation)
    assert "$$" in explanation._repr_markdown_()
    assert p.explain(stages=2).text != explanation.text


def test_versions_agree():
    assert importlib.metadata.version("variational") == vi.__version__


def test_greek_letters_may_be_written_out():
    pendulum = vi.DoublePendulum()
    sol = pendulum.integrate([0.5, 0.2], h=0.05).until(1.0)
    assert np.array_equal(sol["theta1"], sol["θ1"]) and np.array_equal(sol["dot(theta2)"], sol["dot(θ2)"])
    with pytest.raises(KeyError, match="has no coordinate 'theta3'"):
        sol["theta3"]


def test_latex_leaves_the_step_density_to_the_explanation():
    latex = vi.DoublePendulum()._repr_latex_()
    assert "E &=" in latex and "D &=" not in latex and "D = " in vi.DoublePendulum().explain().text


@pytest.mark.parametrize("name", ["Kepler", "DampedOscillator", "FourBar"])
def test_latex_of_all_formulas(name):
    mathtext = pytest.importorskip("matplotlib.mathtext")
    explanation = getattr(vi, name)().explain()
    latex = explanation.latex()
    formulas = [(left, right) for _, lines in explanation.sections for left, right in lines if left]
    assert latex.count(" &= ") == len(formulas) > 5
    assert latex.count(r"\begin{align*}") == latex.count(r"\end{align*}") == latex.count(r"\subsection*{")
    # The signs of titles are escaped: one of constraints has `A^T`.
    assert ("A\\^{}T" in latex) == (name == "FourBar")
    # Another reader of LaTeX knows every formula.
    parser = mathtext.MathTextParser("path")
    for left, right in formulas:
        parser.parse(f"${left} = {right}$")


def test_a_derived_class_has_attributes_of_its_own():
    class Planet(vi.Kepler):
        pass

    Planet.name = "Mars"
    assert Planet().name == "Mars" and not hasattr(vi.Kepler, "name")
    assert Planet(mu=2.0).set(mu=3.0).copy().mu == 3.0
