"""A friction rig turned by hand: true motion, one friction contact, sensors; the hidden effect is known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from generators.hand_motion import Motion, hand_motion, smooth_wobble
from generators.physics import Force, complete, force
from generators.sensor import fine_factor, noise_of, quantised

BASE: dict[str, dict[str, float]] = {
    "offset": {"level_nm": 0.03},
    "coulomb": {"level_nm": 0.75},
    "viscous": {"coefficient_nm_s_per_rad": 0.35},
}


@dataclass(frozen=True)
class RigRun:
    """What was recorded, and the truth behind it at the sample times (clean torque without noise, with delay)."""

    time_s: np.ndarray
    angle_rad: np.ndarray
    torque_nm: np.ndarray
    load_n: np.ndarray | None
    true_angle_rad: np.ndarray
    true_speed_rad_s: np.ndarray
    clean_torque_nm: np.ndarray
    in_gap: np.ndarray
    motion: Motion
    force: Force


def simulate_rig_full(
    hidden: Mapping[str, object] | None = None,
    *,
    base: Mapping[str, object] | None = None,
    motion: Mapping[str, object] | Motion | None = None,
    sample_rate_hz: float = 500.0,
    encoder_deg: float = 0.02,
    noise: str = "0.5 s",
    noise_nm: float = 0.05,
    wander_nm: float = 0.01,
    hum_nm: float = 0.01,
    duration_s: float | None = None,
    start_state: float = 0.0,
    load_range_n: tuple[float, float] = (2.0, 10.0),
    fine_rate_hz: float = 5000.0,
    seed: int | list[int] = 0,
) -> RigRun:
    """One run with the truth beside it; see `simulate_rig`."""
    motion_seed, noise_seed, load_seed = np.random.SeedSequence(seed).spawn(3)
    factor = fine_factor(sample_rate_hz, fine_rate_hz)
    step_s = 1.0 / (sample_rate_hz * factor)
    if not isinstance(motion, Motion):
        options = dict(motion or {})
        if duration_s is not None:
            options["duration_s"] = duration_s
        motion = hand_motion(np.random.default_rng(motion_seed), step_s=step_s, **options)
    elif not np.isclose(motion.step_s, step_s, rtol=1e-9):
        raise ValueError(f"the motion has a step of {motion.step_s} s, {step_s} s is needed")
    half_step_rad = 0.5 * np.deg2rad(encoder_deg)
    effects = complete(BASE if base is None else base, breakaway=half_step_rad)
    effects += complete(hidden or {}, breakaway=half_step_rad)
    load = None
    if any(effect == "load" for effect, _ in effects):
        low, high = load_range_n
        wobble = smooth_wobble(motion.time_s, np.random.default_rng(load_seed), (0.02, 0.15))
        load = 0.5 * (low + high) + 0.5 * (high - low) * wobble
    torque = force(motion, effects, load=load, start_state=start_state)
    at = np.arange(0, motion.time_s.size, factor)
    time_s = np.arange(at.size) / sample_rate_hz
    clean_nm = torque.total[at]
    if torque.delay_s != 0.0:
        clean_nm = np.interp(time_s - torque.delay_s, motion.time_s, torque.total)
    rng = np.random.default_rng(noise_seed)
    added_nm = noise_of(at.size, sample_rate_hz, rng, colour=noise, white=noise_nm, wander=wander_nm, hum=hum_nm)
    return RigRun(
        time_s=time_s,
        angle_rad=np.deg2rad(quantised(np.rad2deg(motion.position[at]), encoder_deg)),
        torque_nm=np.round(clean_nm + added_nm, 4),
        load_n=None if load is None else np.round(load[at], 3),
        true_angle_rad=motion.position[at],
        true_speed_rad_s=motion.speed[at],
        clean_torque_nm=clean_nm,
        in_gap=torque.in_gap[at],
        motion=motion,
        force=torque,
    )


def simulate_rig(
    hidden: Mapping[str, object] | None = None, **options: object
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One run as (time_s, angle_rad, torque_nm).

    hidden: effect -> parameters as in the interface (`{"stribeck": {"extra_nm": 0.35, "speed_rad_s": 0.08}}`);
    a list of parameter sets for several of one kind. Effects outside the catalogue: see `physics.OUTSIDE`.
    base: offset, coulomb and viscous under it (default `BASE`). motion: options of `hand_motion`, or a `Motion`.
    noise: "white", "50 ms" or "0.5 s" (time constant of the wander of `wander_nm`; white noise of `noise_nm` always).
    The motion and the noise come from separate streams of `seed`: the same seed gives the same hand whatever is hidden.
    """
    run = simulate_rig_full(hidden, **options)
    return run.time_s, run.angle_rad, run.torque_nm


def simulate_rig_with_load(
    hidden: Mapping[str, object], **options: object
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """One run as (time_s, angle_rad, torque_nm, load_n); `hidden` must hold the effect `load`."""
    run = simulate_rig_full(hidden, **options)
    if run.load_n is None:
        raise ValueError("no load effect is hidden")
    return run.time_s, run.angle_rad, run.torque_nm, run.load_n


def simulate_rig_set(
    hidden: Mapping[str, object] | None = None, *, runs: int = 3, seed: int = 0, **options: object
) -> list[RigRun]:
    """Several runs of one rig: the same parameters, another hand and other noise in each."""
    return [simulate_rig_full(hidden, seed=[seed, number], **options) for number in range(1, runs + 1)]
