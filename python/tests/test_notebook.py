"""A notebook shows formulas and figures, and declares systems."""

import math
import re
from pathlib import Path

import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")
pytest.importorskip("matplotlib")

CELLS = [
    "%matplotlib inline\nimport variational as vi\npendulum = vi.Pendulum(l=0.5)\npendulum",
    "pendulum.explain()",
    "pendulum.integrate(q=[1.0], h=0.05).until(10.0).plot();",
]


NOTEBOOKS = sorted((Path(__file__).parents[2] / "docs/python").glob("*.ipynb"))


def execute(book, folder):
    """Runs a notebook in a folder: in that of the sources `variational` would be found without its library."""
    resources = {"metadata": {"path": str(folder)}}
    nbclient.NotebookClient(book, timeout=240, kernel_name="python3", resources=resources).execute()


def executed(cells, folder):
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    execute(book, folder)
    return [[output.get("data", output) for output in cell.outputs] for cell in book.cells]


def test_formulas_and_figures(tmp_path):
    system, explanation, figure = executed(CELLS, tmp_path)
    assert any(data.get("text/latex", "").startswith("$$") for data in system)
    assert any("text/markdown" in data for data in explanation)
    assert any("image/png" in data for data in figure)


def test_a_long_run_writes_no_warning(tmp_path):
    pytest.importorskip("tqdm")
    cell = "import variational as vi\nfrom variational import _progress\n_progress._PATIENCE = 0.0\n"
    cell += "vi.Kepler().integrate([0.4, 0.0], [0.0, 2.0], h=0.01).until(300.0, every=1000);"
    (outputs,) = executed([cell], tmp_path)
    assert not [output for output in outputs if output.get("name") == "stderr"], outputs


def test_a_cell_declares_a_system(warm_cache, tmp_path):
    spring = "struct Spring {\n    param k = 4.0;\n    coord x;\n    L = dot(x)^2/2 - k*x^2/2;\n}"
    *_, result, mistake = executed(
        [
            "%load_ext variational",
            f"%%lagrangian gauss 8\n{spring}",
            "float(Spring(k=9.0).integrate(q=[1.0], h=0.1).until(1.0).q[-1, 0])",
            f"%%lagrangian\n{spring.replace('k*x', 'kk*x')}",
        ],
        tmp_path,
    )
    value = float(re.search(r"-?\d\.\d+", result[0]["text/plain"])[0])
    # Measured: 4e-16.
    assert value == pytest.approx(math.cos(3.0), abs=1e-13)
    assert "definition:" in str(mistake)


@pytest.mark.long
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_notebooks_of_the_documentation(path, tmp_path):
    pytest.importorskip("scipy")
    pytest.importorskip("pandas")
    book = nbformat.read(path, as_version=4)
    nbformat.validate(book)
    code = [cell for cell in book.cells if cell.cell_type == "code"]
    # Code hosts show the stored outputs, without the animation, which is large.
    stored = kinds(code)
    execute(book, tmp_path)
    found = kinds(code)
    assert found == [*stored, ["text/html", "text/plain"]], "store the outputs again"
    assert sum("image/png" in kind for kind in found) == 5
    assert not [output for cell in code for output in cell.outputs if output.get("name") == "stderr"]


def kinds(cells):
    """The kinds of the outputs of cells."""
    return [sorted(output.get("data", [output.get("name")])) for cell in cells for output in cell.outputs]
