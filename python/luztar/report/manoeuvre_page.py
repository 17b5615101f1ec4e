"""Pages of the double lane change: one self-contained HTML file per result."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import __version__
from ..errors import MissingError, ParameterError
from . import embed, manoeuvre_figures
from .figures_of import values
from .write import HERE, put_in_place

if TYPE_CHECKING:
    from ..manoeuvre import Optimum, Robustness, Sensitivity, SignalMap

# Key, title, words, figure.
Shown = tuple[str, str, str, Callable[[], Any]]


def write_optimum(path: str | os.PathLike[str], result: Optimum) -> None:
    """Write an optimum; its drive, and how the search came there."""
    if result.feasible:
        sentence = f"The best signal found costs J_w = {result.best.scores['criterion']:.4g}."
    else:
        sentence = f"No signal within the limits was found. Of the least bad one: {'; '.join(result.broken())}."
    shown: list[Shown] = [
        (
            "drives",
            "The drive",
            "Grey: where the body has to stay. Dotted: the limit of the lateral acceleration. Dashed: the best signal "
            "of another kind.",
            lambda: manoeuvre_figures.drives(result),
        ),
        (
            "history",
            "The search",
            "The companion equals J_w where the limits hold and the clearance is at least 0.1 m; beyond, it says by "
            "how much they break.",
            lambda: manoeuvre_figures.history(result),
        ),
    ]
    _write(path, result, "Double lane change: the optimal signal", sentence, result.feasible, shown)


def write_robustness(path: str | os.PathLike[str], result: Robustness) -> None:
    """Write a table of signals on cars, difference signals and the finer grid."""
    sentence = f"Most robust: {result.verdict()}."
    good = bool(result.infeasible_share[result.most_robust] < 1.0)
    shown: list[Shown] = [
        (
            "table",
            "Every signal on every car",
            "J_w; the diagonal is what each signal was optimised for.",
            lambda: manoeuvre_figures.table(result),
        ),
        (
            "differences-first",
            "Difference signals of the nominal signal",
            "What each car does beyond the first one, under the signal that was optimised for the first one.",
            lambda: manoeuvre_figures.differences(result, 0),
        ),
        (
            "fine-first",
            "The nominal signal on a finer grid of cars",
            "Crosses: the car leaves the corridor or passes the limit of the lateral acceleration.",
            lambda: manoeuvre_figures.fine(result, 0),
        ),
        (
            "fine-robust",
            "The most robust signal on a finer grid of cars",
            "As above.",
            lambda: manoeuvre_figures.fine(result, result.most_robust),
        ),
    ]
    _write(path, result, "Double lane change: freeplay, friction and the optimal signal", sentence, good, shown)


def write_map(path: str | os.PathLike[str], result: SignalMap) -> None:
    """Write a map of amplitude and frequency."""
    missing = sum(bool(why) for row in result.why for why in row)
    sentence = f"{result.criterion.size - missing} of {result.criterion.size} cells have a signal within the limits."
    shown: list[Shown] = [
        (
            "maps",
            "The optimal signal over length and speed",
            "First sine of the signal. Empty: no signal keeps the car in the corridor below the limit.",
            lambda: manoeuvre_figures.maps(result),
        )
    ]
    _write(path, result, "Double lane change: maps of the optimal signal", sentence, missing == 0, shown)


def write_sensitivity(path: str | os.PathLike[str], result: Sensitivity) -> None:
    """Write the indices of a sensitivity study."""
    share = 100.0 * result.feasible / result.drives
    sentence = f"{share:.1f} % of {result.drives} drives stay within the limits; none was dropped."
    shown: list[Shown] = [
        (
            "indices",
            "What decides",
            "Shares of the variance of three outputs, with 95 % intervals. J_w is infinite outside the limits: "
            "its rank among all drives has indices, and its logarithm within the limits.",
            lambda: manoeuvre_figures.indices(result),
        )
    ]
    _write(path, result, "Double lane change: sensitivity", sentence, True, shown)


def _write(
    path: str | os.PathLike[str], result: Any, title: str, sentence: str, good: bool, shown: Sequence[Shown]
) -> None:
    try:
        from jinja2 import Environment, FileSystemLoader, StrictUndefined
        from markupsafe import Markup
    except ImportError as error:
        raise MissingError("a report needs jinja2 and plotly", "report", "pip install jinja2 plotly") from error
    target = Path(path)
    if not target.parent.is_dir():
        raise ParameterError("there is no such folder", str(target.parent), "Make it first.")
    plotly_js, draw_js = embed.library(), embed.drawing()
    environment = Environment(
        loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    page = environment.get_template("manoeuvre.html.jinja").render(
        {
            "title": title,
            "date": datetime.now().astimezone().isoformat(sep=" ", timespec="seconds"),
            "version": __version__,
            "class": "found" if good else "open",
            "sentence": sentence,
            "figures": [{"key": key, "title": head, "words": words} for key, head, words, _ in shown],
            "text": str(result),
            "css": Markup((HERE / "report.css").read_text(encoding="utf-8")),
            "result": Markup(embed.safe_json(result.to_dict())),
            "drawn": Markup(embed.safe_json({key: values(make()) for key, _, _, make in shown})),
            "plotly_packed": Markup(embed.packed(plotly_js)),
            "draw_js": Markup(draw_js),
            "script_hashes": Markup(f"{embed.script_hash(plotly_js)} {embed.script_hash(draw_js)}"),
        }
    )
    put_in_place(target, page)
