#!/usr/bin/env python3
"""Writes scipy_reference.csv beside this script: SciPy's modes of a string on a plate, for tests/engine/pair_reference.rs.

    pip install scipy && python3 tests/engine/pairs/scipy_reference.py

The string follows the keys, the plate does not. They are apart, in series, or joined by a spring and a damper. Each case
is solved as a dense eigenproblem of the state (displacement, velocity) with the matrices of the whole, independently of
this project's code. A joined string is tuned by root finding, so that the pair has the pitch of the key. Of each mode:
frequency in Hz, T60 in seconds, and what is heard after an impulse, the displacement times the angular frequency, on the
string and on the plate: cosine and sine each.
"""

from math import log, pi, sin, sqrt
from pathlib import Path

import numpy as np
import scipy
from scipy.linalg import eig
from scipy.optimize import brentq

KEYS = [43, 55, 67]
MASS, STIFFNESS, DAMPING = 8.0, 600.0, 0.05
STRING, PLATE = (196.0, 12), (95.0, 10)
LN_1000 = log(1000.0)


def string(frequency):
    """Angular frequency, decay rate, and the shapes at the joint, the strike and the pick-up."""
    shape = lambda n, x: sqrt(2.0) * sin(n * pi * x)
    rate = lambda n: 0.8 + 2e-7 * (STRING[0] * n) ** 2
    return [[2 * pi * frequency * n, rate(n), shape(n, 0.97), shape(n, 0.12), shape(n, 0.9)] for n in range(1, STRING[1] + 1)]


def plate():
    numbers = sorted((m * m + (1.4 * n) ** 2, m, n) for m in range(1, 20) for n in range(1, 20))[: PLATE[1]]
    first = numbers[0][0]
    modes = []
    for k2, m, n in numbers:
        shape = lambda x, y: 2.0 * sin(m * pi * x) * sin(n * pi * y) / sqrt(MASS)
        f = PLATE[0] * k2 / first
        modes.append([2 * pi * f, 12.0 + 0.02 * f, shape(0.6, 0.4), shape(0.7, 0.4), shape(0.9, 0.45)])
    return modes


def solve(kind, first, second):
    """Poles, and displacements of both bodies after an impulse on the first, as complex amplitudes."""
    modes = np.array(first + second)
    n, k = len(modes), len(first)
    damping, stiffness = np.diag(2 * modes[:, 1]), np.diag(modes[:, 0] ** 2 + modes[:, 1] ** 2)
    omega = 2 * pi * STIFFNESS
    if kind == "spring":
        joint = modes[:, 2] * np.where(np.arange(n) < k, 1.0, -1.0)
        stiffness += omega**2 * np.outer(joint, joint)
        damping += 2 * DAMPING * omega * np.outer(joint, joint)
    if kind == "series":
        stiffness[k:, :k] -= np.outer(modes[k:, 2], modes[:k, 2])
    # Time in units that make both halves of the state alike.
    scale = 1000.0
    state = np.block([[np.zeros((n, n)), scale * np.eye(n)], [-stiffness / scale, -damping]])
    values, vectors = eig(state)
    start = np.linalg.solve(vectors, np.concatenate([np.zeros(n), np.where(np.arange(n) < k, modes[:, 3], 0.0) / scale]))
    heard = [np.where((np.arange(n) < k) == (body == 0), modes[:, 4], 0.0) @ vectors[:n] * start for body in range(2)]
    rings = values.imag > 0
    order = np.argsort(values[rings].imag)
    return values[rings][order], [2 * amplitude[rings][order] for amplitude in heard]


def case(kind, key):
    frequency = 440.0 * 2 ** ((key - 69) / 12)
    if kind != "spring":
        return solve(kind, string(frequency), plate())

    def off(a):
        found = solve(kind, string(frequency * a), plate())[0].imag / (2 * pi)
        return found[np.argmin(abs(np.log(found / frequency * (1 + 1e-15))))] - frequency

    # The tuning nearest to 1.
    tries = np.linspace(0.9, 1.1, 401)
    signs = [off(a) for a in tries]
    roots = [
        brentq(off, a, b, xtol=1e-15)
        for a, b, x, y in zip(tries, tries[1:], signs, signs[1:])
        if x * y <= 0 and abs(x) + abs(y) < 0.01 * frequency
    ]
    a = min(roots, key=lambda a: abs(a - 1))
    return solve(kind, string(frequency * a), plate())


with open(Path(__file__).with_suffix(".csv"), "w", encoding="utf-8") as out:
    print(f"# SciPy {scipy.__version__}, eig; made by scipy_reference.py", file=out)
    print("kind,key,frequency,t60,string_cosine,string_sine,plate_cosine,plate_sine", file=out)
    for kind in ["apart", "series", "spring"]:
        for key in KEYS:
            values, heard = case(kind, key)
            for j, s in enumerate(values):
                numbers = [s.imag / (2 * pi), LN_1000 / -s.real]
                for amplitude in heard:
                    numbers += [s.imag * amplitude[j].real, -s.imag * amplitude[j].imag]
                print(kind, key, *(repr(float(number)) for number in numbers), sep=",", file=out)
