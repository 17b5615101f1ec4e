"""From the words of a command to runs and a model."""

from __future__ import annotations

import difflib
import math
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import DoubtfulError, LuztarError, MeasurementError, ModelError, ParameterError
from . import exits
from .output import tell

if TYPE_CHECKING:
    from ..measurement import Run, Runs
    from ..model import Model

# A value in quotes of its own, as in a script that escaped them: "SR Angle" or "ADC6"*0.52.
_QUOTED = re.compile(r"""(["'])(?P<name>.*)\1(?P<rest>\s*\*[^"']*)?\Z""")
# Findings that keep the samples they concern from being used at all.
UNREADABLE = ("cut", "gap", "duplicate_time", "reversed_time", "not_finite")


class UnreadablePart(MeasurementError):
    """A part of a run cannot be read, so that nothing can be concluded from it."""

    exit_code = exits.INCONCLUSIVE


@dataclass(frozen=True)
class Given:
    """The runs of a command: those that are fitted, and those that are only predicted."""

    fitted: Runs
    held_out: Runs

    @property
    def every(self) -> tuple[Run, ...]:
        """All runs."""
        return (*self.fitted, *self.held_out)


def pairs(option: str, texts: Sequence[str]) -> dict[str, str]:
    """Take ``KEY=VALUE`` words apart.

    Raises
    ------
    ParameterError
        Where a word has no ``=`` or a key is given twice.
    """
    found: dict[str, str] = {}
    for text in texts:
        key, equals, value = text.partition("=")
        key, value = key.strip(), value.strip()
        if not equals or not key:
            raise ParameterError(f"{text!r} is not of the form KEY=VALUE", option, f'Write {option} angle="VALUE".')
        if key in found:
            raise ParameterError(f"{key} is given twice", option, "Leave one of them out.")
        quoted = _QUOTED.match(value)
        found[key] = f"{quoted['name']}{quoted['rest'] or ''}" if quoted else value
    return found


def read_runs(
    paths: Sequence[str],
    held_out: Sequence[str] = (),
    *,
    mapped: Sequence[str] = (),
    units: Sequence[str] = (),
    resample_hz: float | None = None,
    drop_copies: bool = True,
) -> Given:
    """Read the runs of a command.

    A run that is also held out is only predicted, and a file given twice counts once: a copy among the fitted runs
    would let the others predict it, and one among the held-out runs would not be unseen.

    Raises
    ------
    MeasurementError, ParameterError
        A file that cannot be read, an option that cannot be understood, or no run left to fit.
    """
    from ..measurement import Runs, read

    if resample_hz is not None:
        check_positive("--resample", resample_hz, "Hz")
    # The held-out ones first: of two copies the first is kept.
    files = [*held_out, *paths]
    runs = read(files, map=pairs("--map", mapped), units=pairs("--unit", units), resample_hz=resample_hz)
    if not drop_copies:
        return Given(runs, Runs())
    kept: list[int] = []
    for i, run in enumerate(runs):
        copy = next((k for k in kept if _same(files[k], runs[k], files[i], run)), None)
        if copy is None:
            kept.append(i)
        elif copy < len(held_out) <= i:
            tell(f"{files[i]}: held out, so it is only predicted")
        else:
            tell(f"{files[i]}: the same run as {files[copy]}; it counts once")
    fitted = [runs[i] for i in kept if i >= len(held_out)]
    if not fitted:
        raise ParameterError(
            "every run is held out, none is left to fit", "--held-out", "Give a RUN that is not held out."
        )
    return Given(Runs(fitted), Runs([runs[i] for i in kept if i < len(held_out)]))


def _same(a: str, run_a: Run, b: str, run_b: Run) -> bool:
    return os.path.realpath(a) == os.path.realpath(b) or (run_a.sha256 is not None and run_a.sha256 == run_b.sha256)


def check_positive(option: str, value: float, unit: str) -> None:
    """Refuse a number that is not finite and above 0, by the option's own name."""
    if not (math.isfinite(value) and value > 0.0):
        raise ParameterError(f"{value:g} is not a positive number", option, f"Give a positive number of {unit}.")


def find_model(text: str, band_hz: float | None = None, add: Sequence[str] = ()) -> Model:
    """Return a built-in structure's model, or the one of a TOML file, with effects added.

    Raises
    ------
    ModelError
        Where there is neither; the nearest names are in the remedy.
    """
    from ..model import STRUCTURES, Model

    if text in STRUCTURES:
        model = Model(text, STRUCTURES[text].effects)
    elif Path(text).is_file():
        model = Model.load(text)
    else:
        near = difflib.get_close_matches(text.lower(), STRUCTURES, n=1)
        guess = f"Did you mean {near[0]}? " if near else ""
        known = ", ".join(STRUCTURES)
        raise ModelError(
            f"there is no model '{text}'", "--model", f"{guess}Built in: {known}; or give the path of a TOML file."
        )
    if band_hz is not None:
        check_positive("--band", band_hz, "Hz")
        model = model.with_band(band_hz)
    try:
        for name in add:
            model = model + name
    except ModelError as error:
        raise ModelError(error.kind, "--add", error.remedy) from None
    return model


def unreadable(error: LuztarError, runs: Sequence[Run], model: Model) -> LuztarError:
    """Return the error as :class:`UnreadablePart` where a part of a run or doubt about it is the reason."""
    if isinstance(error, DoubtfulError):
        return UnreadablePart(error.kind, error.where, error.remedy)
    if not isinstance(error, MeasurementError | ParameterError):
        return error
    channels = (None, "time", model.structure.motion, model.structure.effort)
    for run in runs:
        lost = [f for f in run.integrity.findings if f.kind in UNREADABLE and f.channel in channels]
        if run.name in error.where and (lost or not run.integrity.complete):
            return UnreadablePart(error.kind, error.where, error.remedy)
    return error
