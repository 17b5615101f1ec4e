"""Which column of a file is which channel: names, units in headers, and the ``--map`` language.

``--map KEY=COLUMN`` names the column of a channel, ``--map KEY=COLUMN*FACTOR`` scales it by one number and nothing
else.
The unit of a mapped column is settled like this, in this order:

1. ``--unit KEY=UNIT`` given and the column scaled: the scaled numbers are in that unit, whatever the header says.
2. The column's own unit measures the channel's quantity (``angle=SR Angle*-1``, in deg): the factor is a pure number
   and the column's unit stays.
3. Scaled, and the column's unit measures something else (N, kN, V): the column is brought to SI first and the factor
   carries it into the channel's SI unit (``torque=ADC6*0.52``: kN or N becomes N, times 0.52 m, gives Nm).
4. Scaled, and the column has no unit or one luztar does not know: the factor carries the raw numbers into the
   channel's SI unit.
5. Not scaled and no unit: ``--unit`` decides; without it, an error.

A ``--unit`` that contradicts the header of a column that is not scaled is an error: one of the two is wrong by a
factor. In a .mat file, which has nowhere to write a unit, time and the variables named by ``--map`` are SI without one.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..errors import MeasurementError
from . import units as _units
from .headers import Column, plain
from .run import CHANNEL_UNITS

KEYS: tuple[str, ...] = ("time", *CHANNEL_UNITS)

QUANTITY: Mapping[str, str] = {
    "time": "time",
    "angle": "angle",
    "torque": "torque",
    "force": "force",
    "position": "length",
    "handwheel": "angle",
    "roadwheel": "angle",
    "load": "force",
}

# Everyday words that other instruments use for other things (engine load in %, pedal position in V): such a column is
# left alone, with a note, in a file that already has an angle and a torque.
_EVERYDAY = frozenset({"load", "position"})

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\Z")


@dataclass(frozen=True)
class Source:
    """Where one channel's numbers come from and what makes them SI.

    Attributes
    ----------
    column : Column
    to_si : float
        Multiplies the raw numbers.
    column_text : str
        The column as asked for, with its factor.
    unit_read : str
        The unit of the raw numbers, with the factor where there is one; empty where the file gave none.
    unit_used : str
        The SI unit after scaling.
    assumed : str
        A sentence where the unit was not in the file, else empty.
    """

    column: Column
    to_si: float
    column_text: str
    unit_read: str
    unit_used: str
    assumed: str = ""


def check_keys(option: str, given: Mapping[str, str] | None) -> dict[str, str]:
    """Return ``given`` as a dict of text, with its keys checked against the known channels."""
    checked: dict[str, str] = {}
    for key, value in (given or {}).items():
        if key not in KEYS:
            close = difflib.get_close_matches(str(key), KEYS, n=1)
            hint = f"Did you mean {close[0]}? " if close else ""
            raise MeasurementError(f"unknown key {key!r}", option, f"{hint}The keys are {', '.join(KEYS)}.")
        if not isinstance(value, str) or not value.strip():
            raise MeasurementError(f"{key} has no value", option, f"Write {option} {key}=TEXT.")
        checked[key] = value.strip()
    return checked


def _listed(columns: Sequence[Column]) -> str:
    shown = ", ".join(repr(c.header) for c in columns[:30])
    return shown + (f" and {len(columns) - 30} more" if len(columns) > 30 else "") if columns else "none"


def _match(text: str, columns: Sequence[Column], where: str) -> Column | None:
    for same in (
        lambda c: c.header == text,
        lambda c: c.name == text,
        lambda c: plain(c.header) == plain(text) or plain(c.name) == plain(text),
    ):
        found = [c for c in columns if same(c)]
        if len(found) == 1:
            return found[0]
        if found:
            places = " and ".join(str(c.index + 1) for c in found)
            raise MeasurementError(
                f"{len(found)} columns answer to {text!r} (columns {places}: {_listed(found)})",
                where,
                "Give the full header in --map, or rename one of them in the file.",
            )
    return None


def parse_map(key: str, text: str, columns: Sequence[Column], where: str) -> tuple[Column, float | None]:
    """Return the column and the factor (None: not scaled) that ``--map key=text`` asks for.

    Raises
    ------
    MeasurementError
        Where no column has the name, several have, or what follows ``*`` is not one number.
    """
    whole = _match(text, columns, where)
    if whole is not None:
        return whole, None
    name, star, factor_text = text.rpartition("*")
    factor_text = factor_text.strip()
    if star and _match(name.strip(), columns, where) is not None:
        factor = float(factor_text) if _NUMBER.match(factor_text) else math.nan
        if not math.isfinite(factor) or factor == 0.0:
            raise MeasurementError(
                f"--map {key}: {factor_text!r} is not a factor",
                where,
                f'Write one number with a decimal point, such as --map {key}="{name.strip()}*0.52".',
            )
        column = _match(name.strip(), columns, where)
        assert column is not None
        return column, factor
    wanted = name.strip() if star and _NUMBER.match(factor_text) else text
    close = difflib.get_close_matches(wanted, [c.header for c in columns] + [c.name for c in columns], n=1)
    hint = f"Did you mean {close[0]!r}? " if close else ""
    raise MeasurementError(f"--map {key}: there is no column {wanted!r}", where, f"{hint}Columns: {_listed(columns)}.")


def _settle(key: str, column: Column, factor: float | None, given: str | None, where: str, si_if_none: bool) -> Source:
    """Decide the unit of one channel, by the rules at the head of this file."""
    place = f"{where}, column {column.header!r}"
    used = _units.SI_SYMBOL[QUANTITY[key]]
    text = column.header if factor is None else f"{column.header}*{factor:g}"
    own = _units.find(column.unit) if column.unit is not None else None
    asked = None
    if given is not None:
        asked = _units.parse(given, f"--unit {key}")
        if asked.quantity != QUANTITY[key]:
            raise MeasurementError(
                f"{given!r} measures {asked.quantity}, {key} is kept in {used}",
                f"--unit {key}",
                f"Give a unit of {QUANTITY[key]}.",
            )
    if factor is not None:
        if asked is not None:
            read = f"{column.unit or ''}*{factor:g} as {asked.symbol}"
            return Source(
                column, factor * asked.si, text, read, used, f"{key} is taken as {asked.symbol} after scaling"
            )
        if own is not None:
            return Source(column, factor * own.si, text, f"{own.symbol}*{factor:g}", used)
        return Source(
            column,
            factor,
            text,
            f"{column.unit or ''}*{factor:g}",
            used,
            f"{key}: {column.header!r} gives no known unit; the factor {factor:g} is taken to make it {used}",
        )
    if column.unit is not None and own is None and asked is not None:
        said = f"{key} is taken as {asked.symbol}; the unit in the file, {column.unit!r}, is not known"
        return Source(column, asked.si, text, column.unit, used, said)
    if column.unit is not None:
        if own is None:
            raise _unknown_unit(key, column, place)
        if own.quantity != QUANTITY[key]:
            remedy = f'Give the factor: --map {key}="{column.header}*FACTOR"'
            if key == "torque" and own.quantity == "force":
                remedy = f'Multiply by the lever arm in metres: --map torque="{column.header}*0.52"'
            raise MeasurementError(
                f"{key} is in {own.symbol} ({own.quantity}), not in a unit of {QUANTITY[key]}", place, f"{remedy}."
            )
        if asked is not None and asked.symbol != own.symbol:
            raise MeasurementError(
                f"the file says {own.symbol}, --unit says {asked.symbol}",
                place,
                f'Leave --unit {key} out, or overrule the file with --map {key}="{column.header}*1".',
            )
        return Source(column, own.si, text, column.unit, used)
    if asked is not None:
        return Source(column, asked.si, text, "", used, f"{key} is taken as {asked.symbol}; the file gives no unit")
    if si_if_none:
        return Source(column, 1.0, text, "", used, f"{key} is taken as {used}; the file gives no unit")
    raise MeasurementError(
        f"{key} has no unit",
        place,
        f"Write it in the header, as {key}_{used}, or say which it is, as --unit {key}={used} (known: {_known(key)}).",
    )


def _known(key: str) -> str:
    """Return the units a channel may be in."""
    return ", ".join(dict.fromkeys(u.symbol for u in _units.UNITS.values() if u.quantity == QUANTITY[key]))


def _unknown_unit(key: str, column: Column, place: str) -> MeasurementError:
    """Return the error that says which unit is not known, which are, and how to say what it is."""
    quantity, unit = QUANTITY[key], column.unit or ""
    close = [g for g in _units.nearest(unit) if _units.UNITS[g].quantity == quantity]
    hint = f"Did you mean {' or '.join(close)}? " if close else ""
    example = close[0] if close else _units.SI_SYMBOL[quantity]
    return MeasurementError(
        f"unknown unit {unit!r} for {key}",
        place,
        f"{hint}Known for {key}: {_known(key)}. Write one in the header, or say --unit {key}={example} "
        f'(in Python units={{"{key}": "{example}"}}).',
    )


def resolve(
    columns: Sequence[Column],
    *,
    mapped: Mapping[str, str],
    units: Mapping[str, str],
    where: str,
    need_time: bool,
    unitless_is_si: bool = False,
) -> tuple[dict[str, Source], list[str]]:
    """Find the column of every channel.

    Parameters
    ----------
    columns : sequence of Column
    mapped, units : mapping
        ``--map`` and ``--unit``, keys checked.
    where : str
        The file, for messages.
    need_time : bool
        False where the sample rate is declared.
    unitless_is_si : bool
        Whether the format has nowhere to write a unit (.mat): then time and mapped columns without one are SI, with a
        finding.

    Returns
    -------
    sources : dict of channel to Source
    notes : list of str
        Sentences about columns left alone.

    Raises
    ------
    MeasurementError
        Where a channel has two candidates, no unit, a wrong unit, or there is no time or no channel at all.
    """
    notes: list[str] = []
    picked: dict[str, tuple[Column, float | None]] = {}
    for key, text in mapped.items():
        picked[key] = parse_map(key, text, columns, where)
    taken = {column.index for column, _ in picked.values()}
    for key in KEYS:
        if key in picked:
            continue
        named = [c for c in columns if c.channel == key and c.index not in taken]
        candidates = [c for c in named if not c.estimated] or named
        if len(candidates) > 1:
            raise MeasurementError(
                f"{len(candidates)} columns could be {key}: {_listed(candidates)}",
                where,
                f'Name one: --map {key}="{candidates[0].header}".',
            )
        if candidates:
            picked[key] = (candidates[0], None)
    rig = "angle" in picked and "torque" in picked
    sources: dict[str, Source] = {}
    for key in KEYS:
        if key not in picked:
            continue
        column, factor = picked[key]
        if key in _EVERYDAY and key not in mapped and key not in units and rig:
            own = _units.find(column.unit) if column.unit else None
            if own is None or own.quantity != QUANTITY[key]:
                notes.append(f"the column {column.header!r} was not read: its unit is not one of {QUANTITY[key]}")
                continue
        assume = unitless_is_si and (key in mapped or key == "time")
        sources[key] = _settle(key, column, factor, units.get(key), where, assume)
    if need_time and "time" not in sources:
        raise MeasurementError(
            f"there is no time column among {_listed(columns)}",
            where,
            "Name it with --map time=COLUMN, or declare the rate in Python: luztar.read(..., sample_rate_hz=...).",
        )
    if not any(key != "time" for key in sources):
        raise MeasurementError(
            f"no channel was recognised among the columns {_listed(columns)}",
            where,
            'Name them: --map angle="COLUMN" --map torque="COLUMN".',
        )
    return sources, notes
