"""Batches on a Ray cluster: the files and the manifest that one machine writes.

>>> import sprung.ray
>>> manifest = sprung.ray.batch("jobs.jsonl", "/shared/sounds")

Ray runs the shards where there is room, and again where a worker or a node has died; each goes on with what the folder has.
"""

from __future__ import annotations

import functools
import os
import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Union

import ray
from ray.exceptions import RayError, RayTaskError

from ._batch import make
from ._sprung import Error

__all__ = ["batch"]

# Seconds in which a file system lets go of what a dead node has locked: NFS gives it 90.
_LOCKED = 120.0

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
    if shards < 1 or cpus < 1 or retries < -1:
        raise Error("shards, cpus: expected 1 or more; retries: -1 or more")
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
    finally:
        for left in waiting:
            ray.cancel(left)
        if waiting:
            # Whoever calls again must not meet them.
            ray.wait(list(waiting), num_returns=len(waiting), timeout=_LOCKED)
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
        if number is None and shards > 1:
            # The whole has all their lines. What is left in the folder is what one machine writes.
            for one in range(1, shards + 1):
                Path(out, f"manifest-{one}-of-{shards}.jsonl").unlink(missing_ok=True)
    finally:
        # The worker goes on with other tasks.
        os.chdir(before)


def _wait_and_make(jobs: _Jobs, out: str, **options: Any) -> None:
    """Makes a shard as soon as a dead node's lock on its manifest is gone."""
    started = time.monotonic()
    while True:
        try:
            make(jobs, out, **options)
            return
        except Error as error:
            if not str(error).endswith("another process is writing it") or time.monotonic() - started > _LOCKED:
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
