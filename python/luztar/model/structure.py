"""The structures a model can have: which channel drives it and which it explains."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ..errors import ModelError


@dataclass(frozen=True)
class Structure:
    """What is given, what is explained, and how a stroke is told from a hesitation.

    Attributes
    ----------
    name : str
    motion, effort : str
        The channel that drives the model and the one it explains.
    motion_unit, effort_unit : str
    effects : tuple of str
        The default model.
    band_hz : float or None
        Upper edge of the comparison where the model file does not say; None compares without a filter.
    unknown_travel_share : float
        The friction state of a run is unknown until its first motion has run through the widest gap or break-away to be
        expected, as a share of the range: 3.6 degrees of 120 for a steering wheel, a thousandth for a driven axis.
    outputs : tuple of str
        The channels that are explained, where there are several; they are then compared in multiples of their noise
        (unit sigma).
    is_free : bool
        Whether the model is run freely, motion out, instead of being asked for the effort of a given motion.
    drive : str
        The channel that goes in, where it is not the motion.
    """

    name: str
    motion: str
    effort: str
    motion_unit: str
    effort_unit: str
    effects: tuple[str, ...]
    band_hz: float | None
    unknown_travel_share: float
    outputs: tuple[str, ...] = ()
    is_free: bool = False
    drive: str = ""

    @property
    def driven_by(self) -> str:
        """The channel that goes in."""
        return self.drive or self.motion

    @property
    def channels(self) -> tuple[str, ...]:
        """The channels of a run that belong to the structure, whether recorded or not."""
        drive = (self.drive,) if self.drive else ()
        return (*drive, self.motion, *(self.outputs or (self.effort,)))

    @property
    def turns(self) -> bool:
        """Whether the motion is an angle."""
        return self.motion_unit == "rad"

    def hysteresis(self, motion_range: float) -> float:
        """Return how far the motion must come back to count as a reversal, in its unit."""
        return math.radians(1.0) if self.turns else 0.01 * motion_range

    def minimum_travel(self, motion_range: float) -> float:
        """Return the least travel of a stroke, in the motion's unit."""
        return math.radians(5.0) if self.turns else 0.05 * motion_range

    @property
    def rest_speed(self) -> float | None:
        """The speed below which the mechanism counts as at rest or reversing; None: a share of the top speed."""
        return math.radians(2.0) if self.turns else None


STRUCTURES = {
    "rig": Structure("rig", "angle", "torque", "rad", "Nm", ("offset", "coulomb", "viscous"), 6.0, 0.03),
    "axis": Structure("axis", "position", "force", "m", "N", ("offset", "coulomb", "viscous", "inertia"), 40.0, 0.001),
    "steering": Structure("steering", "handwheel", "roadwheel", "rad", "rad", ("viscous",), None, 0.0, is_free=True),
    "car": Structure(
        "car",
        "handwheel",
        "response",
        "rad",
        "sigma",
        ("viscous",),
        None,
        0.0,
        ("yaw_rate", "lateral_acceleration", "roll_angle", "roadwheel", "speed"),
        is_free=True,
    ),
}


# The same axis with the force in and the position out: strokes are those of the position.
_FREE_AXIS = replace(
    STRUCTURES["axis"],
    effort="position",
    effort_unit="m",
    band_hz=None,
    unknown_travel_share=0.0,
    is_free=True,
    drive="force",
)


def structure(name: str, *, free: bool = False) -> Structure:
    """Return a structure by name; ``free`` asks for the axis that runs freely.

    Raises
    ------
    ModelError
        Where there is none of that name.
    """
    if name not in STRUCTURES:
        raise ModelError(f"there is no structure '{name}'", "structure", f"Known: {', '.join(STRUCTURES)}.")
    if free and name == "axis":
        return _FREE_AXIS
    if free and not STRUCTURES[name].is_free:
        raise ModelError(f"a {name} is driven", "run", "Leave free out: only an axis, a steering, a car run freely.")
    return STRUCTURES[name]
