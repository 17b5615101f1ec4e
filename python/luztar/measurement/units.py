"""The units a measurement file may use, in one table, each with its size in SI."""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from ..errors import MeasurementError


@dataclass(frozen=True)
class Unit:
    """One unit of measurement.

    Attributes
    ----------
    symbol : str
        How luztar writes it.
    quantity : str
        What it measures: ``time``, ``angle``, ``torque``, ``force``, ``length``, and a few that only a factor turns
        into a channel (``voltage``, ``current``, ``mass``, ``angular speed``, ``speed``, ``none``).
    si : float
        Its size in the SI unit of the quantity.
    """

    symbol: str
    quantity: str
    si: float


# The SI unit each quantity is kept in.
SI_SYMBOL: Mapping[str, str] = MappingProxyType(
    {
        "time": "s",
        "angle": "rad",
        "torque": "Nm",
        "force": "N",
        "length": "m",
        "voltage": "V",
        "current": "A",
        "mass": "kg",
        "angular speed": "rad/s",
        "speed": "m/s",
        "acceleration": "m/s^2",
        "none": "1",
    }
)

# The international foot and the avoirdupois pound-force are exact by definition (NIST SP 811, appendix B).
_FOOT_M = 0.3048
_POUND_FORCE_N = 4.4482216152605
# Exact by definition (CGPM 1901).
STANDARD_GRAVITY = 9.80665

# Symbol, quantity, SI size, and every spelling. A spelling is matched exactly: the case of a prefix decides a factor
# of 10^9 (mN, MN). "nm" is torque because no steering channel is measured in nanometres. "Â°" and "Ââ°" are the
# degree sign after a UTF-8 file went through cp1252 once; "\ufffd" is what is left where it was lost altogether and
# is *not* accepted, as it could have been any character.
_TABLE: tuple[tuple[str, str, float, str], ...] = (
    ("s", "time", 1.0, "s sec secs second seconds Sekunde Sekunden S SEC Sec"),
    ("ms", "time", 1e-3, "ms msec millisecond milliseconds Millisekunden"),
    ("us", "time", 1e-6, "us usec µs μs Âµs Î¼s microseconds"),
    ("min", "time", 60.0, "min minute minutes"),
    ("h", "time", 3600.0, "h hour hours"),
    ("rad", "angle", 1.0, "rad Rad RAD radian radians Radiant"),
    ("mrad", "angle", 1e-3, "mrad milliradian milliradians"),
    ("deg", "angle", math.pi / 180.0, "deg degs Deg DEG degree degrees Degree Degrees ° º Â° Âº Grad grad_deg"),
    ("rev", "angle", 2.0 * math.pi, "rev turn turns revolution revolutions Umdrehung Umdrehungen"),
    ("Nm", "torque", 1.0, "Nm N*m N.m N·m N⋅m N•m NÂ·m N_m N-m Nxm nm NM N.M newtonmetre newtonmeter"),
    ("cNm", "torque", 1e-2, "cNm cN*m cN.m cN·m cNÂ·m"),
    ("mNm", "torque", 1e-3, "mNm mN*m mN.m mN·m mNÂ·m"),
    ("kNm", "torque", 1e3, "kNm kN*m kN.m kN·m kNÂ·m"),
    ("Nmm", "torque", 1e-3, "Nmm N*mm N.mm N·mm NÂ·mm"),
    (
        "lbf.ft",
        "torque",
        _POUND_FORCE_N * _FOOT_M,
        "lbf.ft lbf*ft lbf·ft lbfft ft.lbf ft*lbf ft·lbf ft-lbf lbf-ft ftlbf",
    ),
    (
        "lbf.in",
        "torque",
        _POUND_FORCE_N * _FOOT_M / 12.0,
        "lbf.in lbf*in lbf·in lbfin in.lbf in*lbf in·lbf in-lbf lbf-in inlbf",
    ),
    ("N", "force", 1.0, "N newton newtons Newton"),
    ("kN", "force", 1e3, "kN kilonewton"),
    ("mN", "force", 1e-3, "mN"),
    ("daN", "force", 10.0, "daN"),
    ("lbf", "force", _POUND_FORCE_N, "lbf"),
    ("m", "length", 1.0, "m metre metres meter meters"),
    ("mm", "length", 1e-3, "mm millimetre millimetres millimeter millimeters"),
    ("cm", "length", 1e-2, "cm"),
    ("um", "length", 1e-6, "um µm μm Âµm Î¼m"),
    ("in", "length", _FOOT_M / 12.0, "in inch inches"),
    ("V", "voltage", 1.0, "V volt volts Volt"),
    ("mV", "voltage", 1e-3, "mV"),
    ("A", "current", 1.0, "A"),
    ("mA", "current", 1e-3, "mA"),
    ("kg", "mass", 1.0, "kg"),
    ("g", "mass", 1e-3, "g"),
    ("rad/s", "angular speed", 1.0, "rad/s rads-1 rad_s"),
    ("deg/s", "angular speed", math.pi / 180.0, "deg/s °/s Â°/s Grad/s dps deg_s"),
    ("rpm", "angular speed", math.pi / 30.0, "rpm 1/min"),
    ("m/s", "speed", 1.0, "m/s m_s"),
    ("mm/s", "speed", 1e-3, "mm/s"),
    ("km/h", "speed", 1.0 / 3.6, "km/h kph kmh"),
    ("m/s^2", "acceleration", 1.0, "m/s^2 m/s2 m/s² m/sÂ² m/s**2 m_s2"),
    ("g", "acceleration", STANDARD_GRAVITY, "gn g0"),
    ("1", "none", 1.0, "1 - % counts count"),
)

UNITS: Mapping[str, Unit] = MappingProxyType(
    {
        spelling: Unit(symbol, quantity, si)
        for symbol, quantity, si, spellings in _TABLE
        for spelling in spellings.split()
    }
)


# What a spelling means where the quantity is known: g is grams, and the acceleration of gravity.
_BESIDE: Mapping[tuple[str, str], Unit] = MappingProxyType(
    {("g", "acceleration"): Unit("g", "acceleration", STANDARD_GRAVITY)}
)


def find(text: str, quantity: str = "") -> Unit | None:
    """Return the unit spelt ``text``, or None where it is not in the table; the quantity decides between meanings."""
    tight = text.strip().strip("[]()").replace(" ", "")
    return _BESIDE.get((tight, quantity)) or UNITS.get(tight)


def nearest(text: str) -> list[str]:
    """Return up to three known spellings that look like ``text``."""
    tight = text.strip().strip("[]()").replace(" ", "")
    by_fold: dict[str, str] = {}
    for spelling in UNITS:
        if spelling.isascii():
            by_fold.setdefault(spelling.lower(), spelling)
    found = difflib.get_close_matches(tight.lower(), list(by_fold), n=3, cutoff=0.6)
    return [by_fold[f] for f in found]


def parse(text: str, where: str, quantity: str = "") -> Unit:
    """Return the unit spelt ``text``.

    Parameters
    ----------
    text : str
        The spelling, with or without brackets and spaces.
    where : str
        File and column, for the message.
    quantity : str
        What it is to measure, where a spelling has two meanings.

    Raises
    ------
    MeasurementError
        Where the spelling is not in the table; the remedy holds the nearest ones.
    """
    unit = find(text, quantity)
    if unit is None:
        guesses = nearest(text)
        remedy = f"Did you mean {' or '.join(guesses)}?" if guesses else "Use one of s, ms, deg, rad, Nm, N, m, mm."
        raise MeasurementError(f"unknown unit {text.strip()!r}", where, remedy)
    return unit
