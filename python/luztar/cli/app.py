"""The commands."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from . import exits
from .manoeuvre import manoeuvre
from .options import Band, Debug, Files, HeldOut, Json, Map, ModelName, Report, Resample, Unit

app = typer.Typer(
    name="luztar",
    help="Friction and freeplay of steering mechanisms: measured, compared with a model, and what is missing named.",
    epilog="Exit codes: 0 done or pass, 1 fail (tb038), 2 inconclusive, 3 usage or input error, 4 internal error.",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)

app.add_typer(manoeuvre)


def _version(wanted: bool) -> None:
    if wanted:
        from .. import __version__
        from .output import say

        say(f"luztar {__version__}")
        raise typer.Exit(exits.DONE)


@app.callback(invoke_without_command=True)
def start(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
    debug: Debug = False,
) -> None:
    """Say what there is where no command is given."""
    if context.invoked_subcommand is None:
        from .output import tell

        tell(context.get_help())
        raise typer.Exit(exits.INPUT)


@app.command()
def demo(
    out: Annotated[str, typer.Option("--out", metavar="DIR", help="Where the demo's files go.")] = "luztar-demo",
    json: Json = False,
    debug: Debug = False,
) -> int:
    """Run the main job on bundled data, with a report."""
    from .demo import run_demo

    return run_demo(out, json)


@app.command()
def tb038(
    runs: Files,
    map: Map = [],  # noqa: B006
    unit: Unit = [],  # noqa: B006
    link_distance_m: Annotated[
        float, typer.Option("--link-distance-m", metavar="M", help="Lever arm: torque = force times this distance.")
    ] = 0.52,
    centre: Annotated[
        bool, typer.Option("--centre", help="Take the hysteresis centre off first; shows both verdicts.")
    ] = False,
    resample: Resample = None,
    json: Json = False,
    report: Report = None,
    debug: Debug = False,
) -> int:
    """Check a steering robot's friction by Euro NCAP TB 038.

    Exit code 0 pass, 1 fail, 2 inconclusive. One file is one test; three are needed for a pass.
    """
    from ..tb038 import evaluate
    from .inputs import check_positive, read_runs
    from .output import say
    from .report import check_place, write

    check_place(report, runs)
    check_positive("--link-distance-m", link_distance_m, "metres")
    # The check counts copies itself and says so.
    given = read_runs(runs, mapped=map, units=unit, resample_hz=resample, drop_copies=False)
    check = evaluate(given.fitted, link_distance_m=link_distance_m, centre=centre)
    if report is not None:
        write(report, check=check)
    say(check.to_dict() if json else check)
    return exits.TB038[check.verdict]


@app.command()
def compare(
    runs: Files,
    model: ModelName,
    map: Map = [],  # noqa: B006
    unit: Unit = [],  # noqa: B006
    held_out: HeldOut = [],  # noqa: B006
    band: Band = None,
    resample: Resample = None,
    json: Json = False,
    debug: Debug = False,
) -> int:
    """Show how large a model's error is, and where.

    The error is set against the noise floor: what no model could remove.
    """
    from ..diagnosis import compare as compare_fit
    from ..diagnosis import fit as fit_model
    from .output import show

    start_from, given = _inputs(model, band, runs, held_out, map, unit, resample)
    show(compare_fit(fit_model(start_from, given.fitted, given.held_out)), given.every, json)
    return exits.DONE


@app.command()
def diagnose(
    runs: Files,
    model: ModelName,
    map: Map = [],  # noqa: B006
    unit: Unit = [],  # noqa: B006
    held_out: HeldOut = [],  # noqa: B006
    band: Band = None,
    resample: Resample = None,
    json: Json = False,
    debug: Debug = False,
) -> int:
    """Look once at what is missing from a model.

    Exit code 2 with too few strokes or an unreadable part.
    """
    from ..diagnosis import diagnose as diagnose_fit
    from ..diagnosis import fit as fit_model
    from ..errors import LuztarError
    from .inputs import unreadable
    from .output import show
    from .progress import bar

    start_from, given = _inputs(model, band, runs, held_out, map, unit, resample)
    try:
        with bar() as tell_progress:
            fitted = fit_model(start_from, given.fitted, given.held_out)
            each = None if tell_progress is None else (lambda done, total: tell_progress("diagnosing", done, total))
            look = diagnose_fit(fitted, progress=each)
    except LuztarError as error:
        raise unreadable(error, given.every, start_from) from None
    show(look, given.every, json)
    return _concluded(look.verdict, given)


@app.command()
def study(
    runs: Files,
    model: ModelName,
    map: Map = [],  # noqa: B006
    unit: Unit = [],  # noqa: B006
    held_out: HeldOut = [],  # noqa: B006
    band: Band = None,
    resample: Resample = None,
    max_effects: Annotated[
        int | None, typer.Option("--max-effects", metavar="N", min=0, help="Add at most so many effects. Default: 4.")
    ] = None,
    json: Json = False,
    report: Report = None,
    debug: Debug = False,
) -> int:
    """Diagnose, add, refit, until nothing is missing.

    Exit code 2 with too few strokes or an unreadable part.
    """
    from ..diagnosis import study as study_runs
    from ..errors import LuztarError
    from .inputs import unreadable
    from .output import show
    from .progress import bar
    from .report import check_of, check_place, write

    check_place(report, [*runs, *held_out, model])
    start_from, given = _inputs(model, band, runs, held_out, map, unit, resample)
    most = {} if max_effects is None else {"max_effects": max_effects}
    try:
        with bar() as tell_progress:
            result = study_runs(start_from, given.fitted, given.held_out, progress=tell_progress, **most)
    except LuztarError as error:
        raise unreadable(error, given.every, start_from) from None
    if report is not None:
        write(report, study=result, check=check_of(given.every, start_from))
    show(result, given.every, json)
    return _concluded(result.verdict, given)


@app.command()
def fit(
    runs: Files,
    model: ModelName,
    add: Annotated[list[str], typer.Option("--add", metavar="EFFECT", help="Add an effect to the model.")] = [],  # noqa: B006
    map: Map = [],  # noqa: B006
    unit: Unit = [],  # noqa: B006
    held_out: HeldOut = [],  # noqa: B006
    band: Band = None,
    resample: Resample = None,
    json: Json = False,
    debug: Debug = False,
) -> int:
    """Estimate a model's parameters, with 95 % intervals."""
    from ..diagnosis import fit as fit_model
    from .output import show

    start_from, given = _inputs(model, band, runs, held_out, map, unit, resample, add)
    show(fit_model(start_from, given.fitted, given.held_out), given.every, json)
    return exits.DONE


