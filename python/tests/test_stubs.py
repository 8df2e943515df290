"""The type stubs are current."""

import ast
from pathlib import Path

import variational as vi


def test_stubs_are_current():
    """`python -m variational stubs > variational/__init__.pyi` writes them."""
    path = Path(vi.__file__).with_name("__init__.pyi")
    assert path.read_text(encoding="utf-8") == vi.stubs()


def test_stubs_are_python():
    tree = ast.parse(vi.stubs())
    classes = {node.name for node in tree.body if isinstance(node, ast.ClassDef)}
    assert set(vi.systems) < classes
    public = {name for name in vi.__all__ if name[0].isupper()}
    imported = {alias.asname for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names}
    assert public <= classes | imported


def test_the_package_is_typed():
    assert Path(vi.__file__).with_name("py.typed").exists()
