"""Figures of the double lane change."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..manoeuvre.clearance import along, outline
from ..manoeuvre.synthesis import played
from .style import AFTER, BEFORE, DECOY, FLOOR, INK, QUIET, RUNS, dressed, numbers, panels, plain, plotly

if TYPE_CHECKING:
    from ..manoeuvre import Manoeuvre, Optimum, Robustness, Sensitivity, SignalMap
    from ..manoeuvre.indices import Indices

# How often the car is drawn along its path.
CARS_DRAWN = 12
# Beyond this kappa a clearance is below 5 cm: the picture need not follow it to infinity.
LARGEST_KAPPA = 20.0
# J_w near an edge grows without bound: shades end so many decades above the least.
DECADES = 1.0
SCALE = [[0.0, "#FFFFFF"], [0.5, "#9ECAE1"], [1.0, "#08519C"]]


def drives(optimum: Optimum) -> Any:
    """Return the drive under the best signal, and dashed under the runner-up.

    Parameters
    ----------
    optimum : Optimum
    """
    task = optimum.task
    signals = [("optimal", optimum.best.values, AFTER, "solid", 2.0)]
    if optimum.other is not None:
        signals.append(("runner-up", optimum.other.values, BEFORE, "dash", 1.5))
    picture = panels(
        rows=4,
        cols=1,
        row_heights=[0.4, 0.2, 0.2, 0.2],
        vertical_spacing=0.105,
        subplot_titles=[
            "Path of the reference point, the car, the corridor",
            "Handwheel" if task.steer == "angle" else "Steering torque",
            "Lateral acceleration",
            f"kappa: inverse of the distance from the nearest edge (outside and above: {LARGEST_KAPPA:g})",
        ],
    )
    _corridor(picture, task)
    for name, values, colour, dash, width in signals:
        drive = task.drive(values)
        line = {"color": colour, "dash": dash, "width": width}
        if name == "optimal":
            _bodies(picture, task, drive, colour)
        kappa = np.minimum(1.0 / np.maximum(along(drive, task.track, task.car), 1.0 / LARGEST_KAPPA), LARGEST_KAPPA)
        hand = (
            drive.handwheel_rad if task.steer == "angle" else task.direction * played(task.form, values, drive.time_s)
        )
        rows = [
            (drive.x_m, drive.y_m),
            (drive.time_s, hand),
            (drive.time_s, drive.lateral_acceleration_m_s2),
            (drive.time_s, kappa),
        ]
        for row, (x, y) in enumerate(rows, start=1):
            picture.add_scatter(
                x=numbers(x),
                y=numbers(y),
                mode="lines",
                line=line,
                name=name,
                legendgroup=name,
                showlegend=row == 1,
                row=row,
                col=1,
            )
    for level in (-task.limit_m_s2, task.limit_m_s2):
        picture.add_hline(y=level, line={"color": QUIET, "dash": "dot", "width": 1}, row=3, col=1)
    for row, (x, y) in enumerate(
        [("x [m]", "y [m]"), ("", f"[{task.unit}]"), ("", "[m/s\u00b2]"), ("time [s]", "[1/m]")], start=1
    ):
        picture.update_xaxes(title_text=x, row=row, col=1)
        picture.update_yaxes(title_text=y, row=row, col=1)
    picture.update_xaxes(range=[task.track.entry_m[0], task.track.exit_m[1] + 4.0], row=1, col=1)
    return dressed(picture, height=900, legend=True)


def _corridor(picture: Any, task: Manoeuvre) -> None:
    for start, end, right, left in task.track.sections():
        picture.add_scatter(
            x=[start, end, end, start, start],
            y=[right, right, left, left, right],
            mode="lines",
            fill="toself",
            fillcolor="rgba(154,160,166,0.14)",
            line={"color": INK, "width": 1},
            hoverinfo="skip",
            showlegend=False,
            row=1,
            col=1,
        )


def _bodies(picture: Any, task: Manoeuvre, drive: Any, colour: str) -> None:
    xs: list[float | None] = []
    ys: list[float | None] = []
    for at in np.linspace(0, len(drive.time_s) - 1, CARS_DRAWN).astype(int):
        x, y = outline(drive.x_m[at], drive.y_m[at], drive.yaw_rad[at], task.car)
        # None lifts the pen between two cars.
        xs += [*numbers(x), None]
        ys += [*numbers(y), None]
    picture.add_scatter(
        x=xs,
        y=ys,
        mode="lines",
        line={"color": colour, "width": 1},
        hoverinfo="skip",
        showlegend=False,
        row=1,
        col=1,
    )


def history(optimum: Optimum) -> Any:
    """Return the least criterion over the drives simulated.

    Parameters
    ----------
    optimum : Optimum
    """
    picture = plotly().Figure()
    stages = list(dict.fromkeys(s.stage for s in optimum.history))
    for stage, colour in zip(stages, (QUIET, AFTER, FLOOR, BEFORE, DECOY), strict=False):
        steps = [s for s in optimum.history if s.stage == stage]
        picture.add_scatter(
            x=[s.evaluations for s in steps],
            y=numbers(s.best for s in steps),
            mode="lines+markers",
            marker={"size": 4, "color": colour},
            line={"color": colour},
            name=stage,
        )
    picture.update_yaxes(type="log", title_text="least companion of J_w")
    picture.update_xaxes(title_text="drives simulated")
    return dressed(picture, height=340, legend=True)


def table(result: Robustness) -> Any:
    """Return the table of J_w: signals down, cars across.

    Parameters
    ----------
    result : Robustness
    """
    names = [f"{z:g} / {f:g}" for z, f in result.pairs]
    picture = plotly().Figure()
    finite = np.isfinite(result.criterion)
    with np.errstate(divide="ignore"):
        shade = np.where(finite, np.log10(np.where(finite, result.criterion, 1.0)), np.nan)
    texts = [[f"{v:.4g}" if np.isfinite(v) else "" for v in row] for row in result.criterion]
    picture.add_heatmap(
        x=names,
        y=names,
        z=[numbers(row) for row in shade],
        text=texts,
        texttemplate="%{text}",
        colorscale=SCALE,
        showscale=False,
        xgap=1,
        ygap=1,
        hovertemplate="signal for %{y}, car %{x}: %{text}<extra></extra>",
    )
    for i, row in enumerate(result.criterion):
        for j, value in enumerate(row):
            if not np.isfinite(value):
                picture.add_annotation(x=j, y=i, text="\u221e", showarrow=False, font={"color": "#A61B1B"})
    made = dressed(picture, height=170 + 36 * len(names))
    made.update_xaxes(type="category", title_text="car: half freeplay [rad] / friction [Nm]", showgrid=False)
    made.update_yaxes(
        type="category", title_text="signal optimised for", autorange="reversed", showgrid=False, zeroline=False
    )
    return made


def fine(result: Robustness, signal: int) -> Any:
    """Return J_w of one signal over the finer grid of cars; white with a cross where the limits break.

    Parameters
    ----------
    result : Robustness
    signal : int
    """
    picture = plotly().Figure()
    values = result.fine_criterion[signal]
    shown = np.where(np.isfinite(values), values, np.nan)
    picture.add_heatmap(
        x=numbers(result.fine_freeplay_rad),
        y=numbers(result.fine_friction_nm),
        z=[numbers(row) for row in np.log10(shown).T],
        zmax=float(np.log10(shown[np.isfinite(shown)].min())) + DECADES if np.isfinite(shown).any() else None,
        zmin=float(np.log10(shown[np.isfinite(shown)].min())) if np.isfinite(shown).any() else None,
        customdata=[numbers(row) for row in shown.T],
        colorscale=SCALE,
        colorbar={"title": {"text": "log10 J_w"}, "thickness": 14},
        hovertemplate="z0 %{x} rad, %{y} Nm: %{customdata}<extra></extra>",
    )
    out = np.argwhere(~np.isfinite(values))
    picture.add_scatter(
        x=numbers(result.fine_freeplay_rad[out[:, 0]]),
        y=numbers(result.fine_friction_nm[out[:, 1]]),
        mode="markers",
        marker={"symbol": "x-thin", "size": 5, "line": {"width": 1, "color": "#A61B1B"}},
        name="limits broken",
        hoverinfo="skip",
    )
    picture.update_xaxes(title_text="half freeplay z0 [rad]")
    picture.update_yaxes(title_text="friction [Nm]")
    return dressed(picture, height=380)


def differences(result: Robustness, signal: int) -> Any:
    """Return difference signals of all cars under one signal, against the car that it was optimised for.

    Parameters
    ----------
    result : Robustness
    signal : int
    """
    found = result.differences(signal)
    shown = (
        ("y_m", "Path: difference of y [m]"),
        ("lateral_acceleration_m_s2", "Difference of the lateral acceleration [m/s\u00b2]"),
        ("roadwheel_rad", "Difference of the road-wheel angle [rad]"),
    )
    picture = panels(rows=3, cols=1, shared_xaxes=True, vertical_spacing=0.08, subplot_titles=[t for _, t in shown])
    dashes = ("solid", "dash", "dot", "dashdot", "longdash")
    frictions = len(result.friction_nm)
    for i, (z, f) in enumerate(result.pairs):
        line = {"color": RUNS[i // frictions % len(RUNS)], "dash": dashes[i % frictions % len(dashes)], "width": 1.5}
        for row, (key, _) in enumerate(shown, start=1):
            picture.add_scatter(
                x=numbers(found["time_s"]),
                y=numbers(found[key][i]),
                mode="lines",
                line=line,
                name=f"{z:g} rad, {f:g} Nm",
                legendgroup=str(i),
                showlegend=row == 1,
                row=row,
                col=1,
            )
    picture.update_xaxes(title_text="time [s]", row=3, col=1)
    return dressed(picture, height=680, legend=True)


def maps(result: SignalMap) -> Any:
    """Return amplitude, frequency and J_w over length and speed; empty where no signal keeps the limits.

    Parameters
    ----------
    result : SignalMap
    """
    unit = result.tasks[0][0].unit
    shown = (
        (result.of("amplitude_1"), f"Amplitude A [{unit}]"),
        (result.of("frequency_1_hz"), "Frequency f [Hz]"),
        (result.criterion, "J_w"),
    )
    picture = panels(rows=1, cols=3, horizontal_spacing=0.09, subplot_titles=[plain(t) for _, t in shown])
    for col, (values, _) in enumerate(shown, start=1):
        picture.add_heatmap(
            x=[f"{v:g}" for v in result.speeds_m_s],
            y=[f"{v:g}" for v in result.lengths_m],
            z=[numbers(row) for row in values],
            texttemplate="%{z:.3g}",
            colorscale=SCALE,
            showscale=False,
            xgap=1,
            ygap=1,
            row=1,
            col=col,
        )
        picture.update_xaxes(type="category", title_text="speed [m/s]", showgrid=False, row=1, col=col)
        picture.update_yaxes(type="category", showgrid=False, zeroline=False, row=1, col=col)
    picture.update_yaxes(title_text="L [m]", row=1, col=1)
    return dressed(picture, height=160 + 50 * len(result.lengths_m))


def indices(result: Sensitivity) -> Any:
    """Return the indices of the three outputs with their 95 % intervals.

    Parameters
    ----------
    result : Sensitivity
    """
    parts: list[tuple[str, Indices | None]] = [
        ("whether the limits hold", result.on_feasibility),
        ("ln J_w where finite", result.on_criterion),
        ("rank among all drives", result.on_rank),
    ]
    picture = panels(
        rows=1, cols=3, shared_yaxes=True, horizontal_spacing=0.03, subplot_titles=[title for title, _ in parts]
    )
    names = list(result.ranges)
    for col, (_, found) in enumerate(parts, start=1):
        if found is None:
            continue
        for key, values, colour in (("first order", found.first, AFTER), ("total", found.total, BEFORE)):
            if values is None:
                continue
            picture.add_bar(
                orientation="h",
                y=names,
                x=numbers(values[n].value for n in names),
                error_x={
                    "type": "data",
                    "symmetric": False,
                    "array": numbers(max(values[n].high - values[n].value, 0.0) for n in names),
                    "arrayminus": numbers(max(values[n].value - values[n].low, 0.0) for n in names),
                    "thickness": 1,
                    "width": 3,
                },
                marker={"color": colour},
                name=key,
                legendgroup=key,
                showlegend=col == 1,
                row=1,
                col=col,
            )
    made = dressed(picture, height=150 + 42 * len(names), legend=True, barmode="group")
    made.update_yaxes(autorange="reversed", zeroline=False)
    return made
