"""Systems from text.

`compile` writes a crate into the user's cache, builds it with cargo, and loads it. The library is kept by a hash of
everything that it depends on; later it is loaded without cargo.

    <cache>/<version>/workspace   sources of the library, and the crates of a system and of a unit
                      target      what cargo built
                      modules     the libraries of systems
                      lock        held during a build
                      MARK        that `clean` may delete the folder
"""

from __future__ import annotations

import contextlib
import copyreg
import hashlib
import importlib.util
import os
import re
import shutil
import signal
import stat
import subprocess
import sys
import sysconfig
import threading
import time
from collections.abc import Iterator
from importlib.machinery import ExtensionFileLoader
from pathlib import Path
from typing import Any

from . import _core
from ._binding import CONTRACT, _bind
from ._calls import checked_call
from ._lock import locked
from ._names import meant
from ._system import System, SystemType

_SUFFIX = ".pyd" if os.name == "nt" else ".abi3.so"
LIBRARY = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
"""The end of the name of a library that cargo builds."""

_MANIFEST = """\
[package]
name = "{crate}"
version.workspace = true
edition.workspace = true
publish = false

[lib]
crate-type = ["cdylib"]

[dependencies]
vi-core.workspace = true
{beside} = {{ path = "../python/{beside}" }}
"""

_CRATES = {"compiled": "vi-python", "unit": "vi-fmi"}
"""The crates of a system, as a module of Python and as a unit of FMI, and the crate that each depends on."""

# The linker of macOS must leave the symbols of Python to the process.
_CARGO_CONFIG = """\
[target.'cfg(target_os = "macos")']
rustflags = ["-C", "link-arg=-undefined", "-C", "link-arg=dynamic_lookup"]
"""

_BEFORE = "#![allow(warnings)]\nvi_core::lagrangian! {\n"
_AFTER = "\n}\n"
_MODULE = "vi_python::module!(@inner {library}, {name}, {{ {methods} }});\n"

_SPRING = "struct Spring { param k = 1.0; coord x; L = dot(x)^2 / 2 - k * x^2 / 2; discretize midpoint; }"


_MARK = "variational-cache.txt"
_MARKED = "This folder was made by the Python package variational. `python -m variational clean` deletes it.\n"


class CompileError(Exception):
    """A system cannot be compiled: a mistake in its definition with its line, or what is missing on this machine."""

    __module__ = "variational"


def cache() -> Path:
    """The folder of compiled systems: `$VARIATIONAL_CACHE`, or a folder in the user's cache."""
    given = os.environ.get("VARIATIONAL_CACHE")
    if given:
        return Path(given).absolute()
    if os.name == "nt":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "variational"


_loaded: dict[str, type[System]] = {}
_loading = threading.RLock()


class _Compiled(SystemType):
    """The type of compiled classes. A pickle of one holds its text."""


def _pickled(cls: Any) -> Any:
    # A subclass is known by its name.
    return (_unpickled, cls._source) if "_source" in vars(cls) else cls.__qualname__


def _unpickled(definition: str, methods: str, tables: str) -> type[System]:
    """The class of a pickle. Its tables have the values that they had: from the library in the cache, or from files
    that have not changed since.

    Raises ValueError for files that have.
    """
    digest = _digest(definition, methods, tables)
    if digest not in _loaded and not _built(digest).exists() and _located(definition)[1] != tables:
        files = ", ".join(found[2] for found in TABLE.finditer(definition))
        raise ValueError(
            f"the tables of this system had other values when it was pickled: {files} changed or is missing, and the "
            "library of the old system is not in the cache. Restore the file, or make the pickle again"
        )
    return _class(definition, methods, tables, False)


copyreg.pickle(_Compiled, _pickled)


