"""`python -m variational`: the cache of compiled systems, and type stubs."""

from __future__ import annotations

import argparse
import importlib
import sys

from . import CompileError, stubs, warm
from ._compile import cache, clean


def main() -> int:
    """Runs a command; returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m variational", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("warm", help="build what all compiled systems share (about a minute, needs cargo)")
    commands.add_parser("clean", help="delete the compiled systems in the cache, and nothing else there")
    commands.add_parser("cache", help="print the folder of the cache")
    of_module = commands.add_parser("stubs", help="print the type stubs of a module of systems")
    of_module.add_argument("module", nargs="?", default="variational")
    arguments = parser.parse_args()
    if arguments.command == "warm":
        try:
            warm()
        except CompileError as error:
            print(f"error: {error}", file=sys.stderr)
            return 1
    elif arguments.command == "clean":
        return _clean()
    elif arguments.command == "cache":
        print(cache())
    else:
        print(stubs(importlib.import_module(arguments.module)), end="")
    return 0


def _clean() -> int:
    try:
        deleted, left = clean()
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    if left:
        names = ", ".join(path.name for path in left[:10]) + (", …" if len(left) > 10 else "")
        what = "left" if deleted else "error: there are no compiled systems to delete"
        message = f"{what} in {cache()}: variational did not make {names}; delete by hand what you do not need"
        print(message, file=sys.stderr)
    return 1 if left and not deleted else 0


if __name__ == "__main__":
    sys.exit(main())