@app.command()
def plan(
    structure: Annotated[
        str, typer.Option("--structure", metavar="S", help="rig, axis, or a model file (TOML): the model in use.")
    ] = "rig",
    encoder_deg: Annotated[
        float | None, typer.Option("--encoder-deg", metavar="DEG", help="Step of the angle sensor. Default: 0.02.")
    ] = None,
    step_m: Annotated[
        float | None, typer.Option("--step-m", metavar="M", help="Step of an axis's position sensor. Default: 1e-6.")
    ] = None,
    rate: Annotated[
        float | None, typer.Option("--rate", metavar="HZ", help="Sample rate. Default: 500 for rig, 1000 for axis.")
    ] = None,
    speed: Annotated[
        tuple[float, float] | None,
        typer.Option("--speed", metavar="LOW HIGH", help="Speeds, deg/s or m/s. Default: 5 38; axis 0.04 0.13."),
    ] = None,
    speeds: Annotated[
        str | None, typer.Option("--speeds", metavar="LIST", help="Even speeds instead, two strokes each: 3,12,40.")
    ] = None,
    angle: Annotated[
        float | None, typer.Option("--angle", metavar="DEG", help="Strokes go beyond plus and minus this. Default: 50.")
    ] = None,
    travel_m: Annotated[
        float | None, typer.Option("--travel-m", metavar="M", help="Length of an axis's strokes. Default: 0.24.")
    ] = None,
    runs: Annotated[int, typer.Option("--runs", metavar="N", help="Runs.")] = 3,
    strokes: Annotated[int, typer.Option("--strokes", metavar="N", help="Strokes of each run.")] = 6,
    minutes: Annotated[
        float | None, typer.Option("--minutes", metavar="MIN", help="Length of all runs together, for --strokes.")
    ] = None,
    noise: Annotated[
        float | None,
        typer.Option("--noise", metavar="NM", help="Noise floor as compare shows it. Default: 0.02 Nm; axis 1 N."),
    ] = None,
    friction: Annotated[
        float | None, typer.Option("--friction", metavar="NM", help="Friction level. Default: 0.75 Nm; axis 20 N.")
    ] = None,
    json: Json = False,
    report: Report = None,
    debug: Debug = False,
) -> int:
    """Show beforehand what a test can see.

    The test is simulated: how small each effect may be, which pairs cannot be told apart, and which test would do it.
    """
    from .plan import run_plan

    return run_plan(
        structure,
        speeds,
        json,
        report,
        encoder_deg=encoder_deg,
        step_m=step_m,
        rate_hz=rate,
        speed=speed,
        angle_deg=angle,
        travel_m=travel_m,
        runs=runs,
        strokes=strokes,
        minutes=minutes,
        noise=noise,
        friction=friction,
    )


