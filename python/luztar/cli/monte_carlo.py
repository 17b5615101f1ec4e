"""The simulate command over many mechanisms: a row for each of them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import Interrupted, ParameterError
from . import exits
from .inputs import find_model
from .output import say, tell
from .progress import bar

if TYPE_CHECKING:
    from ..dynamics import Summary

SHARES = (5.0, 50.0, 95.0)


def run_monte_carlo(
    model: str, study: str, drives: list[tuple[str, np.ndarray, float]], out: Path | None, json: bool
) -> int:
    """Draw, run, write the table of lanes and print what was found; an interrupt keeps the lanes that are done."""
    from ..freerun.monte_carlo import MonteCarlo, draw, run_many

    if len(drives) != 1:
        raise ParameterError(f"{len(drives)} drives", "RUN", "Give one run or a sine with --monte-carlo.")
    ((name, psi, rate_hz),) = drives
    plan = MonteCarlo.load(study)
    drawn = draw(find_model(model), plan)
    stopped = None
    with bar() as tell_progress:

        def progress(done: int, lanes: int) -> None:
            if tell_progress is not None:
                tell_progress("simulating", done, lanes)

        try:
            found = run_many(drawn, plan, psi, sample_rate_hz=rate_hz, progress=progress)
        except Interrupted as error:
            found, stopped = error.partial, error
    if out is not None:
        _write(out, drawn, found, plan.first)
    if stopped is not None:
        kept = f"and stand in {out}" if out is not None else "but nothing was kept: give --out"
        tell(f"{stopped.done.size} of {stopped.lanes} lanes are done {kept}")
        return exits.INTERRUPTED
    if json:
        say(
            {
                "schema": 1,
                "drive": name,
                "lanes": found.lanes,
                "seed": plan.seed,
                "first": plan.first,
                "varied": list(plan.vary),
                "percentiles": {k: _percentiles(v) for k, v in found.items() if v.ndim == 1},
            }
        )
    else:
        say(f"{name}: {found}")
    return exits.DONE


def _percentiles(values: np.ndarray) -> dict[str, float]:
    return {f"{share:g}": float(v) for share, v in zip(SHARES, np.percentile(values, SHARES), strict=True)}


def _write(place: Path, drawn: Mapping[str, Any], found: Summary, first: int) -> None:
    """One row per lane that is done: its number, what was drawn for it, what was kept of it."""
    columns: dict[str, np.ndarray] = {"lane": found.done + first}
    columns |= {k: v[found.done] for k, v in drawn.items() if isinstance(v, np.ndarray)}
    for name, values in found.items():
        if values.ndim == 1:
            columns[name] = values
        else:
            columns |= {f"{name}_{i}": column for i, column in enumerate(values.T)}
    try:
        table = np.column_stack(list(columns.values()))
        np.savetxt(place, table, fmt="%.9g", delimiter=",", header=",".join(columns), comments="")
    except OSError as error:
        reason = error.strerror or str(error)
        raise ParameterError(f"{place} cannot be written: {reason}", "--out", "Name another place.") from None
    tell(f"lanes: {place}")
