"""A page of one leaf: a text as it prints itself, and its pictures below it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

from . import embed
from .figures_of import values
from .style import FONT


def write_leaf(path: str | os.PathLike[str], title: str, text: str, figure: Any = None, instead: str = "") -> None:
    """Write one HTML file that needs nothing but a browser.

    Parameters
    ----------
    path : path
        An existing file is replaced.
    title, text : str
        Plain text; escaped here.
    figure : plotly Figure, or sequence of (heading, plotly Figure), optional
    instead : str
        Plain text in the place of a figure where there is none, or no script may run.
    """
    named: Sequence[tuple[str, Any]] = figure if isinstance(figure, (list, tuple)) else [("", figure)]
    picture = "".join(
        (f"<h2>{escape(heading)}</h2>\n" if heading else "")
        + f'<div data-figure="picture{number}" role="img">{escape(instead)}</div>\n'
        for number, (heading, _) in enumerate(named)
    )
    if figure is not None:
        data = embed.safe_json({f"picture{number}": values(drawn) for number, (_, drawn) in enumerate(named)})
        picture += (
            f'<script type="application/json" id="luztar-figures">{data}</script>\n'
            f'<script type="application/gzip" id="luztar-plotly">{embed.packed(embed.library())}</script>\n'
            f"<script>{embed.drawing()}</script>\n"
        )
    page = (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title></head>\n'
        f'<body style="font-family:{FONT};margin:2em">\n<h1>{escape(title)}</h1>\n'
        f'<pre style="white-space:pre-wrap">{escape(text)}</pre>\n{picture}</body></html>\n'
    )
    Path(path).write_text(page, encoding="utf-8")
