#!/usr/bin/env python3
"""Sounds per second and memory of `sprung batch`, beside Python's plugin hosts that render the same notes with Sprung.vst3.

`cargo xtask batch-table` builds what it takes and runs this. Each run is processes of its own, timed from the first sound to
the last; memory is what all of them together have resident. Each host's sounds are compared with those of the batch. Linux only.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import struct
import subprocess
import sys
import tempfile
import time
import wave
from dataclasses import dataclass, field
from pathlib import Path

RATE = 48_000
BLOCK = 512
CLASS = b"537072756E674D617373537072696E67"
#: A seed that all share: a host plays with that of the plugin's state.
JOB = {"preset": "Kick", "note": {"integer": [55, 65]}, "velocity": {"integer": [40, 127]}, "length": 1, "tail": "none", "seed": 0}
#: Seconds between two looks at a run.
LOOK = 0.02


@dataclass
class Run:
    """What was seen of a run: seconds, finished sounds and resident memory in MB."""

    name: str
    processes: int
    threads: int
    seen: list[tuple[float, int, float]] = field(default_factory=list)
    #: Seconds that processors worked, start included.
    work: float = 0.0
    difference: str = "–"

    def row(self, sounds: int) -> str:
        """A line of the table."""
        first = next(one for one in self.seen if one[1] > 0)
        last = next(one for one in self.seen if one[1] == sounds)
        rate = (last[1] - first[1]) / (last[0] - first[0])
        parts = [next(one[2] for one in self.seen if one[1] >= sounds * part) for part in (0.1, 0.5)]
        # Once all is done, memory is being given back.
        parts.append([one[2] for one in self.seen if one[1] < sounds][-1])
        memory = " | ".join(f"{part:.0f}" for part in [*parts, max(one[2] for one in self.seen)])
        cells = f"{self.name} | {self.processes} | {self.threads} | {first[0]:.1f} s | {rate:.1f}"
        cells += f" | {1000 * self.work / sounds:.1f} | {memory}"
        return f"| {cells} | {self.difference} |"


HEAD = """| renderer | processes | threads each | first sound after | sounds/s | CPU ms a sound | MB at 10 % | at 50 % | at 100 % | peak MB | difference |
|---|---|---|---|---|---|---|---|---|---|---|"""


def resident(process: int) -> float:
    """Resident memory of a process in MB; 0 if it has ended."""
    try:
        pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    except (OSError, IndexError):
        return 0.0
    return pages * os.sysconf("SC_PAGESIZE") / 1e6


def worked() -> float:
    """Seconds that processors have worked for processes that have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Lines:
    """Counts the lines of a file that grows."""

    def __init__(self, path: Path) -> None:
        self.path, self.read, self.count = path, 0, 0

    def look(self) -> int:
        """How many there are now."""
        if self.path.exists():
            with open(self.path, "rb") as file:
                file.seek(self.read)
                new = file.read()
            self.read += len(new)
            self.count += new.count(b"\n")
        return self.count


def watch(run: Run, commands: list[list[str]], told: list[Path]) -> Run:
    """Starts processes and watches them until all have ended. Each file in `told` gets a line a sound."""
    # Without this the hosts would look for a display.
    environment = {**os.environ, "DISPLAY": ":none"}
    lines = [Lines(path) for path in told]
    before, started = worked(), time.monotonic()
    running = [subprocess.Popen(one, env=environment, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL) for one in commands]
    ended = False
    while not ended:
        ended = all(one.poll() is not None for one in running)
        done = sum(one.look() for one in lines)
        parts = [resident(one.pid) for one in running]
        # Once one has ended, what all had together before.
        memory = sum(parts) if all(parts) else run.seen[-1][2] if run.seen else 0.0
        run.seen.append((time.monotonic() - started, done, memory))
        time.sleep(LOOK)
    for one in running:
        message = one.communicate()[1].decode(errors="replace")
        if one.returncode != 0:
            sys.exit(f"{run.name}: exit code {one.returncode}\n{message}")
    run.work = worked() - before
    return run


def write_preset(sprung: str, path: Path) -> None:
    """Writes the sound as a preset for VST3 hosts: the plugin's state, in the format's own file."""
    text = subprocess.run([sprung, "presets", "show", str(JOB["preset"])], check=True, capture_output=True, text=True).stdout
    version = subprocess.run([sprung, "--version"], check=True, capture_output=True, text=True).stdout.split()[-1]
    own = json.dumps({"format": 1, "preset": text, "seed": JOB["seed"], "window": [880, 640]})
    state = json.dumps({"version": version, "params": {}, "fields": {"sprung": own}}).encode()
    start, size = 48, len(state)
    parts = struct.pack("<4sI4sQQ", b"List", 1, b"Comp", start, size)
    path.write_bytes(struct.pack("<4sI32sQ", b"VST3", 1, CLASS, start + size) + state + parts)