@checked_call
def compile(definition: str, *, methods: str | None = None, verbose: bool = False, wait: bool = True) -> type[System]:
    """The class of the system that a text in the language of `lagrangian!` declares.

    >>> Spring = compile('''
    ... struct Spring {
    ...     param k = 1.0;
    ...     coord x;
    ...     L = dot(x)^2/2 - k*x^2/2;
    ...     discretize midpoint;
    ... }
    ... ''')  # doctest: +SKIP

    `methods` lists the integrators to build: "fixed; compositions; gauss 4, 8; energy; energy 2". The default is
    "fixed; gauss 8", without "fixed" for a system without the clause `discretize`, and with "transformed 8" for one
    with a `time_scale`, and "gauss 3" for one with constraints, which has "gauss" and "energy" with stages.

    It needs cargo, https://rustup.rs. The first build takes about a minute and later ones seconds; a system that was
    compiled before is loaded in milliseconds. With `wait=False` the class of `System` is returned at once, and changes
    to compiled steps when these are built, as `System.native` says.

    Raises CompileError.
    """
    if not isinstance(definition, str):
        raise TypeError(f"the definition must be a text, not {type(definition).__name__}")
    if methods is not None and not isinstance(methods, str):
        raise TypeError(f'methods must be a text such as "fixed; gauss 8", not {type(methods).__name__}')
    if not wait:
        from ._text import of_text

        return of_text(definition).native(methods=methods, verbose=verbose, wait=False)
    definition, tables = _located(definition)
    return _class(definition, _methods(methods, _without_comments(definition)), tables, verbose)


def _class(definition: str, methods: str, tables: str, verbose: bool) -> type[System]:
    """The class of a definition with absolute paths, whose tables have this digest."""
    digest = _digest(definition, methods, tables)
    # A library is loaded once.
    with _loading:
        if digest not in _loaded:
            built = _built(digest)
            if not built.exists():
                name = _checked(definition)
                _suitable(definition, methods)
                last = _MODULE.format(library=_library(digest), name=name, methods=_words(methods))
                _build("compiled", definition, last, name, built, tables, verbose)
            _check_private(built)
            cls = _load(_library(digest), built)
            cls._source = (definition, methods, tables)  # type: ignore[attr-defined]
            cls.definition = definition
            _loaded[digest] = cls
    return _loaded[digest]


def _digest(definition: str, methods: str, tables: str) -> str:
    """A digest of everything that a library depends on."""
    key = "\0".join([definition, tables, methods, str(CONTRACT), _core.sources_digest, sysconfig.get_platform()])
    return hashlib.sha256(key.encode()).hexdigest()[:20]


def _check_private(path: Path) -> None:
    """Checks that no other user can have written a file of the cache, because its code runs in this process.

    Raises CompileError.
    """
    if os.name == "nt":
        return
    remedy = "code in it would run here: delete it, or set VARIATIONAL_CACHE to a folder of your own"
    for of in (path, *path.relative_to(cache()).parents):
        of = cache() / of
        state = of.stat()
        if of == cache():
            # Folders such as /tmp protect the files of each user.
            others = stat.S_IWOTH if not state.st_mode & stat.S_ISVTX else 0
        else:
            others = stat.S_IWGRP | stat.S_IWOTH
            if state.st_uid not in (os.geteuid(), 0):
                raise CompileError(f"{of} belongs to another user, {state.st_uid}, and {remedy}")
        if state.st_mode & others:
            mode = stat.S_IMODE(state.st_mode)
            what = f"can be written by other users (mode {mode:o})"
            raise CompileError(f"{of} {what}, and {remedy}, or take the right away")


def _library(digest: str) -> str:
    """The name of a library."""
    return f"s_{digest}"


def _built(digest: str) -> Path:
    """The file of a library in the cache."""
    return _folder() / "modules" / (_library(digest) + _SUFFIX)


def warm(verbose: bool = True) -> None:
    """Builds what all systems share, so that the next `compile` takes seconds."""
    compile(_SPRING, verbose=verbose)


def clean() -> tuple[list[Path], list[Path]]:
    """Deletes the folders in the cache that this package has made. Returns them, and what else is there and stays. A
    program that uses one of the systems must not run.

    Raises OSError for a folder that cannot be deleted.
    """
    folder = cache()
    deleted, left = [], []
    for entry in sorted(folder.iterdir()) if folder.is_dir() else []:
        if not entry.is_symlink() and (entry / _MARK).is_file():
            # The mark goes last: an interrupted call can be repeated.
            for part in entry.iterdir():
                if part.is_dir() and not part.is_symlink():
                    shutil.rmtree(part)
                elif part.name != _MARK:
                    part.unlink()
            shutil.rmtree(entry)
            deleted.append(entry)
        else:
            left.append(entry)
    if deleted and not left:
        folder.rmdir()
    return deleted, left


