#!/usr/bin/env python3
"""Writes scipy_reference.csv beside this script: SciPy's numbers for the bodies that tests/engine/body_reference.rs compares.

    pip install scipy && python3 tests/engine/bodies/scipy_reference.py

Roots by Brent's method, normalisation and air loads by adaptive quadrature, the kettle by a dense eigenproblem: each by
another way than this project's code. Columns: model, the numbers that are set on it, place in ascending order of
frequency, frequency over the body's, shape struck times shape heard, T60 in seconds, and how far the ratio may be off.
"""

from math import cos, cosh, log, pi, sin, sinh, sqrt, tan
from pathlib import Path

import numpy as np
import scipy
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import iv, ivp, jn_zeros, jv, jvp

STRUCK, HEARD, TURN = 0.7, 0.9, 0.05
C4 = 440 * 2 ** (-9 / 12)
LN1000 = log(1000)
eta = lambda factor, b0: lambda f: b0 + pi * factor * f
LOSS = {
    "steel": eta(2e-4, 0.3),
    "bronze": eta(4e-4, 0.1),
    "rosewood": eta(5e-3, 0.5),
    "glass": eta(1e-3, 0.3),
    "brass": eta(4e-4, 0.3),
    "skin": eta(1.5e-2, 8),
    "mylar": eta(2e-3, 1),
    "aluminium": eta(1e-4, 0.5),
    "wire": lambda f: 1.1 + 2.7e-4 * (2 * pi * f / 329.6) ** 2,
    "air": lambda f: 2 + 1.2e-5 * sqrt(2 * pi * f) / 0.01 * 343,
}
NU = {"bronze": 0.34, "steel": 0.28}
lines = []


def case(model, fields, material, modes, frequency=C4, tolerance=1e-9):
    """modes: (ratio, shape product, rate besides the material's)"""
    for place, (ratio, product, extra) in enumerate(sorted(modes, key=lambda mode: mode[0])):
        t60 = min(60.0, LN1000 / (LOSS[material](frequency * ratio) + extra))
        text = ";".join(f"{name}={value!r}" for name, value in fields.items())
        lines.append(f"{model},{text},{place},{float(ratio)!r},{float(product)!r},{float(t60)!r},{tolerance!r}")


def normalised(shape, weight=lambda x: 1.0):
    """shape, scaled so that the mean of its square over [0, 1] with this weight is 1"""
    square = quad(lambda x: weight(x) * shape(x) ** 2, 0, 1, limit=400)[0] / quad(weight, 0, 1)[0]
    return lambda x: shape(x) / sqrt(square)


def product(shape):
    return shape(STRUCK) * shape(HEARD)


def round_product(shape, m):
    """shape(r) cos(m theta) over a disk, struck at the angle 0"""
    mean = quad(lambda r: 2 * r * shape(r) ** 2, 0, 1, limit=400)[0] * (1 if m == 0 else 0.5)
    return product(shape) / mean * cos(2 * pi * m * TURN)


# Strings
case("string", {}, "wire", [(n, 2 * sin(n * pi * STRUCK) * sin(n * pi * HEARD), 0) for n in range(1, 13)])
B = 1e-3
stiff = [(n * sqrt(1 + B * n * n) / sqrt(1 + B), 2 * sin(n * pi * STRUCK) * sin(n * pi * HEARD), 0) for n in range(1, 13)]
case("string", {"inharmonicity": B}, "wire", stiff)

# Bars, as they stand in textbooks: good for the first modes, before the hyperbolic functions cancel.
free_beta = [brentq(lambda b: cos(b) * cosh(b) - 1, (k + 0.5) * pi - 0.3, (k + 0.5) * pi + 0.3, xtol=1e-14) for k in range(1, 8)]
tine_beta = [brentq(lambda b: cos(b) * cosh(b) + 1, (k - 0.5) * pi - 0.4, (k - 0.5) * pi + 0.4, xtol=1e-14) for k in range(1, 8)]


def free_shape(b):
    s = (cosh(b) - cos(b)) / (sinh(b) - sin(b))
    return normalised(lambda x: cosh(b * x) + cos(b * x) - s * (sinh(b * x) + sin(b * x)))


