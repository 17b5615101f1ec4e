"""The check as a picture: torque over angle in the window, trend lines and limits."""

from __future__ import annotations

from collections import Counter
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import MissingError

if TYPE_CHECKING:
    from .check import Check, Trace

# One colour-blind safe hue per run (Okabe and Ito); the direction is told by the dash of the trend line.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
# Points per verification, shared by its crossings: a screen has no more columns, and a report must stay small.
MAX_POINTS = 2000
MIN_POINTS_PER_CROSSING = 50
# Above the highest curve or limit, for the limit's words.
ROOM = 1.12


def figure(check: Check) -> Any:
    """Return the check as a plotly figure; see :meth:`luztar.tb038.Check.figure`."""
    try:
        import plotly.graph_objects as go  # type: ignore[import-untyped]
    except ImportError as error:
        raise MissingError("figures need plotly", "figure", "pip install plotly") from error

    rules = check.rules
    half = rules.half_width_deg
    picture = go.Figure()
    names = list(dict.fromkeys(v.run for v in check.verifications))
    colour = {name: COLOURS[i % len(COLOURS)] for i, name in enumerate(names)}
    shown: set[tuple[str, str]] = set()
    crossings = Counter((trace.run, trace.direction) for trace in check.traces)
    # plotly reads tags, links among them, in names: a file's name stays text.
    for trace in check.traces:
        key = (trace.run, trace.direction)
        angle, torque = thinned(trace, max(MAX_POINTS // crossings[key], MIN_POINTS_PER_CROSSING))
        picture.add_scatter(
            x=angle,
            y=torque,
            mode="lines",
            name=escape(f"{trace.run} {trace.direction}", quote=False),
            legendgroup=escape(" ".join(key), quote=False),
            showlegend=key not in shown,
            line={"color": colour[trace.run], "width": 1},
        )
        shown.add(key)
    for v in check.verifications:
        if v.slope_nm_per_deg is None or v.intercept_nm is None:
            continue
        ends = [-half, half]
        picture.add_scatter(
            x=ends,
            y=[v.intercept_nm + v.slope_nm_per_deg * x for x in ends],
            mode="lines",
            name=escape(f"{v.run} {v.direction} trend", quote=False),
            legendgroup=escape(f"{v.run} {v.direction}", quote=False),
            showlegend=False,
            line={"color": colour[v.run], "width": 2, "dash": "solid" if v.direction == "increasing" else "dash"},
        )
    for level, word in ((rules.mean_max_nm, "upper limit"), (rules.mean_above_nm, "lower limit")):
        for sign in (1.0, -1.0):
            picture.add_hline(
                y=sign * level,
                line={"color": "black", "width": 1, "dash": "dot"},
                annotation_text=f"{word} {sign * level:+g} Nm",
            )
    highest = max([rules.mean_max_nm, *(v.max_abs_nm or 0.0 for v in check.verifications)])
    centred = ", hysteresis centre removed" if check.centred else ""
    picture.update_layout(
        title=f"{check.rule_set}: {check.verdict}{centred}",
        xaxis={"title": "angle [deg]", "range": [-1.05 * half, 1.05 * half]},
        # Both upper limits in sight, whichever way the torque lies.
        yaxis={"title": "torque [Nm]", "range": [-ROOM * highest, ROOM * highest]},
        template="plotly_white",
    )
    return picture


def thinned(trace: Trace, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a trace of about ``points`` points that keeps the least and greatest torque of every part."""
    n = trace.angle_deg.size
    if n <= points:
        return trace.angle_deg, trace.torque_nm
    edges = np.linspace(0, n, points // 2 + 1).astype(int)
    kept: set[int] = {0, n - 1}
    for a, b in zip(edges[:-1], edges[1:], strict=True):
        part = trace.torque_nm[a:b]
        kept.update((a + int(part.argmin()), a + int(part.argmax())))
    index = np.array(sorted(kept))
    return trace.angle_deg[index], trace.torque_nm[index]