@app.command()
def simulate(
    model: Annotated[
        str, typer.Argument(metavar="MODEL", help="A steering model with every parameter given, or a mechanism.")
    ],
    runs: Annotated[
        list[str] | None, typer.Argument(metavar="RUN", help="Run files: their handwheel drives the model.")
    ] = None,
    sine: Annotated[
        tuple[float, float] | None,
        typer.Option("--sine", metavar="RAD HZ", help="Drive with a sine instead: amplitude and frequency."),
    ] = None,
    seconds: Annotated[float, typer.Option("--seconds", metavar="S", help="Length of the sine.")] = 10.0,
    rate: Annotated[float, typer.Option("--rate", metavar="HZ", help="Samples per second of the sine.")] = 500.0,
    out: Annotated[
        str | None,
        typer.Option("--out", metavar="F.csv", help="Write the trajectory; numbered where there are several."),
    ] = None,
    monte_carlo: Annotated[
        str | None,
        typer.Option("--monte-carlo", metavar="STUDY.toml", help="Draw many mechanisms; --out is a row for each."),
    ] = None,
    map: Map = [],  # noqa: B006
    unit: Unit = [],  # noqa: B006
    resample: Resample = None,
    report: Annotated[
        str | None, typer.Option("--report", metavar="F.html", help="Write an HTML page with pictures of every run.")
    ] = None,
    json: Json = False,
    debug: Debug = False,
) -> int:
    """Run a steering model: handwheel in, road wheel out.

    A mechanism of several bodies runs along its handwheel, or along its first driven node or load.

    Prints the events (stick, slip, reversal, contact, release) and where the energy went; with --monte-carlo, how what
    was kept of many runs is spread.
    """
    from .simulate import run_simulate

    return run_simulate(model, runs or [], sine, seconds, rate, out, report, monte_carlo, json, map, unit, resample)


@app.command()
def explain(
    effect: Annotated[str | None, typer.Argument(metavar="EFFECT", help="An effect's name.")] = None,
    report: Annotated[
        str | None, typer.Option("--report", metavar="F.html", help="Write the card with its picture as an HTML page.")
    ] = None,
    json: Json = False,
    debug: Debug = False,
) -> int:
    """Show the card of one effect, or the list."""
    from .explain import card_text, list_text, listed, write_card
    from .output import say

    if effect is None:
        say({"schema": 1, "effects": listed()} if json else list_text())
    else:
        from ..model import find_card

        found = find_card(effect.strip().lower().replace("-", "_").replace(" ", "_"))
        say({"schema": 1, **found.to_dict()} if json else card_text(found))
        if report is not None:
            write_card(report, found)
    return exits.DONE


def _inputs(
    model: str,
    band: float | None,
    runs: list[str],
    held_out: list[str],
    mapped: list[str],
    units: list[str],
    resample: float | None,
    add: list[str] | None = None,
) -> tuple[Any, Any]:
    """Return the model and the runs; the model first, as its mistakes show without reading a file."""
    from .inputs import find_model, read_runs

    start_from = find_model(model, band, add or ())
    return start_from, read_runs(runs, held_out, mapped=mapped, units=units, resample_hz=resample)


def _concluded(verdict: str, given: Any) -> int:
    """Return the exit code of a look: a run that is not whole leaves it inconclusive, whatever was found."""
    if not all(run.integrity.complete for run in given.every):
        return exits.INCONCLUSIVE
    return exits.of_verdict(verdict)
