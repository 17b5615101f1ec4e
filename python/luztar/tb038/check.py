"""The result: six verifications, one verdict, and what it rests on."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .once_per_turn import OncePerTurn
from .rules import CheckItem, RuleSet
from .verification import Verification


@dataclass(frozen=True)
class FilterUse:
    """How the filter was read, and whether another reading would give another verdict.

    Attributes
    ----------
    poles, cutoff_hz : int, float [Hz]
        As the rule set names them.
    passes, text : str
        The reading in words.
    verdict_depends_on_it : bool
    """

    poles: int
    cutoff_hz: float
    passes: str
    text: str
    verdict_depends_on_it: bool

    def to_dict(self) -> dict[str, Any]:
        """Return the filter as plain JSON values."""
        return {key: getattr(self, key) for key in self.__dataclass_fields__}


@dataclass(frozen=True, eq=False)
class Trace:
    """The filtered torque over the window of one crossing, for the figure.

    Attributes
    ----------
    run, direction : str
    angle_deg, torque_nm : ndarray, shape (n,) [deg], [Nm]
        Read-only.
    """

    run: str
    direction: str
    angle_deg: np.ndarray
    torque_nm: np.ndarray


@dataclass(frozen=True)
class Outcome:
    """One way to look at the same data: its overall verdict and its verifications."""

    verdict: str
    verifications: tuple[Verification, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return verdict and verifications as plain JSON values."""
        return {"verdict": self.verdict, "verifications": [v.to_dict() for v in self.verifications]}


@dataclass(frozen=True)
class Check:
    """The friction check of a set of runs.

    Attributes
    ----------
    rule_set : str
        The rule set's name.
    verdict : str
        ``pass``, ``fail`` or ``inconclusive``: of the data as recorded, or centred where that was asked for.
    filter : FilterUse
    verifications : tuple of Verification
        One per run and direction, in the order of the runs.
    offset_nm : float or None [Nm]
        The centre of the hysteresis: the mean of the recorded torque's two directions.
    once_per_rev : OncePerTurn
    integrity : tuple of dict
        The integrity report of each run, with its name and this check's notes.
    advice : tuple of str
    centred : bool
        Whether the hysteresis centre was taken off before the verdict.
    other : Outcome or None
        Where ``centred``: the same data as recorded.
    rules : RuleSet
    traces : tuple of Trace
    """

    rule_set: str
    verdict: str
    filter: FilterUse
    verifications: tuple[Verification, ...]
    offset_nm: float | None
    once_per_rev: OncePerTurn
    integrity: tuple[dict[str, Any], ...]
    advice: tuple[str, ...]
    centred: bool = False
    other: Outcome | None = None
    rules: RuleSet = field(repr=False, kw_only=True)
    traces: tuple[Trace, ...] = field(default=(), repr=False, compare=False)

    @property
    def as_recorded(self) -> Outcome:
        """The verdict and verifications of the data as recorded."""
        return self.other or Outcome(self.verdict, self.verifications)

    @property
    def checklist(self) -> tuple[CheckItem, ...]:
        """What the engineer ticks before the readings."""
        return self.rules.checklist

    def to_dict(self) -> dict[str, Any]:
        """Return the check as the JSON interface prints it: plain values, None for what is not known.

        With ``centre=True`` there is one key more, ``as_recorded``: the verdict and verifications without centring.
        """
        result: dict[str, Any] = {
            "schema": 1,
            "rule_set": self.rule_set,
            "verdict": self.verdict,
            "filter": self.filter.to_dict(),
            "verifications": [v.to_dict() for v in self.verifications],
            "offset_nm": self.offset_nm,
            "once_per_rev": self.once_per_rev.to_dict(),
            "integrity": [dict(report) for report in self.integrity],
            "advice": list(self.advice),
        }
        if self.other is not None:
            result["as_recorded"] = self.other.to_dict()
        return result

    def figure(self) -> Any:
        """Return a plotly figure: torque over angle in the window, trend lines and limits.

        Raises
        ------
        MissingError
            Where plotly is not installed.
        """
        from .figure import figure

        return figure(self)

    def __str__(self) -> str:
        from .text import as_text

        return as_text(self)

    __repr__ = __str__

    def _repr_html_(self) -> str:
        from .text import as_html

        return as_html(self)