def tine_shape(b):
    s = (sinh(b) - sin(b)) / (cosh(b) + cos(b))
    return normalised(lambda x: cosh(b * x) - cos(b * x) - s * (sinh(b * x) - sin(b * x)))


free = [(b * b / free_beta[0] ** 2, product(free_shape(b)), 0) for b in free_beta]
case("free_bar", {}, "steel", free)
case("tine", {}, "steel", [(b * b / tine_beta[0] ** 2, product(tine_shape(b)), 0) for b in tine_beta])
for model, material, tuned in [
    ("marimba", "rosewood", [1, 4, 10]),
    ("vibraphone", "aluminium", [1, 4, 10]),
    ("xylophone", "rosewood", [1, 3, 6]),
]:
    above = [tuned[2] * (b / free_beta[2]) ** 2 for b in free_beta[3:]]
    case(model, {}, material, [(ratio, shape, 0) for ratio, (_, shape, _) in zip(tuned + above, free)])
case("tubular_bell", {}, "brass", [(2 * (b / free_beta[3]) ** 2, shape, 0) for b, (_, shape, _) in zip(free_beta, free)])

# Membranes
zeros = sorted((float(k), m) for m in range(25) for k in jn_zeros(m, 12))[:40]
membrane = lambda m, k: lambda r: jv(m, k * r)
case("membrane", {}, "skin", [(k / zeros[0][0], round_product(membrane(m, k), m), 0) for k, m in zeros])

# The kettledrum of 65 cm at 150 Hz
RHO, C, RADIUS, SIGMA, VOLUME, PITCH = 1.204, 343.2, 0.328, 0.262, 0.14, 150.0
drum = sorted((float(k), m) for m in range(25) for k in jn_zeros(m, 12))[:24]


def spectrum(m, k, kappa):
    """the Hankel transform of sqrt(2 (or 4)) J_m(k r) / |J_m+1(k)|, so that its square times kappa integrates to 1"""
    root = sqrt(2)
    if abs(kappa - k) < 1e-9:
        return root * abs(jv(m + 1, k)) / 2
    return root * k * jv(m, kappa) / (k * k - kappa * kappa) * (1 if jv(m + 1, k) > 0 else -1)


def load(m, k):
    side = quad(lambda kappa: spectrum(m, k, kappa) ** 2, 0, 400, points=[k], limit=2000)[0]
    return 1 + RHO * RADIUS / SIGMA * side * (1 if m == 0 else 2)


def radiation(parts, m, omega):
    u = omega * RADIUS / C
    inner = lambda t: sum(share * spectrum(m, k, u * sin(t)) for share, k in parts) ** 2 * u * sin(t)
    return 0.5 * RHO * RADIUS / SIGMA * omega * quad(inner, 0, pi / 2)[0]


j11 = float(jn_zeros(1, 1)[0])
speed2 = (2 * pi * PITCH) ** 2 * load(1, j11) / j11**2
modes = []
for k, m in drum:
    if m > 0:
        mass = load(m, k)
        omega = k * sqrt(speed2 / mass)
        ratio = omega / (2 * pi * PITCH)
        modes.append((ratio, round_product(membrane(m, k), m) / mass, radiation([(1 / sqrt(mass), k)], m, omega)))
flat = [k for k, m in drum if m == 0]
masses = [load(0, k) for k in flat]
# Volume: the mean of J_0(k r) / |J_1(k)|
volumes = np.array([quad(lambda r: 2 * r * jv(0, k * r), 0, 1)[0] / abs(jv(1, k)) / sqrt(mass) for k, mass in zip(flat, masses)])
matrix = np.diag([k * k * speed2 / mass for k, mass in zip(flat, masses)])
matrix = matrix + RHO * C**2 * pi * RADIUS**2 / (VOLUME * SIGMA) * np.outer(volumes, volumes)
values, vectors = np.linalg.eigh(matrix)
for value, vector in zip(values, vectors.T):
    omega = sqrt(value)
    parts = [(float(weight) / sqrt(mass), k) for weight, mass, k in zip(vector, masses, flat)]
    shape = lambda r: sum(share * jv(0, k * r) / abs(jv(1, k)) for share, k in parts)
    modes.append((omega / (2 * pi * PITCH), product(shape), radiation(parts, 0, omega)))
