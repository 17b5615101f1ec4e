"""A study over many mechanisms: a model, the distributions of some of its parameters, and what to keep of every run."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from .._arrays import vector, whole_number
from ..dynamics import COLUMNS, Summary, sample, summarise
from ..errors import ModelError, ParameterError
from ..model import Model
from ..model.steering_words import SHORT_KEYS
from .plant import keys_of
from .run_model import OPTIONAL, substeps_for

SCHEMA = 1
KEYS = ("schema", "lanes", "seed", "first", "method", "keep", "window_s", "times_s", "vary")
# What a sensor does to the angle is not part of a mechanism, and lanes are run without it.
SENSOR = ("offset.", "delay.")


@dataclass(frozen=True)
class MonteCarlo:
    """What a study file says.

    Attributes
    ----------
    lanes : int
        Trajectories.
    vary : mapping of str to distribution
        As :func:`luztar.dynamics.sample` takes them; keys as in model files.
    seed, first, method
        As :func:`luztar.dynamics.sample` takes them.
    keep, window_s, times_s
        As :func:`luztar.dynamics.summarise` takes them.
    """

    lanes: int
    vary: Mapping[str, Any]
    seed: int = 0
    first: int = 0
    method: str = "random"
    keep: tuple[str, ...] = ("last", "peak", "rms", "at_rest")
    window_s: float | None = None
    times_s: tuple[float, ...] | None = None
    where: str = field(default="", repr=False)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> MonteCarlo:
        """Read a study file (TOML).

        Raises
        ------
        ModelError
            Names the file, the key and the remedy.
        """
        shown = Path(path).name
        try:
            raw = tomllib.loads(Path(path).read_text(encoding="utf-8"))
        except OSError as error:
            kind = f"cannot be read ({error.strerror})"
            raise ModelError(kind, os.fspath(path), "Give the path of a study file.") from None
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise ModelError(f"is not TOML: {error}", shown, "See docs/dynamics.md for an example.") from None
        remedy = "See docs/dynamics.md for an example."
        unknown = [key for key in raw if key not in KEYS]
        if unknown:
            raise ModelError(f"there is no key {', '.join(unknown)}; known are {', '.join(KEYS)}", shown, remedy)
        missing = [key for key in ("schema", "lanes", "vary") if key not in raw]
        if missing:
            raise ModelError(f"{', '.join(missing)} is missing", shown, remedy)
        if raw.pop("schema") != SCHEMA:
            raise ModelError("another schema", shown, f"This version reads schema {SCHEMA}.")
        if not isinstance(raw["vary"], dict) or not raw["vary"]:
            raise ModelError("nothing varies", f"{shown}, vary", remedy)
        lists = {key: tuple(raw[key]) for key in ("keep", "times_s") if isinstance(raw.get(key), list)}
        given = {**raw, **lists, "vary": MappingProxyType(_flat(raw["vary"]))}
        made = cls(**given, where=shown)
        whole_number("lanes", made.lanes, 1, 2**40)
        return made


def _flat(table: Mapping[str, Any]) -> dict[str, Any]:
    """``coulomb.level_nm = {...}`` is a nested table to TOML; short keys of the structure stand at the top."""
    flat: dict[str, Any] = {}
    for key, value in table.items():
        if key in SHORT_KEYS:
            flat[f"steering.{SHORT_KEYS[key]}"] = value
        elif "." not in key and isinstance(value, Mapping):
            flat |= {f"{key}.{inner}": v for inner, v in value.items()}
        else:
            flat[key] = value
    return flat


def draw(model: Model, study: MonteCarlo) -> dict[str, Any]:
    """Return the parameters of every lane: those of the model, and those that vary.

    Raises
    ------
    ModelError, ParameterError
        A model that does not run freely, a parameter without a value or with a distribution that makes no sense.
    """
    if model.structure_name != "steering":
        remedy = 'Give a model file with structure = "steering".'
        raise ModelError(f"'{model.structure_name}' is not simulated here", "structure", remedy)
    given = {**model.start, **model.known, **study.vary}
    missing = [k for k in keys_of(model) if k not in given and k not in OPTIONAL and not k.startswith(SENSOR)]
    if missing:
        remedy = "Give every parameter in [known] or [start] of the model, or in [vary]."
        raise ModelError(f"no value for {', '.join(missing)}", "known", remedy)
    unknown = [key for key in study.vary if key not in COLUMNS]
    if unknown:
        kind = f"there is no parameter {', '.join(unknown)}"
        raise ModelError(kind, f"{study.where}, vary", f"Known are: {', '.join(COLUMNS)}.")
    physical = {key: value for key, value in given.items() if key in COLUMNS}
    try:
        return sample(physical, study.lanes, seed=study.seed, first=study.first, method=study.method)
    except ParameterError as error:
        raise ParameterError(error.kind, f"{study.where}, {error.where}", error.remedy) from None


def run_many(
    drawn: Mapping[str, Any],
    study: MonteCarlo,
    handwheel_rad: Any,
    *,
    sample_rate_hz: float,
    progress: Callable[[int, int], None] | None = None,
) -> Summary:
    """Run all lanes along one handwheel angle, in steps that the stiffest of them allows.

    Raises
    ------
    ParameterError
        As :func:`luztar.dynamics.summarise`.
    Interrupted
        With the lanes that are done.
    """
    psi = vector("handwheel_rad", handwheel_rad, minimum=2)
    wanted = {k: np.asarray(v) for k, v in drawn.items()}
    return summarise(
        drawn,
        psi,
        sample_rate_hz=sample_rate_hz,
        substeps=substeps_for(wanted, psi, sample_rate_hz),
        keep=study.keep,
        window_s=study.window_s,
        times_s=study.times_s,
        progress=progress,
    )
