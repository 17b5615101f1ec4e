"""Force of one friction contact with everything the catalogue (and something outside it) can add, from the true motion.

Motion is split into pieces of one direction. Inside a piece the friction state, the gap and the break-away have closed
forms in the travelled distance, so nothing is stepped through sample by sample.
Parameter names are those of the rig; `axis_name` gives the name of the same parameter on a linear axis.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from generators.hand_motion import Motion

# effect -> parameters; a value of None must be given, everything else is a default
CATALOGUE: dict[str, dict[str, object]] = {
    "offset": {"level_nm": None},
    "coulomb": {"level_nm": None, "breakaway_rad": "half an encoder step"},
    "viscous": {"coefficient_nm_s_per_rad": None},
    "asymmetric_coulomb": {"difference_nm": None},
    "asymmetric_viscous": {"difference_nm_s_per_rad": None},
    "drag": {"coefficient_nm_s2_per_rad2": None},
    "stribeck": {"extra_nm": None, "speed_rad_s": None},
    # at_stop: also when coming to rest, as the limit of stribeck with speed to 0; without it only at break-away.
    "stiction": {"extra_nm": None, "at_stop": True, "stop_speed_rad_s": 0.01, "slip_rad": 0.005},
    "presliding": {"breakaway_rad": None, "shape": "exponential"},
    "freeplay": {"gap_rad": None},
    "dead_zone": {"stiffness_nm_per_rad": None, "half_width_rad": None, "centre_rad": 0.0},
    "stiffness": {"stiffness_nm_per_rad": None},
    "hardening": {"coefficient_nm_per_rad3": None},
    "end_stop": {"stiffness_nm_per_rad": None, "limit_rad": None},
    "inertia": {"inertia_kg_m2": None},
    "once_per_rev": {"amplitude_nm": None, "phase_rad": None},
    "twice_per_rev": {"amplitude_nm": None, "phase_rad": None},
    "cogging": {"amplitude_nm": None, "phase_rad": None, "per_turn": None},
    "position_coulomb": {"slope_nm_per_rad": None},
    "tight_spot": {"extra_nm": None, "angle_rad": None, "width_rad": None},
    "load": {"coefficient": None},
    "delay": {"time_s": None},
    "lead": {"time_s": None},
    "warmup": {"extra_nm": None, "time_s": None},
    "drift": {"rate_nm_per_s": None},
    # slip_rad: distance over which the excess of the static level fades once the contact slides.
    "dwell": {"extra_nm": None, "time_s": None, "slip_rad": 0.005},
}
OUTSIDE: dict[str, dict[str, object]] = {
    "torque_step": {"amplitude_nm": None, "angle_rad": None, "width_rad": 0.01},
    "torque_bump": {"amplitude_nm": None, "angle_rad": None, "width_rad": 0.1},
    "time_sine": {"amplitude_nm": None, "frequency_hz": None, "phase_rad": 0.0},
    "odd_product": {"coefficient_nm_s_per_rad": None, "per_turn": 1.0, "phase_rad": 0.0},
}
_NOT_AN_ANGLE_ON_AN_AXIS = ("phase_rad",)


def axis_name(rig_name: str) -> str:
    """Name of a parameter on an axis: n for nm, m for rad, kg for kg_m2; phases stay angles."""
    if rig_name in _NOT_AN_ANGLE_ON_AN_AXIS:
        return rig_name
    if rig_name == "inertia_kg_m2":
        return "inertia_kg"
    if rig_name == "angle_rad":
        return "position_m"
    swap = {"nm": "n", "rad": "m", "rad2": "m2", "rad3": "m3"}
    return "_".join(swap.get(word, word) for word in rig_name.split("_"))


def complete(
    effects: Mapping[str, object], *, axis: bool = False, breakaway: float
) -> list[tuple[str, dict[str, object]]]:
    """Check names, fill defaults, and return (effect, parameters in rig names). A value may be a list of several."""
    known = CATALOGUE | OUTSIDE
    result = []
    for effect, value in effects.items():
        if effect not in known:
            raise ValueError(f"unknown effect {effect!r}; known: {', '.join(known)}")
        for given in value if isinstance(value, (list, tuple)) else [value]:
            parameters = dict(known[effect])
            to_rig = {axis_name(name) if axis else name: name for name in parameters}
            for name, number in given.items():
                if name not in to_rig:
                    raise ValueError(f"{effect} has no parameter {name!r}; it has {', '.join(to_rig)}")
                parameters[to_rig[name]] = number
            missing = [name for name, number in parameters.items() if number is None]
            if missing:
                raise ValueError(f"{effect} needs {', '.join(missing)}")
            if parameters.get("breakaway_rad") == "half an encoder step":
                parameters["breakaway_rad"] = breakaway
            result.append((effect, parameters))
    return result


@dataclass(frozen=True)
class Force:
    """What the contact and everything in front of it give, at the fine step."""

    total: np.ndarray
    friction: np.ndarray
    behind_gap: np.ndarray
    in_gap: np.ndarray
    delay_s: float


def pieces_of_one_direction(position: np.ndarray) -> list[tuple[int, int, int]]:
    """(first, last, direction) with direction -1, 0 or +1; `last` is the `first` of the next piece."""
    direction = np.sign(np.diff(position)).astype(np.int8)
    edges = np.flatnonzero(np.diff(direction)) + 1
    starts = np.concatenate([[0], edges])
    stops = np.concatenate([edges, [direction.size]])
    return [(int(a), int(b), int(direction[a])) for a, b in zip(starts, stops, strict=True)]


def force(
    motion: Motion,
    effects: list[tuple[str, dict[str, object]]],
    *,
    radians_per_unit: float = 1.0,
    load: np.ndarray | None = None,
    start_state: float = 0.0,
) -> Force:
    """Sum of all effects along a motion.

    start_state: friction state before the first motion, -1 to 1 (0 = nobody has pushed yet).
    """
    t, x, w, a = motion.time_s, motion.position, motion.speed, motion.acceleration
    turn = radians_per_unit * x
    front = np.zeros_like(x)  # before the gap: never interrupted
    flow = np.zeros_like(x)  # behind the gap, by speed
    level = np.zeros_like(x)  # of the one friction state, behind the gap
    asymmetry = 0.0
    breakaway, shape, gap = 0.0, "stop", 0.0
    static: list[tuple[str, dict[str, object]]] = []
    delay_s = 0.0
    speed_size = np.abs(w)
    for effect, p in effects:
        if effect == "offset":
            front += p["level_nm"]
        elif effect == "coulomb":
            level += p["level_nm"]
            breakaway = max(breakaway, p["breakaway_rad"])
        elif effect == "viscous":
            flow += p["coefficient_nm_s_per_rad"] * w
        elif effect == "asymmetric_coulomb":
            asymmetry += p["difference_nm"]
        elif effect == "asymmetric_viscous":
            flow += p["difference_nm_s_per_rad"] * speed_size
        elif effect == "drag":
            flow += p["coefficient_nm_s2_per_rad2"] * w * speed_size
        elif effect == "stribeck":
            level += p["extra_nm"] * np.exp(-np.square(w / p["speed_rad_s"]))
        elif effect in ("stiction", "dwell"):
            static.append((effect, p))
        elif effect == "presliding":
            pass  # after the loop: it replaces the break-away of coulomb whatever the order
        elif effect == "freeplay":
            gap += p["gap_rad"]
        elif effect == "dead_zone":
            beyond = x - p["centre_rad"]
            front += p["stiffness_nm_per_rad"] * np.sign(beyond) * np.maximum(np.abs(beyond) - p["half_width_rad"], 0.0)
        elif effect == "stiffness":
            front += p["stiffness_nm_per_rad"] * x
        elif effect == "hardening":
            front += p["coefficient_nm_per_rad3"] * x**3
        elif effect == "end_stop":
            front += p["stiffness_nm_per_rad"] * np.sign(x) * np.maximum(np.abs(x) - p["limit_rad"], 0.0)
        elif effect == "inertia":
            front += p["inertia_kg_m2"] * a
        elif effect in ("once_per_rev", "twice_per_rev", "cogging"):
            per_turn = {"once_per_rev": 1, "twice_per_rev": 2}.get(effect) or p["per_turn"]
            front += p["amplitude_nm"] * np.sin(per_turn * turn + p["phase_rad"])
        elif effect == "position_coulomb":
            level += p["slope_nm_per_rad"] * x
        elif effect == "tight_spot":
            level += p["extra_nm"] * np.exp(-0.5 * np.square((x - p["angle_rad"]) / p["width_rad"]))
        elif effect == "load":
            if load is None:
                raise ValueError("the load effect needs a load channel")
            level += p["coefficient"] * np.abs(load)
        elif effect == "delay":
            delay_s += p["time_s"]
        elif effect == "lead":
            delay_s -= p["time_s"]
        elif effect == "warmup":
            level += p["extra_nm"] * np.exp(-t / p["time_s"])
        elif effect == "drift":
            front += p["rate_nm_per_s"] * t
        elif effect == "torque_step":
            front += p["amplitude_nm"] * np.tanh((x - p["angle_rad"]) / p["width_rad"])
        elif effect == "torque_bump":
            front += p["amplitude_nm"] * np.exp(-0.5 * np.square((x - p["angle_rad"]) / p["width_rad"]))
        elif effect == "time_sine":
            front += p["amplitude_nm"] * np.sin(2.0 * np.pi * p["frequency_hz"] * t + p["phase_rad"])
        elif effect == "odd_product":
            front += p["coefficient_nm_s_per_rad"] * np.sin(p["per_turn"] * turn + p["phase_rad"]) * w
    for effect, p in effects:
        if effect == "presliding":
            breakaway, shape = p["breakaway_rad"], p["shape"]
    if shape not in ("stop", "exponential"):
        raise ValueError(f"shape must be 'stop' or 'exponential', got {shape!r}")
    np.maximum(level, 0.0, out=level)
    friction, in_gap = _friction(
        motion, level, asymmetry, max(breakaway, 1e-12), shape, gap, static, start_state=start_state
    )
    flow[in_gap] = 0.0
    behind = friction + flow
    return Force(front + behind, friction, behind, in_gap, delay_s)


def _friction(
    motion: Motion,
    level: np.ndarray,
    asymmetry: float,
    breakaway: float,
    shape: str,
    gap: float,
    static: list[tuple[str, dict[str, object]]],
    *,
    start_state: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Friction force of the one contact and where the gap is open."""
    t, x, w = motion.time_s, motion.position, motion.speed
    friction = np.empty_like(x)
    in_gap = np.zeros(x.size, dtype=bool)
    held = start_state * max(level[0] + asymmetry * np.sign(start_state), 0.0)
    friction[0] = held
    # Room in the gap: 0 = pushing on the negative side, gap = pushing on the positive side. A start in the middle.
    place = 0.5 * gap
    if gap > 0.0:
        held = friction[0] = 0.0
        in_gap[0] = True
    still_since_s = t[0]
    for first, last, direction in pieces_of_one_direction(x):
        span = slice(first + 1, last + 1)
        if direction == 0:
            friction[span] = held
            in_gap[span] = in_gap[first]
            continue
        travel = direction * (x[span] - x[first])
        room = (gap - place) if direction > 0 else place
        pushed = travel - room
        touching = pushed >= 0.0 if gap > 0.0 else np.ones(travel.size, dtype=bool)
        if room > 0.0:
            held = 0.0  # the gap opens: whatever the contact held is let go
        place = min(max(place + direction * travel[-1], 0.0), gap)
        in_gap[span] = ~touching
        contact_at = int(np.argmax(touching)) if touching.any() else None
        if contact_at is None:
            friction[span] = held = 0.0
            continue
        slide = np.maximum(pushed, 0.0)
        limit = level[span]
        rest_s = max(t[first + 1 + contact_at] - still_since_s, 0.0)
        excess_now = 0.0
        if static:
            excess_now = sum(
                p["extra_nm"] * (1.0 if effect == "stiction" else 1.0 - np.exp(-rest_s / p["time_s"]))
                for effect, p in static
            )
        # The state that, with the limit of this moment, gives the force held so far.
        full = max(limit[contact_at] + excess_now + asymmetry * np.sign(held), 1e-12)
        begin = float(np.clip(held / full, -1.0, 1.0))
        if shape == "stop":
            state = np.clip(begin + direction * slide / breakaway, -1.0, 1.0)
            sliding_from = breakaway * (1.0 - direction * begin)
        else:
            state = direction - (direction - begin) * np.exp(-slide / breakaway)
            sliding_from = 3.0 * breakaway  # 95 % of the way
        if static:
            limit = limit.copy()
            slipped = np.maximum(slide - sliding_from, 0.0)
            for effect, p in static:
                fade = np.exp(-slipped / p["slip_rad"])
                if effect == "stiction":
                    if p["at_stop"]:
                        fade = np.maximum(fade, np.exp(-np.square(w[span] / p["stop_speed_rad_s"])))
                    limit += p["extra_nm"] * fade
                else:
                    limit += p["extra_nm"] * (1.0 - np.exp(-rest_s / p["time_s"])) * fade
        value = np.maximum(limit + asymmetry * np.sign(state), 0.0) * state
        value[~touching] = 0.0
        friction[span] = value
        held = float(value[-1])
        still_since_s = t[last]
    return friction, in_gap