case("timpani", {"frequency": PITCH, "count": 24}, "mylar", modes, PITCH, 1e-6)

# Plates
ASPECT = sqrt(2) * 1.1
number = lambda m, n: m * m + (ASPECT * n) ** 2
half_waves = lambda n: sin(n * pi * STRUCK) * sin(n * pi * HEARD)
plate = sorted((number(m, n), m, n) for m in range(1, 20) for n in range(1, 20))[:30]
Y = [0.3, 0.45]
case(
    "plate",
    {"aspect": ASPECT, "strike_y": Y[0], "pickup_y": Y[1]},
    "steel",
    [(k / plate[0][0], 4 * half_waves(m) * sin(n * pi * Y[0]) * sin(n * pi * Y[1]), 0) for k, m, n in plate],
)

# A free plate, by Rayleigh's quotient with the integrals taken numerically instead of from Warburton's table
def line(m):
    """a shape along one side, and the integrals of X''², X X'' and X'²"""
    if m == 0:
        return (lambda x: 1.0), 0.0, 0.0, 0.0
    if m == 1:
        return (lambda x: sqrt(3) * (1 - 2 * x)), 0.0, 0.0, 12.0
    b = free_beta[m - 2]
    s = (cosh(b) - cos(b)) / (sinh(b) - sin(b))
    x0 = lambda x: cosh(b * x) + cos(b * x) - s * (sinh(b * x) + sin(b * x))
    x1 = lambda x: b * (sinh(b * x) - sin(b * x) - s * (cosh(b * x) + cos(b * x)))
    x2 = lambda x: b * b * (cosh(b * x) - cos(b * x) - s * (sinh(b * x) - sin(b * x)))
    n2 = quad(lambda x: x0(x) ** 2, 0, 1)[0]
    of = lambda f: quad(f, 0, 1, limit=200)[0] / n2
    return (lambda x: x0(x) / sqrt(n2)), of(lambda x: x2(x) ** 2), of(lambda x: x0(x) * x2(x)), of(lambda x: x1(x) ** 2)


linesets = [line(m) for m in range(7)]
nu, a2 = NU["steel"], ASPECT**2
free_plate = []
for m, (along, bend_x, mixed_x, slope_x) in enumerate(linesets):
    for n, (aside, bend_y, mixed_y, slope_y) in enumerate(linesets):
        value = bend_x + a2 * a2 * bend_y + 2 * a2 * (nu * mixed_x * mixed_y + (1 - nu) * slope_x * slope_y)
        if value > 1:
            shape = product(along) * aside(Y[0]) * aside(Y[1])
            free_plate.append((sqrt(value), shape, 0))
free_plate = sorted(free_plate, key=lambda mode: mode[0])[:16]
case(
    "free_plate",
    {"aspect": ASPECT, "strike_y": Y[0], "pickup_y": Y[1]},
    "steel",
    [(value / free_plate[0][0], shape, 0) for value, shape, _ in free_plate],
    tolerance=1e-3,
)

# Discs: the moment and shear of J_n(l r) + c I_n(l r) at the rim as a determinant
nu = NU["bronze"]


def rim(n, l, edge):
    out = []
    for f, d, sign in [(jv, jvp, 1), (iv, ivp, -1)]:
        # The Laplacian of J_n is -l² J_n, that of I_n is l² I_n.
        value, slope = f(n, l), l * d(n, l, 1)
        moment = -sign * l * l * value - (1 - nu) * (slope - n * n * value)
        shear = -sign * l * l * slope - (1 - nu) * n * n * (slope - value)
        out.append((value, moment) if edge == "supported" else (moment, shear))
    return out


