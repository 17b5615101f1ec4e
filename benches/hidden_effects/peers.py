"""The same records for other programs: PySINDy (sparse regression) and lmfit with BIC (candidates one at a time).

Both get the torque after the same low pass as luztar, at 50 samples per second, only samples that move, and every
regressor through the same low pass, for that is what a careful user would give them.
"""

from __future__ import annotations

import importlib.util
import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.signal import butter, sosfiltfilt

from .cases import Measured

BAND_HZ, ANGLE_BAND_HZ, RATE_HZ, EVERY = 6.0, 20.0, 100.0, 2
LEAST_SPEED_RAD_S = math.radians(3.0)
REST_SPEED_RAD_S = math.radians(0.3)
THRESHOLD = 0.1  # PySINDy's own default for STLSQ
VERY_STRONG = -10.0  # difference of BIC, Kass and Raftery 1995
PROGRAMS = {"PySINDy": "pysindy", "lmfit + BIC": "lmfit"}


def installed(program: str) -> bool:
    """Whether a peer can be imported here."""
    return importlib.util.find_spec(PROGRAMS[program]) is not None


@dataclass(frozen=True)
class Samples:
    """One run at the rate of the regressors, rest included: effects with memory and filters need all of it."""

    time_s: np.ndarray
    angle: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    torque: np.ndarray

    @property
    def moving(self) -> np.ndarray:
        """Samples above the least speed."""
        return np.abs(self.speed) > LEAST_SPEED_RAD_S


_LOW_PASS = butter(4, BAND_HZ, fs=RATE_HZ, output="sos")


def kept(runs: list[Samples], column: Callable[[Samples], np.ndarray], *, smooth: bool = True) -> np.ndarray:
    """Return a column of all runs as it is compared: filtered, thinned out, moving."""
    made = [sosfiltfilt(_LOW_PASS, column(r)) if smooth else column(r) for r in runs]
    return np.concatenate([c[::EVERY][r.moving[::EVERY]] for c, r in zip(made, runs, strict=True)])


def samples(measured: Measured) -> list[Samples]:
    """Filter and thin out the runs of a case."""
    out = []
    for r in measured.raw:
        rate = 1.0 / (r.time_s[1] - r.time_s[0])
        torque = sosfiltfilt(butter(4, BAND_HZ, fs=rate, output="sos"), r.torque_nm)
        angle = sosfiltfilt(butter(4, ANGLE_BAND_HZ, fs=rate, output="sos"), r.angle_rad)
        speed = np.gradient(angle, 1.0 / rate)
        acceleration = np.gradient(speed, 1.0 / rate)
        every = slice(None, None, max(1, round(rate / RATE_HZ)))
        out.append(Samples(r.time_s[every], angle[every], speed[every], acceleration[every], torque[every]))
    return out


def look(measured: Measured) -> dict[str, Any]:
    """Return what each peer finds beside offset, Coulomb and viscous friction."""
    runs = samples(measured)
    found: dict[str, Any] = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if installed("PySINDy"):
            found["PySINDy"] = pysindy_terms(runs)
        if installed("lmfit + BIC"):
            found["lmfit + BIC"] = lmfit_best(runs)
    return found


# --- PySINDy ---

LIBRARY: dict[str, tuple[Callable[[np.ndarray, np.ndarray], np.ndarray], str | None]] = {
    "1": (lambda x, v: np.ones_like(x), None),
    "sign v": (lambda x, v: np.sign(v), None),
    "v": (lambda x, v: v, None),
    "|v|": (lambda x, v: np.abs(v), "asymmetric_viscous"),
    "v|v|": (lambda x, v: v * np.abs(v), "drag"),
    "x": (lambda x, v: x, "stiffness"),
    "x^3": (lambda x, v: x**3, "hardening"),
    "sin x": (lambda x, v: np.sin(x), "once_per_rev"),
    "cos x": (lambda x, v: np.cos(x), "once_per_rev"),
    "exp(-(v/0.1)^2) sign v": (lambda x, v: np.exp(-((v / 0.1) ** 2)) * np.sign(v), "stribeck"),
}
IN_LIBRARY = tuple(dict.fromkeys(e for _, e in LIBRARY.values() if e))


def pysindy_terms(runs: list[Samples]) -> list[str]:
    """Return the effects whose terms sparse regression keeps beside the base."""
    from pysindy.optimizers import STLSQ

    table = np.column_stack([kept(runs, lambda r, make=make: make(r.angle, r.speed)) for make, _ in LIBRARY.values()])
    torque = kept(runs, lambda r: r.torque, smooth=False)
    used = np.abs(np.ravel(STLSQ(threshold=THRESHOLD).fit(table, torque[:, None]).coef_)) > 0.0
    named = [effect for (_, effect), k in zip(LIBRARY.values(), used, strict=True) if k and effect]
    return list(dict.fromkeys(named))


# --- lmfit ---

Column = Callable[..., np.ndarray]


def _stop(x: np.ndarray, reach: float) -> np.ndarray:
    """Friction state that follows the travel up to 1: the stop operator, from 0."""
    state = np.empty_like(x)
    s = state[0] = 0.0
    for i, dx in enumerate(np.diff(x) / max(reach, 1e-6), start=1):
        s = min(1.0, max(-1.0, s + dx))
        state[i] = s
    return state


