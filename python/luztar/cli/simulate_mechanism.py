"""The simulate command on a mechanism of several bodies."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import ParameterError
from . import exits
from .output import say, tell

if TYPE_CHECKING:
    from ..mechanism import Mechanism, MechanismRun


def find_mechanism(text: str) -> Mechanism | None:
    """Return the mechanism of a file with ``structure = "mechanism"``, None for anything else.

    Raises
    ------
    ModelError
        A mechanism's file that makes no sense.
    """
    from ..mechanism import Mechanism

    try:
        tables = tomllib.loads(Path(text).read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError):
        return None
    return Mechanism.load(text) if tables.get("structure") == "mechanism" else None


def simulate_mechanism(
    mechanism: Mechanism, drives: list[tuple[str, np.ndarray, float]], places: list[Path | None], json: bool
) -> int:
    """Run a mechanism along drives of its first channel and print what happened."""
    from ..mechanism import simulate

    if not mechanism.channels:
        raise ParameterError(
            "nothing drives this mechanism", "MODEL", "Add a driven node or a load, or run it in Python."
        )
    channel = "handwheel" if "handwheel" in mechanism.channels else mechanism.channels[0]
    made = [(name, simulate(mechanism, {channel: values}, sample_rate_hz=rate_hz)) for name, values, rate_hz in drives]
    for (_, run), place in zip(made, places, strict=True):
        if place is not None:
            _write(place, run)
    if json:
        say({"schema": 1, "mechanism": mechanism.to_dict(), "runs": [_as_json(name, run) for name, run in made]})
    else:
        say("\n".join(f"{name}: {run}" for name, run in made))
    return exits.DONE


def _write(place: Path, run: MechanismRun) -> None:
    columns = {"time_s": run.time_s}
    for p in (*run.mechanism.driven, *run.mechanism.bodies):
        columns[f"{p.name}_{p.unit}"] = run.position[p.name]
        columns[f"{p.name}_{p.unit}_per_s"] = run.speed[p.name]
    columns |= {s.name: run.sensor(s.name) for s in run.mechanism.sensors}
    table = np.column_stack(list(columns.values()))
    try:
        np.savetxt(place, table, fmt="%.9g", delimiter=",", header=",".join(columns), comments="")
    except OSError as error:
        reason = error.strerror or str(error)
        raise ParameterError(f"{place} cannot be written: {reason}", "--out", "Name another place.") from None
    tell(f"trajectory: {place}")


def _as_json(name: str, run: MechanismRun) -> dict[str, Any]:
    indeterminate = run.indeterminate
    return {
        "run": name,
        "samples": int(run.time_s.size),
        "bodies": {
            b.name: {
                "min": float(run.position[b.name].min()),
                "max": float(run.position[b.name].max()),
                "unit": b.unit,
                "at_rest_share": float(np.mean(run.speed[b.name] == 0.0)),
            }
            for b in run.mechanism.bodies
        },
        "events": [e.to_dict() for e in run.events],
        "energy_j": dict(run.energy_j),
        "balanced": run.balanced,
        "indeterminate": None if indeterminate is None else indeterminate.to_dict(),
    }
