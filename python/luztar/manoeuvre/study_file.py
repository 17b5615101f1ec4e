"""Study files: a manoeuvre and what is to be studied about it, in TOML."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .._arrays import number
from ..errors import LuztarError, ModelError, ParameterError
from ..vehicle import Car
from .task import Manoeuvre, manoeuvre
from .weights import KEYS, Weights, weights_at

SCHEMA = 1
# Section: the keys that it may hold.
TOP = ("schema", "manoeuvre", "length_m", "speed_m_s", "car", "form", "steer", "limit_m_s2", "model", "tyre", "step_s")
SECTIONS: dict[str, tuple[str, ...] | None] = {
    "track": None,
    "vary": None,
    "weights": (*KEYS, "table"),
    "search": ("seed", "effort"),
    "robust": ("freeplay_half_width_rad", "friction_nm", "fine"),
    "map": ("lengths_m", "speeds_m_s"),
    "sensitivity": ("samples", "ranges"),
}


@dataclass(frozen=True)
class Study:
    """What a study file says.

    Attributes
    ----------
    name : str
        Of the manoeuvre.
    options : mapping
        As :func:`manoeuvre` takes them.
    search, robust, map, sensitivity : mapping
        Arguments of the functions of these names; ``search`` those that all share.
    """

    name: str
    options: Mapping[str, Any]
    search: Mapping[str, Any] = field(default_factory=dict)
    robust: Mapping[str, Any] = field(default_factory=dict)
    map: Mapping[str, Any] = field(default_factory=dict)
    sensitivity: Mapping[str, Any] = field(default_factory=dict)

    def task(self) -> Manoeuvre:
        """Return the manoeuvre."""
        return manoeuvre(self.name, **self.options)


def load(path: str | Path, **others: Any) -> Study:
    """Read a study file; see ``examples/avoiding.toml``.

    Parameters
    ----------
    path : path
        TOML; a car that is a file's name is looked for beside it.
    **others
        Values of the first section that are other than the file's.

    Raises
    ------
    ModelError
        Names the file, the key and the remedy.
    """
    where = str(path)
    try:
        read = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as problem:
        raise ModelError(f"cannot be read: {problem}", where, "Give a TOML file in UTF-8.") from None
    except tomllib.TOMLDecodeError as problem:
        raise ModelError(f"is not TOML: {problem}", where, "See examples/avoiding.toml.") from None
    if read.get("schema") != SCHEMA:
        raise ModelError(f"has no 'schema = {SCHEMA}'", where, "Add it as the first line.")
    for key, value in read.items():
        if key not in TOP and key not in SECTIONS:
            raise ModelError(f"'{key}' is not known", where, f"Known are: {', '.join([*TOP, *SECTIONS])}.")
        if (key in SECTIONS) != isinstance(value, dict):
            raise ModelError(f"'{key}' is {value!r}", where, "Write [sections] as sections and values as values.")
        known = SECTIONS.get(key) or ()
        for inner in value if known else ():
            if inner not in known:
                raise ModelError(f"[{key}] does not know '{inner}'", where, f"Known are: {', '.join(known)}.")
    read |= others
    if not isinstance(read.get("manoeuvre"), str):
        raise ModelError("names no manoeuvre", where, 'Add manoeuvre = "avoiding" or another.')
    options = {k: read[k] for k in TOP[2:] if k in read}
    options |= {k: read[k] for k in ("track", "vary") if k in read}
    try:
        if str(options.get("car", "")).endswith(".toml"):
            options["car"] = Car.load(Path(path).parent / options["car"])
        if "weights" in read:
            options["weights"] = _weights(read["weights"], Path(path).parent, options)
        study = Study(
            read["manoeuvre"],
            options,
            *(_flat(read.get(name, {})) for name in ("search", "robust", "map", "sensitivity")),
        )
        study.task()
    except TypeError as problem:
        raise ModelError(f"something is missing: {problem}", where, "See examples/avoiding.toml.") from None
    except LuztarError as problem:
        place = f"{where}, {problem.where}" if problem.where else where
        raise ModelError(problem.kind, place, problem.remedy) from None
    return study


def _weights(given: Mapping[str, Any], folder: Path, options: Mapping[str, Any]) -> Weights:
    """Three numbers, or those of a table at the study's speed."""
    if "table" not in given:
        return Weights(**given)
    if len(given) > 1:
        raise ParameterError("weights are a table or three numbers", "weights", "Leave one of the two out.")
    return weights_at(number("speed_m_s", options.get("speed_m_s")), folder / str(given["table"]))


def _flat(section: Mapping[str, Any]) -> dict[str, Any]:
    return {k: tuple(v) if isinstance(v, list) else v for k, v in section.items()}
