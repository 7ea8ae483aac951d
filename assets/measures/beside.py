#!/usr/bin/env python3
"""Draws assets/measures/beside.png: spectrograms of recordings, and of the factory sounds that stand beside them.

    sudo apt-get install fluidsynth fluid-soundfont-gm && pip install matplotlib mido scipy
    cargo build --release && python3 assets/measures/beside.py

The recordings are those of FluidR3 GM (Frank Wen, MIT) as FluidSynth plays them, without reverb and chorus. Both notes are struck
with velocity 100 and held for 1.4 s. Both pictures of a row have one range of colours, from the loudest point 75 dB down. FluidR3
has no gong and no bowed glass: a soft stroke on the gong stands beside a hard one, and glass beside the nearest program, a pad.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import mido
import numpy as np
from scipy.io import wavfile
from scipy.signal import stft

ROOT = Path(__file__).parents[2]
SPRUNG = ROOT / "target/release/sprung"
SOUNDFONT = sys.argv[1] if len(sys.argv) > 1 else "/usr/share/sounds/sf2/FluidR3_GM.sf2"
RATE, SECONDS, RANGE_DB = 44100, 2.0, 75

# Titles of the left and right picture, program from 1 (0 for drums; None for Sprung, softly) and key of the left, preset, its note.
ROWS = [
    ("Marimba, FluidR3", "Marimba, Sprung", 13, 60, "Marimba", "C4"),
    ("Nylon guitar, FluidR3", "Nylon guitar, Sprung", 25, 52, "Nylon Guitar", "E3"),
    ("Steel string on its soundboard, FluidR3", "Steel string on its soundboard, Sprung", 26, 52, "Steel Guitar", "E3"),
    ("Snare and its wires, FluidR3", "Snare and its wires, Sprung", 0, 38, "Snare", "C4"),
    ("Ride, FluidR3", "Ride, Sprung", 0, 51, "Ride", "C4"),
    ("Crash, FluidR3", "Crash, Sprung", 0, 49, "Crash", "C4"),
    ("Gong, Sprung, softly (velocity 50)", "Gong, Sprung, hard (velocity 120): it blooms", None, 0, "Gong", "C4"),
    ("Bowed glass pad (program 93), FluidR3", "Bowed glass, Sprung", 93, 60, "Bowed Glass", "C4"),
]


def recorded(program, key, folder):
    channel = 0 if program else 9
    track = mido.MidiTrack()
    if program:
        track.append(mido.Message("program_change", channel=channel, program=program - 1))
    track.append(mido.Message("note_on", channel=channel, note=key, velocity=100))
    track.append(mido.Message("note_off", channel=channel, note=key, time=int(1.4 * 960)))
    track.append(mido.MetaMessage("end_of_track", time=960))
    song = mido.MidiFile(ticks_per_beat=480)
    song.tracks.append(track)
    song.save(folder / "note.mid")
    wav = folder / "recorded.wav"
    options = ["-ni", "-R", "0", "-C", "0", "-g", "0.8", "-r", str(RATE), "-F", wav]
    subprocess.run(["fluidsynth", *options, SOUNDFONT, folder / "note.mid"], check=True, capture_output=True)
    return wav


def rendered(preset, note, velocity, folder):
    wav = folder / f"rendered-{velocity}.wav"
    options = ["--velocity", str(velocity), "--length", "1.4", "--rate", str(RATE), "--bits", "16", "--force", "-o", wav]
    subprocess.run([SPRUNG, "render", "--preset", preset, "--note", note, *options], check=True, capture_output=True)
    return wav


def spectrum(wav):
    """Decibels by frequency and time, from the onset: the first sample above 3 % of the peak."""
    sound = wavfile.read(wav)[1].astype(float)
    sound = sound.mean(axis=1) if sound.ndim > 1 else sound
    sound = sound[np.argmax(abs(sound) > 0.03 * abs(sound).max()) :]
    sound = np.pad(sound, (0, int(SECONDS * RATE)))[: int(SECONDS * RATE)]
    frequencies, times, values = stft(sound / abs(sound).max(), RATE, nperseg=2048, noverlap=1792)
    return frequencies, times, 20 * np.log10(abs(values) + 1e-9)


def main():
    figure, axes = plt.subplots(len(ROWS), 2, figsize=(11, 2.6 * len(ROWS)), sharex=True, sharey=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for (left, right, program, key, preset, note), row in zip(ROWS, axes):
            if program is None:
                sounds = [rendered(preset, note, 50, folder), rendered(preset, note, 120, folder)]
            else:
                sounds = [recorded(program, key, folder), rendered(preset, note, 100, folder)]
            for wav, axis, title in zip(sounds, row, [left, right]):
                frequencies, times, decibels = spectrum(wav)
                top = decibels.max()
                axis.pcolormesh(times, frequencies, decibels, vmin=top - RANGE_DB, vmax=top, cmap="magma", rasterized=True)
                axis.set(yscale="log", ylim=(50, 16000), title=title)
            row[0].set_ylabel("Hz")
    for axis in axes[-1]:
        axis.set_xlabel("s")
    figure.tight_layout()
    figure.savefig(Path(__file__).with_suffix(".png"), dpi=75)


if __name__ == "__main__":
    main()
