"""The notebook cell `%%lagrangian`."""

from __future__ import annotations

import sys
from typing import Any


def load_ipython_extension(shell: Any) -> None:
    """`%load_ext variational` adds the cell `%%lagrangian`: a definition, whose class then has its name.

    The methods to build may follow on the first line: `%%lagrangian fixed; gauss 4, 8`.
    """

    def lagrangian(line: str, cell: str) -> None:
        from ._compile import CompileError, compile

        try:
            cls = compile(cell, methods=line.strip() or None)
        except CompileError as error:
            # A traceback would hide the line of the mistake.
            print(f"CompileError: {error}", file=sys.stderr)
            return
        shell.user_ns[cls.__name__] = cls

    shell.register_magic_function(lagrangian, "cell")
