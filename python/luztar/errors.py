"""The exceptions luztar raises: every message names the culprit, the place and the remedy."""

from __future__ import annotations

from typing import Any


class LuztarError(Exception):
    """The base of every error luztar raises on purpose.

    Parameters
    ----------
    kind : str
        What is wrong, in one sentence.
    where : str, optional
        The file, line, column or argument.
    remedy : str, optional
        What to do about it.
    """

    def __init__(self, kind: str, where: str = "", remedy: str = "") -> None:
        self.kind = kind
        self.where = where
        self.remedy = remedy
        super().__init__(kind, where, remedy)

    def __str__(self) -> str:
        # "x: x is 3" would say it twice.
        named = not self.where or f"{self.kind} ".startswith(f"{self.where} ")
        text = self.kind if named else f"{self.where}: {self.kind}"
        return f"{text}. {self.remedy}" if self.remedy else text

    def to_dict(self) -> dict[str, str]:
        """Return ``kind``, ``where`` and ``remedy`` as the JSON interface prints them."""
        return {"kind": self.kind, "where": self.where, "remedy": self.remedy}


class ParameterError(LuztarError, ValueError):
    """A value that cannot be used: out of range, not finite, unknown, or of the wrong shape."""


class MeasurementError(LuztarError, ValueError):
    """A file or table that cannot be read as a measurement."""


class DoubtfulError(MeasurementError):
    """A measurement that can be read and compared, but from which nothing may be concluded."""


class ModelError(LuztarError, ValueError):
    """A model or model file that makes no sense."""


class MissingError(LuztarError, ImportError):
    """An optional package that the call needs and that is not installed."""


class Interrupted(KeyboardInterrupt):
    """An interrupt during a batch; what was finished by then is kept.

    A ``KeyboardInterrupt``: it ends a program that does not ask for it.

    Attributes
    ----------
    partial : object
        The result of the lanes that are done, as the call would have returned it.
    done : ndarray of int
        Their numbers, increasing.
    lanes : int
        How many were asked for.
    """

    def __init__(self, partial: Any, done: Any, lanes: int) -> None:
        self.partial = partial
        self.done = done
        self.lanes = lanes
        super().__init__(f"stopped; {len(done)} of {lanes} lanes are done and kept in .partial")
