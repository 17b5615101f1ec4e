"""Hand-turned friction records with known figures, for the tests of TB 038 alone.

The wheel goes back and forth between two angles at constant speed and rests at each end. Friction opposes the motion;
while the wheel rests, the torque keeps its last value. Everything is an exact formula, so that a figure that comes out
of luztar can be compared with the one that went in.
"""

from __future__ import annotations

import numpy as np

import luztar

RATE_HZ = 500.0


def turning(
    reach_deg: float = 60.0,
    speed_deg_s: float = 20.0,
    crossings: int = 4,
    rate_hz: float = RATE_HZ,
    start_deg: float | None = None,
    rest_s: float = 0.5,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time [s], angle [deg] and the sign of motion for a wheel turned between -reach and +reach.

    The first stroke runs upwards from ``start_deg`` (-reach unless given); the wheel rests at each end.
    """
    first = -reach_deg if start_deg is None else start_deg
    ends = [first, *(reach_deg if k % 2 == 0 else -reach_deg for k in range(crossings))]
    angle = [np.full(round(rest_s * rate_hz), first)]
    sign = [np.full(angle[0].size, 1.0 if ends[1] > ends[0] else -1.0)]
    for a, b in zip(ends[:-1], ends[1:], strict=True):
        n = round(abs(b - a) / speed_deg_s * rate_hz)
        way = float(np.sign(b - a))
        angle += [a + (b - a) * np.arange(1, n + 1) / n, np.full(round(rest_s * rate_hz), b)]
        # Friction keeps its sign while the wheel rests.
        sign += [np.full(n, way), np.full(round(rest_s * rate_hz), way)]
    x = np.concatenate(angle)
    return np.arange(x.size) / rate_hz, x, np.concatenate(sign)


def torque(
    angle_deg: np.ndarray,
    sign: np.ndarray,
    level_nm: float = 0.8,
    offset_nm: float = 0.0,
    noise_nm: float = 0.02,
    seed: int = 0,
    once_per_turn_nm: float = 0.0,
    ripple_nm: float = 0.0,
    slope_nm_per_deg: float = 0.0,
) -> np.ndarray:
    """Return the torque [Nm] of Coulomb friction with what is asked for on top."""
    noise = np.random.default_rng(seed).normal(0.0, 1.0, angle_deg.size) * noise_nm
    x = np.deg2rad(angle_deg)
    # Twelve periods per window of 90 degrees: slow enough at 20 deg/s (2.7 Hz) to pass the 6 Hz filter.
    ripple = ripple_nm * np.sin(48.0 * x)
    return level_nm * sign + offset_nm + noise + once_per_turn_nm * np.sin(x) + ripple + slope_nm_per_deg * angle_deg


def run(seed: int = 1, name: str | None = None, *, motion: dict | None = None, **kinds: float) -> luztar.Run:
    """Return one sound record; ``motion`` goes to :func:`turning`, the rest to :func:`torque`."""
    t, angle, sign = turning(**(motion or {}))
    return as_run(t, angle, torque(angle, sign, seed=seed, **kinds), name or f"run{seed}.csv")


def as_run(t: np.ndarray, angle_deg: np.ndarray, torque_nm: np.ndarray, name: str = "run") -> luztar.Run:
    return luztar.Run(time=t, angle=angle_deg, torque=torque_nm, units={"angle": "deg"}, name=name)


def three(**kinds) -> list[luztar.Run]:
    """Return three records that differ by their noise."""
    return [run(seed, **kinds) for seed in (1, 2, 3)]


def write_csv(path, t, angle_deg, torque_nm, head: str = "time_s,angle_deg,torque_Nm") -> None:
    rows = [f"{a:.4f},{b:.4f},{c:.6f}" for a, b, c in zip(t, angle_deg, torque_nm, strict=True)]
    path.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")
