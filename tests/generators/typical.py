"""One table of typical effect sizes, and random draws around it for calibration loops.

for effect in RIG: for size in (1.0, 0.3, 0.1):
    hidden, base = draw(effect, size, rng)
    runs = simulate_rig_set(hidden, base=base, seed=seed, noise="50 ms", **needs(effect))
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from generators.physics import CATALOGUE, OUTSIDE, axis_name


@dataclass(frozen=True)
class Typical:
    """Size factor 1 of an effect.

    sized: parameters that grow with the size factor. inner: parameters that only say where, how fast or how wide.
    either_sign: the sized parameters may be negative. fixed: set as they stand.
    uniform: drawn between two values.
    """

    sized: dict[str, float]
    inner: dict[str, float] = field(default_factory=dict)
    uniform: dict[str, tuple[float, float]] = field(default_factory=dict)
    fixed: dict[str, object] = field(default_factory=dict)
    either_sign: bool = False


_PHASE = {"phase_rad": (0.0, 2.0 * np.pi)}

RIG: dict[str, Typical] = {
    "offset": Typical({"level_nm": 0.15}, either_sign=True),  # on top of the base
    "asymmetric_coulomb": Typical({"difference_nm": 0.15}, either_sign=True),
    "asymmetric_viscous": Typical({"difference_nm_s_per_rad": 0.36}, either_sign=True),
    "drag": Typical({"coefficient_nm_s2_per_rad2": 1.1}),
    "stribeck": Typical({"extra_nm": 0.36}, {"speed_rad_s": 0.08}),
    "stiction": Typical({"extra_nm": 0.36}),
    "presliding": Typical({"breakaway_rad": 0.037}, fixed={"shape": "exponential"}),
    "freeplay": Typical({"gap_rad": 0.06}),
    "dead_zone": Typical({"stiffness_nm_per_rad": 0.6}, {"half_width_rad": 0.4}),
    "stiffness": Typical({"stiffness_nm_per_rad": 0.19}),
    "hardening": Typical({"coefficient_nm_per_rad3": 0.27}, either_sign=True),
    # Strokes end beyond 54 degrees = 0.94 rad, so the stop is met in each of them.
    "end_stop": Typical({"stiffness_nm_per_rad": 4.0}, uniform={"limit_rad": (0.80, 0.90)}),
    "inertia": Typical({"inertia_kg_m2": 0.12}),
    "once_per_rev": Typical({"amplitude_nm": 0.2}, uniform=_PHASE),
    "twice_per_rev": Typical({"amplitude_nm": 0.2}, uniform=_PHASE),
    "cogging": Typical({"amplitude_nm": 0.2}, uniform=_PHASE, fixed={"per_turn": (3, 4, 5, 6, 8)}),
    "position_coulomb": Typical({"slope_nm_per_rad": 0.25}, either_sign=True),
    "tight_spot": Typical({"extra_nm": 0.35}, {"width_rad": 0.1}, {"angle_rad": (-0.6, 0.6)}),
    "load": Typical({"coefficient": 0.05}),  # Nm per N with a load of 2 to 10 N
    "delay": Typical({"time_s": 0.04}),
    "warmup": Typical({"extra_nm": 0.35}, {"time_s": 12.0}),
    "drift": Typical({"rate_nm_per_s": 0.018}, either_sign=True),
    "dwell": Typical({"extra_nm": 0.4}, {"time_s": 0.4}),
}
RIG_OUTSIDE: dict[str, Typical] = {
    "torque_step": Typical({"amplitude_nm": 0.2}, {"width_rad": 0.01}, {"angle_rad": (-0.5, 0.5)}, either_sign=True),
    "torque_bump": Typical({"amplitude_nm": 0.3}, {"width_rad": 0.1}, {"angle_rad": (-0.5, 0.5)}, either_sign=True),
    "time_sine": Typical({"amplitude_nm": 0.1}, uniform={"frequency_hz": (0.7, 1.7), **_PHASE}),
    # More than once per turn: otherwise it is x * speed within a narrow window.
    "odd_product": Typical({"coefficient_nm_s_per_rad": 0.4}, uniform=_PHASE, fixed={"per_turn": 3.0}),
}
AXIS: dict[str, Typical] = {
    "asymmetric_viscous": Typical({"difference_nm_s_per_rad": 37.0}, either_sign=True),
    "drag": Typical({"coefficient_nm_s2_per_rad2": 800.0}),
    "stribeck": Typical({"extra_nm": 6.0}, {"speed_rad_s": 0.01}),
    "presliding": Typical({"breakaway_rad": 5e-4}, fixed={"shape": "exponential"}),
    "freeplay": Typical({"gap_rad": 5e-4}),
    "stiffness": Typical({"stiffness_nm_per_rad": 30.0}),
    "once_per_rev": Typical({"amplitude_nm": 3.0}, uniform=_PHASE),
    "position_coulomb": Typical({"slope_nm_per_rad": 25.0}, either_sign=True),
    "tight_spot": Typical({"extra_nm": 6.0}, {"width_rad": 0.01}, {"angle_rad": (0.05, 0.2)}),
    "delay": Typical({"time_s": 0.003}),
    "lead": Typical({"time_s": 0.002}),
    "warmup": Typical({"extra_nm": 6.0}, {"time_s": 8.0}),
    "drift": Typical({"rate_nm_per_s": 0.25}, either_sign=True),
}
_SPREAD = 1.25  # sized and inner parameters lie within a factor of this around the table


def _draw_one(typical: Typical, size: float, rng: np.random.Generator, *, axis: bool) -> dict[str, object]:
    def around(value: float) -> float:
        return float(value * _SPREAD ** rng.uniform(-1.0, 1.0))

    sign = float(rng.choice([-1.0, 1.0])) if typical.either_sign else 1.0
    parameters: dict[str, object] = {name: sign * size * around(value) for name, value in typical.sized.items()}
    parameters |= {name: around(value) for name, value in typical.inner.items()}
    parameters |= {name: float(rng.uniform(*limits)) for name, limits in typical.uniform.items()}
    for name, value in typical.fixed.items():
        parameters[name] = int(rng.choice(value)) if isinstance(value, tuple) else value
    return {axis_name(name) if axis else name: value for name, value in parameters.items()}


def draw_base(rng: np.random.Generator, *, structure: str = "rig") -> dict[str, dict[str, float]]:
    """A random sound rig or axis."""
    if structure == "rig":
        return {
            "offset": {"level_nm": float(rng.uniform(-0.1, 0.1))},
            "coulomb": {"level_nm": float(rng.uniform(0.55, 0.95))},
            "viscous": {"coefficient_nm_s_per_rad": float(rng.uniform(0.15, 0.5))},
        }
    return {
        "offset": {"level_n": float(rng.uniform(-4.0, 4.0))},
        "coulomb": {"level_n": float(rng.uniform(15.0, 25.0)), "breakaway_m": 5e-6},
        "viscous": {"coefficient_n_s_per_m": float(rng.uniform(150.0, 260.0))},
        "inertia": {"inertia_kg": float(rng.uniform(80.0, 110.0))},
    }


def draw(
    effect: str | tuple[str, ...] | None, size: float, rng: np.random.Generator, *, structure: str = "rig"
) -> tuple[dict[str, dict[str, object]], dict[str, dict[str, float]]]:
    """(hidden, base) at a size factor. effect: one name, several, or None for nothing hidden."""
    table = RIG | RIG_OUTSIDE if structure == "rig" else AXIS
    base = draw_base(rng, structure=structure)
    names = () if effect is None else (effect,) if isinstance(effect, str) else effect
    hidden = {}
    for name in names:
        if name not in table:
            raise ValueError(f"no typical size of {name!r} for {structure}; known: {', '.join(table)}")
        hidden[name] = _draw_one(table[name], size, rng, axis=structure == "axis")
    return hidden, base


def needs(effect: str | None) -> dict[str, object]:
    """Options of `simulate_rig` under which an effect shows at all in a narrow window."""
    if effect in ("stiction", "dwell"):
        # A break-away is over in a few samples unless the hand starts slowly; more dwells, of different length.
        return {"motion": {"slow_breakaway": True, "dwell_s": (0.15, 2.5)}}
    return {}


assert set(RIG) | {"coulomb", "viscous", "lead"} == set(CATALOGUE)  # a lead is looked for on an axis only
assert set(RIG_OUTSIDE) == set(OUTSIDE)
