"""Parts of a run, and the same run on an even time axis."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from .._arrays import number
from ..errors import MeasurementError, ParameterError
from .arrays import check_rate
from .check import inspect
from .integrity import Finding, Integrity
from .run import Run
from .runs import Runs

# Findings about the time axis; they are looked for afresh in every part.
_OF_TIME = ("gap", "duplicate_time", "reversed_time", "uneven")

# More samples than this from one resampling is a wrong rate or a wrong time column.
_MOST_SAMPLES = 10**9


def resample(run: Run, sample_rate_hz: float, *, method: str = "linear") -> Run:
    """Bring a run to an even rate by interpolation.

    No anti-alias filter is applied: to a rate below the run's own, low-pass first.

    Parameters
    ----------
    run : Run
    sample_rate_hz : float [Hz], > 0
    method : {"linear", "pchip"}
        Straight lines, or the monotone cubic of SciPy's ``PchipInterpolator``; neither overshoots the samples.

    Returns
    -------
    Run
        Starts at the run's first time and ends at or before its last, with a finding that says what was done. A value
        that is not finite spoils the new samples on both sides of it (linear) or is refused (pchip).

    Raises
    ------
    MeasurementError
        Where the time axis has a gap, stands still or runs backwards: interpolation would invent data there.
    ParameterError
        For an unknown method or rate.
    """
    rate = check_rate(sample_rate_hz)
    if method not in ("linear", "pchip"):
        raise ParameterError(f"unknown method {method!r}", "method", "Use linear or pchip.")
    for finding in run.integrity.findings:
        if finding.kind in ("gap", "duplicate_time", "reversed_time"):
            raise MeasurementError(
                f"cannot resample across this: {finding.text}",
                run.name,
                "Resample the parts before and after, each a file of its own (Python: run.split_at_gaps()).",
            )
    if not (run.duration_s > 0.0 and (np.diff(run.time_s) > 0.0).all()):
        raise MeasurementError("the time does not run forward", run.name, "Look at the time column.")
    span = run.duration_s * rate
    if span > _MOST_SAMPLES:
        raise ParameterError(f"{rate:g} Hz would make {span:.3g} samples", "sample_rate_hz", "Give a lower rate.")
    # A last sample that rounding puts a hair beyond the record belongs to it.
    n = math.floor(span * (1.0 + 4.0 * np.finfo(float).eps) + 1e-9) + 1
    if n < 2:
        raise ParameterError(f"{rate:g} Hz leaves {n} sample", "sample_rate_hz", "Give a higher rate.")
    time_s = np.minimum(run.time_s[0] + np.arange(n) / rate, run.time_s[-1])
    channels = {key: _interpolated(run, key, time_s, method) for key in run.channels}
    before = 1.0 / run.integrity.dt_median_s if run.integrity.dt_median_s else math.nan
    how = "straight lines" if method == "linear" else "monotone cubics"
    text = f"resampled from about {before:.6g} Hz to {rate:g} Hz by {how}"
    if rate < 0.999 * before:
        text += "; what lies above half the new rate is folded down, as no filter was applied"
    return _rebuilt(run, run.name, time_s, channels, (Finding("note", text, False),))


def _interpolated(run: Run, key: str, time_s: np.ndarray, method: str) -> np.ndarray:
    values = run.channels[key]
    if method == "linear":
        with np.errstate(invalid="ignore"):
            return np.interp(time_s, run.time_s, values)
    if not np.isfinite(values).all():
        raise MeasurementError(
            f"{key} holds values that are not finite",
            run.name,
            'Use method="linear", or cut them off with run.slice().',
        )
    from scipy.interpolate import PchipInterpolator

    return np.asarray(PchipInterpolator(run.time_s, values)(time_s), dtype=np.float64)


def cut_out(run: Run, from_s: float | None = None, to_s: float | None = None, *, name: str | None = None) -> Run:
    """Return the samples with ``from_s <= time_s <= to_s``.

    Parameters
    ----------
    run : Run
    from_s, to_s : float [s], optional
        In the run's own time; None for its start and end.
    name : str, optional
        For the new run; the old name by default.

    Raises
    ------
    MeasurementError
        Where fewer than two samples lie between.
    """
    low = -math.inf if from_s is None else number("from_s", from_s)
    high = math.inf if to_s is None else number("to_s", to_s)
    rows = np.flatnonzero((run.time_s >= low) & (run.time_s <= high))
    return _taken(run, rows, name or run.name)


def split_at_gaps(run: Run) -> Runs:
    """Return the stretches between gaps, repeated stamps and steps backwards.

    A run without any comes back alone under its own name; else the parts are called ``name#1``, ``name#2`` and so on. A
    stretch of a single row is no run; how many there were is noted in the first part.
    """
    breaks = {0, len(run)}
    dt = np.diff(run.time_s)
    gaps = [f for f in run.integrity.findings if f.kind == "gap"]
    if gaps:
        # Every gap is longer than the shortest one found, and no other step is.
        shortest = min(f.to_s - f.from_s for f in gaps if f.from_s is not None and f.to_s is not None)
        breaks |= {int(i) + 1 for i in np.flatnonzero(dt >= shortest * (1.0 - 1e-9))}
    breaks |= {int(i) + 1 for i in np.flatnonzero(dt <= 0.0)}
    if len(breaks) == 2:
        return Runs([run])
    edges = sorted(breaks)
    parts: list[Run] = []
    lone = 0
    for a, b in zip(edges[:-1], edges[1:], strict=True):
        if b - a < 2:
            lone += 1
            continue
        parts.append(_taken(run, np.arange(a, b), f"{run.name}#{len(parts) + 1}"))
    if not parts:
        raise MeasurementError("no two rows follow each other in time", run.name, "Look at the time column.")
    if lone:
        parts[0] = parts[0].with_finding(Finding("note", f"{lone} single rows between gaps belong to no part", False))
    return Runs(parts)


def _taken(run: Run, rows: np.ndarray, name: str) -> Run:
    if rows.size < 2:
        raise MeasurementError(
            f"{rows.size} samples lie in this stretch",
            run.name,
            f"The run reaches from {run.time_s[0]:g} s to {run.time_s[-1]:g} s.",
        )
    return _rebuilt(run, name, run.time_s[rows], {k: v[rows] for k, v in run.channels.items()}, ())


def _rebuilt(
    run: Run, name: str, time_s: np.ndarray, channels: dict[str, np.ndarray], extra: tuple[Finding, ...]
) -> Run:
    """Make a run of new arrays, with the findings that still concern it and those of the new arrays."""
    time_s, found, steps = inspect(time_s, channels)
    first, last = float(time_s.min()), float(time_s.max())
    afresh = (*_OF_TIME, "clipped", "stuck", "not_finite")
    kept = [
        f
        for f in run.integrity.findings
        if (f.kind not in afresh or (f.kind == "not_finite" and f.channel == "time")) and _touches(f, first, last)
    ]
    integrity: Integrity = replace(run.integrity, rows_read=int(time_s.size), findings=(*kept, *extra, *found), **steps)
    return Run.from_parts(name, time_s, channels, integrity, run.source, run.sha256)


def _touches(finding: Finding, first: float, last: float) -> bool:
    return finding.concerns(first, last)
