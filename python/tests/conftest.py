"""Shared parts of the tests."""

import os
import shutil

import pytest

import variational as vi


@pytest.fixture
def kepler():
    """A run on the orbit of eccentricity 0.6."""
    return vi.Kepler().integrate(q=[0.4, 0.0], v=[0.0, 2.0], h=0.05)


@pytest.fixture(scope="session")
def warm_cache(tmp_path_factory):
    """A cache of compiled systems; `VARIATIONAL_CACHE` keeps it between sessions."""
    if shutil.which("cargo") is None:
        pytest.skip("compiled systems need cargo")
    if "VARIATIONAL_CACHE" not in os.environ:
        os.environ["VARIATIONAL_CACHE"] = str(tmp_path_factory.mktemp("cache"))
    vi.warm(verbose=False)
    return os.environ["VARIATIONAL_CACHE"]