def host(name: str, plugin: str, preset: str, notes: str, folder: str, part: int, parts: int) -> None:
    """Renders every n-th of some notes, `key velocity` a line, in a host, and writes a WAV file of 24 bits for each."""
    import numpy

    if name == "pedalboard":
        import re

        import pedalboard
        from pedalboard import _pedalboard

        # It would try out thousands of values of each of the 2,080 parameters that stand for MIDI controllers.
        _pedalboard.PARAMETER_NAME_REGEXES_TO_IGNORE.add(re.compile(r"^MIDI Ch\. "))
        other = pedalboard.VST3Plugin(plugin)
        other.load_preset(preset)
        synth = pedalboard.VST3Plugin(plugin)
        synth.raw_state = other.raw_state
        del other

        def play(key: int, velocity: int) -> numpy.ndarray:
            messages = [(bytes([0x90, key, velocity]), 0.0), (bytes([0x80, key, 0]), 1.0)]
            return synth(messages, (RATE + 0.25) / RATE, RATE, num_channels=2, buffer_size=BLOCK)

    else:
        import dawdreamer

        engine = dawdreamer.RenderEngine(RATE, BLOCK)
        synth = engine.make_plugin_processor("sprung", plugin)
        if not synth.load_vst3_preset(preset):
            sys.exit(f"{preset}: not loaded")
        engine.load_graph([(synth, [])])

        def play(key: int, velocity: int) -> numpy.ndarray:
            synth.clear_midi()
            synth.add_midi_note(key, velocity, 0.0, 1.0)
            engine.render((RATE + 0.25) / RATE)
            return engine.get_audio()

    with open(notes, encoding="utf-8") as lines, open(f"{folder}/done-{part}", "wb", buffering=0) as done:
        for number, line in enumerate(lines):
            if number % parts != part:
                continue
            key, velocity = map(int, line.split())
            samples = play(key, velocity)[:, :RATE]
            rounded = numpy.clip(numpy.rint(samples.astype(numpy.float64) * 2**23), -(2**23), 2**23 - 1).astype("<i4")
            with wave.open(f"{folder}/{number:07}.wav", "wb") as file:
                file.setnchannels(2)
                file.setsampwidth(3)
                file.setframerate(RATE)
                file.writeframes(numpy.ascontiguousarray(rounded.T).reshape(-1, 1).view(numpy.uint8)[:, :3].tobytes())
            done.write(b"\n")


def samples_of(path: Path):
    """The samples of a WAV file of 24 bits."""
    import numpy

    data = path.read_bytes()
    chunk = data.index(b"data") + 8
    size = struct.unpack_from("<I", data, chunk - 4)[0]
    octets = numpy.frombuffer(data, numpy.uint8, size, chunk).reshape(-1, 3)
    wide = numpy.zeros((len(octets), 4), numpy.uint8)
    wide[:, 1:] = octets
    return (wide.view("<i4") >> 8).ravel()


def difference(folder: Path, batch: Path) -> str:
    """How far the sounds of a host are from those of the batch, at most."""
    import math

    import numpy

    lines = [json.loads(line) for line in (batch / "manifest.jsonl").read_text().splitlines()]
    pairs = ((samples_of(folder / f"{line['number']:07}.wav"), samples_of(batch / line["file"])) for line in lines)
    worst = max(int(numpy.abs(found - expected).max()) if found.shape == expected.shape else 2**23 for found, expected in pairs)
    return "none" if worst == 0 else f"{20 * math.log10(worst / 2**23):.0f} dBFS"


def main() -> None:
    if sys.argv[1:2] == ["host"]:
        name, plugin, preset, notes, folder, part, parts = sys.argv[2:]
        host(name, plugin, preset, notes, folder, int(part), int(parts))
        return
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sprung", help="the command, as built for release")
    parser.add_argument("plugin", help="Sprung.vst3, as built for release")
    parser.add_argument("--sounds", type=int, default=2000, help="sounds of a second each, 20 or more (default: 2000)")
    options = parser.parse_args()
    cores = len(os.sched_getaffinity(0))
    each = sorted({1, cores})
    rows = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        jobs, preset = folder / "jobs.jsonl", folder / "sound.vstpreset"
        jobs.write_text(json.dumps({**JOB, "repeat": options.sounds}) + "\n")
        write_preset(options.sprung, preset)
        for threads in each:
            batch = folder / f"batch-{threads}"
            manifest = batch / "manifest.jsonl"
            command = [options.sprung, "batch", str(jobs), "--out", str(batch), "--jobs", str(threads)]
            print(f"sprung batch, {threads} at once", file=sys.stderr)
            rows.append(watch(Run("`sprung batch`", 1, threads), [command], [manifest]))
        notes = folder / "notes.txt"
        drawn = [json.loads(line)["job"] for line in manifest.read_text().splitlines()]
        notes.write_text("".join(f"{job['note']} {job['velocity']}\n" for job in drawn))
        for name in ("pedalboard", "dawdreamer"):
            for processes in each:
                print(f"{name}, {processes} at once", file=sys.stderr)
                out = folder / f"{name}-{processes}"
                out.mkdir()
                arguments = ["host", name, options.plugin, str(preset), str(notes), str(out)]
                commands = [[sys.executable, __file__, *arguments, str(part), str(processes)] for part in range(processes)]
                run = watch(Run(name, processes, 1), commands, [out / f"done-{part}" for part in range(processes)])
                run.difference = difference(out, batch)
                rows.append(run)
    print(HEAD)
    print("\n".join(run.row(options.sounds) for run in rows))


main()
