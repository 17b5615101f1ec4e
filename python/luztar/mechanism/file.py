"""Mechanisms as TOML files: ``structure = "mechanism"``, one table per part, units in the keys."""

from __future__ import annotations

import os
import tomllib
from dataclasses import fields
from pathlib import Path
from typing import Any

from ..errors import ModelError, ParameterError
from .mechanism import Mechanism
from .parts import ELEMENTS, Body, Driven, Load, Sensor, spelt

SCHEMA = 1
STRUCTURE = "mechanism"
_KINDS = {e.KIND: e for e in ELEMENTS}
_SECTIONS = {"bodies": Body, "driven": Driven, "loads": Load, "elements": None, "sensors": Sensor}
_PAGE = "See docs/mechanisms.md for an example."


def as_tables(m: Mechanism) -> dict[str, Any]:
    """Return the mechanism as the tables of its file."""
    tables: dict[str, Any] = {"schema": SCHEMA, "structure": STRUCTURE}
    if m.title:
        tables["title"] = m.title
    for section in _SECTIONS:
        parts = {p.name: _table(p) for p in getattr(m, section)}
        if parts:
            tables[section] = parts
    return tables


def _table(part: Any) -> dict[str, Any]:
    table: dict[str, Any] = {"kind": part.KIND} if hasattr(part, "KIND") else {}
    unit = getattr(part, "unit", "rad")
    for f in fields(part):
        value = getattr(part, f.name)
        if f.name != "name" and value != f.default and value is not None:
            table[spelt(f.name, unit)] = list(value) if isinstance(value, tuple) else value
    return table


def from_tables(tables: dict[str, Any]) -> Mechanism:
    """Return the mechanism of a file's tables.

    Raises
    ------
    ModelError
        Names the part and the key.
    """
    rest = dict(tables)
    if rest.pop("schema", None) != SCHEMA:
        raise ModelError(f"schema is {tables.get('schema')!r}", "schema", f"This version reads schema {SCHEMA}.")
    if rest.pop("structure", None) != STRUCTURE:
        raise ModelError(
            f"structure is {tables.get('structure')!r}", "structure", f'Give "{STRUCTURE}", or load it as a Model.'
        )
    title = rest.pop("title", "")
    found: dict[str, list[Any]] = {}
    for section in _SECTIONS:
        parts = rest.pop(section, {})
        if not isinstance(parts, dict) or not all(isinstance(p, dict) for p in parts.values()):
            raise ModelError(f"{section} is no table of tables", section, _PAGE)
        found[section] = [_part(section, name, part) for name, part in parts.items()]
    if rest:
        key = next(iter(rest))
        known = ", ".join(("title", *_SECTIONS))
        raise ModelError(f"there is no key '{key}'", key, f"Known are: {known}.")
    try:
        return Mechanism(title=title, **found)
    except ParameterError as error:
        raise ModelError(error.kind, error.where, error.remedy) from None


def _part(section: str, name: str, table: dict[str, Any]) -> Any:
    table = dict(table)
    kind = _SECTIONS[section]
    where = f"{section}.{name}"
    if kind is None:
        word = table.pop("kind", None)
        if word not in _KINDS:
            raise ModelError(f"its kind is {word!r}", where, f"Known are: {', '.join(_KINDS)}.")
        kind = _KINDS[word]
    unit = table.get("unit", "rad")
    own = [f.name for f in fields(kind) if f.name != "name"]
    keys = {spelt(field, unit if unit in ("rad", "m") else "rad"): field for field in own}
    given = {}
    for key, value in table.items():
        if key not in keys:
            raise ModelError(f"there is no key '{key}'", where, f"With unit {unit} there are: {', '.join(keys)}.")
        given[keys[key]] = tuple(value) if isinstance(value, list) else value
    try:
        return kind(name, **given)
    except TypeError:
        missing = ", ".join(key for key in keys if keys[key] not in given)
        raise ModelError("a key is missing", where, f"Give one of: {missing}.") from None
    except ParameterError as error:
        raise ModelError(error.kind, f"{section}.{error.where}", error.remedy) from None


def load(path: str | os.PathLike[str]) -> Mechanism:
    """Read a file; see :meth:`Mechanism.load`."""
    shown = Path(path).name
    try:
        tables = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise ModelError(
            f"cannot be read ({error.strerror})", os.fspath(path), "Give the path of a mechanism's file."
        ) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ModelError(f"is not TOML: {error}", shown, _PAGE) from None
    try:
        return from_tables(tables)
    except ModelError as error:
        raise ModelError(error.kind, f"{shown}, {error.where}", error.remedy) from None


def save(m: Mechanism, path: str | os.PathLike[str]) -> None:
    """Write a file; see :meth:`Mechanism.save`."""
    tables = as_tables(m)
    lines = [f"{key} = {_toml(value)}" for key, value in tables.items() if not isinstance(value, dict)]
    for section, parts in tables.items():
        if isinstance(parts, dict):
            for name, part in parts.items():
                lines += ["", f"[{section}.{_key(name)}]", *(f"{key} = {_toml(v)}" for key, v in part.items())]
    try:
        Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")
    except OSError as error:
        remedy = "Make the folder first, or name another place."
        raise ModelError(f"cannot be written ({error.strerror})", os.fspath(path), remedy) from None


def _key(name: str) -> str:
    plain = name.isascii() and name.replace("_", "").replace("-", "").isalnum()
    return name if plain else _toml(name)


def _toml(value: Any) -> str:
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return '"' + "".join(c if c.isprintable() else f"\\u{ord(c):04x}" for c in escaped) + '"'
    if isinstance(value, list):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    return repr(value)