def _folder() -> Path:
    return cache() / _core.sources_digest


def _without_comments(definition: str) -> str:
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", definition, flags=re.DOTALL)


_MOST_STAGES = {
    "fixed": 0,
    "compositions": 0,
    "splitting": 0,
    "energy": 3,
    "gauss": 16,
    "adaptive": 16,
    "transformed": 16,
}


def _methods(methods: str | None, code: str) -> str:
    """The integrators to build, in one spelling.

    Raises CompileError for a wrong word, and for a method that the definition does not allow.
    """
    has_rule = re.search(r"\bdiscretize\b", code) is not None
    has_scale = re.search(r"\btime_scale\b", code) is not None
    has_constraints = _CONSTRAINT.search(code) is not None
    if methods is None and has_constraints:
        return "gauss 3"
    if methods is None:
        return "; ".join(["fixed"] * has_rule + ["gauss 8"] + ["transformed 8"] * has_scale)
    found = []
    for part in filter(None, (part.strip() for part in methods.split(";"))):
        word, _, rest = part.partition(" ")
        # The name of "gauss" with constraints in earlier versions, which pickles hold.
        word = "gauss" if word == "gauss-lobatto" else word
        stages = [stage.strip() for stage in rest.split(",")] if rest.strip() else []
        most = _MOST_STAGES.get(word)
        if most is None:
            several = meant(word, _MOST_STAGES)
            if word.startswith("splitting"):
                several = " (splitting has splitting-4 and splitting-6)"
            elif "-" in word:
                several = " (compositions has suzuki-4, kahan-li-6 and kahan-li-8)"
            raise CompileError(
                f"there is no method {word!r}{several}: "
                "write fixed, compositions, splitting, gauss 8, adaptive 8, transformed 8, energy, energy 2"
            )
        if not all(stage.isascii() and stage.isdigit() and 1 <= int(stage) <= most for stage in stages):
            limits = f"stages from 1 to {most}" if most else "no stages"
            raise CompileError(f"{word} has {limits}, not {rest!r}")
        if word in ("gauss", "adaptive", "transformed") and not stages:
            raise CompileError(f'{word} needs its stages, such as "{word} 8"')
        if has_constraints and word not in ("gauss", "adaptive", "energy"):
            raise CompileError(f'the method {word} does not keep constraints: write "gauss 3" or "energy 2"')
        if has_constraints and not stages:
            raise CompileError('energy needs its stages with constraints: write "energy 2"')
        if not stages and word != "splitting" and not has_rule:
            raise CompileError(f"the method {word} needs the clause `discretize midpoint;` in the definition")
        if word == "transformed" and not has_scale:
            raise CompileError("the method transformed needs the clause `time_scale = …;` in the definition")
        found.append(f"{word} {', '.join(str(int(stage)) for stage in stages)}".strip())
    if not found:
        raise CompileError('methods has no method: write for example "fixed; gauss 8"')
    return "; ".join(found)


def _words(methods: str) -> str:
    """The integrators in the words of Rust's macro: its `fixed` has the compositions."""
    words = methods.split("; ")
    if "compositions" in words:
        words = ["fixed", *(word for word in words if word not in ("fixed", "compositions"))]
    else:
        words = ["fixed_2" if word == "fixed" else word for word in words]
    return "; ".join(words)


_CONSTRAINT = re.compile(r"(?:^|[;{}])\s*(?:constraint|rotation)\s+[^\W\d]")
"""A clause that declares a constraint."""


TABLE = re.compile(r'(\btable\b[^;"]*=\s*")([^"]+)(")')


