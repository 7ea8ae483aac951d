"""Batches on a Ray cluster of two nodes, with workers and nodes that die, against the command's files.

On demand, on Linux: ``pip install -e '.[ray]' pytest``, then ``python -m pytest -s tests/on_ray.py`` in the package's folder.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import signal
import stat
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import sprung

ray = pytest.importorskip("ray")
cluster_utils = pytest.importorskip("ray.cluster_utils")
on_ray = pytest.importorskip("sprung.ray")

JOBS = 400
SHARDS = 8
SEED = 7
LINES: list[dict[str, Any]] = [
    {"preset": "Kick", "note": "C2", "length": 1, "tail": "none", "decay": {"log_uniform": [0.05, 2]}, "repeat": JOBS - 100},
    {"preset": {"choice": ["Marimba", "Snare"]}, "note": {"integer": [48, 72]}, "length": 0.3, "tail": "none", "repeat": 100},
]


@pytest.fixture
def cluster() -> Iterator[Any]:
    """Two nodes with a CPU each."""
    nodes = cluster_utils.Cluster(initialize_head=True, head_node_args={"num_cpus": 1})
    nodes.add_node(num_cpus=1)
    nodes.wait_for_nodes()
    ray.init(address=nodes.address)
    try:
        yield nodes
    finally:
        ray.shutdown()
        nodes.shutdown()


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What one machine writes."""
    folder = tmp_path_factory.mktemp("alone")
    sprung.batch(LINES, folder, seed=SEED)
    return folder


