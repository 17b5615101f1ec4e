"""The command that looks at a test before anybody turns a wheel."""

from __future__ import annotations

from typing import Any

from ..errors import ParameterError
from . import exits
from .inputs import find_model
from .output import say
from .report import check_place, written


def run_plan(structure: str, speeds: str | None, json: bool, report: str | None, **options: Any) -> int:
    """Plan a test and print what it can see.

    Parameters
    ----------
    structure : str
        A built-in structure's name or a model file.
    speeds : str or None
        Even speeds with commas between.
    json : bool
    report : str or None
        Where to write the plan as HTML.
    **options
        As :func:`luztar.plan` takes them; None leaves one as usual.
    """
    from ..planning import plan

    check_place(report)
    given = {k: v for k, v in options.items() if v is not None}
    model = find_model(structure, None, ())
    try:
        result = plan(model, speeds=_numbers(speeds), **given)
    except ParameterError as error:
        raise ParameterError(error.kind, _option(error.where), error.remedy) from None
    if report is not None:
        written(report, lambda: result.report(report))
    say(result.to_dict() if json else result)
    return exits.DONE


def _option(name: str) -> str:
    """Return what a value is called on the command line."""
    short = {"angle_deg": "angle", "rate_hz": "rate"}.get(name, name)
    return short if short.startswith("--") else f"--{short.replace('_', '-')}"


def _numbers(text: str | None) -> tuple[float, ...]:
    if text is None:
        return ()
    try:
        return tuple(float(word) for word in text.split(","))
    except ValueError:
        raise ParameterError(f"'{text}' is no list of speeds", "--speeds", "Give numbers: --speeds 3,12,40.") from None
