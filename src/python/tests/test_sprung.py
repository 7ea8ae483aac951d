"""The package against the command: the same bits, the same messages."""

from __future__ import annotations

import copy
import json
import os
import pickle
import subprocess
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sprung

COMMAND = os.environ.get("SPRUNG_COMMAND", "")
PROJECT = Path(__file__).resolve().parents[3]
PRESETS = ["Kick", "Snare", "Marimba", "Church Bell", "Ride", "Steel Guitar", "Gong", "Kalimba", "init", "Timpani"]


def command(*arguments: str, code: int = 0) -> str:
    """Runs the command, and gives what it writes to stderr."""
    done = subprocess.run([COMMAND, *arguments], capture_output=True, encoding="utf-8")
    assert done.returncode == code, done.stderr
    return done.stderr


def floats(path: Path) -> np.ndarray[Any, np.dtype[np.float32]]:
    """The samples of a WAV file of floats with two channels."""
    data = path.read_bytes()
    return np.frombuffer(data[data.index(b"data") + 8 :], dtype="<f4").reshape(-1, 2)


@pytest.mark.parametrize("preset", PRESETS)
def test_notes_have_the_bits_of_the_command(preset: str, tmp_path: Path) -> None:
    if preset not in {entry["name"] for entry in sprung.presets()} | {"init"}:
        pytest.fail(f"there is no preset {preset}")
    out = tmp_path / "out.wav"
    rest = ["--length", "0.3", "--tail", "0.1", "--seed", "3", "--set", "decay=300 ms", "--bits", "32f", "-o", str(out)]
    command("render", "--preset", preset, "--note", "C3,64.5", *rest)
    sound = sprung.render(preset, ["C3", 64.5], length=0.3, tail=0.1, seed=3, set={"decay": "300 ms"})
    assert sound.rate == 48_000 and sound.dtype == np.float32 and np.any(sound != 0)
    assert sound.tobytes() == floats(out).tobytes()


def test_a_song_has_the_bits_of_the_command(tmp_path: Path) -> None:
    song, out = PROJECT / "assets/midi/groove.mid", tmp_path / "out.wav"
    command("render", str(song), "--rate", "8000", "--tail", "none", "--normalize", "peak=-1", "--bits", "32f", "-o", str(out))
    sound = sprung.render(song=song, rate=8000, tail="none", normalize="peak=-1")
    assert sound.rate == 8000 and sound.tobytes() == floats(out).tobytes()


def test_a_part_of_a_song_has_the_bits_of_the_command(tmp_path: Path) -> None:
    song, out = PROJECT / "assets/midi/groove.mid", tmp_path / "out.wav"
    rest = ["--rate", "8000", "--tail", "none", "--bits", "32f", "-o", str(out)]
    command("render", str(song), "--from", "bar2", "--to", "4.5", *rest)
    sound = sprung.render(song=song, from_="bar2", to=4.5, rate=8000, tail="none")
    assert 0 < len(sound) < 4.5 * 8000 and sound.tobytes() == floats(out).tobytes()
    with pytest.raises(sprung.Error, match="from: ‘9x’ is not a number: expected 0 to 86400 s, or a bar"):
        sprung.render(song=song, from_="9x")
    with pytest.raises(sprung.Error, match="only files of type 2 have patterns"):
        sprung.render(song=song, pattern=1)


def test_options_take_what_python_has() -> None:
    sound = sprung.render("Kick", np.int64(36), velocity=np.int32(90), length=0.05, tail=0, mono=True, rate=16_000)
    assert sound.shape == (800, 1)
    part, louder = sound[100:200], sound * 2
    assert isinstance(part, sprung.Sound) and part.rate == 16_000 and isinstance(louder, sprung.Sound)
    assert pickle.loads(pickle.dumps(part)).rate == 16_000


