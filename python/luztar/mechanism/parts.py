"""What a mechanism is made of: bodies, driven nodes, loads, elements, sensors.

Every body and driven node has one coordinate, an angle (``unit="rad"``) or a way (``"m"``). An element acts along
``x = ratio_a * a - ratio_b * b``; its own unit says whether its numbers are Nm over rad or N over m.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from .._arrays import number
from ..errors import ParameterError

UNITS = ("rad", "m")
# Parameter: its name in files and lanes, for angles and for ways.
_SPELT = {
    "inertia": ("inertia_kg_m2", "mass_kg"),
    "stiffness": ("stiffness_nm_per_rad", "stiffness_n_per_m"),
    "gap": ("gap_rad", "gap_m"),
    "limit": ("limit_rad", "limit_m"),
    "hardening": ("hardening_nm_per_rad3", "hardening_n_per_m3"),
    "viscous": ("viscous_nm_s_per_rad", "viscous_n_s_per_m"),
    "drag": ("drag_nm_s2_per_rad2", "drag_n_s2_per_m2"),
    "kinetic": ("kinetic_nm", "kinetic_n"),
    "static": ("static_nm", "static_n"),
    "difference": ("difference_nm", "difference_n"),
    "stribeck": ("stribeck_nm", "stribeck_n"),
    "stribeck_speed": ("stribeck_speed_rad_s", "stribeck_speed_m_s"),
}


def spelt(parameter: str, unit: str) -> str:
    """Return a parameter's name with its unit, as files and lanes have it."""
    return _SPELT[parameter][UNITS.index(unit)] if parameter in _SPELT else parameter


def _settle(part: Any, numbers: tuple[str, ...]) -> None:
    if not isinstance(part.name, str):
        raise ParameterError(f"a name is {part.name!r}", "name", "Give a text.")
    for field in ("a", "b", "on", "senses"):
        end = getattr(part, field, "")
        if not isinstance(end, str):
            raise ParameterError(f"its {field} is {end!r}", part.name, "Give the name of one body, node or element.")
    unit = getattr(part, "unit", "rad")
    if unit not in UNITS:
        raise ParameterError(f"its unit is {unit!r}", part.name, "Give rad or m.")
    for field in numbers:
        value = getattr(part, field)
        if value is not None:
            object.__setattr__(part, field, number(f"{part.name}.{spelt(field, unit)}", value))


@dataclass(frozen=True)
class Body:
    """A body with one coordinate.

    Attributes
    ----------
    name : str
    inertia : float, > 0
        Moment of inertia, kg m2, or mass, kg.
    unit : {"rad", "m"}
    """

    name: str
    inertia: float
    unit: str = "rad"
    NUMBERS: ClassVar = ("inertia",)

    def __post_init__(self) -> None:
        _settle(self, self.NUMBERS)


@dataclass(frozen=True)
class Driven:
    """A node whose motion is given.

    Attributes
    ----------
    name : str
        Also the name of its channel.
    unit : {"rad", "m"}
    """

    name: str
    unit: str = "rad"

    def __post_init__(self) -> None:
        _settle(self, ())


@dataclass(frozen=True)
class Load:
    """A torque or force on a body, given as a channel.

    Attributes
    ----------
    name : str
        The name of the channel.
    on : str
        The body.
    """

    name: str
    on: str

    def __post_init__(self) -> None:
        _settle(self, ())


@dataclass(frozen=True)
class _Element:
    name: str
    a: str
    b: str = "ground"
    KIND: ClassVar[str] = ""
    NUMBERS: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        _settle(self, (*self.NUMBERS, "ratio_a", "ratio_b"))

    def _values(self) -> list[float]:
        """Return the numbers of the core's law."""
        return [float(getattr(self, field)) for field in self.NUMBERS]


@dataclass(frozen=True)
class Spring(_Element):
    """A spring with freeplay: ``K l + K3 l^3``, ``l = luz(x, gap / 2)`` (the seed paper's equation 3).

    Attributes
    ----------
    name, a, b : str
        ``a`` and ``b`` are bodies, driven nodes or ``ground``.
    stiffness : float, >= 0
        K, Nm/rad or N/m.
    gap : float, >= 0
        Full width of the freeplay, rad or m.
    hardening : float, >= 0
        K3, Nm/rad3 or N/m3.
    ratio_a, ratio_b : float, not 0
        Element coordinate per coordinate of the node.
    unit : {"rad", "m"}
        Of the element's coordinate.
    """

    stiffness: float = 0.0
    gap: float = 0.0
    hardening: float = 0.0
    ratio_a: float = 1.0
    ratio_b: float = 1.0
    unit: str = "rad"
    KIND: ClassVar = "spring"
    NUMBERS: ClassVar = ("stiffness", "gap", "hardening")


@dataclass(frozen=True)
class EndStop(_Element):
    """A spring beyond a limit on both sides.

    Attributes
    ----------
    name, a, b, ratio_a, ratio_b, unit
        As :class:`Spring`.
    stiffness : float, >= 0
        Nm/rad or N/m.
    limit : float, >= 0
        Where it is met, rad or m.
    """

    stiffness: float = 0.0
    limit: float = 0.0
    ratio_a: float = 1.0
    ratio_b: float = 1.0
    unit: str = "rad"
    KIND: ClassVar = "end_stop"
    NUMBERS: ClassVar = ("stiffness", "limit")

    def _values(self) -> list[float]:
        return [self.stiffness, 2.0 * self.limit, 0.0]


