"""Batches of sounds, from jobs in a file or in Python."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack
from typing import Any

import numpy as np

from . import _sprung
from ._sprung import Error


def batch(
    jobs: str | os.PathLike[str] | Iterable[Mapping[str, Any]],
    out: str | os.PathLike[str],
    *,
    shard: tuple[int, int] = (1, 1),
    resume: bool = False,
    seed: int = 0,
    format: str = "wav",
    at_once: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> list[dict[str, Any]]:
    """Makes a batch of sounds, as ``sprung batch`` does, and gives the lines of its manifest.

    ``jobs`` is a file, or jobs as dictionaries. ``shard`` is ``(i, n)``. ``progress`` is called with how many jobs are done,
    of how many.
    """
    path = make(jobs, out, shard=shard, resume=resume, seed=seed, format=format, at_once=at_once, progress=progress)
    with open(path, encoding="utf-8") as lines:
        return [json.loads(line) for line in lines]


def check_format(format: str) -> None:
    """Raises an error unless the files can be written so."""
    if format not in ("wav", "flac"):
        raise Error(f"format: ‘{format}’: expected wav or flac")


def make(
    jobs: str | os.PathLike[str] | Iterable[Mapping[str, Any]],
    out: str | os.PathLike[str],
    *,
    shard: tuple[int, int],
    resume: bool,
    seed: int,
    format: str,
    at_once: int | None,
    progress: Callable[[int, int], object] | None = None,
) -> str:
    """As :func:`batch`, but gives the path of the manifest, which may be longer than memory."""
    check_format(format)
    with ExitStack() as stack:
        if isinstance(jobs, (str, os.PathLike)):
            path = os.fspath(jobs)
        else:
            folder = stack.enter_context(tempfile.TemporaryDirectory())
            path = os.path.join(folder, "jobs.jsonl")
            with open(path, "w", encoding="utf-8") as file:
                file.writelines(json.dumps(_plain(job)) + "\n" for job in jobs)
        _sprung.batch(path, os.fspath(out), shard, resume, seed, format == "flac", at_once, progress)
    name = "manifest.jsonl" if shard[1] == 1 else f"manifest-{shard[0]}-of-{shard[1]}.jsonl"
    return os.path.join(out, name)


def _plain(value: Any) -> Any:
    """A value that JSON has."""
    if isinstance(value, Mapping):
        return {str(key): _plain(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(inner) for inner in value]
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    return os.fspath(value) if isinstance(value, os.PathLike) else value
