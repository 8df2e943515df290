"""The compiled part: the ready systems, and the mathematics of a definition."""

from typing import Any

_contract: int
_kinds: list[Any]
METHODS: list[str]
sources_digest: str
texts: list[tuple[str, str]]

def explain(
    definition: str, stages: int | None = None, alone: bool = False
) -> tuple[str, str, list[tuple[str, list[tuple[str, str]]]]]: ...
def of_text(definition: str, files: list[tuple[str, str]], dropped: list[str]) -> Any: ...
class Observable:
    def __init__(
        self,
        definition: str,
        files: list[tuple[str, str]],
        expression: str,
        wrt: list[int] | None = None,
        twice: bool = False,
    ) -> None: ...
    @property
    def shape(self) -> list[int]: ...
    @property
    def zeros(self) -> list[bool]: ...
    def values(
        self,
        points: tuple[list[float], list[list[float]], list[list[float]]],
        parameters: list[list[float]],
    ) -> list[float]: ...
def properties(definition: str) -> tuple[bool, bool]: ...
def sources() -> list[tuple[str, str]]: ...
