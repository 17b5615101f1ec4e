"""Curves of a fit: measured and modelled loops, and the residual over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .downsample import MAX_POINTS, extremes
from .style import AFTER, BEFORE, MEASURED, RUNS, dressed, motion_axis, numbers, panels, plain, plotly

if TYPE_CHECKING:
    from ..diagnosis.fit import Fit
    from ..diagnosis.prepare import Prepared
    from ..diagnosis.study import Study

# Points of all curves of one figure together: a report with ten of them stays below 3 MB.
FIGURE_POINTS = 16000
# More panels than this do not fit a page; the others are left to the numbers.
MOST_PANELS = 12
PANEL_HEIGHT = 150
# Of one of several panels of loops.
LOOP_HEIGHT = 260


def loops(fit: Fit) -> Any:
    """Return measured and modelled torque (or force) over the motion, a curve per run.

    Parameters
    ----------
    fit : Fit
    """
    channels = _channels(fit)
    picture = panels(rows=len(channels), cols=1, shared_xaxes=True, vertical_spacing=0.04)
    for row, channel in enumerate(channels, start=1):
        for trace in _loop_traces(fit, channel, AFTER, "model", _budget(2 * len(fit.runs))):
            trace.showlegend = bool(trace.showlegend) and row == 1
            picture.add_trace(trace, row=row, col=1)
        picture.update_yaxes(title_text=_effort(fit, channel), row=row, col=1)
    picture.update_xaxes(title_text=_abscissa_title(fit), row=len(channels), col=1)
    height = 500 if len(channels) == 1 else 80 + LOOP_HEIGHT * len(channels)
    return dressed(picture, height=height, title="Measured and modelled loops", legend=True)


def loops_before_after(study: Study) -> Any:
    """Return the loops of the model as given and of the model after the last step, side by side.

    Parameters
    ----------
    study : Study
    """
    first, last = study.steps[0].fit, study.steps[-1].fit
    added = len(study.steps) > 1
    titles = ["model as given", f"after step {len(study.steps) - 1}"] if added else ["model as given"]
    channels = _channels(first)
    picture = panels(
        rows=len(channels),
        cols=len(titles),
        subplot_titles=titles,
        shared_yaxes=True,
        horizontal_spacing=0.04,
        vertical_spacing=0.04,
    )
    for column, fit in enumerate([first, last][: len(titles)], start=1):
        colour = BEFORE if column == 1 and added else AFTER
        words = ("model as given" if added else "model") if column == 1 else "model after the last step"
        for row, channel in enumerate(channels, start=1):
            for trace in _loop_traces(fit, channel, colour, words, _budget(4 * len(fit.runs))):
                # The measurement is the same on both sides: one entry in the legend switches both.
                named = row == 1 and (column == 1 or trace.legendgroup != "measured")
                trace.showlegend = bool(trace.showlegend) and named
                picture.add_trace(trace, row=row, col=column)
            if column == 1:
                picture.update_yaxes(title_text=_effort(first, channel), row=row, col=1)
    picture.update_xaxes(title_text=_abscissa_title(first), row=len(channels))
    return dressed(picture, height=460 if len(channels) == 1 else 80 + LOOP_HEIGHT * len(channels), legend=True)


def residual_time(fit: Fit) -> Any:
    """Return the residual over time, a panel per run, with the strokes behind it.

    Parameters
    ----------
    fit : Fit
    """
    shown = list(zip(fit.runs, fit.residual, strict=True))[:MOST_PANELS]
    picture = panels(
        rows=len(shown), cols=1, subplot_titles=[plain(r.name) for r, _ in shown], vertical_spacing=0.32 / len(shown)
    )
    limit = max(float(np.abs(e[r.usable]).max(initial=0.0)) for r, e in shown) or 1.0
    for row, (r, error) in enumerate(shown, start=1):
        values = np.where(r.usable, error, np.nan)
        at = extremes(values, points=_budget(len(shown)))
        picture.add_scatter(
            x=numbers(r.time_s[at]),
            y=numbers(values[at]),
            mode="lines",
            line={"color": RUNS[(row - 1) % len(RUNS)], "width": 1},
            name=plain(r.name),
            showlegend=False,
            row=row,
            col=1,
        )
        # After the curve: a panel without one takes no shapes.
        for s in r.strokes:
            if s.direction > 0:
                edges = {"x0": float(r.time_s[s.onset]), "x1": float(r.time_s[s.last - 1])}
                picture.add_vrect(**edges, fillcolor="#DCE8F4", line_width=0, layer="below", row=row, col=1)
    picture.update_xaxes(range=[0.0, max(float(r.time_s[-1]) for r, _ in shown)], showgrid=False)
    picture.update_yaxes(range=[-1.05 * limit, 1.05 * limit], title_text=fit.noise_floor.unit)
    picture.update_xaxes(title_text="time [s]", row=len(shown), col=1)
    return dressed(picture, height=80 + PANEL_HEIGHT * len(shown))


def _loop_traces(fit: Fit, channel: str, colour: str, words: str, points: int) -> list[Any]:
    go = plotly()
    measured: list[Any] = []
    modelled: list[Any] = []
    chosen = [(r, p) for r, p in zip(fit.runs, fit.predicted, strict=True) if r.channel == channel]
    for number, (r, predicted) in enumerate(chosen):
        x = _abscissa(fit, r)[r.usable]
        for values, into, name, line in (
            (r.effort, measured, "measured", {"color": MEASURED, "width": 3.5}),
            (predicted, modelled, words, {"color": colour, "width": 1}),
        ):
            y = values[r.usable]
            at = extremes(x, y, points=points)
            trace = go.Scatter(
                x=numbers(x[at]),
                y=numbers(y[at]),
                mode="lines",
                line=line,
                name=name,
                legendgroup=name,
                showlegend=number == 0,
                hovertext=plain(r.name),
                hoverinfo="x+y+text",
            )
            into.append(trace)
    return [*measured, *modelled]


def _budget(traces: int) -> int:
    return max(min(MAX_POINTS, FIGURE_POINTS // max(traces, 1)), 200)


def _abscissa(fit: Fit, r: Prepared) -> np.ndarray:
    """Return the motion, or the time where the motion itself is what is explained."""
    structure = fit.model.structure
    return r.time_s if structure.drive else r.motion * motion_axis(structure)[0]


def _abscissa_title(fit: Fit) -> str:
    structure = fit.model.structure
    if structure.drive:
        return "time [s]"
    _, motion, unit = motion_axis(structure)
    return f"{motion} [{unit}]"


def _channels(fit: Fit) -> list[str]:
    """Return the channels that are explained, in their order; one without a name where there is only one."""
    return list(dict.fromkeys(r.channel for r in fit.runs))


def _effort(fit: Fit, channel: str) -> str:
    structure = fit.model.structure
    return f"{(channel or structure.effort).replace('_', ' ')} [{structure.effort_unit}]"
