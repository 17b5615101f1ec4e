"""Rule sets: a bulletin's numbers as versioned data, and the one function that compares with its limits."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from .._stream import Mappings
from ..errors import ParameterError

SCHEMA = 1
READINGS = ("two_forward_two_backward", "four_forward_four_backward", "four_forward")


class CheckItem(NamedTuple):
    """One line of the list the engineer ticks before the readings: where it stands, and what must be so."""

    step: str
    text: str


@dataclass(frozen=True)
class RuleSet(Mappings):
    """One bulletin's numbers.

    Attributes
    ----------
    name : str
        What ``rule_set=`` and the JSON call it.
    title : str
        The document it was taken from.
    mean_max_nm, mean_above_nm, std_below_nm : float [Nm]
        A verification passes iff mean <= ``mean_max_nm``, mean > ``mean_above_nm`` and std < ``std_below_nm``.
    half_width_deg : float [deg]
        The window is minus to plus this angle.
    speed_max_deg_s : float [deg/s]
        A higher speed inside the window makes a verification inconclusive.
    runs, directions : int
        How many tests, and directions per test, are asked for.
    poles, cutoff_hz : int, float [Hz]
        The filter as the bulletin names it.
    reading, other_readings : str, tuple of str
        How luztar reads that filter, and the other readings that are computed beside it (:mod:`luztar.tb038.filters`).
    link_distance_m : float [m]
        The lever of the bulletin's own device.
    prominent_nm, standard_errors, range_deg : float
        When a once-per-turn pattern is prominent (both must be exceeded), and the angle range [deg] that can show one.
    sections : mapping of str to str
        Where in the document each subject stands.
    checklist : tuple of CheckItem
        What is to be ticked before the readings.
    """

    name: str
    title: str
    mean_max_nm: float
    mean_above_nm: float
    std_below_nm: float
    half_width_deg: float
    speed_max_deg_s: float
    runs: int
    directions: int
    poles: int
    cutoff_hz: float
    reading: str
    other_readings: tuple[str, ...]
    link_distance_m: float
    prominent_nm: float
    standard_errors: float
    range_deg: float
    sections: Mapping[str, str]
    checklist: tuple[CheckItem, ...]

    def section(self, subject: str) -> str:
        """Return where ``subject`` stands, with the rule set's short name where the rule set does not say."""
        return self.sections.get(subject, self.name)


class Judgement(NamedTuple):
    """The three comparisons of one verification; NaN satisfies none of them."""

    below_max: bool
    above_min: bool
    steady: bool

    @property
    def passed(self) -> bool:
        """Whether all three hold."""
        return self.below_max and self.above_min and self.steady


def judge(mean_nm: float, std_nm: float, rules: RuleSet) -> Judgement:
    """Compare one verification's mean and standard deviation with the limits, and nothing else.

    Written with comparisons that are false for NaN, so that a missing number can never pass.

    Parameters
    ----------
    mean_nm : float [Nm]
        Mean of torque times the sign of motion.
    std_nm : float [Nm]
        Population standard deviation.
    rules : RuleSet

    Returns
    -------
    Judgement
    """
    return Judgement(
        below_max=bool(mean_nm <= rules.mean_max_nm),
        above_min=bool(mean_nm > rules.mean_above_nm),
        steady=bool(std_nm < rules.std_below_nm),
    )


def rule_set(which: str | RuleSet) -> RuleSet:
    """Return a rule set by its name; a :class:`RuleSet` is returned as it is.

    Raises
    ------
    ParameterError
        For an unknown name; the message lists the known ones.
    """
    if isinstance(which, RuleSet):
        return which
    known = _shipped()
    if which not in known:
        raise ParameterError(
            f"there is no rule set {which!r}", "rule_set", f"Known: {', '.join(known)}; or tb038.load_rules(FILE.toml)."
        )
    return known[which]


def rule_sets() -> tuple[str, ...]:
    """Return the names of the rule sets that come with luztar."""
    return tuple(_shipped())


def load_rules(path: str | Path) -> RuleSet:
    """Read a rule set from a TOML file laid out like the shipped ones.

    Raises
    ------
    ParameterError
        Where the file is not TOML, a key is missing or unknown, or a number makes no sense.
    """
    where = Path(path)
    try:
        text = where.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ParameterError(f"the rule set cannot be read: {error}", str(path), "Give a TOML file.") from error
    return parse_rules(text, where.name)


