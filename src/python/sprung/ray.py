"""Batches on a Ray cluster: the files and the manifest that one machine writes.

>>> import sprung.ray
>>> manifest = sprung.ray.batch("jobs.jsonl", "/shared/sounds")

Ray runs the shards where there is room, and again where a worker or a node has died; each goes on with what the folder has.
"""

from __future__ import annotations

import contextlib
import functools
import json
import os
import re
import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Union

import ray
from ray.exceptions import RayError, RayTaskError

from ._batch import check_format, make
from ._sprung import Error, Locked

__all__ = ["batch"]

# Seconds in which a file system lets go of what a dead node has locked: NFS gives it 90.
_LOCKED = 120.0

# The manifest of a shard, of any number of shards.
_PART = re.compile(r"manifest-\d+-of-\d+\.jsonl")

# The most threads that a batch can be given.
_MOST_CPUS = 65535

_Jobs = Union[str, "list[Mapping[str, Any]]"]


def batch(
    jobs: str | os.PathLike[str] | Iterable[Mapping[str, Any]],
    out: str | os.PathLike[str],
    *,
    seed: int = 0,
    format: str = "wav",
    shards: int = 64,
    cpus: int = 1,
    retries: int = 3,
    progress: Callable[[int, int], object] | None = None,
) -> Path:
    """Makes a batch of sounds on a Ray cluster, goes on with one that was broken off, and gives the path of its manifest.

    ``jobs`` is a file, or jobs as dictionaries. ``out``, and every file that jobs name, must be in folders that all nodes
    share; relative paths count from the present folder. A shard takes ``cpus``, and is tried again ``retries`` times if its
    worker dies (-1: always). ``progress`` is called with how many shards are done, of how many. Without ``ray.init``, Ray
    connects as it does by itself.
    """
    if shards < 1:
        raise Error(f"shards: {shards}: expected 1 or more")
    if not 1 <= cpus <= _MOST_CPUS:
        raise Error(f"cpus: {cpus}: expected 1 to {_MOST_CPUS}")
    if retries < -1:
        raise Error(f"retries: {retries}: expected 0 or more, or -1 for always")
    check_format(format)
    given: _Jobs = os.fspath(jobs) if isinstance(jobs, (str, os.PathLike)) else list(jobs)
    if not ray.is_initialized():
        ray.init()
    task = ray.remote(num_cpus=cpus, max_retries=retries)(_part)
    # Once in the cluster's memory, not once a shard.
    shared = ray.put(given)
    start = functools.partial(task.remote, shared, os.fspath(out), os.getcwd(), seed, format, cpus, shards)
    waiting = {start(number): f"shard {number}/{shards}" for number in range(1, shards + 1)}
    try:
        while waiting:
            [done, *_], _ = ray.wait(list(waiting))
            _result(done, waiting.pop(done))
            if progress is not None:
                progress(shards - len(waiting), shards)
        whole = start(None)
        waiting[whole] = "the manifest of the whole"
        _result(whole, waiting[whole])
        del waiting[whole]
    except BaseException:
        # What is wrong is told, even if the cluster has gone and nothing can be cancelled.
        with contextlib.suppress(Exception):
            _cancel(list(waiting))
        raise
    return Path(out, "manifest.jsonl")


def _part(
    jobs: _Jobs, out: str, folder: str, seed: int, format: str, at_once: int, shards: int, number: int | None
) -> None:
    """Makes a shard in a worker or, without a number, the manifest of the whole from what the shards have made."""
    before = os.getcwd()
    try:
        os.chdir(folder)
    except OSError as error:
        raise Error(f"{folder}: {error.strerror} on a node: expected a folder that all nodes share") from None
    try:
        shard = (1, 1) if number is None else (number, shards)
        _wait_and_make(jobs, out, shard=shard, resume=True, seed=seed, format=format, at_once=at_once)
        if number is None:
            _remove_parts(Path(out))
    finally:
        # The worker goes on with other tasks. If its folder has gone, what happened here is still what is told.
        with contextlib.suppress(OSError):
            os.chdir(before)


def _cancel(tasks: list[Any]) -> None:
    """Ends tasks, and waits until they have ended: whoever calls again must not meet them."""
    for task in tasks:
        ray.cancel(task)
    if tasks:
        ray.wait(tasks, num_returns=len(tasks), timeout=_LOCKED)


def _remove_parts(out: Path) -> None:
    """Removes the manifests of shards, also those of an earlier call with another number of shards.

    The whole has all their lines, and what is left in the folder is what one machine writes. A manifest with jobs of higher
    numbers than the whole has stays, and so does what is no manifest.
    """
    with open(out / "manifest.jsonl", "rb") as lines:
        whole = sum(1 for _ in lines)
    for part in [path for path in out.iterdir() if _PART.fullmatch(path.name)]:
        last = None
        with open(part, "rb") as lines:
            for line in lines:
                # A line without an end was cut off when its writer was killed.
                last = line if line.endswith(b"\n") else last
        try:
            is_done = last is None or json.loads(last)["number"] < whole
        except (ValueError, KeyError, TypeError):
            continue
        if is_done:
            part.unlink(missing_ok=True)


def _wait_and_make(jobs: _Jobs, out: str, **options: Any) -> None:
    """Makes a shard as soon as a dead node's lock on its manifest is gone."""
    started = time.monotonic()
    while True:
        try:
            make(jobs, out, **options)
            return
        except Locked:
            if time.monotonic() - started > _LOCKED:
                raise
        time.sleep(1.0)


def _result(task: Any, what: str) -> None:
    """Waits for a task, and raises what is wrong as the command's message."""
    try:
        ray.get(task)
    except RayTaskError as error:
        if isinstance(error.cause, Error):
            raise error.cause from None
        raise
    except RayError as error:
        reason = next(iter(str(error).strip().splitlines()), type(error).__name__)
        raise Error(f"{what}: {reason}; what is finished stays: the same call goes on with it") from error
