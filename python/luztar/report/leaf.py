"""A page of one leaf: a text as it prints itself, and a picture below it."""

from __future__ import annotations

import os
from html import escape
from pathlib import Path

from .style import FONT


def write_leaf(path: str | os.PathLike[str], title: str, text: str, picture: str) -> None:
    """Write one HTML file that needs nothing but a browser.

    Parameters
    ----------
    path : path
        An existing file is replaced.
    title, text : str
        Plain text; escaped here.
    picture : str
        HTML.
    """
    page = (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title></head>\n'
        f'<body style="font-family:{FONT};margin:2em">\n<h1>{escape(title)}</h1>\n'
        f'<pre style="white-space:pre-wrap">{escape(text)}</pre>\n{picture}\n</body></html>\n'
    )
    Path(path).write_text(page, encoding="utf-8")