def _located(definition: str) -> tuple[str, str]:
    """The definition with absolute paths of its tables, and a digest of their files: a relative path starts at the
    current folder, and a change of a file is a change of the system."""
    digest = hashlib.sha256()

    def located(found: re.Match[str]) -> str:
        path = Path(found[2]).expanduser().absolute()
        if path.is_file():
            digest.update(path.read_bytes())
        return found[1] + path.as_posix() + found[3]

    return TABLE.sub(located, definition), digest.hexdigest()


def _checked(definition: str) -> str:
    """The name of the system. Mistakes are found here in milliseconds, by the compiler that is part of `_core`."""
    try:
        name, _, _ = _core.explain(definition, alone=True)
    except ValueError as mistake:
        raise CompileError(str(mistake)) from None
    return name


def _suitable(definition: str, methods: str) -> None:
    """Raises CompileError for a method that needs another L or another rule: cargo would say it in terms of Rust."""
    words = methods.split("; ")
    if "splitting" not in words and "energy" not in words:
        return
    is_separable, has_step_density = _core.properties(definition)
    if "splitting" in words and not is_separable:
        raise CompileError(
            "the method splitting does not fit this system: it needs `L = v·M v/2 - V(t, q)` with constant masses M, and "
            'forces of time and coordinates alone; write "gauss 8"'
        )
    if "energy" in words and not has_step_density:
        raise CompileError(
            "the method energy needs the rule midpoint: write `discretize midpoint;` in the definition, or "
            '"energy 2" for the methods'
        )


def unit(definition: str, last: str, verbose: bool) -> Path:
    """The library of the unit that this last line defines for a definition.

    Raises CompileError.
    """
    definition, tables = _located(definition)
    built = _built(_digest(definition, last, tables))
    if not built.exists():
        _build("unit", definition, last, _checked(definition), built, tables, verbose)
    _check_private(built)
    return built


def _build(crate: str, definition: str, last: str, name: str, built: Path, tables: str, verbose: bool) -> None:
    """Builds a crate with this definition and this last line, and keeps its library in the cache."""
    cargo = shutil.which("cargo") or shutil.which("cargo", path=str(Path.home() / ".cargo" / "bin"))
    if cargo is None:
        raise CompileError(
            "cargo was not found: install Rust from https://rustup.rs. Without it, vi.System takes a text without constraints "
            "and tables, and vi.systems has ready systems"
        )
    folder = _folder()
    try:
        # Only this user may write, for any umask.
        folder.mkdir(mode=0o755, parents=True, exist_ok=True)
        (folder / "target").mkdir(mode=0o700, exist_ok=True)
        (folder / _MARK).write_text(_MARKED, encoding="utf-8")
        built.parent.mkdir(mode=0o755, exist_ok=True)
        # What is built here is loaded.
        _check_private(built.parent)
        with locked(folder / "lock"):
            # Another process may have built it meanwhile.
            if not built.exists():
                workspace = _workspace(folder)
                text = _BEFORE + definition + _AFTER + last
                (workspace / crate / "src" / "lib.rs").write_text(text, encoding="utf-8")
                shared = "" if (folder / "target" / "release").exists() else ", and once what all systems share: a minute"
                print(f"variational: cargo builds {name}{shared} …", file=sys.stderr, flush=True)
                began = time.monotonic()
                _cargo(cargo, crate, workspace, folder / "target", verbose)
                print(f"variational: {name} took {time.monotonic() - began:.0f} s", file=sys.stderr, flush=True)
                if _located(definition)[1] != tables:
                    raise CompileError("a file of a table changed during the build: compile again")
                part = built.with_suffix(".part")
                library = ("" if os.name == "nt" else "lib") + crate + LIBRARY
                shutil.copyfile(folder / "target" / "release" / library, part)
                part.chmod(0o644)
                os.replace(part, built)
    except OSError as error:
        raise CompileError(
            f"the cache {folder} cannot be written: {error}; set VARIATIONAL_CACHE to another folder"
        ) from error


