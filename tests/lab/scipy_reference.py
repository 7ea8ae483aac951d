#!/usr/bin/env python3
"""Writes scipy_reference.csv beside this script: SciPy's numbers for the motions that tests/lab/reference.rs compares.

    pip install scipy && python3 tests/lab/scipy_reference.py

Integrates m x'' + c x' + k s(x - target) = amplitude cos(2 pi frequency t + phase) with DOP853 (Hairer, Norsett & Wanner
1993) at rtol 1e-12, independently of this project's code.
"""

from math import cos, pi, sin, sqrt
from pathlib import Path

import scipy
from scipy.integrate import solve_ivp

RESONANCE = sqrt(50.0) / (2 * pi)

# name, spring, mass, stiffness, damping, cubic, target, force amplitude, frequency, phase, x0, v0
CASES = [
    ("undamped", "linear", 1, 50, 0, 0, 0, 0, 0, 0, 0.5, 0),
    ("undamped from speed", "linear", 2.5, 80, 0, 0, 0, 0, 0, 0, 0, 1.3),
    ("underdamped", "linear", 1, 50, 0.8, 0, 0, 0, 0, 0, 0.5, 0),
    ("underdamped heavily", "linear", 3, 700, 40, 0, 0, 0, 0, 0, -0.3, 2),
    ("critically damped", "linear", 1, 16, 8, 0, 0, 0, 0, 0, 0.5, -1),
    ("overdamped", "linear", 1, 16, 20, 0, 0, 0, 0, 0, 0.5, 1),
    ("unsprung", "linear", 1, 0, 3, 0, 0, 0, 0, 0, 0.2, 1),
    ("unimpeded", "linear", 2, 0, 0, 0, 0, 0, 0, 0, 0.2, -0.5),
    ("with a target", "linear", 1, 50, 1, 0, 0.4, 0, 0, 0, -0.5, 0),
    ("constant force", "linear", 1, 50, 0.5, 0, 0, 4, 0, 0, 0.5, 0),
    ("constant force, unsprung", "linear", 1, 0, 2, 0, 0, 1.5, 0, 0, 0.1, 0.3),
    ("driven below resonance", "linear", 1, 50, 0.6, 0, 0, 3, 0.5, 0.7, 0.5, 0),
    ("driven at resonance, undamped", "linear", 1, 50, 0, 0, 0, 1, RESONANCE, 0, 0, 0),
    ("driven at resonance, damped", "linear", 1, 50, 0.3, 0, 0, 1, RESONANCE, 1, 0, 0.2),
    ("Duffing", "duffing", 1, 50, 0, 200, 0, 0, 0, 0, 0.5, 0),
    ("Duffing, damped and driven", "duffing", 1.2, 30, 0.7, 90, 0.1, 2, 0.8, 0.3, 0.4, -0.5),
    ("pendulum, far up", "pendulum", 1, 9.81, 0, 0, 0, 0, 0, 0, 2.8, 0),
    ("pendulum, damped", "pendulum", 1.5, 20, 0.4, 0, 0, 0, 0, 0, 1.5, 1),
    ("pendulum, over the top", "pendulum", 1, 9.81, 0, 0, 0, 0, 0, 0, 0, 7),
]

TIMES = [0.25, 1.0, 2.3, 5.0]
COLUMNS = "name,spring,mass,stiffness,damping,cubic,target,amplitude,frequency,phase,x0,v0,t,x,v"

with open(Path(__file__).with_suffix(".csv"), "w", encoding="utf-8") as out:
    print(f"# SciPy {scipy.__version__}, solve_ivp DOP853, rtol 1e-12, atol 1e-14; made by scipy_reference.py", file=out)
    print(COLUMNS, file=out)
    for name, spring, m, k, c, cubic, target, amplitude, frequency, phase, x0, v0 in CASES:

        def derivative(t, y):
            d = y[0] - target
            pull = {"linear": k * d, "duffing": k * d + cubic * d**3, "pendulum": k * sin(d)}[spring]
            return [y[1], (amplitude * cos(2 * pi * frequency * t + phase) - c * y[1] - pull) / m]

        solution = solve_ivp(
            derivative, (0, TIMES[-1]), [x0, v0], method="DOP853", t_eval=TIMES, rtol=1e-12, atol=1e-14, max_step=0.01
        )
        for t, x, v in zip(solution.t, *solution.y):
            values = [m, k, c, cubic, target, amplitude, frequency, phase, x0, v0, float(t), float(x), float(v)]
            print('"' + name + '"', spring, *(repr(float(value)) for value in values), sep=",", file=out)