def test_errors_are_those_of_the_command() -> None:
    for preset in ["Kcik", "none.toml"]:
        told = command("render", "--preset", preset, "--note", "C4", "-o", "never.wav", code=1)
        with pytest.raises(sprung.Error) as raised:
            sprung.render(preset, "C4")
        assert str(raised.value) in told
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"velocity": 0}, "velocity: 0 is out of range: expected 1 to 127"),
        ({"velocty": 3}, "velocty: there is no option ‘velocty’; the nearest is ‘velocity’"),
        ({"set": {"decay": "2 m"}}, "decay: ‘2 m’ is not a number in s"),
        ({"set": "decay=250 ms"}, "set: a str: expected a mapping"),
        ({"song": "a.mid"}, "expected either a song or notes"),
    ]
    for options, message in wrong:
        with pytest.raises(sprung.Error, match=message):
            sprung.render("Kick", "C2", **options)
    for most_modes in [0, 1001]:
        with pytest.raises(sprung.Error, match=f"most_modes: {most_modes}: expected 1 to 1000"):
            sprung.analyze(np.zeros(4410), most_modes=most_modes)
    for rate in [-1, 0, 999, 768_001, 4_000_000_000]:
        with pytest.raises(sprung.Error, match=f"rate: {rate} is out of range: expected 1000 to 768000 Hz"):
            sprung.analyze((np.zeros(4410), rate))
    with pytest.raises(sprung.Error, match="it has 65 channels: expected 1 to 64"):
        sprung.analyze(np.zeros((10, 65)))


def test_the_mix_has_a_gain() -> None:
    loud, soft = [sprung.render("Kick", "C2", length=0.1, tail="none", set={"limiter": "off"}, mix_gain_db=gain) for gain in [0, -12]]
    assert np.allclose(soft, loud * 10 ** (-12 / 20), atol=1e-6)


def test_warnings_are_raised() -> None:
    with pytest.warns(UserWarning, match="silent: their kits have no pad"):
        sprung.render("Acoustic Kit", 0, length=0.01, tail="none")


def test_a_patch_has_parameters_as_attributes(tmp_path: Path) -> None:
    patch = sprung.Patch("Church Bell")
    assert patch.name == "Church Bell" and patch.modes.shape[1] == 5 and len(patch.modes) > 3
    patch.decay = "250 ms"
    assert (patch.decay, patch.text("decay")) == (0.25, "250 ms")
    patch.gain = -3
    assert patch.gain == -3.0
    patch.mallet_pulse = "contact"
    assert patch.mallet_pulse == "contact"
    with pytest.raises(AttributeError, match="there is no parameter ‘deacy’; the nearest is ‘decay’"):
        patch.deacy = 1
    with pytest.raises(AttributeError):
        _ = patch.deacy
    with pytest.raises(sprung.Error, match="gain: 99 is out of range"):
        patch.gain = 99
    assert "decay" in dir(patch)
    other = copy.copy(patch)
    other.decay = 1
    assert patch.decay == 0.25 and other != patch
    assert pickle.loads(pickle.dumps(patch)) == patch
    patch.save(tmp_path / "bell.toml")
    assert sprung.Patch(tmp_path / "bell.toml") == patch
    played = patch.render("C4", length=0.1, tail="none")
    changes = {"decay": 0.25, "gain": -3, "mallet_pulse": "contact"}
    assert played.tobytes() == sprung.render("Church Bell", "C4", length=0.1, tail="none", set=changes).tobytes()


def test_a_notebook_plays_patches_and_sounds() -> None:
    page = sprung.Patch("Kick")._repr_html_()
    assert "Kick" in page and '<audio controls src="data:audio/wav;base64,UklGR' in page
    sound = sprung.render("Kick", "C2", length=0.1, tail="none")
    assert sound._repr_html_().startswith("<audio")


def test_lists_are_whole() -> None:
    assert len(sprung.presets()) > 200 and {"name", "family", "tags", "comment"} <= set(sprung.presets()[0])
    decay = next(param for param in sprung.params() if param["id"] == "decay")
    assert (decay["unit"], decay["min"], decay["max"]) == ("s", 0.005, 60.0)


