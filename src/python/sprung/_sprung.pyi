"""What the package `sprung` is made of."""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

class Error(ValueError):
    """What is wrong, where, and what would be right."""

class Locked(Error):
    """Another process writes the file."""

class NativePatch:
    """A preset's values, modes and routes."""

    name: str
    def __init__(self, name: str) -> None: ...
    @staticmethod
    def from_toml(text: str) -> NativePatch: ...
    def to_toml(self) -> str: ...
    @property
    def comment(self) -> str: ...
    def value(self, id: str) -> float | str: ...
    def text(self, id: str) -> str: ...
    def set(self, id: str, value: str) -> None: ...
    def modes(self) -> list[list[float]]: ...

def presets() -> list[dict[str, Any]]:
    """The factory presets and kits: name, family, tags, comment, details."""

def params() -> list[dict[str, Any]]:
    """The table of parameters: id, name, unit, min, max, default, choices, help."""

def render(options: list[tuple[str, str]]) -> tuple[npt.NDArray[np.float32], int]: ...
def analyze(
    sound: str | tuple[float, list[list[float]]], most_modes: int, all_strikes: bool
) -> list[dict[str, Any]]: ...
def fit(
    sounds: list[tuple[str | tuple[float, list[list[float]]], str | None, float]], name: str, body: str, most_modes: int
) -> tuple[str, list[float]]: ...
def diff(
    expected: str | tuple[float, list[list[float]]], actual: str | tuple[float, list[list[float]]]
) -> dict[str, Any] | None: ...
def batch(
    jobs: str,
    out: str,
    shard: tuple[int, int],
    resume: bool,
    seed: int,
    flac: bool,
    at_once: int | None,
    progress: Callable[[int, int], object] | None,
) -> tuple[int, int]: ...
