"""The command that runs a steering model freely."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ParameterError
from . import exits
from .inputs import check_positive, find_model, read_runs
from .output import say, tell
from .progress import bar
from .report import check_place, written


def run_simulate(
    model: str,
    runs: list[str],
    sine: tuple[float, float] | None,
    seconds: float,
    rate: float,
    out: str | None,
    report: str | None,
    study: str | None,
    json: bool,
    mapped: list[str],
    units: list[str],
    resample: float | None,
) -> int:
    """Simulate a model along the handwheel of runs, or along a sine, and print what happened."""
    from ..freerun.run_model import parameters_given, run_model
    from .simulate_mechanism import find_mechanism, simulate_mechanism

    mechanism = find_mechanism(model)
    if mechanism is not None:
        for option, value in (("--report", report), ("--monte-carlo", study)):
            if value is not None:
                raise ParameterError(
                    "a mechanism of several bodies has none", option, "Use luztar.mechanism in Python."
                )
        drives = _drives(runs, sine, seconds, rate, mapped, units, resample)
        places = _places(out, [name for name, *_ in drives], [model, *runs])
        return simulate_mechanism(mechanism, drives, places, json)
    check_place(report, [model, *runs])
    if study is not None:
        if report is not None:
            raise ParameterError("a page shows single runs", "--report", "Give --out for the table of all lanes.")
        from .monte_carlo import run_monte_carlo

        drives = _drives(runs, sine, seconds, rate, mapped, units, resample)
        place = _places(out, ["lanes"], [model, study, *runs])[0]
        return run_monte_carlo(model, study, drives, place, json)
    start_from = find_model(model)
    given = parameters_given(start_from)
    drives = _drives(runs, sine, seconds, rate, mapped, units, resample)
    places = _places(out, [name for name, *_ in drives], [model, *runs])
    made = []
    with bar() as tell_progress:
        for i, (name, psi, rate_hz) in enumerate(drives):
            if tell_progress is not None:
                tell_progress("simulating", i, len(drives))
            made.append((name, rate_hz, run_model(start_from, psi, sample_rate_hz=rate_hz)))
    for (_, _, traced), place in zip(made, places, strict=True):
        _write(place, traced)
    if report is not None:
        _write_page(report, made)
    if json:
        say(
            {
                "schema": 1,
                "structure": start_from.structure_name,
                "effects": list(start_from.effects),
                "parameters": given,
                "runs": [_as_json(*m) for m in made],
            }
        )
    else:
        say("\n".join(f"{name}: {traced}" for name, _, traced in made))
    return exits.DONE


def _drives(
    runs: list[str],
    sine: tuple[float, float] | None,
    seconds: float,
    rate: float,
    mapped: list[str],
    units: list[str],
    resample: float | None,
) -> list[tuple[str, np.ndarray, float]]:
    if bool(runs) == (sine is not None):
        remedy = "Give run files with a handwheel channel, or --sine RAD HZ."
        raise ParameterError("one drive is needed, runs or a sine", "RUN", remedy)
    if sine is not None:
        check_positive("--seconds", seconds, "seconds")
        check_positive("--rate", rate, "Hz")
        amplitude, frequency = sine
        if not (math.isfinite(amplitude) and math.isfinite(frequency) and frequency > 0.0):
            raise ParameterError(f"{amplitude:g} rad at {frequency:g} Hz is no sine", "--sine", "Give RAD and HZ > 0.")
        if not frequency < 0.1 * rate:
            raise ParameterError(
                f"{rate:g} Hz is too slow for {frequency:g} Hz", "--rate", "Sample ten times a period."
            )
        t = np.arange(max(2, round(seconds * rate) + 1)) / rate
        return [("sine", amplitude * np.sin(2.0 * math.pi * frequency * t), rate)]
    given = read_runs(runs, mapped=mapped, units=units, resample_hz=resample)
    return [(r.name, r["handwheel"], r.sample_rate_hz) for r in given.fitted]


def _places(out: str | None, names: list[str], inputs: list[str]) -> list[Path | None]:
    if out is None:
        return [None] * len(names)
    place = Path(out)
    if not place.parent.is_dir():
        raise ParameterError(f"there is no folder {place.parent}", "--out", "Make it first, or name another place.")
    places = (
        [place]
        if len(names) == 1
        else [place.with_name(f"{place.stem}-{i}{place.suffix}") for i in range(1, len(names) + 1)]
    )
    for p in places:
        if p.is_dir() or any(p.resolve() == Path(name).resolve() for name in inputs):
            raise ParameterError(f"{p} is a folder or a file that is read", "--out", "Name a file of its own.")
    return list(places)


def _write(place: Path | None, traced: Any) -> None:
    if place is None:
        return
    table = np.column_stack([traced.time_s, traced.handwheel_rad, traced.roadwheel_rad, traced.speed_rad_s])
    header = "time_s,handwheel_rad,roadwheel_rad,roadwheel_rad_per_s"
    try:
        np.savetxt(place, table, fmt="%.9g", delimiter=",", header=header, comments="")
    except OSError as error:
        reason = error.strerror or str(error)
        raise ParameterError(f"{place} cannot be written: {reason}", "--out", "Name another place.") from None
    tell(f"trajectory: {place}")


def _write_page(path: str, made: list[tuple[str, float, Any]]) -> None:
    from ..report.leaf import write_leaf

    text = "\n\n".join(f"{name}: {traced}" for name, _, traced in made)
    pictures = [(name, traced.figure()) for name, _, traced in made]
    title = "Free runs" if len(made) > 1 else "Free run"
    written(path, lambda: write_leaf(path, title, text, pictures, "This figure is drawn by the browser."))


def _as_json(name: str, rate_hz: float, traced: Any) -> dict[str, Any]:
    return {
        "run": name,
        "samples": int(traced.time_s.size),
        "sample_rate_hz": rate_hz,
        "roadwheel_min_rad": float(traced.roadwheel_rad.min()),
        "roadwheel_max_rad": float(traced.roadwheel_rad.max()),
        "at_rest_share": float(np.mean(traced.speed_rad_s == 0.0)),
        "events": [e.to_dict() for e in traced.events],
        "energy_j": dict(traced.energy_j),
        "balanced": traced.balanced,
    }