def parse_rules(text: str, where: str = "rule set") -> RuleSet:
    """Return the rule set that a TOML text holds; see :func:`load_rules`."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ParameterError(f"the rule set is not TOML: {error}", where, "Start from a shipped rule set.") from error
    if data.get("schema") != SCHEMA:
        raise ParameterError(f"the rule set has schema {data.get('schema')!r}", where, f"This luztar reads {SCHEMA}.")
    numbers = {
        attribute: _number(data, table, key, where, low, high)
        for attribute, (table, key, low, high) in _NUMBERS.items()
    }
    _refuse_unknown(data, where)
    readings = (data["filter"].get("reading"), *data["filter"].get("other_readings", []))
    for reading in readings:
        if reading not in READINGS:
            raise ParameterError(f"unknown filter reading {reading!r}", where, f"Known: {', '.join(READINGS)}.")
    for key in ("name", "title"):
        if not isinstance(data.get(key), str) or not data[key].strip():
            raise ParameterError(f"the rule set has no {key}", where, f'Add {key} = "...".')
    if not numbers["mean_above_nm"] < numbers["mean_max_nm"]:
        raise ParameterError("mean_above_nm is not below mean_max_nm", where, "No mean could pass.")
    try:
        checklist = tuple(CheckItem(str(item["step"]), str(item["text"])) for item in data.get("checklist", []))
    except (KeyError, TypeError) as error:
        raise ParameterError("a checklist item lacks its step or text", where, "Give both.") from error
    runs, directions, poles = (_whole(numbers.pop(key), key, where) for key in ("runs", "directions", "poles"))
    return RuleSet(
        name=data["name"],
        title=data["title"],
        **numbers,
        runs=runs,
        directions=directions,
        poles=poles,
        reading=readings[0],
        other_readings=tuple(readings[1:]),
        sections=MappingProxyType({str(k): str(v) for k, v in data.get("sections", {}).items()}),
        checklist=checklist,
    )


# attribute of RuleSet: table, key, least and greatest sensible value
_NUMBERS: Mapping[str, tuple[str, str, float, float]] = MappingProxyType(
    {
        "mean_max_nm": ("limits", "mean_max_nm", 0.0, math.inf),
        "mean_above_nm": ("limits", "mean_above_nm", 0.0, math.inf),
        "std_below_nm": ("limits", "std_below_nm", 0.0, math.inf),
        "half_width_deg": ("window", "half_width_deg", 1.0, math.inf),
        "speed_max_deg_s": ("window", "speed_max_deg_s", 0.0, math.inf),
        "runs": ("tests", "runs", 1, 1000),
        "directions": ("tests", "directions", 2, 2),
        "poles": ("filter", "poles", 4, 4),
        "cutoff_hz": ("filter", "cutoff_hz", 1e-3, math.inf),
        "link_distance_m": ("device", "link_distance_m", 1e-3, math.inf),
        "prominent_nm": ("once_per_rev", "prominent_reading_nm", 0.0, math.inf),
        "standard_errors": ("once_per_rev", "standard_errors_reading", 0.0, math.inf),
        "range_deg": ("once_per_rev", "range_reading_deg", 0.0, math.inf),
    }
)
_OTHER_KEYS = {"filter": {"reading", "other_readings"}}
_OTHER_TABLES = {"schema", "name", "title", "sections", "checklist"}


def _number(data: Mapping[str, Any], table: str, key: str, where: str, low: float, high: float) -> float:
    value = data.get(table, {}).get(key) if isinstance(data.get(table, {}), dict) else None
    # bool is an int in Python, and true is not a limit
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ParameterError(f"[{table}] {key} is {value!r}", where, "Give a finite number.")
    if not low <= value <= high:
        raise ParameterError(f"[{table}] {key} is {value!r}", where, f"It must lie from {low:g} to {high:g}.")
    return float(value)


def _whole(value: float, key: str, where: str) -> int:
    if value != int(value):
        raise ParameterError(f"{key} is {value!r}", where, "Give a whole number.")
    return int(value)


def _refuse_unknown(data: Mapping[str, Any], where: str) -> None:
    # A misspelt limit must not be passed over in silence.
    tables: dict[str, set[str]] = {}
    for table, key, _, _ in _NUMBERS.values():
        tables.setdefault(table, set(_OTHER_KEYS.get(table, set()))).add(key)
    for name, value in data.items():
        if name not in tables and name not in _OTHER_TABLES:
            raise ParameterError(f"unknown entry {name!r}", where, "Remove it.")
        for key in value if name in tables else ():
            if key not in tables[name]:
                raise ParameterError(f"unknown key {key!r} in [{name}]", where, "Remove it or spell it as shipped.")


@cache
def _shipped() -> Mapping[str, RuleSet]:
    folder = resources.files(__package__).joinpath("rule_sets")
    files = sorted((f for f in folder.iterdir() if f.name.endswith(".toml")), key=lambda f: f.name)
    loaded = [parse_rules(file.read_text(encoding="utf-8"), file.name) for file in files]
    return MappingProxyType({rules.name: rules for rules in loaded})
