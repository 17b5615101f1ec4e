"""A mechanism as a whole: its parts, checked together."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, fields, replace
from typing import Any, Self

import numpy as np

from .. import _core
from ..errors import ParameterError
from .parts import Assistance, Body, Driven, Element, Friction, Load, Sensor, spelt


@dataclass(frozen=True)
class Mechanism:
    """Bodies, what drives them, and the elements between them.

    Attributes
    ----------
    bodies : tuple of Body
    elements : tuple of Spring, EndStop, Damper, Friction or Assistance
    driven : tuple of Driven
        Nodes whose motion is given.
    loads : tuple of Load
        Torques or forces that are given.
    sensors : tuple of Sensor
        Channels of the result with names of their own.
    title : str

    Raises
    ------
    ParameterError
        Names the body or element: a name that is taken or unknown, an inertia that is not positive, a negative
        stiffness, gap or friction, static below kinetic friction, bodies that nothing connects.

    Examples
    --------
    >>> from luztar.mechanism import Body, Driven, Friction, Mechanism, Spring
    >>> m = Mechanism(
    ...     bodies=[Body("mass", 1.0, "m")],
    ...     driven=[Driven("belt", "m")],
    ...     elements=[
    ...         Spring("spring", "mass", stiffness=1.0, unit="m"),
    ...         Friction("rub", "mass", "belt", kinetic=0.6, static=1.0, unit="m"),
    ...     ],
    ... )
    >>> m.longest_step_s
    2.0
    """

    bodies: tuple[Body, ...]
    elements: tuple[Element, ...] = ()
    driven: tuple[Driven, ...] = ()
    loads: tuple[Load, ...] = ()
    sensors: tuple[Sensor, ...] = ()
    title: str = ""
    _network: Any = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        for part in ("bodies", "elements", "driven", "loads", "sensors"):
            object.__setattr__(self, part, tuple(getattr(self, part)))
        object.__setattr__(self, "_network", _network(self))
        known = {p.name for p in (*self.bodies, *self.driven)}, {e.name for e in self.elements}
        for sensor in self.sensors:
            of = known[sensor.quantity in ("torque", "stretch")]
            if sensor.of not in of:
                raise ParameterError(
                    f"there is no '{sensor.of}' of which it could measure the {sensor.quantity}",
                    sensor.name,
                    f"Known are: {', '.join(sorted(of))}.",
                )

    def __getstate__(self) -> dict[str, Any]:
        return {f.name: getattr(self, f.name) for f in fields(self) if f.init}

    def __setstate__(self, state: dict[str, Any]) -> None:
        for name, value in state.items():
            object.__setattr__(self, name, value)
        object.__setattr__(self, "_network", _network(self))

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of what drives it: driven nodes, then loads."""
        return (*(d.name for d in self.driven), *(p.name for p in self.loads))

    @property
    def longest_step_s(self) -> float:
        """The step that the stiffest spring allows, s: 2 over the highest circular frequency, all gaps closed."""
        return float(self._network.longest_step()[0])

    @property
    def stiffest(self) -> str | None:
        """The element that limits the step."""
        index = self._network.longest_step()[1]
        return None if index is None else self.elements[index].name

    def __getitem__(self, name: str) -> Any:
        for part in (*self.bodies, *self.driven, *self.loads, *self.elements, *self.sensors):
            if part.name == name:
                return part
        raise ParameterError(f"there is no '{name}'", "mechanism", f"Known are: {', '.join(self._names())}.")

    def _names(self) -> list[str]:
        return [p.name for p in (*self.bodies, *self.driven, *self.loads, *self.elements, *self.sensors)]

    def parameters(self) -> dict[str, float]:
        """Return every number by its name with unit, as ``column.stiffness_nm_per_rad``."""
        found: dict[str, float] = {}
        for part in (*self.bodies, *self.elements):
            unit = getattr(part, "unit", "rad")
            ratios = () if isinstance(part, Body | Assistance) else ("ratio_a", "ratio_b")
            for name in (*part.NUMBERS, *ratios):
                value = getattr(part, name)
                if name == "static" and value is None:
                    value = part.kinetic + part.stribeck
                found[f"{part.name}.{spelt(name, unit)}"] = value
        return found

    def with_parameters(self, changes: dict[str, float]) -> Self:
        """Return the same mechanism with other numbers, by the names of :meth:`parameters`.

        Raises
        ------
        ParameterError
            An unknown name, or a number that makes no sense.
        """
        by_name: dict[str, dict[str, float]] = {}
        for key, value in changes.items():
            owner, parameter = self._field_of(key)
            by_name.setdefault(owner, {})[parameter] = value
        return replace(
            self,
            bodies=tuple(replace(b, **by_name.get(b.name, {})) for b in self.bodies),
            elements=tuple(replace(e, **by_name.get(e.name, {})) for e in self.elements),
        )

    def _field_of(self, key: str) -> tuple[str, str]:
        """Return whose parameter this is, and the name of the field."""
        owner, _, parameter = key.partition(".")
        for part in (*self.bodies, *self.elements):
            if part.name == owner:
                for name in (*part.NUMBERS, "ratio_a", "ratio_b"):
                    if parameter == spelt(name, getattr(part, "unit", "rad")) and hasattr(part, name):
                        return owner, name
        known = ", ".join(self.parameters())
        raise ParameterError(f"there is no parameter '{key}'", "parameters", f"Known are: {known}.")

    def given(self, node: str) -> Self:
        """Return the mechanism with a body's motion given instead of found: the body becomes a driven node.

        What acts between the body and the ground, and the loads on it, are left out: they no longer matter.

        Raises
        ------
        ParameterError
            There is no such body.
        """
        body = next((b for b in self.bodies if b.name == node), None)
        if body is None:
            known = ", ".join(b.name for b in self.bodies)
            raise ParameterError(f"there is no body '{node}'", "node", f"Known are: {known}.")
        fixed = {node, "ground", *(d.name for d in self.driven)}
        elements = tuple(e for e in self.elements if isinstance(e, Assistance) or not {e.a, e.b} <= fixed)
        kept = {e.name for e in elements}
        return replace(
            self,
            bodies=tuple(b for b in self.bodies if b.name != node),
            driven=(*self.driven, Driven(node, body.unit)),
            loads=tuple(p for p in self.loads if p.on != node),
            elements=elements,
            sensors=tuple(s for s in self.sensors if s.quantity in ("position", "speed") or s.of in kept),
        )

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Mechanism:
        """Read a TOML file with ``structure = "mechanism"``; see ``docs/mechanisms.md``.

        Raises
        ------
        ModelError
            Names the file, the part and the remedy.
        """
        from .file import load

        return load(path)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a TOML file that :meth:`load` reads back.

        Raises
        ------
        ModelError
            Where the file cannot be written.
        """
        from .file import save

        save(self, path)

    def to_dict(self) -> dict[str, Any]:
        """Return the mechanism as plain JSON values, as in its file."""
        from .file import as_tables

        return as_tables(self)

    def figure(self) -> Any:
        """Return the mechanism as a network of bodies and elements (plotly)."""
        from .picture import network

        return network(self)

    def __str__(self) -> str:
        lines = [self.title or "mechanism"]
        lines += [f"  {b.name}: {b.inertia:g} {'kg m2' if b.unit == 'rad' else 'kg'}" for b in self.bodies]
        lines += [f"  {d.name}: {'angle' if d.unit == 'rad' else 'position'} given" for d in self.driven]
        lines += [f"  {p.name}: {'torque' if self[p.on].unit == 'rad' else 'force'} on {p.on}" for p in self.loads]
        for e in self.elements:
            where = f"{e.senses} -> {e.on}" if isinstance(e, Assistance) else f"{e.a} - {e.b}"
            unit = getattr(e, "unit", "rad")
            told = ", ".join(f"{spelt(n, unit)} {v:g}" for n in e.NUMBERS if (v := getattr(e, n)) not in (0.0, None))
            lines.append(f"  {e.name}: {e.KIND} {where}; {told}")
        if self.stiffest is not None:
            lines.append(f"longest step {self.longest_step_s:.3g} s ({self.stiffest})")
        return "\n".join(lines)


def _network(m: Mechanism) -> Any:
    for element in m.elements:
        if isinstance(element, Friction) and element.static is not None:
            sliding = element.kinetic + element.stribeck
            if element.static < sliding:
                raise ParameterError(
                    f"static friction {element.static:g} is below kinetic friction {sliding:g}",
                    element.name,
                    "Give a static level of at least the kinetic one.",
                )
    springs = {e.name: e for e in m.elements if not isinstance(e, Assistance)}
    parts = []
    for e in m.elements:
        if not isinstance(e, Assistance):
            kind = "spring" if e.KIND == "end_stop" else e.KIND
            parts.append((e.name, kind, (e.a, e.ratio_a), (e.b, e.ratio_b), e._values(), ("ground", 1.0), []))
            continue
        sensed = springs.get(e.senses)
        if sensed is None:
            known = ", ".join(springs)
            raise ParameterError(f"there is no element '{e.senses}' to sense", e.name, f"Known are: {known}.")
        ends = ((sensed.a, sensed.ratio_a), (sensed.b, sensed.ratio_b))
        parts.append((e.name, "assist", *ends, [e.scale], (e.on, e.ratio), e._terms()))
    return _core.Mechanism(
        [(b.name, b.inertia) for b in m.bodies],
        [d.name for d in m.driven],
        [(p.name, p.on) for p in m.loads],
        parts,
    )


def lane_table(m: Mechanism, changes: dict[str, np.ndarray], lanes: int) -> np.ndarray:
    """Return the core's values, one row per lane, with some parameters changed by lane."""
    core = m._network.parameters()
    rows = np.tile(np.array([value for *_, value in core]), (lanes, 1))
    column = {(owner, name): i for i, (owner, name, _) in enumerate(core)}
    by_name: dict[str, dict[str, np.ndarray]] = {}
    for key, values in changes.items():
        owner, parameter = m._field_of(key)
        by_name.setdefault(owner, {})[parameter] = values
    for owner, given in by_name.items():
        part = m[owner]
        for parameter, values in given.items():
            if parameter == "limit":
                rows[:, column[owner, "gap"]] = 2.0 * values
            elif isinstance(part, Friction) and parameter == "kinetic":
                rows[:, column[owner, "level"]] = values
            elif parameter != "static":
                rows[:, column[owner, parameter]] = values
        if isinstance(part, Friction):
            sliding = rows[:, column[owner, "level"]] + rows[:, column[owner, "stribeck"]]
            static = given.get("static", part.static)
            rows[:, column[owner, "stiction"]] = 0.0 if static is None else static - sliding
    return rows
