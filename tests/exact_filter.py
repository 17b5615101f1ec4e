"""The exact forward Butterworth filter: textbook sections in 320-bit fixed point, sharing no formula with luztar.

The library works with state-variable sections in doubles; here the poles are placed in the s plane, taken to z by the
bilinear transform with mpmath, and the direct-form recursion runs in Python integers.
"""

from __future__ import annotations

import mpmath
import numpy as np

# A direct form at fc/fs = 1e-7 amplifies rounding by 1e14 per section: 320 bits leave more than 60 digits.
BITS = 320


def _fixed(value: mpmath.mpf) -> int:
    return int(mpmath.nint(mpmath.ldexp(value, BITS)))


def sections(poles: int, cutoff_hz: float, sample_rate_hz: float) -> list[tuple[list[int], list[int]]]:
    """Return numerator and denominator of each section as fixed-point integers."""
    found = []
    with mpmath.workprec(BITS + 64):
        warp = mpmath.tan(mpmath.pi * mpmath.mpf(cutoff_hz) / mpmath.mpf(sample_rate_hz))
        for i in range(poles // 2):
            s = warp * mpmath.expjpi(mpmath.mpf(2 * i + 1 + poles) / (2 * poles))
            z = (1 + s) / (1 - s)
            a1, a2 = -2 * z.real, abs(z) ** 2
            b0 = (1 + a1 + a2) / 4
            found.append(([_fixed(b0), _fixed(2 * b0), _fixed(b0)], [_fixed(a1), _fixed(a2)]))
        if poles % 2:
            z = (1 - warp) / (1 + warp)
            b0 = (1 - z) / 2
            found.append(([_fixed(b0), _fixed(b0), 0], [_fixed(-z), 0]))
    return found


def band_sections(
    kind: str, poles: int, low_hz: float, high_hz: float, sample_rate_hz: float
) -> list[tuple[list[int], list[int]]]:
    """Return the sections of a high pass (``low_hz``), band pass or band stop, from its poles in the s plane."""
    found = []
    with mpmath.workprec(BITS + 64):
        low = mpmath.tan(mpmath.pi * mpmath.mpf(low_hz) / mpmath.mpf(sample_rate_hz))
        order = poles if kind == "high" else poles // 2
        prototype = [mpmath.expjpi(mpmath.mpf(2 * i + 1 + order) / (2 * order)) for i in range(order)]
        if kind == "high":
            s_poles, zero = [low / p for p in prototype], mpmath.mpf(0)
        else:
            high = mpmath.tan(mpmath.pi * mpmath.mpf(high_hz) / mpmath.mpf(sample_rate_hz))
            width, middle = high - low, low * high
            halves = [(p if kind == "pass" else 1 / p) * width / 2 for p in prototype]
            s_poles = [h + sign * mpmath.sqrt(h * h - middle) for h in halves for sign in (1, -1)]
            zero = mpmath.sqrt(middle)
        real = sorted((s for s in s_poles if abs(s.imag) < mpmath.mpf(10) ** -80 * abs(s)), key=lambda s: s.real)
        pairs = [(s, mpmath.conj(s)) for s in s_poles if s.imag > 0 and s not in real]
        pairs += [(a, b) for a, b in zip(real[::2], real[1::2], strict=False)]
        for a, b in pairs:
            # numerators in s: s^2, s width, s^2 + middle; (a0 + a1 s + a2 s^2) by s = (1 - 1/z) / (1 + 1/z)
            total, product = -(a + b).real, (a * b).real
            n2, n1, n0 = {"high": (1, 0, 0), "pass": (0, width if kind == "pass" else 0, 0), "stop": (1, 0, zero**2)}[
                kind
            ]
            found.append(_bilinear((n0, n1, n2), (product, total, 1)))
        if len(real) % 2:
            found.append(_bilinear((0, 1, 0), (-real[-1].real, 1, 0)))
    return found


def _bilinear(above: tuple, below: tuple) -> tuple[list[int], list[int]]:
    """Return the section of two quadratics in s, constant first."""

    def in_z(c0, c1, c2):
        return [c0 + c1 + c2, 2 * (c0 - c2), c0 - c1 + c2]

    b, a = in_z(*above), in_z(*below)
    if below[2] == 0:  # one real pole: both have the factor 1 + 1/z
        b, a = [above[0] + above[1], above[0] - above[1], mpmath.mpf(0)], [below[0] + below[1], below[0] - below[1], 0]
    return [_fixed(v / a[0]) for v in b], [_fixed(mpmath.mpf(v) / a[0]) for v in a[1:]]


def _integer(value: float) -> int:
    numerator, denominator = float(value).as_integer_ratio()
    return (numerator << BITS) // denominator


def forward(x: np.ndarray, level: float, poles: int, cutoff_hz: float, sample_rate_hz: float) -> np.ndarray:
    """Filter ``x``, settled at ``level`` before the first sample, each result rounded to the nearest double."""
    return run(sections(poles, cutoff_hz, sample_rate_hz), x, level, level)


def run(parts: list[tuple[list[int], list[int]]], x: np.ndarray, level: float, lift: float) -> np.ndarray:
    """Filter ``x - level`` from rest, add ``lift``, each result rounded to the nearest double."""
    start, end = _integer(level), _integer(lift)
    signal = [_integer(v) - start for v in x]
    for (b0, b1, b2), (a1, a2) in parts:
        x1 = x2 = y1 = y2 = 0
        for i, v in enumerate(signal):
            y = (b0 * v + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2) >> BITS
            x2, x1, y2, y1 = x1, v, y1, y
            signal[i] = y
    return np.array([(v + end) / (1 << BITS) for v in signal])
