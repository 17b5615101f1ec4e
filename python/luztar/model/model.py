"""A model: a structure, its effects, and what is known beforehand. Immutable; ``model + effect`` makes a new one."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from .. import _core
from .._stream import Mappings
from ..errors import ModelError
from .cards import card, own_cards
from .steering_words import SHORT_KEYS
from .structure import Structure, structure

if TYPE_CHECKING:
    import os

# Given, they must be above 0.
_POSITIVE = (
    "steering.inertia_kg_m2",
    "steering.ratio",
    "steering.stiffness_nm_per_rad",
    "body.mass_kg",
    "body.yaw_inertia_kg_m2",
    "body.front_axle_m",
    "body.rear_axle_m",
    "front.cornering_n_per_rad",
    "rear.cornering_n_per_rad",
)
# Given for a structure as a whole: what it is.
_WHOLE = {("axis", "pitch_m"): "the travel per turn", ("car", "speed_m_s"): "the speed of all runs"}


@dataclass(frozen=True)
class Effect:
    """An effect with start values for some of its parameters; made by ``luztar.effects.Stribeck(...)``."""

    name: str
    start: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Comparison:
    """How model and measurement are compared.

    Attributes
    ----------
    band_hz : float or None
        Upper edge of the band; None takes the structure's default.
    filter_already_applied : bool
        Whether the measured torque or force has been low-passed by this band before.
    decimate : int or None
        Keep every n-th sample; None chooses from the band.
    """

    band_hz: float | None = None
    filter_already_applied: bool = False
    decimate: int | None = None


@dataclass(frozen=True)
class Model(Mappings):
    """A structure with effects.

    Attributes
    ----------
    structure_name : str
        ``rig`` (angle in, torque out), ``axis`` (position in, force out), ``steering`` (handwheel in, road wheel
        out) or ``car`` (handwheel and speed in, motion of the car out).
    effects : tuple of str
        Names of the catalogue.
    known : mapping
        Parameters that are given and not estimated, ``{"coulomb.level_nm": 0.7}``; ``pitch_m`` of an axis.
    start : mapping
        Start values of inner parameters, tried beside those of the search's own grid.
    comparison : Comparison
    free : bool
        Whether an axis runs freely, force in and position out, instead of being driven; a steering and a car always do.
    """

    structure_name: str
    effects: tuple[str, ...]
    known: Mapping[str, float] = field(default_factory=dict)
    start: Mapping[str, float] = field(default_factory=dict)
    comparison: Comparison = Comparison()
    free: bool = False

    def __post_init__(self) -> None:
        structure(self.structure_name, free=self.free)
        object.__setattr__(self, "effects", tuple(self.effects))
        for table in ("known", "start"):
            given = {self._whole_key(k): v for k, v in getattr(self, table).items()}
            object.__setattr__(self, table, MappingProxyType(given))
        seen: set[str] = set()
        for name in self.effects:
            needed = card(name, self.structure_name)
            if needed.is_decoy:
                remedy = "It competes in every diagnosis by itself; take it out of the effects."
                raise ModelError(f"'{name}' is a decoy without physics", "effects", remedy)
            if name in seen:
                raise ModelError(f"the effect '{name}' is listed twice", "effects", "Remove one of them.")
            if needed.kind == "structure":
                raise ModelError(f"'{name}' is the structure and no effect", "effects", "Take it out of the effects.")
            seen.add(name)
            if needed.needs and needed.needs not in self.effects:
                raise ModelError(f"'{name}' needs '{needed.needs}'", "effects", f"Add '{needed.needs}' to the effects.")
            if needed.per_turn and self.structure_name == "axis" and "pitch_m" not in self.known:
                remedy = "Give the travel per turn, pitch_m, among the known parameters: Model.axis(pitch_m=0.01)."
                raise ModelError(f"'{name}' counts turns, and an axis has none without its pitch", "known", remedy)
        for where, values in (("known", self.known), ("start", self.start)):
            for key, value in values.items():
                self._check(where, key, value)
        for key in self.start:
            if key in self.known:
                raise ModelError(f"{key} is known and has a start value too", "start", "Take it out of one of them.")
        if self.structure.is_free and self.comparison != Comparison():
            remedy = "Leave the comparison (--band, decimate, filter_already_applied) out."
            raise ModelError("a free run is compared as recorded, without a filter", "comparison", remedy)
        band, decimate = self.comparison.band_hz, self.comparison.decimate
        if band is not None and not (math.isfinite(band) and band > 0):
            raise ModelError(f"the band is {band} Hz", "comparison.band_hz", "Give a frequency above 0.")
        if decimate is not None and decimate < 1:
            raise ModelError(f"decimate is {decimate}", "comparison.decimate", "Give a whole number from 1.")

    def _check(self, where: str, key: str, value: float) -> None:
        if not isinstance(value, int | float) or isinstance(value, bool) or not math.isfinite(value):
            raise ModelError(f"{key} is {value!r}", where, "Give a finite number.")
        if (self.structure_name, key) in _WHOLE:
            if value <= 0:
                raise ModelError(f"{key} is {value}", where, f"Give {_WHOLE[self.structure_name, key]}, above 0.")
            return
        effect, _, parameter = key.partition(".")
        if effect not in self.effects and effect not in (c.name for c in own_cards(self.structure_name)):
            listed = ", ".join(self.effects)
            raise ModelError(f"'{key}' belongs to no effect of the model", where, f"Its effects are: {listed}.")
        parameters = {p.key: p for p in card(effect, self.structure_name).parameters}
        if parameter not in parameters:
            raise ModelError(f"'{effect}' has no '{parameter}'", where, f"It has: {', '.join(parameters) or 'none'}.")
        low, high = parameters[parameter].low, parameters[parameter].high
        if not low <= value <= high:
            raise ModelError(f"{key} is {value}", where, f"It must lie between {low:g} and {high:g}.")
        if value == 0.0 and key in _POSITIVE:
            raise ModelError(f"{key} is {value}", where, "It must be above 0.")

    def _whole_key(self, key: str) -> str:
        """Return the key with the structure's name where a short one was given (``ratio``)."""
        short = self.structure.is_free and key in SHORT_KEYS
        return f"steering.{SHORT_KEYS[key]}" if short else key

    @classmethod
    def rig(cls, **comparison: Any) -> Model:
        """Return the model of a friction rig: offset, Coulomb and viscous friction."""
        return cls("rig", structure("rig").effects, comparison=Comparison(**comparison))

    @classmethod
    def axis(cls, *, pitch_m: float | None = None, free: bool = False, **comparison: Any) -> Model:
        """Return the model of an axis: offset, Coulomb and viscous friction, inertia.

        Driven, position in and force out, or ``free``, force in and position out.
        """
        known = {} if pitch_m is None else {"pitch_m": pitch_m}
        return cls("axis", structure("axis").effects, known, comparison=Comparison(**comparison), free=free)

    @classmethod
    def steering(cls, **known: float) -> Model:
        """Return the seed paper's one-mass steering model with viscous friction.

        Parameters
        ----------
        **known : float
            What is given and not estimated: ``ratio`` (handwheel over road wheel), ``stiffness`` [Nm/rad] (of the
            spring at the handwheel), ``inertia`` [kg m²] and ``aligning`` [Nm/rad] (at the road wheel). A fit needs
            the ratio and one of the others: angles alone do not show the scale of the torques.
        """
        wrong = sorted(set(known) - set(SHORT_KEYS))
        if wrong:
            raise ModelError(f"there is no '{wrong[0]}'", "Model.steering", f"Known are: {', '.join(SHORT_KEYS)}.")
        return cls("steering", structure("steering").effects, known)

    @classmethod
    def car(cls, known: Mapping[str, float], *, estimate: Iterable[str] = ()) -> Model:
        """Return the model of a car: handwheel and speed in, motion of the car out; a linear car, viscous steering.

        Parameters
        ----------
        known : mapping of str to float
            What is given, keys of ``luztar.vehicle.Car`` (``{k: p.value for k, p in car.parameters.items()}``); keys
            that a car model has no use for are left out. Mass, axles and steering ratio must be given; cornering
            stiffnesses, yaw inertia and viscous friction are estimated where they are not.
        estimate : iterable of str
            Keys that are estimated although they are given: their values are where the search starts.
        """
        own = {f"{c.name}.{p.key}" for c in own_cards("car") for p in c.parameters}
        own |= {"viscous.coefficient_nm_s_per_rad", "speed_m_s"}
        wanted = set(estimate)
        wrong = sorted(wanted - own)
        if wrong:
            raise ModelError(f"there is no '{wrong[0]}'", "Model.car", f"Known are: {', '.join(sorted(own))}.")
        of_cars = set(_core.car_names()[0]) | own
        unknown = sorted(set(known) - of_cars)
        if unknown:
            raise ModelError(f"there is no '{unknown[0]}'", "Model.car", f"Known are: {', '.join(sorted(of_cars))}.")
        given = {k: v for k, v in known.items() if k in own}
        start = {k: v for k, v in given.items() if k in wanted}
        return cls("car", structure("car").effects, {k: v for k, v in given.items() if k not in wanted}, start)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Model:
        """Read a model file (TOML). See ``docs/model-files.md``."""
        from .file import load

        return load(path)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the model as a TOML file."""
        from .file import save

        save(self, path)

    @property
    def structure(self) -> Structure:
        """The structure with its channels."""
        return structure(self.structure_name, free=self.free)

    @property
    def band_hz(self) -> float | None:
        """Upper edge of the comparison; None where nothing is filtered."""
        return self.comparison.band_hz or self.structure.band_hz

    def with_band(self, band_hz: float | None) -> Model:
        """Return the same model with another comparison band; None leaves it as it is."""
        if band_hz is None:
            return self
        return replace(self, comparison=replace(self.comparison, band_hz=band_hz))

    def __add__(self, other: str | Effect | Iterable[str]) -> Model:
        """Return the model with an effect more (a name, or ``luztar.effects.X(...)``)."""
        if isinstance(other, str):
            other = Effect(other)
        if isinstance(other, Effect):
            start = {**self.start, **{f"{other.name}.{k}": v for k, v in other.start.items()}}
            return replace(self, effects=(*self.effects, other.name), start=start)
        return NotImplemented

    def __sub__(self, name: str) -> Model:
        """Return the model without an effect."""
        if name not in self.effects:
            raise ModelError(f"'{name}' is not in the model", "effects", f"It has: {', '.join(self.effects)}.")
        drop = f"{name}."
        return replace(
            self,
            effects=tuple(e for e in self.effects if e != name),
            known={k: v for k, v in self.known.items() if not k.startswith(drop)},
            start={k: v for k, v in self.start.items() if not k.startswith(drop)},
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the model as plain JSON values, in the layout of a model file."""
        run = {"run": {"free": True}} if self.free else {}
        return {
            "schema": 1,
            "structure": self.structure_name,
            "effects": list(self.effects),
            "known": dict(self.known),
            "start": dict(self.start),
            "comparison": {
                "band_hz": self.band_hz,
                "filter_already_applied": self.comparison.filter_already_applied,
                "decimate": self.comparison.decimate,
            },
            **run,
        }