@dataclass(frozen=True)
class Damper(_Element):
    """Viscous friction and drag: ``c v + d |v| v``.

    Attributes
    ----------
    name, a, b, ratio_a, ratio_b, unit
        As :class:`Spring`.
    viscous : float, >= 0
        Nm s/rad or N s/m.
    drag : float, >= 0
        Nm s2/rad2 or N s2/m2.
    """

    viscous: float = 0.0
    drag: float = 0.0
    ratio_a: float = 1.0
    ratio_b: float = 1.0
    unit: str = "rad"
    KIND: ClassVar = "damper"
    NUMBERS: ClassVar = ("viscous", "drag")


@dataclass(frozen=True)
class Friction(_Element):
    """Dry friction, kinetic and static.

    In motion ``s (kinetic + s difference + stribeck exp(-(v/stribeck_speed)^2))``, s the direction; at rest whatever
    holds, up to ``static + s difference``.

    Attributes
    ----------
    name, a, b, ratio_a, ratio_b, unit
        As :class:`Spring`.
    kinetic : float, >= 0
        Nm or N.
    static : float, optional
        At least ``kinetic + stribeck``, which it is where it is not given.
    difference : float
        Half the difference of the levels of the two directions; no more than ``kinetic``.
    stribeck : float
        Extra at very low speed.
    stribeck_speed : float
        Where it has fallen to 37 %, rad/s or m/s.
    """

    kinetic: float = 0.0
    static: float | None = None
    difference: float = 0.0
    stribeck: float = 0.0
    stribeck_speed: float = 0.0
    ratio_a: float = 1.0
    ratio_b: float = 1.0
    unit: str = "rad"
    KIND: ClassVar = "friction"
    NUMBERS: ClassVar = ("kinetic", "static", "difference", "stribeck", "stribeck_speed")

    def _values(self) -> list[float]:
        sliding = self.kinetic + self.stribeck
        static = sliding if self.static is None else self.static
        return [self.kinetic, self.difference, self.stribeck, self.stribeck_speed, static - sliding]


@dataclass(frozen=True)
class Assistance:
    """Power assistance: a torque or force on a body by how far a spring is twisted.

    The curve is odd and piecewise linear through the points given, 0 at a twist of 0, constant beyond the last point.
    In the core it is a sum of luz terms. It does not weaken the spring it senses.

    Attributes
    ----------
    name : str
    senses : str
        A spring; its twist is ``ratio_a * a - ratio_b * b``, freeplay included.
    on : str
        The body that is helped.
    twist : tuple of float
        Rising, > 0, in the spring's unit.
    torque : tuple of float
        As many; Nm, or N where the body is of unit m.
    ratio : float
        Torque on the body per torque of the curve.
    scale : float, >= 0
        Factor on the curve.
    """

    name: str
    senses: str
    on: str
    twist: tuple[float, ...]
    torque: tuple[float, ...]
    ratio: float = 1.0
    scale: float = 1.0
    KIND: ClassVar = "assistance"
    NUMBERS: ClassVar = ("scale",)

    def __post_init__(self) -> None:
        _settle(self, ("ratio", "scale"))
        for field in ("twist", "torque"):
            values = tuple(number(f"{self.name}.{field}", v) for v in getattr(self, field))
            object.__setattr__(self, field, values)
        rising = all(a < b for a, b in zip((0.0, *self.twist), self.twist, strict=False))
        if not self.twist or len(self.twist) != len(self.torque) or not rising:
            raise ParameterError(
                f"its curve has the twists {self.twist} and the torques {self.torque}",
                self.name,
                "Give rising twists above 0, and one torque for each.",
            )

    def _terms(self) -> list[tuple[float, float]]:
        """Return (k, a): the curve is the sum of ``k luz(x, a)``."""
        points = list(zip((0.0, *self.twist), (0.0, *self.torque), strict=True))
        slopes = [(t1 - t0) / (x1 - x0) for (x0, t0), (x1, t1) in zip(points, points[1:], strict=False)]
        changes = [b - a for a, b in zip((0.0, *slopes), (*slopes, 0.0), strict=True)]
        return [(change, x) for change, (x, _) in zip(changes, points, strict=True) if change != 0.0]


Element = Spring | EndStop | Damper | Friction | Assistance
ELEMENTS: tuple[type, ...] = (Spring, EndStop, Damper, Friction, Assistance)
QUANTITIES = ("position", "speed", "torque", "stretch")


@dataclass(frozen=True)
class Sensor:
    """A channel of the result with a name of its own.

    Attributes
    ----------
    name : str
    of : str
        A body or driven node (position, speed) or an element (torque, stretch).
    quantity : {"position", "speed", "torque", "stretch"}
    factor : float
        The channel is the quantity times this.
    """

    name: str
    of: str
    quantity: str = "position"
    factor: float = 1.0

    def __post_init__(self) -> None:
        _settle(self, ("factor",))
        if self.quantity not in QUANTITIES:
            raise ParameterError(
                f"it measures {self.quantity!r}", self.name, f"A sensor measures one of: {', '.join(QUANTITIES)}."
            )
