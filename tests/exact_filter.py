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


def _integer(value: float) -> int:
    numerator, denominator = float(value).as_integer_ratio()
    return (numerator << BITS) // denominator


def forward(x: np.ndarray, level: float, poles: int, cutoff_hz: float, sample_rate_hz: float) -> np.ndarray:
    """Filter ``x``, settled at ``level`` before the first sample, each result rounded to the nearest double."""
    start = _integer(level)
    signal = [_integer(v) - start for v in x]
    for (b0, b1, b2), (a1, a2) in sections(poles, cutoff_hz, sample_rate_hz):
        x1 = x2 = y1 = y2 = 0
        for i, v in enumerate(signal):
            y = (b0 * v + b1 * x1 + b2 * x2 - a1 * y1 - a2 * y2) >> BITS
            x2, x1, y2, y1 = x1, v, y1, y
            signal[i] = y
    return np.array([(v + start) / (1 << BITS) for v in signal])
