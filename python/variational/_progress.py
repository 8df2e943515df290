"""Progress of calls that take longer than two seconds, by tqdm if it is installed."""

from __future__ import annotations

import contextlib
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from typing import Any

_PATIENCE = 2.0
"""Seconds without a bar."""

Report = Callable[[float], None]
"""Takes the part of a call that is done, 0 to 1."""


class _Bar:
    """A bar that appears after some time, in a terminal or a notebook."""

    def __init__(self, title: str, total: float | None):
        self.title, self.total, self.begun = title, total, time.monotonic()
        self.bar: Any = None
        self.is_due = True

    def __call__(self, done: float) -> None:
        if self.is_due and (passed := time.monotonic() - self.begun) > _PATIENCE:
            self.is_due = False
            self._appear(passed)
        if self.bar is not None:
            self.bar.update(done - self.bar.n)

    def _appear(self, passed: float) -> None:
        # In a notebook without ipywidgets tqdm warns, and shows no bar.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                from tqdm.auto import tqdm
            except ImportError:
                return
        shown = "{n_fmt} [{elapsed}]" if self.total is None else "{percentage:3.0f}% |{bar}| {elapsed}<{remaining}"
        layout = {"bar_format": "{desc}: " + shown, "leave": False, "miniters": 0}
        # Nothing is written to a file.
        bar = tqdm(desc=self.title, total=self.total, disable=None, **layout)
        if not bar.disable:
            bar.start_t -= passed
            self.bar = bar

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()


@contextlib.contextmanager
def progress(title: str, total: float | None = 1.0) -> Iterator[Report | None]:
    """A function that shows which part of a call is done; None in other threads, which would show many bars. Without a
    total it shows a count."""
    if threading.current_thread() is not threading.main_thread():
        yield None
        return
    bar = _Bar(title, total)
    try:
        yield bar
    finally:
        bar.close()