def _workspace(folder: Path) -> Path:
    """The sources, written once. A folder that is there is whole, since it was renamed into place."""
    workspace = folder / "workspace"
    if not workspace.exists():
        part = folder / "workspace.part"
        shutil.rmtree(part, ignore_errors=True)
        part.mkdir(mode=0o700)
        files = {**dict(_core.sources()), ".cargo/config.toml": _CARGO_CONFIG}
        for crate, beside in _CRATES.items():
            files[f"{crate}/Cargo.toml"] = _MANIFEST.format(crate=crate, beside=beside)
            files[f"{crate}/src/lib.rs"] = ""
        for name, text in files.items():
            path = part / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="\n")
        os.replace(part, workspace)
    return workspace


def _cargo(cargo: str, crate: str, workspace: Path, target: Path, verbose: bool) -> None:
    """Builds a crate. Its environment is always the same: otherwise all is built again."""
    kept = ("CARGO_HOME", "CARGO_HTTP_", "CARGO_NET_", "CARGO_REGISTRIES_", "CARGO_SOURCE_", "CARGO_REGISTRY_")
    environment = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(("CARGO", "PYO3_", "RUSTFLAGS")) or name.startswith(kept)
    }
    environment |= {"CARGO_TERM_COLOR": "never", "PYO3_NO_PYTHON": "1", "PYO3_BUILD_EXTENSION_MODULE": "1"}
    # With vi-python all crates get the same features of their dependencies, and share what is built of these.
    packages = ["--package", crate, "--package", "vi-python"]
    command = [cargo, "build", "--release", *packages, "--target-dir", str(target)]
    process = None
    try:
        # A Ctrl-C during the start waits: otherwise nobody knows what to end.
        with _uninterrupted():
            process = subprocess.Popen(
                command if verbose else [*command, "--quiet"],
                cwd=workspace,
                env=environment,
                stdin=subprocess.DEVNULL,
                stderr=None if verbose else subprocess.PIPE,
                encoding="utf-8",
                errors="replace",
                # A group of its own: an interrupted build ends with all compilers that cargo has started.
                start_new_session=True,
            )
        with process:
            _, messages = process.communicate()
    except BaseException:
        if process is not None:
            _kill(process)
        raise
    if process.returncode != 0:
        raise CompileError(_reason(messages or "cargo failed; its messages are above"))


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """Delays a Ctrl-C to the end of a block."""
    if threading.current_thread() is not threading.main_thread():
        # Only the main thread is interrupted.
        yield
        return
    came: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, frame: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL if before is None else before)
        if came and before is not signal.SIG_IGN:
            raise KeyboardInterrupt


def _kill(process: subprocess.Popen[str]) -> None:
    """Ends a process and its children."""
    if os.name == "nt":
        process.kill()
    else:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)


def _reason(messages: str) -> str:
    """The messages of cargo, with lines of the definition."""
    if re.search(
        r"failed to download|Could not resolve|failed to fetch|network failure|offline", messages, re.IGNORECASE
    ):
        return (
            "cargo cannot download the crates that it needs: run `python -m variational warm` once with a network\n"
            + messages.strip()
        )
    if re.search(r"linker `?[\w.-]+`? not found|link\.exe` not found", messages):
        return (
            "Rust found no linker: install a C compiler (gcc, clang, or Visual Studio's C++ tools)\n" + messages.strip()
        )
    lines_before = _BEFORE.count("\n")
    messages = re.sub(
        r"(?:compiled|unit)[/\\]src[/\\]lib\.rs:(\d+):",
        lambda found: f"definition:{int(found[1]) - lines_before}:",
        messages,
    )
    ends = ("error: could not compile", "warning: build failed", "For more information about")
    return "\n".join(line for line in messages.splitlines() if not line.startswith(ends)).strip()


def _load(library: str, built: Path) -> type[System]:
    """The class in a library."""
    loader = ExtensionFileLoader(library, str(built))
    spec = importlib.util.spec_from_file_location(library, str(built), loader=loader)
    assert spec is not None
    try:
        module: Any = importlib.util.module_from_spec(spec)
        loader.exec_module(module)
    except ImportError as error:
        built.unlink(missing_ok=True)
        raise CompileError(f"the library of the system cannot be loaded, and was deleted: {error}") from error
    (name,) = _bind(module, None, "variational.compiled", _Compiled)
    return getattr(module, name)