def disc(edge):
    found = []
    for n in range(14):
        f = lambda l: np.linalg.det(np.array(rim(n, l, edge)) / np.array([[1], [iv(n, l)]]))
        grid = np.arange(max(1.0, 0.9 * n), 16.0, 0.05)
        signs = [f(l) for l in grid]
        for left, right, a, b in zip(grid, grid[1:], signs, signs[1:]):
            if a * b < 0:
                l = brentq(f, left, right, xtol=1e-13)
                (j, _), (i, _) = rim(n, l, edge)
                shape = lambda r: jv(n, l * r) - j / i * iv(n, l * r)
                found.append((l, round_product(shape, n)))
    found = sorted(found)[:32]
    return [(l * l / found[0][0] ** 2, shape, 0) for l, shape in found]


case("disc", {}, "bronze", disc("supported"))
case("free_disc", {}, "bronze", disc("free"))

# Bells, bowls and glasses
ring = lambda n: n * (n * n - 1) / sqrt(n * n + 1)
turned = lambda m: cos(2 * pi * m * TURN)
hand = [(1 if m == 2 else 3 * ring(m) / ring(3), 2 * turned(m), 0) for m in range(2, 12)]
case("hand_bell", {}, "bronze", hand)
church = [0.5, 1.0, 1.183, 1.506, 2.0, 2.514, 2.662, 3.011, 4.166, 5.433, 6.796, 8.215]
meridians = [2, 2, 3, 3, 4, 4, 2, 5, 6, 7, 8, 9]
case("church_bell", {"count": 12}, "bronze", [(r, 2 * turned(m), 0) for r, m in zip(church, meridians)])


def bowl(s):
    half = lambda phi: tan(phi / 2) ** (2 * s)
    bending = quad(lambda p: half(p) / sin(p) ** 3, 0, pi / 2)[0]
    moving = quad(lambda p: ((s + cos(p)) ** 2 + 2 * sin(p) ** 2) * half(p) * sin(p), 0, pi / 2)[0]
    out = lambda x: (s + cos(pi / 2 * x)) * tan(pi / 4 * x) ** s
    return (s**3 - s) * sqrt(bending / moving), product(out) * 2 / moving * turned(s), 0


bowls = [bowl(s) for s in range(2, 14)]
AT = {"strike": STRUCK, "pickup": HEARD}
case("bowl", AT, "bronze", [(omega / bowls[0][0], shape, 0) for omega, shape, _ in bowls], tolerance=1e-5)

SLENDER = 1.7
glass = []
for n in range(2, 30):
    for b in tine_beta:
        omega = sqrt(((n * n - 1) ** 2 + (b / SLENDER) ** 4) / (1 + 1 / n**2))
        # The wall moves out, and round by 1/n of that.
        glass.append((omega, 2 / (1 + 1 / n**2) * product(tine_shape(b)) * turned(n), 0))
glass = sorted(glass)[:20]
case("glass", {"slenderness": SLENDER, **AT}, "glass", [(omega / glass[0][0], shape, 0) for omega, shape, _ in glass])

# Tubes
case("open_tube", {}, "air", [(n, 2 * half_waves(n), 0) for n in range(1, 10)])
odd = lambda n: 2 * cos((n - 0.5) * pi * STRUCK) * cos((n - 0.5) * pi * HEARD)
case("stopped_tube", {}, "air", [(2 * n - 1, odd(n), 0) for n in range(1, 10)])
for t in [0.0, 0.3, 4.0]:
    roots = [n * pi if t == 0 else brentq(lambda u: sin(u) + t * u * cos(u), (n - 0.5) * pi, n * pi) for n in range(1, 10)]
    modes = []
    for u in roots:
        wave = normalised(lambda x: sin(u * (1 - x)) / max(t + x, 1e-12), lambda x: (t + x) ** 2)
        modes.append((u / roots[0], product(wave), 0))
    case("cone", {"truncation": t}, "air", modes)

with open(Path(__file__).with_suffix(".csv"), "w", encoding="utf-8") as out:
    print(f"# SciPy {scipy.__version__}; made by scipy_reference.py", file=out)
    print("model,set,place,ratio,product,t60,tolerance", file=out)
    print("\n".join(lines), file=out)
