"""A ball-screw axis under trapezoid speed strokes, shaped like the public EMPS record: position in, force out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from generators.hand_motion import Motion, from_speed, smooth_wobble
from generators.physics import Force, complete, force
from generators.sensor import fine_factor, noise_of, quantised

BASE: dict[str, dict[str, float]] = {
    "offset": {"level_n": -3.2},
    "coulomb": {"level_n": 20.4, "breakaway_m": 5e-6},
    "viscous": {"coefficient_n_s_per_m": 203.5},
    "inertia": {"inertia_kg": 95.1},
}
PITCH_M = 0.01  # travel per turn of the screw, for the per-turn effects


@dataclass(frozen=True)
class AxisRun:
    """What was recorded, and the truth behind it at the sample times (clean force without noise, with delay)."""

    time_s: np.ndarray
    position_m: np.ndarray
    force_n: np.ndarray
    load_n: np.ndarray | None
    true_position_m: np.ndarray
    true_speed_m_s: np.ndarray
    clean_force_n: np.ndarray
    motion: Motion
    force: Force


def trapezoid_speed(distance: float, top: float, ramp_s: float, step_s: float) -> np.ndarray:
    """Speed over one movement from rest to rest: ramp, plateau, ramp; a triangle where the way is short."""
    ramp_s = min(ramp_s, distance / top)
    ramp = max(2, round(ramp_s / step_s))
    plateau = max(0, round((distance / top - ramp_s) / step_s))
    up = np.arange(1, ramp + 1) / ramp
    shape = np.concatenate([[0.0], up, np.ones(plateau), up[-2::-1], [0.0]])
    return shape * (distance / (step_s * float(np.sum(shape))))


def trapezoid_motion(
    rng: np.random.Generator,
    *,
    step_s: float = 2e-4,
    range_m: float = 0.246,
    speeds_m_s: tuple[float, float] = (0.04, 0.13),
    ramp_s: tuple[float, float] = (0.08, 0.16),
    strokes: int = 8,
    duration_s: float | None = None,
    stops_per_stroke: tuple[int, int] = (1, 3),
    dwell_s: tuple[float, float] = (0.01, 0.05),
    corner_s: float = 0.015,
) -> Motion:
    """Strokes over the whole range, each in a few movements of their own speed; corners rounded over `corner_s`."""

    def rest(low_s: float, high_s: float) -> np.ndarray:
        return np.zeros(max(2, round(rng.uniform(low_s, high_s) / step_s)))

    window = np.ones(max(1, round(corner_s / step_s)))
    window /= window.size
    pieces = [rest(0.05, 0.1)]
    elapsed_s = 0.0
    done = 0
    while done < strokes if duration_s is None else elapsed_s < duration_s:
        direction = 1.0 if done % 2 == 0 else -1.0
        inner = np.sort(rng.uniform(0.05, 0.95, size=rng.integers(*stops_per_stroke, endpoint=True)))
        for part_m in np.diff(np.concatenate([[0.0], inner, [1.0]])) * range_m:
            # A movement of less than 2 % of the range has no plateau worth the name; it is done slowly.
            top = rng.uniform(*speeds_m_s) if part_m > 0.02 * range_m else speeds_m_s[0]
            speed = trapezoid_speed(part_m, top, rng.uniform(*ramp_s), step_s)
            pieces += [direction * np.convolve(speed, window), rest(*dwell_s)]
        done += 1
        elapsed_s = sum(piece.size for piece in pieces) * step_s
    return from_speed(np.concatenate(pieces), 0.0, step_s)


def simulate_axis_full(
    hidden: Mapping[str, object] | None = None,
    *,
    base: Mapping[str, object] | None = None,
    motion: Mapping[str, object] | Motion | None = None,
    sample_rate_hz: float = 1000.0,
    encoder_m: float = 1e-6,
    noise: str = "50 ms",
    noise_n: float = 1.0,
    wander_n: float = 0.3,
    hum_n: float = 0.1,
    duration_s: float | None = None,
    pitch_m: float = PITCH_M,
    start_state: float = 0.0,
    load_range_n: tuple[float, float] = (100.0, 500.0),
    fine_rate_hz: float = 5000.0,
    seed: int | list[int] = 0,
) -> AxisRun:
    """One run with the truth beside it; see `simulate_axis`."""
    motion_seed, noise_seed, load_seed = np.random.SeedSequence(seed).spawn(3)
    factor = fine_factor(sample_rate_hz, fine_rate_hz)
    step_s = 1.0 / (sample_rate_hz * factor)
    if not isinstance(motion, Motion):
        options = dict(motion or {})
        if duration_s is not None:
            options["duration_s"] = duration_s
        motion = trapezoid_motion(np.random.default_rng(motion_seed), step_s=step_s, **options)
    elif not np.isclose(motion.step_s, step_s, rtol=1e-9):
        raise ValueError(f"the motion has a step of {motion.step_s} s, {step_s} s is needed")
    effects = complete(BASE if base is None else base, axis=True, breakaway=0.5 * encoder_m)
    effects += complete(hidden or {}, axis=True, breakaway=0.5 * encoder_m)
    load = None
    if any(effect == "load" for effect, _ in effects):
        low, high = load_range_n
        wobble = smooth_wobble(motion.time_s, np.random.default_rng(load_seed), (0.05, 0.3))
        load = 0.5 * (low + high) + 0.5 * (high - low) * wobble
    total = force(motion, effects, radians_per_unit=2.0 * np.pi / pitch_m, load=load, start_state=start_state)
    at = np.arange(0, motion.time_s.size, factor)
    time_s = np.arange(at.size) / sample_rate_hz
    clean_n = total.total[at]
    if total.delay_s != 0.0:
        clean_n = np.interp(time_s - total.delay_s, motion.time_s, total.total)
    rng = np.random.default_rng(noise_seed)
    added_n = noise_of(at.size, sample_rate_hz, rng, colour=noise, white=noise_n, wander=wander_n, hum=hum_n)
    return AxisRun(
        time_s=time_s,
        position_m=quantised(motion.position[at], encoder_m),
        force_n=np.round(clean_n + added_n, 4),
        load_n=None if load is None else np.round(load[at], 3),
        true_position_m=motion.position[at],
        true_speed_m_s=motion.speed[at],
        clean_force_n=clean_n,
        motion=motion,
        force=total,
    )


def simulate_axis(
    hidden: Mapping[str, object] | None = None, **options: object
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One run as (time_s, position_m, force_n).

    hidden, base: as for the rig, with n and m in the names (`{"stribeck": {"extra_n": 6.0, "speed_m_s": 0.01}}`,
    `{"inertia": {"inertia_kg": 95.1}}`, see `physics.axis_name`). Per-turn effects use `pitch_m`.
    """
    run = simulate_axis_full(hidden, **options)
    return run.time_s, run.position_m, run.force_n


def simulate_axis_set(
    hidden: Mapping[str, object] | None = None, *, runs: int = 2, seed: int = 0, **options: object
) -> list[AxisRun]:
    """Several runs of one axis: the same parameters, other movements and other noise in each."""
    return [simulate_axis_full(hidden, seed=[seed, number], **options) for number in range(1, runs + 1)]
