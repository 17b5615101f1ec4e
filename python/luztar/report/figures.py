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
from .style import AFTER, BEFORE, DECOY, FLOOR, INK, QUIET, dressed, numbers, plain, plotly, rounded

if TYPE_CHECKING:
    from ..diagnosis.diagnose import Diagnosis, Tried
    from ..diagnosis.fit import Fit
    from ..diagnosis.study import Step, Study

# The words at the end of the longest bar are 130 points wide, a third of what long labels leave of a printed page.
LABEL_ROOM = 1.55
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
    top = max([e.held_out_rms for e in errors] + [floor.high])
    picture.add_bar(
        orientation="h",
        x=numbers(e.held_out_rms for e in errors),
        y=list(range(len(steps))),
        marker={
            "color": [BEFORE if s.added is None else QUIET if s.provisional else AFTER for s in steps],
            "pattern": {"shape": ["/" if s.provisional else "" for s in steps]},
        },
        width=0.55,
        text=[f" {rounded(e.held_out_rms)} {e.unit} ({100 * e.held_out_relative:.1f} %)" for e in errors],
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
            "text": f"noise floor {rounded(floor.rms)} ({rounded(floor.low)} to {rounded(floor.high)}) {floor.unit}",
            "font": {"color": "#00694D"},
            "yanchor": "bottom",
            "xanchor": "left" if floor.rms < 0.5 * top else "right",
        },
        annotation_position="top",
    )
    # Room for the words at the end of the longest bar.
    picture.update_xaxes(
        range=[0.0, LABEL_ROOM * top], title_text=f"unseen error, rms [{floor.unit}] (% of the measurement)"
    )
    picture.update_yaxes(
        tickvals=list(range(len(steps))), ticktext=labels, range=[len(steps) - 0.45, -0.55], showgrid=False
    )
    return listed(picture, height=96 + 52 * len(steps), legend=False)


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
    shown = [c for c in diagnosis.candidates if math.isfinite(c.held_out_rms)]
    values = [c.held_out_rms for c in shown]
    base = diagnosis.unseen_rms
    low = min([*values, base])
    # Differences of less than a few per cent must not fill the picture, nor must what only does harm.
    spare = max(0.5 * (base - low), 0.04 * base)
    edge = base + spare
    beyond = "<br>triangles: beyond the edge" if any(v > edge for v in values) else ""
    best = "best" if len(diagnosis.named) == 1 else "cannot be told from the best"
    groups: list[tuple[str, str, str, list[Tried]]] = [
        (best, AFTER, "circle", [c for c in shown if _offered(c, diagnosis)]),
        ("other effects", QUIET, "circle", [c for c in shown if not _offered(c, diagnosis) and not c.decoy]),
        ("decoys: no physics, a ruler for chance", DECOY, "x", [c for c in shown if c.decoy]),
    ]
    picture = plotly().Figure()
    place = {c.effect: i for i, c in enumerate(shown)}
    for name, colour, symbol, members in groups:
        for clipped in (False, True):
            part = [c for c in members if (c.held_out_rms > edge) == clipped]
            if not part:
                continue
            picture.add_scatter(
                x=numbers(min(c.held_out_rms, edge) for c in part),
                y=[place[c.effect] for c in part],
                mode="markers",
                marker={
                    "color": colour,
                    "symbol": "triangle-right" if clipped else symbol,
                    "size": 11,
                    "line": {"color": INK, "width": 0.6},
                },
                name=name,
                legendgroup=name,
                showlegend=not clipped,
                hovertext=[f"{rounded(c.held_out_rms)}: {100 * c.gain:.1f} % off the error" for c in part],
                hoverinfo="text",
            )
    picture.add_vline(
        x=base,
        line={"color": BEFORE, "dash": "dash", "width": 1.5},
        annotation={"text": "without any of them", "font": {"color": BEFORE}, "yanchor": "bottom", "xanchor": "right"},
        annotation_position="top",
    )
    picture.update_xaxes(
        range=[low - 0.3 * spare, edge + 0.15 * spare],
        title_text=f"unseen error with the effect added [{fit.noise_floor.unit}]{beyond}",
    )
    structure = fit.model.structure_name
    labels = [f"{plain(card(c.effect, structure).title)}{_folded(c)} " for c in shown]
    picture.update_yaxes(tickvals=list(range(len(shown))), ticktext=labels, range=[len(shown) - 0.4, -0.6])
    return listed(picture, height=150 + 24 * len(shown))


def _offered(c: Tried, diagnosis: Diagnosis) -> bool:
    # Where nothing is named, the best of the candidates are no answer and are not highlighted.
    return c.effect in diagnosis.named


def _folded(c: Tried) -> str:
    # Long labels leave no room for the picture on paper; the table says it in words.
    return f" (= {c.same_as})" if c.same_as else ""


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
    for sound, colour, name in (
        (True, AFTER, "determined by the data"),
        (False, QUIET, "not determined, or no interval"),
    ):
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
    picture.update_xaxes(
        range=[-1.1 * widest, 1.1 * widest], title_text="95 % interval [% of the value]", zeroline=True
    )
    picture.update_yaxes(tickvals=list(range(len(labels))), ticktext=labels, range=[len(labels) - 0.4, -0.6])
    return listed(picture, height=130 + 42 * len(labels))


def listed(picture: Any, *, height: int, legend: bool = True) -> Any:
    """Return a figure whose rows are named things rather than numbers, its legend below it."""
    made = dressed(picture, height=height, legend=legend)
    # The rows count from 0, which is no place for an axis.
    made.update_yaxes(zeroline=False)
    return made