def test_recordings_are_taken_apart_and_compared(tmp_path: Path) -> None:
    sound = sprung.render("Church Bell", "C4", length=2, tail="none", mono=True)
    [strike] = sprung.analyze(sound, most_modes=8)
    assert len(strike["modes"]) > 3 and all(mode["t60"] > 0 for mode in strike["modes"])
    assert sprung.diff(sound, sound) is None
    found = sprung.diff(sound, sound * 0.5)
    assert found is not None and found["worst_dbfs"] < 0
    sound.save(tmp_path / "bell.wav")
    assert sprung.diff(tmp_path / "bell.wav", tmp_path / "bell.wav") is None
    with pytest.raises(sprung.Error, match="silent"):
        sprung.analyze(np.zeros(48_000, np.float32))


def test_a_recording_becomes_a_patch() -> None:
    sound = sprung.render("Kalimba", "C5", length=0.5, tail="none", mono=True)
    patch = sprung.fit(sound, note="C5", name=" Again ", most_modes=4)
    assert patch.name == "Again" and 1 <= len(patch.modes) <= 4
    assert np.any(patch.render("C5", length=0.05, tail="none") != 0)
    with pytest.raises(sprung.Error, match="name: it is blank"):
        sprung.fit(sound, note="C5", name=" ")


def test_a_batch_is_that_of_the_command(tmp_path: Path) -> None:
    jobs = [
        {"preset": "Kick", "note": "C2", "length": 0.05, "tail": "none", "decay": {"uniform": [0.1, 1]}, "repeat": 6},
        {"note": ["C4", 67], "length": np.float64(0.05), "tail": "none", "set": {"tune": -2}},
    ]
    told: list[tuple[int, int]] = []
    lines = sprung.batch(jobs, tmp_path / "python", seed=4, progress=lambda done, of: told.append((done, of)))
    plain = [jobs[0], {**jobs[1], "length": 0.05}]
    (tmp_path / "jobs.jsonl").write_text("".join(json.dumps(job) + "\n" for job in plain))
    command("batch", str(tmp_path / "jobs.jsonl"), "--out", str(tmp_path / "command"), "--seed", "4")
    names = ["manifest.jsonl", *(line["file"] for line in lines)]
    assert len(names) == 8 and told[-1] == (7, 7)
    assert all((tmp_path / "python" / name).read_bytes() == (tmp_path / "command" / name).read_bytes() for name in names)
    with pytest.raises(sprung.Error, match="add --resume"):
        sprung.batch(jobs, tmp_path / "python", seed=4)
    parts = [sprung.batch(jobs, tmp_path / "parts", seed=4, shard=(part, 3)) for part in (1, 2, 3)]
    assert sorted((line for part in parts for line in part), key=lambda line: line["number"]) == lines
    with pytest.raises(ZeroDivisionError):
        sprung.batch([{**jobs[0], "repeat": 4000}], tmp_path / "broken", progress=lambda done, of: 1 / 0)


def test_threads_render_at_once() -> None:
    """While a thread renders, the interpreter goes on."""
    done = threading.Event()

    def work() -> None:
        sprung.render("Church Bell", ["C3", "E3", "G3"], length=20, tail="none")
        done.set()

    thread = threading.Thread(target=work)
    thread.start()
    turns = 0
    while not done.is_set():
        time.sleep(0.001)
        turns += 1
    thread.join()
    assert turns > 10, "the interpreter stood still"
    sounds: dict[int, bytes] = {}
    threads = [
        threading.Thread(target=lambda n=n: sounds.update({n: sprung.render("Kick", 36 + n % 2, length=0.1).tobytes()}))
        for n in range(8)
    ]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert len(sounds) == 8 and len(set(sounds.values())) == 2
