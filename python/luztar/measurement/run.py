"""One measured run: named channels on one time axis, in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

# The channels luztar knows, with the unit each has inside.
CHANNEL_UNITS: Mapping[str, str] = MappingProxyType(
    {
        "angle": "rad",
        "torque": "Nm",
        "force": "N",
        "position": "m",
        "handwheel": "rad",
        "roadwheel": "rad",
        "load": "N",
    }
)
