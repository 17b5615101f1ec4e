"""The figures of results: the ladder, the candidates, the parameters; curves and maps are beside it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ..diagnosis.words import number
from ..model import card
from .curves import loops as loops
from .curves import loops_before_after as loops_before_after
from .curves import residual_time as residual_time
from .maps import where_before_after as where_before_after
from .maps import where_map as where_map
from .style import AFTER, BEFORE, DECOY, FLOOR, INK, QUIET, dressed, numbers, plain, plotly

if TYPE_CHECKING:
    from ..diagnosis.diagnose import Diagnosis, Tried
    from ..diagnosis.fit import Fit
    from ..diagnosis.study import Step, Study

# An interval wider than this is drawn to the edge: it says "not determined" either way.
WIDEST_PERCENT = 100.0


def ladder(study: Study) -> Any:
    """Return the unseen error step by step, with the noise floor from low to high as a band.

    Parameters
    ----------
    study : Study
    """
    picture = plotly().Figure()
    floor, steps = study.noise_floor, study.steps
    errors = [s.fit.error for s in steps]
    labels = [step_label(s, study) for s in steps]
    picture.add_bar(
        orientation="h",
        x=numbers(e.held_out_rms for e in errors),
        y=list(range(len(steps))),
        marker={
            "color": [BEFORE if s.added is None else QUIET if s.provisional else AFTER for s in steps],
            "pattern": {"shape": ["/" if s.provisional else "" for s in steps]},
        },
        width=0.55,
        text=[f" {number(e.held_out_rms)} {e.unit} ({100 * e.held_out_relative:.1f} % of the measurement)" for e in errors],
        textposition="outside",
        cliponaxis=False,
        hoverinfo="skip",
        showlegend=False,
    )
    picture.add_vrect(x0=floor.low, x1=floor.high, fillcolor=FLOOR, opacity=0.25, line_width=0, layer="above")
    picture.add_vline(
        x=floor.rms,
        line={"color": FLOOR, "width": 2},
        annotation={
            "text": f"noise floor {number(floor.rms)} ({number(floor.low)} to {number(floor.high)}) {floor.unit}",
            "font": {"color": "#00694D"},
            "yanchor": "bottom",
            "xanchor": "left",
        },
        annotation_position="top",
    )
    top = max([e.held_out_rms for e in errors] + [floor.high])
    # Room for the words at the end of the longest bar.
    picture.update_xaxes(range=[0.0, 1.4 * top], title_text=f"unseen error, rms [{floor.unit}]")
    picture.update_yaxes(
        tickvals=list(range(len(steps))), ticktext=labels, range=[len(steps) - 0.45, -0.55], showgrid=False
    )
    return dressed(picture, height=120 + 52 * len(steps))


def step_label(step: Step, study: Study) -> str:
    """Return what a step is called on an axis."""
    if step.added is None:
        return "model as given "
    structure = study.model.structure_name
    text = f"+ {plain(card(step.added, structure).title)}"
    others = [plain(card(n, structure).title) for n in step.set if n != step.added]
    if others:
        text += f"<br>(or {', '.join(others)})"
    return f"{text}{' (provisional)' if step.provisional else ''} "


def candidates(diagnosis: Diagnosis) -> Any:
    """Return the unseen error of the model with each candidate, decoys marked and the set highlighted.

    Parameters
    ----------
    diagnosis : Diagnosis
    """
    fit = diagnosis.fit
    unit = fit.noise_floor.unit
    listed = [c for c in diagnosis.candidates if math.isfinite(c.held_out_rms)]
    picture = plotly().Figure()
    groups: list[tuple[str, str, str, list[Tried]]] = [
        ("cannot be told from the best", AFTER, "circle", [c for c in listed if c.in_set and not c.decoy]),
        ("other effects", QUIET, "circle", [c for c in listed if not c.in_set and not c.decoy]),
        ("decoys: no physics, a ruler for chance", DECOY, "x", [c for c in listed if c.decoy]),
    ]
    place = {c.effect: i for i, c in enumerate(listed)}
    for name, colour, symbol, members in groups:
        if members:
            picture.add_scatter(
                x=numbers(c.held_out_rms for c in members),
                y=[place[c.effect] for c in members],
                mode="markers",
                marker={"color": colour, "symbol": symbol, "size": 11, "line": {"color": INK, "width": 0.6}},
                name=name,
                hovertext=[f"{100 * c.gain:.1f} % of the squared error" for c in members],
                hoverinfo="x+text",
            )
    values = [c.held_out_rms for c in listed]
    # The gain is a share of the squared error, so any candidate tells what the model has without it.
    base = math.sqrt(values[0] ** 2 / max(1.0 - listed[0].gain, 1e-12)) if listed else 0.0
    if listed:
        picture.add_vline(
            x=base,
            line={"color": BEFORE, "dash": "dash", "width": 1.5},
            annotation={"text": "without any of them", "font": {"color": BEFORE}, "yanchor": "bottom"},
            annotation_position="top",
        )
    # Differences of less than a few per cent must not fill the picture.
    low, high = min([*values, base]), max([*values, base])
    spare = max(0.06 * (high - low), 0.03 * high)
    picture.update_xaxes(range=[low - spare, high + spare], title_text=f"unseen error with this effect added, rms [{unit}]")
    structure = fit.model.structure_name
    labels = [f"{plain(card(c.effect, structure).title)}{_folded(c)} " for c in listed]
    picture.update_yaxes(tickvals=list(range(len(listed))), ticktext=labels, range=[len(listed) - 0.4, -0.6])
    return dressed(picture, height=150 + 24 * len(listed), legend={"orientation": "h", "y": -80 / (60 + 24 * max(len(listed), 1))})


def _folded(c: Tried) -> str:
    return f" (came out as {c.same_as})" if c.same_as else ""


def parameters(fit: Fit) -> Any:
    """Return the parameters' 95 % intervals, each in per cent of its value.

    Parameters
    ----------
    fit : Fit
    """
    picture = plotly().Figure()
    labels = []
    rows: dict[bool, list[tuple[int, float, float]]] = {True: [], False: []}
    for place, (key, e) in enumerate(fit.parameters.items()):
        labels.append(f"{plain(key)}<br>{number(e.value)} {e.unit} ")
        size = abs(e.value)
        if e.low is None or e.high is None or size == 0.0:
            rows[False].append((place, 0.0, 0.0))
            continue
        below, above = 100.0 * (e.value - e.low) / size, 100.0 * (e.high - e.value) / size
        rows[e.identifiable].append((place, min(below, WIDEST_PERCENT), min(above, WIDEST_PERCENT)))
    for sound, colour, name in ((True, AFTER, "determined by the data"), (False, QUIET, "not determined, or no interval")):
        if rows[sound]:
            picture.add_scatter(
                x=[0.0] * len(rows[sound]),
                y=[place for place, _, _ in rows[sound]],
                error_x={
                    "type": "data",
                    "symmetric": False,
                    "array": numbers(above for _, _, above in rows[sound]),
                    "arrayminus": numbers(below for _, below, _ in rows[sound]),
                    "color": colour,
                    "thickness": 2,
                },
                mode="markers",
                marker={"color": colour, "size": 9, "symbol": "circle" if sound else "circle-open"},
                name=name,
                hoverinfo="skip",
            )
    widest = max([5.0, *(max(b, a) for part in rows.values() for _, b, a in part)])
    picture.update_xaxes(range=[-1.1 * widest, 1.1 * widest], title_text="95 % interval [% of the value]", zeroline=True)
    picture.update_yaxes(tickvals=list(range(len(labels))), ticktext=labels, range=[len(labels) - 0.4, -0.6])
    return dressed(picture, height=130 + 42 * len(labels), legend={"orientation": "h", "y": -80 / (60 + 42 * max(len(labels), 1))})
