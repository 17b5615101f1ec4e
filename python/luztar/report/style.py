"""What all figures share: colours, layout, numbers that a browser can read, text that stays text."""

from __future__ import annotations

import math
from collections.abc import Iterable
from html import escape
from typing import TYPE_CHECKING, Any


from ..errors import MissingError

if TYPE_CHECKING:
    from ..model.structure import Structure

# Colour-blind safe (Okabe and Ito); on paper they differ in lightness, too.
MEASURED = "#9AA0A6"
BEFORE = "#D55E00"
AFTER = "#0072B2"
FLOOR = "#009E73"
QUIET = "#B8BEC5"
DECOY = "#CC79A7"
RUNS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
INK = "#1F2933"
GRID = "#E4E7EB"
# Six digits are finer than any line on a screen, and a third of the characters of a full double.
DIGITS = 6


def plotly() -> Any:
    """Return plotly's module of figures.

    Raises
    ------
    MissingError
        Where plotly is not installed.
    """
    try:
        import plotly.graph_objects as go  # type: ignore[import-untyped]
    except ImportError as error:
        raise MissingError("figures need plotly", "figure", "pip install plotly") from error
    return go


def panels(**options: Any) -> Any:
    """Return an empty figure of several panels; see ``plotly.subplots.make_subplots``."""
    plotly()
    from plotly.subplots import make_subplots  # type: ignore[import-untyped]

    return make_subplots(**options)


def numbers(values: Iterable[float]) -> list[float | None]:
    """Return plain numbers of six digits, None where a value is not finite: JSON knows no NaN."""
    return [float(f"{v:.{DIGITS}g}") if math.isfinite(v) else None for v in map(float, values)]


def plain(text: str) -> str:
    """Return text that a figure shows as it is: plotly reads tags, links among them, in names and titles."""
    return escape(text, quote=False)


def motion_axis(structure: Structure) -> tuple[float, str, str]:
    """Return the factor, the quantity and the unit in which an engineer reads the motion."""
    if structure.motion_unit == "rad":
        return 180.0 / math.pi, structure.motion, "deg"
    return 1000.0, structure.motion, "mm"


def dressed(figure: Any, *, height: int, title: str = "", **layout: Any) -> Any:
    """Return the figure with the layout that all figures share."""
    # Without the default template a figure is 7 kB smaller.
    figure.update_layout(
        template="none",
        height=height,
        title={"text": title, "x": 0.0, "xanchor": "left", "font": {"size": 15}} if title else None,
        font={"family": "system-ui, 'Segoe UI', Helvetica, Arial, sans-serif", "size": 12, "color": INK},
        paper_bgcolor="white",
        plot_bgcolor="white",
        margin={"l": 70, "r": 20, "t": 60 if title else 34, "b": 50},
        legend={"orientation": "h", "y": -0.18, "x": 0.0},
        hovermode="closest",
    )
    figure.update_xaxes(gridcolor=GRID, zerolinecolor="#9AA5B1", linecolor="#9AA5B1", automargin=True)
    figure.update_yaxes(gridcolor=GRID, zerolinecolor="#9AA5B1", linecolor="#9AA5B1", automargin=True)
    figure.update_layout(**layout)
    return figure
