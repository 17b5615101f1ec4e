"""Figures of a free run: angles over time with stick shaded, phase portrait, friction over speed, energies."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from .downsample import extremes
from .style import AFTER, BEFORE, FLOOR, INK, MEASURED, QUIET, RUNS, dressed, numbers, panels

if TYPE_CHECKING:
    from ..dynamics.trajectory import Trace

STICK = "#F3DFC1"
# Points of one curve: the figure has five, and its page stays below 1 MB beside plotly itself.
POINTS = 3000
# Rests beyond this are too narrow to be seen one by one, and each is an object of the page.
MOST_RESTS = 400


def free_run(trace: Trace) -> Any:
    """Return the figure of one traced run.

    Parameters
    ----------
    trace : Trace
    """
    titles = (
        "angles over time; shaded: at rest",
        "speed of the road wheel",
        "phase portrait",
        "friction over speed",
        "energy",
    )
    picture = panels(
        rows=3,
        cols=3,
        specs=[[{"colspan": 3}, None, None], [{"colspan": 3}, None, None], [{}, {}, {}]],
        row_heights=[0.34, 0.2, 0.46],
        subplot_titles=titles,
        vertical_spacing=0.1,
        horizontal_spacing=0.11,
    )
    _over_time(picture, trace)
    _phase(picture, trace)
    _friction(picture, trace)
    _energy(picture, trace)
    made = dressed(picture, height=900, legend=True)
    made.update_layout(legend={"itemsizing": "constant"})
    made.update_xaxes(title_standoff=6)
    _shade_rests(made, trace)
    return made


def _over_time(picture: Any, trace: Trace) -> None:
    # Both at the road wheel would need the ratio; as they are, each on the scale that its own size asks for.
    hand, wheel = trace.handwheel_rad, trace.roadwheel_rad
    scale = _round_factor(np.abs(hand).max(), np.abs(wheel).max())
    shown = "road wheel" if scale == 1 else f"road wheel x {scale}"
    for values, name, colour, width in (
        (np.rad2deg(hand), "handwheel", MEASURED, 2.5),
        (scale * np.rad2deg(wheel), shown, AFTER, 1.6),
    ):
        _line(picture, trace.time_s, values, name, colour, width, row=1, col=1)
    _line(picture, trace.time_s, np.rad2deg(trace.speed_rad_s), "speed", RUNS[2], 1.4, row=2, col=1, legend=False)
    _events(picture, trace)
    picture.update_yaxes(title_text="deg", row=1, col=1)
    picture.update_yaxes(title_text="deg/s", row=2, col=1)
    span = [float(trace.time_s[0]), float(trace.time_s[-1])]
    picture.update_xaxes(range=span, showticklabels=False, showgrid=False, row=1, col=1)
    picture.update_xaxes(range=span, matches="x", title_text="time [s]", showgrid=False, row=2, col=1)


def _events(picture: Any, trace: Trace) -> None:
    for kinds, name, symbol, colour in (
        (("slip",), "breaks away", "triangle-up", BEFORE),
        (("stick",), "comes to rest", "triangle-down", INK),
        (("reversal",), "turns", "diamond", RUNS[3]),
    ):
        times = np.array([e.time_s for e in trace.events if e.kind in kinds])
        if not 0 < times.size <= MOST_RESTS:
            continue
        picture.add_scatter(
            x=numbers(times),
            y=[0.0] * times.size,
            mode="markers",
            marker={"symbol": symbol, "size": 8, "color": colour},
            name=name,
            hoverinfo="x+name",
            row=2,
            col=1,
        )


def _phase(picture: Any, trace: Trace) -> None:
    _line(
        picture,
        np.rad2deg(trace.roadwheel_rad),
        np.rad2deg(trace.speed_rad_s),
        "phase portrait",
        AFTER,
        1.2,
        row=3,
        col=1,
        legend=False,
    )
    # A curve is drawn to its last pixel, not to the edge of the panel.
    wheel = np.rad2deg(trace.roadwheel_rad)
    room = 0.06 * float(np.ptp(wheel)) or 1.0
    picture.update_xaxes(
        range=[float(wheel.min()) - room, float(wheel.max()) + room], title_text="road wheel [deg]", row=3, col=1
    )
    picture.update_yaxes(title_text="deg/s", row=3, col=1)


def _friction(picture: Any, trace: Trace) -> None:
    moving = trace.speed_rad_s != 0.0
    # The step after a sample: where it holds an event, its mean is between what was before and after.
    whole = moving & np.append(moving[1:], True) & (np.sign(trace.speed_rad_s) == np.sign(_next(trace.speed_rad_s)))
    for chosen, name, colour, size in (
        (~moving, "held at rest", STICK, 5),
        (whole, "friction in motion", AFTER, 3),
    ):
        speed, torque = np.rad2deg(trace.speed_rad_s[chosen]), trace.friction_nm[chosen]
        if not speed.size:
            continue
        at = extremes(speed, torque, points=POINTS)
        picture.add_scatter(
            x=numbers(speed[at]),
            y=numbers(torque[at]),
            mode="markers",
            marker={"size": size, "color": "#D9A441" if colour == STICK else colour},
            name=name,
            hoverinfo="x+y",
            row=3,
            col=2,
        )
    picture.update_xaxes(title_text="road wheel [deg/s]", row=3, col=2)
    picture.update_yaxes(title_text="Nm", row=3, col=2)


def _energy(picture: Any, trace: Trace) -> None:
    e = trace.energy_j
    rows = [
        ("handwheel", e["handwheel"], AFTER),
        ("load", e["load"], AFTER),
        ("stored", -(e["stored_last"] - e["stored_first"]), FLOOR),
        ("dry friction", -e["dry"], BEFORE),
        ("viscous", -e["viscous"], BEFORE),
        ("other friction", -e["curved"], BEFORE),
        ("residual", e["residual"], QUIET if trace.balanced else RUNS[3]),
    ]
    # What is nothing at all is no row; the residual always is one.
    shown = [r for r in rows if r[1] != 0.0 or r[0] == "residual"]
    picture.add_bar(
        orientation="h",
        x=numbers(value for _, value, _ in shown),
        y=[name for name, _, _ in shown],
        marker={"color": [colour for _, _, colour in shown]},
        text=[f" {value:.3g} J " for _, value, _ in shown],
        textposition="outside",
        cliponaxis=False,
        showlegend=False,
        hoverinfo="skip",
        row=3,
        col=3,
    )
    # Room for the words at the ends of the bars.
    low, high = min(0.0, *(v for _, v, _ in shown)), max(0.0, *(v for _, v, _ in shown))
    room = 0.45 * (high - low) or 1.0
    picture.update_xaxes(range=[low - room, high + room], title_text="put in (+), taken out (-) [J]", row=3, col=3)
    picture.update_yaxes(autorange="reversed", showgrid=False, row=3, col=3)


def _shade_rests(picture: Any, trace: Trace) -> None:
    still = np.concatenate([[False], trace.speed_rad_s == 0.0, [False]])
    edges = np.flatnonzero(np.diff(still.astype(np.int8)))
    # A single sample has no width.
    rests = [(first, end - 1) for first, end in zip(edges[::2], edges[1::2], strict=True) if end - first > 1]
    if len(rests) > MOST_RESTS:
        return
    shapes = [
        {
            "type": "rect",
            "xref": "x",
            "yref": axis,
            "x0": float(trace.time_s[first]),
            "x1": float(trace.time_s[last]),
            "y0": 0,
            "y1": 1,
            "fillcolor": STICK,
            "line": {"width": 0},
            "layer": "below",
        }
        for first, last in rests
        for axis in ("y domain", "y2 domain")
    ]
    picture.update_layout(shapes=shapes)


def _line(
    picture: Any,
    x: np.ndarray,
    y: np.ndarray,
    name: str,
    colour: str,
    width: float,
    *,
    row: int,
    col: int,
    legend: bool = True,
) -> None:
    at = extremes(x, y, points=POINTS)
    picture.add_scatter(
        x=numbers(x[at]),
        y=numbers(y[at]),
        mode="lines",
        line={"color": colour, "width": width},
        name=name,
        showlegend=legend,
        hoverinfo="x+y",
        row=row,
        col=col,
    )


def _next(values: np.ndarray) -> np.ndarray:
    return np.append(values[1:], values[-1])


def _round_factor(large: float, small: float) -> int:
    """Return 1, 2, 5, 10 ...: by what the smaller is shown larger, so that both are seen."""
    if not (large > 0.0 and small > 0.0 and large >= 2.0 * small):
        return 1
    power = 10 ** math.floor(math.log10(large / small))
    return int(max(step * power for step in (1, 2, 5) if step * power <= large / small))
