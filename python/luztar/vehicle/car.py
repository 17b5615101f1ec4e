"""A car: named parameters, each with its source, in a file."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Any

from .. import _core
from .._arrays import number
from ..errors import ModelError, ParameterError

SCHEMA = 1
TYRES = ("linear", "brush", "magic_formula")
CARS = ("abe_textbook", "bmw_320i", "bmw_5")
CAR_COLUMNS, START_COLUMNS, SUMMARY_COLUMNS, CHANNELS = (tuple(names) for names in _core.car_names())
# Without these there is no car, whatever the model.
REQUIRED = (
    "body.mass_kg",
    "body.yaw_inertia_kg_m2",
    "body.front_axle_m",
    "body.rear_axle_m",
    "front.cornering_n_per_rad",
    "rear.cornering_n_per_rad",
    "steering.inertia_kg_m2",
    "steering.ratio",
    "steering.stiffness_nm_per_rad",
)


@dataclass(frozen=True)
class Parameter:
    """A value and where it comes from; the unit stands in the parameter's name."""

    value: float
    source: str


@dataclass(frozen=True)
class Car:
    """A car by its parameters; nothing can be changed, :meth:`with_` makes another.

    Attributes
    ----------
    name, title : str
    tyre : {"linear", "brush", "magic_formula"}
        The law of the tyres where a run does not choose another.
    parameters : mapping of str to Parameter
        Keys as in the file (``body.mass_kg``, ``freeplay.gap_rad`` ...); what is not there is 0.
    sources : mapping of str to str
        What the first word of a source stands for.

    Examples
    --------
    >>> import luztar
    >>> car = luztar.vehicle.Car.named("bmw_320i").with_({"freeplay.gap_rad": 0.1})
    >>> car["freeplay.gap_rad"]
    0.1
    """

    name: str
    title: str
    tyre: str
    parameters: Mapping[str, Parameter]
    sources: Mapping[str, str]

    def __post_init__(self) -> None:
        if self.tyre not in TYRES:
            raise ParameterError(f"there is no tyre {self.tyre!r}", "tyre", f"Known are: {', '.join(TYRES)}.")
        for key in self.parameters:
            check_key(key)
        for key in REQUIRED:
            if key not in self.parameters:
                raise ModelError(f"{key} is missing", self.name, "Every car needs it.")
        object.__setattr__(self, "parameters", MappingProxyType(dict(self.parameters)))
        object.__setattr__(self, "sources", MappingProxyType(dict(self.sources)))

    @classmethod
    def named(cls, name: str) -> Car:
        """Return a built-in car, one of ``CARS``.

        Raises
        ------
        ParameterError
            Unknown name.
        """
        if name not in CARS:
            raise ParameterError(f"there is no car {name!r}", "name", f"Known are: {', '.join(CARS)}.")
        path = files("luztar") / "vehicle" / "cars" / f"{name}.toml"
        return _read(path.read_text(encoding="utf-8"), f"{name}.toml")

    @classmethod
    def load(cls, path: str | Path) -> Car:
        """Read a car from a TOML file.

        Raises
        ------
        ModelError
            Not a car: names file, key and remedy.
        """
        try:
            text = Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as problem:
            raise ModelError(f"cannot be read: {problem}", str(path), "Give a TOML file in UTF-8.") from None
        return _read(text, str(path))

    def save(self, path: str | Path) -> None:
        """Write the car as a TOML file that :meth:`load` reads back to the same values."""
        lines = [f"schema = {SCHEMA}", f"name = {_quoted(self.name)}", f"title = {_quoted(self.title)}"]
        lines += [f"tyre = {_quoted(self.tyre)}", "", "[sources]"]
        lines += [f"{key} = {_quoted(text)}" for key, text in self.sources.items()]
        for section in dict.fromkeys(key.partition(".")[0] for key in CAR_COLUMNS):
            inside = [k for k in CAR_COLUMNS if k.startswith(f"{section}.") and k in self.parameters]
            lines += ["", f"[{section}]"] if inside else []
            for key in inside:
                p = self.parameters[key]
                lines.append(f"{key.partition('.')[2]} = {{ value = {p.value!r}, source = {_quoted(p.source)} }}")
        Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")

    def with_(self, values: Mapping[str, float], *, source: str = "given", tyre: str | None = None) -> Car:
        """Return a car with other values.

        Parameters
        ----------
        values : mapping of str to float
        source : str
            Where they come from.
        tyre : str, optional

        Raises
        ------
        ParameterError
            An unknown key or a value that is not a finite number.
        """
        changed = {key: Parameter(_finite(key, value), source) for key, value in values.items()}
        parameters = {**self.parameters, **changed}
        return Car(self.name, self.title, tyre or self.tyre, parameters, self.sources)

    def __getitem__(self, key: str) -> float:
        check_key(key)
        return self.parameters[key].value if key in self.parameters else 0.0

    def to_dict(self) -> dict[str, Any]:
        """Return the car as plain JSON values."""
        return {
            "schema": SCHEMA,
            "name": self.name,
            "title": self.title,
            "tyre": self.tyre,
            "parameters": {k: {"value": p.value, "source": p.source} for k, p in self.parameters.items()},
            "sources": dict(self.sources),
        }

    def __str__(self) -> str:
        rows = [f"{self.title} ({self.name}), tyres: {self.tyre}"]
        rows += [f"  {key:<36}{p.value:>14.6g}  {p.source}" for key, p in self.parameters.items()]
        return "\n".join(rows)

    __repr__ = __str__


def check_key(key: str) -> None:
    """Refuse a parameter that is not there."""
    if key not in CAR_COLUMNS:
        raise ParameterError(f"a car has no parameter '{key}'", "parameters", f"Known are: {', '.join(CAR_COLUMNS)}.")


def _finite(key: str, value: Any) -> float:
    result = number(key, value)
    if not math.isfinite(result):
        raise ParameterError(f"{key} is {result}", key, "Give a finite number.")
    return result


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}" for c in escaped) + '"'


def _read(text: str, where: str) -> Car:
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as problem:
        raise ModelError(f"is not TOML: {problem}", where, "See docs/vehicle.md for an example.") from None
    if table.pop("schema", None) != SCHEMA:
        raise ModelError(f"has no 'schema = {SCHEMA}'", where, "Add it as the first line.")
    words = {}
    for key in ("name", "title", "tyre"):
        words[key] = table.pop(key, None)
        if not isinstance(words[key], str):
            raise ModelError(f"has no text '{key}'", where, f'Add {key} = "...".')
    sources = table.pop("sources", {})
    parameters: dict[str, Parameter] = {}
    for section, entries in table.items():
        if not isinstance(entries, dict):
            raise ModelError(f"'{section}' is no section", where, "Only schema, name, title, tyre stand at the top.")
        for name, entry in entries.items():
            key = f"{section}.{name}"
            complete = isinstance(entry, dict) and set(entry) == {"value", "source"} and entry["source"]
            if not complete or isinstance(entry["value"], bool):
                remedy = f'Write {name} = {{ value = ..., source = "..." }}.'
                raise ModelError(f"{key} has no value with a source", where, remedy)
            try:
                check_key(key)
                parameters[key] = Parameter(_finite(key, entry["value"]), str(entry["source"]))
            except ParameterError as problem:
                raise ModelError(problem.kind, where, problem.remedy) from None
    try:
        return Car(**words, parameters=parameters, sources=sources)
    except ParameterError as problem:
        raise ModelError(problem.kind, where, problem.remedy) from None
