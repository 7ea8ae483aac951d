#!/usr/bin/env python3
"""Writes scipy_reference.csv beside this script: SciPy's poles and residues of joined bodies, for tests/engine/coupled_reference.rs.

    pip install scipy mpmath && python3 tests/engine/coupled/scipy_reference.py [poles a pair, all if 0]

Makes random pairs of bodies from a generator that the test repeats bit for bit, and solves each as a dense eigenproblem
of the state (displacement times frequency, velocity), independently of this project's code. Of each pair some
poles are kept, evenly spread: frequency in rad/s, decay rate in 1/s, and the cosine and sine of the velocity heard.

Where poles almost coincide, shapes from a dense solver in double precision are worth few digits (the last line tells how
few). So each pole that is kept is refined by Newton's method in 50 digits, from where SciPy has it.
"""

import sys
from pathlib import Path

import numpy as np
import scipy
from mpmath import mp, mpc, mpf
from scipy.linalg import eig, null_space

PAIRS = 200
KEPT = int(sys.argv[1]) if len(sys.argv) > 1 else 6
mp.dps = 50
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


def split(bodies):
    """Modes that the joint moves, and those that it does not: of modes with one pole it moves but one combination."""
    groups = {}
    for sign, struck, heard, body in [(1, 1, -0.75, bodies[0]), (-1, 0.5, 1, bodies[1])]:
        for frequency, rate, shape, strike, pickup in body:
            mode = (sign * mpf(shape), mpf(strike) * struck, mpf(pickup) * heard)
            groups.setdefault((frequency, rate), []).append(mode)
    moved, still = [], []
    for (frequency, rate), group in groups.items():
        joint = mp.sqrt(sum(c * c for c, _, _ in group))
        strike = sum(c * g for c, g, _ in group) / joint
        pickup = sum(c * o for c, _, o in group) / joint
        moved.append((mpf(frequency) ** 2 + mpf(rate) ** 2, 2 * mpf(rate), joint, strike, pickup))
        if len(group) > 1:
            left = sum(g * o for _, g, o in group) - strike * pickup
            s = mpc(-rate, frequency)
            still.append((s, left * s / (s + rate)))
    return moved, still


def refine(moved, still, joint, start):
    """The pole near `start` and its complex amplitude."""
    # Never exactly on the pole of a free mode.
    s = mpc(complex(start)) * (1 + mpf(10) ** -30)
    stiffness, damping = (mpf(joint[0]), mpf(joint[1])) if joint else (mpf(1), mpf(0))
    for _ in range(40):
        q = [s * s + b * s + a for a, b, *_ in moved]
        near = min(range(len(q)), key=lambda k: abs(q[k]))
        total = sum(mode[2] ** 2 / q for mode, q in zip(moved, q))
        slope = -sum(mode[2] ** 2 * (2 * s + mode[1]) / q**2 for mode, q in zip(moved, q))
        beta = stiffness + damping * s
        value = (1 if joint else 0) + beta * total
        slope = damping * total + beta * slope
        slope = slope * q[near] + value * (2 * s + moved[near][1])
        step = value * q[near] / slope if slope else mpc("inf")
        s -= step
        if abs(step) < abs(s) * mpf(10) ** -40:
            break
    else:
        s = mpc("inf")
    for pole, amplitude in still:
        if abs(pole - start) < abs(s - start):
            return pole, amplitude
    # The shape of the mode, and the residue by the derivative of the quadratic eigenproblem.
    shape = [mode[2] / (s * s + mode[1] * s + mode[0]) for mode in moved]
    at_joint = sum(x * mode[2] for x, mode in zip(shape, moved))
    norm = sum((2 * s + mode[1]) * x * x for x, mode in zip(shape, moved)) + (damping * at_joint**2 if joint else 0)
    strike, pickup = (sum(x * mode[k] for x, mode in zip(shape, moved)) for k in (3, 4))
    twice = 2 if s.imag != 0 else 1
    return s, twice * s * strike * pickup / norm


def spread(values):
    order = np.lexsort((values.real, values.imag))
    if KEPT and len(order):
        order = order[np.unique(np.linspace(0, len(order) - 1, KEPT).astype(int))]
    return order


with open(Path(__file__).with_suffix(".csv"), "w", encoding="utf-8") as out:
    print(f"# SciPy {scipy.__version__}, eig, refined by mpmath; made by scipy_reference.py", file=out)
    print("case,poles,frequency,rate,cosine,sine", file=out)
    worst = [0.0, 0.0]
    for case in range(PAIRS):
        bodies, joint = pair(case)
        values, amplitudes = solve(bodies, joint)
        parts = split(bodies)
        for k in spread(values):
            pole, amplitude = (complex(number) for number in refine(*parts, joint, values[k]))
            off = abs(pole - values[k]) / abs(pole), abs(amplitude - amplitudes[k]) / max(abs(amplitudes))
            worst = [max(a, b) for a, b in zip(worst, off)]
            numbers = [pole.imag, -pole.real, amplitude.real, -amplitude.imag]
            print(case, len(values), *(repr(float(number)) for number in numbers), sep=",", file=out)
    print(f"# SciPy alone was off by at most {worst[0]:.1e} of a pole and {worst[1]:.1e} of the largest residue", file=out)
