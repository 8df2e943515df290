"""The Python blocks of the documentation run as they stand."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = ["docs/python.md", "docs/from_scipy.md", "python/README.md", "README.md"]
PAGES += sorted(str(page.relative_to(ROOT)) for page in (ROOT / "docs/python").glob("*.md"))
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)
OPTIONAL = ["casadi", "fmpy", "jax", "matplotlib", "pandas", "scipy", "torch"]
USES = {"matplotlib": (".plot(", ".animate("), "scipy": ("vi.fit(",), "casadi": ("vi.optimise(",)}


def blocks():
    for page in PAGES:
        text = (ROOT / page).read_text(encoding="utf-8")
        for block in BLOCK.finditer(text):
            yield pytest.param(block[1], id=f"{page}:{text.count(chr(10), 0, block.start()) + 2}")


@pytest.mark.parametrize("code", list(blocks()))
def test_block(code, request, tmp_path):
    for name in OPTIONAL:
        if any(word in code for word in (name, *USES.get(name, ()))):
            pytest.importorskip(name)
    if "vi.compile" in code or ".fmu(" in code:
        request.getfixturevalue("warm_cache")
    environment = {**os.environ, "MPLBACKEND": "Agg", "PYTHONUTF8": "1"}
    outcome = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, encoding="utf-8"
    )
    assert outcome.returncode == 0, outcome.stderr


def test_there_are_blocks():
    # A changed fence must not make the test above empty.
    assert len(list(blocks())) >= 12
