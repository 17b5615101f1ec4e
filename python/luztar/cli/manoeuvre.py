"""The commands of the double lane change: a study file in, a result out."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from . import exits
from .options import Debug, Json, Report

manoeuvre = typer.Typer(
    name="manoeuvre",
    help="Optimise a double lane change and disturb it.",
    epilog="Exit codes: 0 done, 2 no signal within the limits (optimise), 3 usage or input error, 4 internal error.",
    rich_markup_mode=None,
    no_args_is_help=True,
)

StudyFile = Annotated[str, typer.Argument(metavar="STUDY.toml", help="The manoeuvre and what is studied about it.")]
Seed = Annotated[int | None, typer.Option("--seed", metavar="N", min=0, help="Other than the file's.")]
EffortOption = Annotated[
    str | None,
    typer.Option("--effort", metavar="E", help="Of the search: quick, usual or hard; other than the file's."),
]
Steer = Annotated[
    str | None, typer.Option("--steer", metavar="S", help="angle (kinematic) or torque (dynamic), not the file's.")
]
JournalOption = Annotated[
    str | None,
    typer.Option("--journal", metavar="F.jsonl", help="Keep finished cells here; an interrupted study goes on."),
]


@manoeuvre.command()
def optimise(
    study: StudyFile,
    seed: Seed = None,
    effort: EffortOption = None,
    steer: Steer = None,
    json: Json = False,
    report: Report = None,
    debug: Debug = False,
) -> int:
    """Find the signal with the least criterion J_w.

    Exit code 2 where no signal keeps the car in the corridor below the limit of the lateral acceleration.
    """
    result = _run("optimise", study, (seed, effort, steer), None, json, report)
    return exits.DONE if result.feasible else exits.INCONCLUSIVE


@manoeuvre.command()
def robust(
    study: StudyFile,
    seed: Seed = None,
    effort: EffortOption = None,
    steer: Steer = None,
    journal: JournalOption = None,
    json: Json = False,
    report: Report = None,
    debug: Debug = False,
) -> int:
    """Try signals optimised for each freeplay and friction on the cars of all others."""
    _run("robust", study, (seed, effort, steer), journal, json, report)
    return exits.DONE


@manoeuvre.command()
def sensitivity(
    study: StudyFile,
    seed: Seed = None,
    effort: EffortOption = None,
    steer: Steer = None,
    journal: JournalOption = None,
    json: Json = False,
    report: Report = None,
    debug: Debug = False,
) -> int:
    """Share out feasibility, J_w and rank among the parameters of the car."""
    _run("sensitivity", study, (seed, effort, steer), journal, json, report)
    return exits.DONE


@manoeuvre.command(name="map")
def map_(
    study: StudyFile,
    seed: Seed = None,
    effort: EffortOption = None,
    steer: Steer = None,
    journal: JournalOption = None,
    json: Json = False,
    report: Report = None,
    debug: Debug = False,
) -> int:
    """Optimise over lengths of the corridor and speeds."""
    _run("map", study, (seed, effort, steer), journal, json, report)
    return exits.DONE


def _run(
    what: str,
    place: str,
    given: tuple[int | None, str | None, str | None],
    journal: str | None,
    json: bool,
    report: str | None,
) -> Any:
    from .. import manoeuvre as studies
    from .output import say
    from .progress import bar
    from .report import check_place, written

    check_place(report, [place])
    seed, effort, steer = given
    study = studies.load(place, **({} if steer is None else {"steer": steer}))
    shared = {**study.search, **{k: v for k, v in (("seed", seed), ("effort", effort)) if v is not None}}
    own = dict(getattr(study, what, {}))
    if what != "optimise":
        shared["journal"] = journal
    with bar() as tell_progress:
        shared["progress"] = tell_progress
        if what == "map":
            options = {k: v for k, v in study.options.items() if k not in ("length_m", "speed_m_s")}
            result: Any = studies.map(study.name, **_required(place, own), **options, **shared)
        else:
            result = getattr(studies, what)(study.task(), **own, **shared)
    if report is not None:
        written(report, lambda: result.report(report))
    say(result.to_dict() if json else result)
    return result


def _required(place: str, given: dict[str, Any]) -> dict[str, Any]:
    from ..errors import ModelError

    for key in ("lengths_m", "speeds_m_s"):
        if key not in given:
            raise ModelError(f"[map] has no '{key}'", place, f"Add [map] with {key} = [...].")
    return given