def _dahl(r: Samples, breakaway: float) -> np.ndarray:
    state = np.empty_like(r.angle)
    s = state[0] = 0.0
    for i, dx in enumerate(np.diff(r.angle) / max(breakaway, 1e-4), start=1):
        way = 1.0 if dx > 0 else -1.0
        s = way - (way - s) * math.exp(-abs(dx))
        state[i] = s
    return state - _sign(r)


def _gap(r: Samples, width: float) -> np.ndarray:
    """Return what a gap takes off Coulomb friction: all of it while the gap is open."""
    open_ = np.abs(_stop(r.angle, 0.5 * max(width, 1e-3))) < 0.999
    return -_sign(r) * open_


def _bell(x: np.ndarray, at: float, width: float) -> np.ndarray:
    return np.exp(-0.5 * ((x - at) / width) ** 2)


def _beyond(x: np.ndarray, reach: float) -> np.ndarray:
    return np.sign(x) * np.maximum(np.abs(x) - reach, 0.0)


def _wave(per_turn: int) -> tuple[Column, Column]:
    return lambda r: np.sin(per_turn * r.angle), lambda r: np.cos(per_turn * r.angle)


# name -> (columns, inner parameters with start and bounds)
CANDIDATES: dict[str, tuple[tuple[Column, ...], dict[str, tuple[float, float, float]]]] = {
    "asymmetric_viscous": ((lambda r: np.abs(r.speed),), {}),
    "drag": ((lambda r: r.speed * np.abs(r.speed),), {}),
    "stribeck": ((lambda r, v: np.exp(-((r.speed / v) ** 2)) * np.sign(r.speed),), {"v": (0.15, 0.01, 1.0)}),
    "stiffness": ((lambda r: r.angle,), {}),
    "hardening": ((lambda r: r.angle**3,), {}),
    "dead_zone": ((lambda r, h: _beyond(r.angle, h),), {"h": (0.3, 0.05, 0.7)}),
    "end_stop": ((lambda r, h: _beyond(r.angle, h),), {"h": (0.8, 0.7, 1.1)}),
    "inertia": ((lambda r: r.acceleration,), {}),
    "once_per_rev": (_wave(1), {}),
    "twice_per_rev": (_wave(2), {}),
    **{f"cogging {n}": (_wave(n), {}) for n in (3, 4, 5, 6, 8)},
    "position_coulomb": ((lambda r: r.angle * np.sign(r.speed),), {}),
    "tight_spot": (
        (lambda r, at, w: _bell(r.angle, at, w) * np.sign(r.speed),),
        {"at": (0.0, -1.0, 1.0), "w": (0.15, 0.02, 0.5)},
    ),
    "warmup": ((lambda r, tau: np.exp(-r.time_s / tau) * np.sign(r.speed),), {"tau": (8.0, 1.0, 60.0)}),
    "drift": ((lambda r: r.time_s,), {}),
    "delay": ((lambda r: np.gradient(r.torque, 1.0 / RATE_HZ),), {}),
    "presliding": ((_dahl,), {"breakaway": (0.02, 0.001, 0.3)}),
    "freeplay": ((_gap,), {"width": (0.03, 0.002, 0.3)}),
}


def lmfit_best(runs: list[Samples]) -> list[str]:
    """Return the candidate with the lowest BIC where the evidence is very strong, else nothing."""
    import lmfit

    torque = kept(runs, lambda r: r.torque, smooth=False)
    base = np.column_stack([kept(runs, f) for f in (lambda r: np.ones_like(r.angle), _sign, _speed)])
    best, least = "", VERY_STRONG
    reference = _bic(torque - base @ np.linalg.lstsq(base, torque, rcond=None)[0], base.shape[1])
    for name, (columns, inner) in CANDIDATES.items():

        def left(given: lmfit.Parameters, columns: tuple[Column, ...] = columns) -> np.ndarray:
            values = {k: p.value for k, p in given.items()}
            more = [kept(runs, lambda r, c=c: c(r, **values)) for c in columns]
            table = np.column_stack([base, *more])
            # Coefficients enter linearly and are solved for: kinder to the search than leaving them to it.
            return torque - table @ np.linalg.lstsq(table, torque, rcond=None)[0]

        parameters = lmfit.Parameters()
        for key, (start, low, high) in inner.items():
            parameters.add(key, start, min=low, max=high)
        rest = lmfit.minimize(left, parameters).residual if inner else left(parameters)
        difference = _bic(rest, base.shape[1] + len(columns) + len(inner)) - reference
        if difference < least:
            best, least = name.partition(" ")[0], difference
    return [best] if best else []


def _sign(r: Samples) -> np.ndarray:
    """Return the direction of the last motion: friction at rest holds its torque."""
    way = np.sign(np.where(np.abs(r.speed) > REST_SPEED_RAD_S, r.speed, 0.0))
    last = np.maximum.accumulate(np.where(way != 0.0, np.arange(way.size), 0))
    return way[last]


def _speed(r: Samples) -> np.ndarray:
    return r.speed


def _bic(residual: np.ndarray, parameters: int) -> float:
    n = residual.size
    return n * math.log(float(residual @ residual) / n) + parameters * math.log(n)