def digest(folder: Path) -> str:
    """The SHA-256 of all files below a folder, manifests included, and of their names."""
    whole = hashlib.sha256()
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        whole.update(f"{path.relative_to(folder)} {hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return whole.hexdigest()


def assert_same(found: Path, expected: Path) -> None:
    names = [sorted(str(path.relative_to(one)) for path in one.rglob("*") if path.is_file()) for one in (found, expected)]
    assert names[0] == names[1] and len(names[0]) == JOBS + 1
    assert digest(found) == digest(expected)
    print(f"the same {len(names[0])} files: {digest(found)}")


def made(folder: Path) -> int:
    """How many sounds are finished."""
    return sum(1 for _ in folder.glob("*/*.wav"))


def made_by(manifest: Path) -> int:
    """How many lines a manifest has."""
    return manifest.read_bytes().count(b"\n")


def writers(folder: Path) -> dict[int, Path]:
    """The processes that write a manifest in a folder, beside this one."""
    found = {}
    for process in Path("/proc").glob("[0-9]*"):
        try:
            # Others are open for reading.
            written = [Path(os.readlink(one)) for one in (process / "fd").iterdir() if one.lstat().st_mode & stat.S_IWUSR]
        except OSError:
            # It has gone.
            continue
        mine = [path for path in written if path.parent == folder and path.name.startswith("manifest")]
        if mine and int(process.name) != os.getpid():
            found[int(process.name)] = mine[0]
    return found


def half_way(folder: Path, strike: Callable[[], None]) -> threading.Thread:
    """Does something once half of the sounds are made."""

    def watch() -> None:
        while made(folder) < JOBS // 2:
            time.sleep(0.01)
        strike()

    thread = threading.Thread(target=watch)
    thread.start()
    return thread


def test_a_worker_is_killed_half_way(cluster: Any, alone: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    killed: list[tuple[int, str, int]] = []
    told: list[tuple[int, int]] = []

    def kill() -> None:
        while not killed and made(out) < JOBS:
            for process, manifest in writers(out).items():
                # In the middle of its shard.
                if made_by(manifest) in range(10, 40):
                    os.kill(process, signal.SIGKILL)
                    killed.append((process, manifest.name, made_by(manifest)))
                    break

    jobs = tmp_path / "jobs.jsonl"
    jobs.write_text("".join(json.dumps(line) + "\n" for line in LINES))
    watch = half_way(out, kill)
    manifest = on_ray.batch(jobs, out, seed=SEED, shards=SHARDS, progress=lambda done, of: told.append((done, of)))
    watch.join()
    [(process, name, lines)] = killed
    assert 10 <= lines < JOBS // SHARDS
    print(f"killed process {process} after {lines} of {JOBS // SHARDS} lines of {name}")
    assert manifest == out / "manifest.jsonl" and told[-1] == (SHARDS, SHARDS) and len(told) == SHARDS
    assert_same(out, alone)
    # With nothing left to do, nothing changes.
    on_ray.batch(jobs, out, seed=SEED, shards=SHARDS)
    assert_same(out, alone)


def test_a_node_is_lost_half_way(cluster: Any, alone: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    node = next(iter(cluster.worker_nodes))
    watch = half_way(out, lambda: cluster.remove_node(node, allow_graceful=False))
    on_ray.batch(LINES, out, seed=SEED, shards=SHARDS)
    watch.join()
    assert len([one for one in ray.nodes() if one["Alive"]]) == 1
    assert_same(out, alone)


def test_a_dead_nodes_lock_is_waited_for(cluster: Any, tmp_path: Path) -> None:
    jobs = [{"note": "C2", "length": 0.01, "tail": "none", "repeat": 4}]
    with open(tmp_path / "manifest-2-of-2.jsonl", "w") as manifest:
        fcntl.flock(manifest, fcntl.LOCK_EX)
        release = threading.Timer(5, lambda: fcntl.flock(manifest, fcntl.LOCK_UN))
        release.start()
        started = time.monotonic()
        on_ray.batch(jobs, tmp_path, shards=2)
        release.join()
    assert time.monotonic() - started > 5 and made(tmp_path) == 4


def test_errors_are_those_of_the_command(cluster: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    job = {"note": "C2", "length": 0.01, "tail": "none"}
    Path("jobs.jsonl").write_text(json.dumps(job) + "\n" + json.dumps({**job, "decay": "2 m"}) + "\n")
    with pytest.raises(sprung.Error, match=r"^jobs\.jsonl:2: decay: ‘2 m’ is not a number in s"):
        on_ray.batch("jobs.jsonl", "sounds", shards=2)
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"shards": 0}, "^shards: 0: expected 1 or more$"),
        ({"cpus": 0}, "^cpus: 0: expected 1 to 65535$"),
        ({"retries": -2}, "^retries: -2: expected 0 or more, or -1 for always$"),
        ({"format": "mp3"}, "^format: ‘mp3’: expected wav or flac$"),
    ]
    for options, message in wrong:
        with pytest.raises(sprung.Error, match=message):
            on_ray.batch("jobs.jsonl", "sounds", **options)


def test_what_is_wrong_is_told_when_nothing_can_be_cancelled(cluster: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(task: Any) -> None:
        raise ConnectionError("the cluster has gone")

    monkeypatch.setattr(ray, "cancel", refuse)
    with pytest.raises(sprung.Error, match="decay: ‘2 m’ is not a number in s"):
        on_ray.batch([{"note": "C2", "length": 0.01, "decay": "2 m"}], tmp_path, shards=4)


def test_manifests_of_another_number_of_shards_go(cluster: Any, tmp_path: Path) -> None:
    jobs = [{"note": "C2", "length": 0.01, "tail": "none", "repeat": 7}]
    alone, out = tmp_path / "alone", tmp_path / "out"
    sprung.batch(jobs, alone)
    # Broken off: one of three shards is made, and another has a line that was cut off.
    sprung.batch(jobs, out, shard=(2, 3))
    (out / "manifest-3-of-3.jsonl").write_bytes(b'{"number": 2, "ver')
    # Of another batch with more jobs.
    other = {**json.loads((out / "manifest-2-of-3.jsonl").read_text().splitlines()[-1]), "number": 7}
    (out / "manifest-8-of-8.jsonl").write_text(json.dumps(other) + "\n")
    on_ray.batch(jobs, out, shards=2)
    assert sorted(path.name for path in out.glob("*.jsonl")) == ["manifest-8-of-8.jsonl", "manifest.jsonl"]
    (out / "manifest-8-of-8.jsonl").unlink()
    assert digest(out) == digest(alone)


def test_a_worker_that_always_dies_is_an_error(cluster: Any, tmp_path: Path) -> None:
    job = {"preset": "Church Bell", "note": "C4", "length": 600, "tail": "none"}
    gone = threading.Event()

    def kill() -> None:
        while not gone.is_set():
            for process in writers(tmp_path):
                os.kill(process, signal.SIGKILL)
            time.sleep(0.01)

    thread = threading.Thread(target=kill)
    thread.start()
    try:
        with pytest.raises(sprung.Error, match="shard 1/1: .*; what is finished stays: the same call goes on with it"):
            on_ray.batch([job], tmp_path, shards=1, retries=1)
    finally:
        gone.set()
        thread.join()
