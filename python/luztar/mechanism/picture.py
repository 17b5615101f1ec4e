"""Pictures of mechanisms: the network, a run, a reduction beside what it stands for."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any

import numpy as np

from .parts import Assistance

if TYPE_CHECKING:
    from .mechanism import Mechanism
    from .reduction import Reduction
    from .result import MechanismRun

_LINES = {"spring": "solid", "end_stop": "dash", "damper": "dot", "friction": "dashdot", "assistance": "longdash"}
_ROW = 90.0
# Elements between the same two nodes lie side by side, this far apart.
_APART = 0.13
# Assistance swings above the spring that it senses.
_BOW = 0.35


def _places(m: Mechanism) -> dict[str, tuple[float, float]]:
    """Columns by the number of elements from the first driven node or body, rows in the order of the bodies."""
    nodes = [p.name for p in (*m.driven, *m.bodies)]
    joined: dict[str, list[str]] = {n: [] for n in nodes}
    for e in m.elements:
        if not isinstance(e, Assistance) and e.a in joined and e.b in joined:
            joined[e.a].append(e.b)
            joined[e.b].append(e.a)
    depth: dict[str, int] = {}
    for root in nodes:
        if root in depth:
            continue
        depth[root] = 0
        ahead = deque([root])
        while ahead:
            node = ahead.popleft()
            for other in joined[node]:
                if other not in depth:
                    depth[other] = depth[node] + 1
                    ahead.append(other)
    places = {}
    for column in sorted(set(depth.values())):
        own = [n for n in nodes if depth[n] == column]
        places |= {n: (float(column), 0.5 * (len(own) - 1) - i) for i, n in enumerate(own)}
    return places


def network(m: Mechanism) -> Any:
    """Return the network: circles are bodies, diamonds driven nodes; lines are elements, bars at the foot the ground.

    Parameters
    ----------
    m : Mechanism
    """
    from ..report.style import INK, RUNS, dressed, plain, plotly

    places = _places(m)
    picture = plotly().Figure()
    colours = dict(zip(_LINES, RUNS, strict=False))
    drawn: dict[tuple[str, str], int] = {}
    shown: set[str] = set()
    for e in m.elements:
        a, b = (e.senses, e.on) if isinstance(e, Assistance) else (e.a, e.b)
        if isinstance(e, Assistance):
            sensed = m[e.senses]
            ends = [places.get(n, places[e.on]) for n in (sensed.a, sensed.b)]
            start, end = tuple(np.mean(ends, axis=0)), places[e.on]
        else:
            a, b = (b, a) if a == "ground" else (a, b)
            start = places[a]
            end = places.get(b, (start[0], start[1] - 0.42))
        count = drawn[a, b] = drawn.get((a, b), 0) + 1
        side = _APART * ((count // 2) * (1 if count % 2 else -1))
        along = b == "ground"
        xs = [start[0] + (side if along else 0.0), 0.5 * (start[0] + end[0]), end[0]]
        xs = [start[0] + side] * 3 if along else xs
        bow = _BOW if isinstance(e, Assistance) else side
        ys = [start[1], 0.5 * (start[1] + end[1]) + (0.0 if along else bow), end[1]]
        picture.add_scatter(
            x=xs,
            y=ys,
            mode="lines+markers" if along else "lines",
            marker={"symbol": "line-ew-open", "size": [0, 0, 12], "line": {"width": 2}},
            line={"dash": _LINES[e.KIND], "color": colours[e.KIND], "width": 2, "shape": "spline"},
            name=plain(e.KIND.replace("_", " ")),
            legendgroup=e.KIND,
            showlegend=e.KIND not in shown,
            hovertemplate=plain(e.name) + "<extra></extra>",
        )
        shown.add(e.KIND)
        if not along:
            picture.add_annotation(
                x=xs[1], y=ys[1], text=plain(e.name), showarrow=False, yshift=9, font={"size": 10, "color": INK}
            )
    for kind, parts, symbol in (("body", m.bodies, "circle"), ("driven node", m.driven, "diamond")):
        if parts:
            picture.add_scatter(
                x=[places[p.name][0] for p in parts],
                y=[places[p.name][1] for p in parts],
                mode="markers+text",
                text=[plain(p.name) for p in parts],
                textposition="top center",
                marker={"symbol": symbol, "size": 18, "color": "#FFFFFF", "line": {"color": INK, "width": 2}},
                name=kind,
            )
    tall = max(1, max(sum(x == column for x, _ in places.values()) for column, _ in places.values()))
    made = dressed(picture, height=200 + round(_ROW * tall), title=plain(m.title or "mechanism"))
    made.update_xaxes(visible=False, range=[-0.4, max(x for x, _ in places.values()) + 0.5])
    made.update_yaxes(visible=False)
    return made


def run(made: MechanismRun) -> Any:
    """Return positions over time, a panel per unit, and below them which frictions hold.

    Parameters
    ----------
    made : MechanismRun
    """
    from ..report.style import INK, RUNS, dressed, numbers, panels, plain

    m = made.mechanism
    units = [u for u in ("rad", "m") if any(p.unit == u for p in (*m.driven, *m.bodies))]
    frictions = list(made.sliding)
    rows = len(units) + bool(frictions)
    picture = panels(rows=rows, cols=1, shared_xaxes=True, vertical_spacing=0.06)
    t = numbers(made.time_s)
    for i, p in enumerate((*m.driven, *m.bodies)):
        row = units.index(p.unit) + 1
        colour = RUNS[i % len(RUNS)]
        picture.add_scatter(
            x=t, y=numbers(made.position[p.name]), name=plain(p.name), line={"color": colour}, row=row, col=1
        )
    for row, unit in enumerate(units, start=1):
        picture.update_yaxes(title_text=unit, row=row, col=1)
    for level, name in enumerate(frictions):
        holds = np.where(made.sliding[name] == 0, float(level), np.nan)
        picture.add_scatter(
            x=t,
            y=numbers(holds),
            mode="lines",
            line={"color": INK, "width": 6},
            name=plain(f"{name} holds"),
            showlegend=False,
            row=rows,
            col=1,
        )
    if frictions:
        picture.update_yaxes(
            tickvals=list(range(len(frictions))), ticktext=[plain(n) for n in frictions], row=rows, col=1
        )
    picture.update_xaxes(title_text="s", row=rows, col=1)
    return dressed(picture, height=180 + 190 * rows, title=plain(f"{m.title or 'mechanism'}, and what holds"))


def reduction(found: Reduction) -> Any:
    """Return mechanism and one mass over time, a panel per manoeuvre.

    Parameters
    ----------
    found : Reduction
    """
    from ..report.style import AFTER, MEASURED, dressed, numbers, panels, plain

    picture = panels(rows=len(found.errors), cols=1, subplot_titles=[plain(str(e)) for e in found.errors])
    for row, e in enumerate(found.errors, start=1):
        t = numbers(e.time_s)
        for name, values, colour in (("mechanism", e.mechanism, MEASURED), ("one mass", e.one_mass, AFTER)):
            picture.add_scatter(
                x=t, y=numbers(values), name=name, line={"color": colour}, showlegend=row == 1, row=row, col=1
            )
        picture.update_yaxes(title_text="rad", row=row, col=1)
    picture.update_xaxes(title_text="s", row=len(found.errors), col=1)
    return dressed(picture, height=100 + 190 * len(found.errors), title=plain(f"One mass at {found.at}"))
