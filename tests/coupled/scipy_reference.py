#!/usr/bin/env python3
"""Writes scipy_reference.csv beside this script: SciPy's poles and residues of joined bodies, for tests/coupled_reference.rs.

    pip install scipy && python3 tests/coupled/scipy_reference.py [poles a pair, all if 0]

Makes random pairs of bodies from a generator that the test repeats bit for bit, and solves each as a dense eigenproblem
of the state (displacement times frequency, velocity), independently of this project's code. Of each pair some
poles are kept, evenly spread: frequency in rad/s, decay rate in 1/s, and the cosine and sine of the velocity heard.
"""

import sys
from pathlib import Path

import numpy as np
import scipy
from scipy.linalg import eig, null_space

PAIRS = 200
KEPT = int(sys.argv[1]) if len(sys.argv) > 1 else 6
MASK = (1 << 64) - 1


class Chance:
    """SplitMix64 (Steele, Lea & Flood 2014)."""

    def __init__(self, seed):
        self.state = seed

    def bits(self):
        self.state = (self.state + 0x9E3779B97F4A7C15) & MASK
        z = self.state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        return z ^ (z >> 31)

    def real(self):
        return (self.bits() >> 11) * 2.0**-53

    def below(self, bound):
        return self.bits() % bound


def pair(case):
    """The modes of both bodies (frequency, rate, joint, strike, pickup), stiffness and damping, or none if rigid."""
    chance = Chance(case)
    sizes = [128, 128] if case % 20 == 0 else [1 + chance.below(1 + chance.below(64)) for _ in range(2)]
    loss = [0.0, 1.0, 30.0, 400.0][chance.below(4)]
    bodies = []
    for size in sizes:
        body = []
        for _ in range(size):
            u, v = chance.real(), chance.real()
            shapes = [2.0 * chance.real() - 1.0 for _ in range(3)]
            body.append([300.0 + 60000.0 * u * u, loss * (0.1 + v), *shapes])
        bodies.append(body)
    # Near-degenerate pairs: some modes of the second body are close to, or the same as, some of the first.
    kind = case % 5
    for k in range(min(sizes)):
        if kind != 0 and chance.below(2) == 0:
            near = [0.0, 1e-2, 1e-4, 1e-6, 0.0][kind] * chance.real()
            bodies[1][k][0] = bodies[0][k][0] * (1.0 + near)
            if kind == 4:
                bodies[1][k][1] = bodies[0][k][1]
    stiffness = chance.real() * 2.0 ** (8 + chance.below(26))
    damping = [0.0, chance.real() * 2.0 ** chance.below(8)][chance.below(2)]
    rigid = chance.below(8) == 0
    return bodies, None if rigid else (stiffness, damping)


def solve(bodies, joint):
    """Poles above the real axis or on it, and the complex amplitudes of the velocity heard."""
    frequency, rate, shape, strike, pickup = np.array(bodies[0] + bodies[1]).T
    second = np.arange(len(frequency)) >= len(bodies[0])
    shape = np.where(second, -shape, shape)
    # Both bodies are struck and heard.
    strike = strike * np.where(second, 0.5, 1.0)
    pickup = pickup * np.where(second, 1.0, -0.75)
    stiff = np.diag(frequency**2 + rate**2)
    damp = np.diag(2 * rate)
    if joint:
        stiff = stiff + joint[0] * np.outer(shape, shape)
        damp = damp + joint[1] * np.outer(shape, shape)
    else:
        basis = null_space(shape[None, :])
        stiff, damp = basis.T @ stiff @ basis, basis.T @ damp @ basis
        strike, pickup = basis.T @ strike, basis.T @ pickup
    # Undamped modes as coordinates, in which the matrix is nearly normal and its eigenvalues well conditioned.
    squares, vectors = scipy.linalg.eigh(stiff)
    scale = np.sqrt(squares)
    damp = vectors.T @ damp @ vectors
    strike, pickup = vectors.T @ strike, vectors.T @ pickup
    zero = np.zeros_like(damp)
    values, right = eig(np.block([[zero, np.diag(scale)], [-np.diag(scale), -damp]]))
    into = np.linalg.solve(right, np.concatenate([np.zeros_like(strike), strike]))
    amplitudes = (np.concatenate([np.zeros_like(pickup), pickup]) @ right) * into
    kept = values.imag >= 0
    return values[kept], amplitudes[kept] * np.where(values[kept].imag > 0, 2, 1)


with open(Path(__file__).with_suffix(".csv"), "w", encoding="utf-8") as out:
    print(f"# SciPy {scipy.__version__}, eig; made by scipy_reference.py", file=out)
    print("case,poles,frequency,rate,cosine,sine", file=out)
    for case in range(PAIRS):
        values, amplitudes = solve(*pair(case))
        order = np.lexsort((values.real, values.imag))
        kept = order if KEPT == 0 else order[np.unique(np.linspace(0, len(order) - 1, KEPT).astype(int))] if len(order) else []
        for k in kept:
            numbers = [values[k].imag, -values[k].real, amplitudes[k].real, -amplitudes[k].imag]
            print(case, len(values), *(repr(float(number)) for number in numbers), sep=",", file=out)
