"""Compares `sprung analyze` with PyPI's lim-sample (SAMPLE; Tiraboschi et al. 2020) on the same synthetic strikes.

    pip install "numpy<2" lim-sample
    cargo build --release && python3 tests/analysis/lim_sample.py target/release/sprung

Prints a table in Markdown. Seconds are those that a processor was at work for. Without lim-sample it says so and ends with 0.
"""

import json
import math
import random
import resource
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

RATE = 44100
SECONDS = 2.0
# Sounds: modes, noise in dB below the strongest mode.
CASES = [(8, None), (8, -60.0), (24, None), (24, -60.0), (60, None), (60, -60.0)]


def body(count, chance):
    """Frequency, T60, amplitude and phase of modes; no two nearer to each other than the wider one's bandwidth and 1 Hz."""
    modes = []
    while len(modes) < count:
        frequency = 60.0 * (14000.0 / 60.0) ** chance.random()
        t60 = 0.03 * 333.0 ** chance.random()
        apart = lambda mode: abs(mode[0] - frequency) > max(2.2 / mode[1], 2.2 / t60, 1.0)
        if all(apart(mode) for mode in modes):
            modes.append((frequency, t60, 10.0 ** (-3.0 * chance.random()), chance.uniform(-math.pi, math.pi)))
    return modes


def sound(np, modes, noise_db, seed):
    time_axis = np.arange(int(SECONDS * RATE)) / RATE
    samples = np.zeros_like(time_axis)
    for frequency, t60, amplitude, phase in modes:
        decay = math.log(1000.0) / t60
        samples += amplitude * np.exp(-decay * time_axis) * np.sin(2 * np.pi * frequency * time_axis + phase)
    if noise_db is not None:
        strongest = max(mode[2] for mode in modes)
        samples += strongest * 10.0 ** (noise_db / 20.0) * np.random.default_rng(seed).standard_normal(samples.size)
    return (0.5 * samples / np.abs(samples).max()).astype(np.float32)


def write_wav(path, samples):
    data = samples.tobytes()
    header = b"WAVEfmt " + struct.pack("<IHHIIHH", 16, 3, 1, RATE, 4 * RATE, 4, 32) + b"data" + struct.pack("<I", len(data))
    path.write_bytes(b"RIFF" + struct.pack("<I", len(header) + len(data)) + header + data)


def by_sprung(sprung, path):
    printed = subprocess.run([sprung, "analyze", path, "--json"], capture_output=True, check=True).stdout
    return [(mode["frequency"], mode["t60"]) for mode in json.loads(printed)["modes"]]


def by_sample(sample, samples):
    model = sample.SAMPLE(sinusoidal__tracker__fs=RATE, sinusoidal__tracker__reverse=True, sinusoidal__t=-90)
    model.fit(samples.astype("float64"))
    # Its decay is the time in which the energy falls to 1/e, twice that of the amplitude.
    return [(f, d * math.log(1000.0) / 2.0) for f, d in zip(model.freqs_, model.decays_)]


def score(known, found):
    """How many are found within half a bandwidth, how many found are none, median errors in cents and % of T60."""
    free, cents, shares = list(found), [], []
    for frequency, t60, _, _ in known:
        width = 0.5 * max(2.2 / t60, 1.0)
        near = [mode for mode in free if abs(mode[0] - frequency) < width]
        if near:
            mode = min(near, key=lambda mode: abs(mode[0] - frequency))
            free.remove(mode)
            cents.append(abs(1200.0 * math.log2(mode[0] / frequency)))
            shares.append(100.0 * abs(mode[1] / t60 - 1.0))
    median = lambda values: sorted(values)[len(values) // 2] if values else math.nan
    return len(cents), len(free), median(cents), median(shares)


def seconds_at_work():
    """Of this process and of those that it has waited for."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: lim_sample.py SPRUNG")
    try:
        import numpy as np
        from sample import sample
    except ImportError as error:
        print(f'skipped: lim-sample is not installed ({error}): pip install "numpy<2" lim-sample')
        return
    print("| modes | noise | program | found | not there | median cents | median T60 error | seconds |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for seed, (count, noise_db) in enumerate(CASES):
            known = body(count, random.Random(seed))
            samples = sound(np, known, noise_db, seed)
            path = Path(folder) / f"{seed}.wav"
            write_wav(path, samples)
            programs = [
                ("sprung analyze", lambda: by_sprung(sys.argv[1], path)),
                ("lim-sample", lambda: by_sample(sample, samples)),
            ]
            for name, take_apart in programs:
                begun = seconds_at_work()
                found = take_apart()
                seconds = seconds_at_work() - begun
                right, wrong, cents, share = score(known, found)
                noise = "none" if noise_db is None else f"{noise_db:.0f} dB"
                print(f"| {count} | {noise} | {name} | {right} | {wrong} | {cents:.2g} | {share:.2g} % | {seconds:.1f} |")


if __name__ == "__main__":
    main()
