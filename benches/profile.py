#!/usr/bin/env python3
"""Prints what whole songs spend their time on, in per cent: perf's samples of `sprung render`, by the functions on their stacks.

cargo build --release --package sprung-cli && python3 benches/profile.py assets/midi/*.mid target/songs/*.mid
"""

import collections
import os
import subprocess
import sys
import tempfile

# A sample belongs to the first part that has a function on its stack.
PARTS = {
    "spaces": ["engine::space", "dsp::space"],
    "limiter, loudness": ["limiter", "ebur128", "true_peak"],
    "starts": ["key_down", "note_on"],
    "control": ["control", "settle", "sweep", "look_ahead"],
    "modes": ["SynthVoice::render", "Synth>::render", "mode_bank", "dsp::cells"],
    "file": ["io::wav", "quantise", "write"],
}
SPRUNG = os.path.join(os.path.dirname(__file__), "..", "target", "release", "sprung")


def part(stack):
    return next((name for name, words in PARTS.items() if any(word in stack for word in words)), "rest")


def profile(song, folder):
    data, sound = (os.path.join(folder, name) for name in ["perf.data", "song.wav"])
    render = [SPRUNG, "render", song, "--threads", "1", "--force", "-o", sound]
    record = ["perf", "record", "--call-graph", "dwarf,24576", "-F", "200", "-o", data]
    subprocess.run(record + render, check=True, capture_output=True)
    script = ["perf", "script", "-i", data, "--no-inline", "-F", "comm,ip,sym"]
    stacks = subprocess.run(script, check=True, capture_output=True, text=True).stdout.split("\n\n")
    return collections.Counter(part(stack) for stack in stacks if stack.strip())


names = [*PARTS, "rest"]
print("| song | " + " | ".join(names) + " |")
print("|---" * (len(names) + 1) + "|")
with tempfile.TemporaryDirectory() as folder:
    for song in sys.argv[1:]:
        found = profile(song, folder)
        shares = " | ".join(f"{100 * found[name] / found.total():.0f}" for name in names)
        print(f"| {os.path.splitext(os.path.basename(song))[0]} | {shares} |", flush=True)
