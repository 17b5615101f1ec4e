"""Model files: TOML, checked as a whole, every mistake reported with its place."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path
from typing import Any

from ..errors import ModelError
from .model import Comparison, Model
from .structure import STRUCTURES, structure

# What users write in a file and what the result is checked against.
SCHEMA = 1


def _schema() -> Any:
    from pydantic import BaseModel, ConfigDict, Field

    class ComparisonPart(BaseModel):
        model_config = ConfigDict(extra="forbid", allow_inf_nan=False, strict=True)
        band_hz: float | None = Field(default=None, gt=0)
        filter_already_applied: bool = False
        decimate: int | None = Field(default=None, ge=1)

    class ModelFile(BaseModel):
        model_config = ConfigDict(extra="forbid", allow_inf_nan=False, populate_by_name=True, strict=True)
        version: int = Field(alias="schema")
        structure: str
        effects: list[str] | None = None
        known: dict[str, float | dict[str, float]] = {}
        start: dict[str, float | dict[str, float]] = {}
        comparison: ComparisonPart = ComparisonPart()

    return ModelFile


def _flat(table: dict[str, Any]) -> dict[str, float]:
    """``coulomb.level_nm = 0.7`` is a nested table to TOML; quoted keys arrive flat. Both mean the same."""
    flat: dict[str, float] = {}
    for key, value in table.items():
        if isinstance(value, dict):
            flat |= {f"{key}.{inner}": v for inner, v in value.items()}
        else:
            flat[key] = value
    return flat


def load(path: str | os.PathLike[str]) -> Model:
    """Read a model file.

    Parameters
    ----------
    path : path-like
        A TOML file with ``schema = 1``, ``structure``, and optionally ``effects``, ``known``, ``start``,
        ``comparison``; see ``docs/model-files.md``.

    Raises
    ------
    ModelError
        Names the file, the key and the remedy; every mistake of the layout is listed at once.
    """
    from pydantic import ValidationError

    shown = Path(path).name
    try:
        raw = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise ModelError(
            f"cannot be read ({error.strerror})", os.fspath(path), "Give the path of a model file."
        ) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ModelError(f"is not TOML: {error}", shown, "See docs/model-files.md for an example.") from None
    if raw.get("structure") == "mechanism":
        remedy = "Load it with luztar.mechanism.Mechanism.load, or run it with luztar simulate."
        raise ModelError("a mechanism of several bodies is no model to fit", f"{shown}, structure", remedy)
    try:
        parts = _schema().model_validate(raw)
    except ValidationError as error:
        wrong = "; ".join(f"{'.'.join(map(str, e['loc'])) or 'file'}: {e['msg']}" for e in error.errors())
        raise ModelError(wrong, shown, "See docs/model-files.md for an example.") from None
    if parts.version != SCHEMA:
        raise ModelError(f"schema is {parts.version}", shown, f"This version reads schema {SCHEMA}.")
    if parts.structure not in STRUCTURES:
        raise ModelError(f"there is no structure '{parts.structure}'", shown, f"Known: {', '.join(STRUCTURES)}.")
    effects = structure(parts.structure).effects if parts.effects is None else tuple(parts.effects)
    try:
        return Model(
            parts.structure,
            effects,
            _flat(parts.known),
            _flat(parts.start),
            Comparison(**parts.comparison.model_dump()),
        )
    except ModelError as error:
        raise ModelError(error.kind, f"{shown}, {error.where}", error.remedy) from None


def save(model: Model, path: str | os.PathLike[str]) -> None:
    """Write a model as a TOML file that :func:`load` reads back.

    Raises
    ------
    ModelError
        Where the file cannot be written.
    """
    quoted = ", ".join(f'"{e}"' for e in model.effects)
    lines = [
        f"schema = {SCHEMA}",
        f'structure = "{model.structure_name}"',
        f"effects = [{quoted}]",
    ]
    for name, table in (("known", model.known), ("start", model.start)):
        if table:
            lines += ["", f"[{name}]", *(f"{key} = {value!r}" for key, value in table.items())]
    comparison = model.comparison
    set_by_user = [
        ("band_hz", comparison.band_hz),
        ("decimate", comparison.decimate),
        ("filter_already_applied", True if comparison.filter_already_applied else None),
    ]
    if any(value is not None for _, value in set_by_user):
        lines += ["", "[comparison]"]
        lines += [f"{k} = {str(v).lower() if isinstance(v, bool) else v!r}" for k, v in set_by_user if v is not None]
    try:
        Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")
    except OSError as error:
        remedy = "Make the folder first, or name another place."
        raise ModelError(f"cannot be written ({error.strerror})", os.fspath(path), remedy) from None
