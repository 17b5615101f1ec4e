"""Takes a picture of plotly figures, one below the other, as the browser draws them.

Needs playwright and Chromium.
"""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from playwright.sync_api import sync_playwright
from plotly.offline import get_plotlyjs

from luztar.report import embed
from luztar.report.figures_of import values

WIDTH = 960


def screenshot(figures: Sequence[Any], target: Path, *, scale: float = 1.25) -> None:
    """Draw figures below each other and keep them as one PNG of :data:`WIDTH` pixels times ``scale``."""
    made = embed.safe_json([values(figure) for figure in figures])
    places = "".join(f"<div id='p{number}'></div>" for number in range(len(figures)))
    text = (
        f"<!DOCTYPE html><meta charset='utf-8'><body style='margin:8px;background:#fff;width:{WIDTH}px'>"
        f"{places}<script>{embed.safe_script(get_plotlyjs())}</script><script>"
        f"const made={made};made.forEach((figure,i)=>Plotly.newPlot('p'+i,figure.data,"
        f"{{...figure.layout,width:{WIDTH}}},{{staticPlot:true}}));document.title='drawn'</script>"
    )
    path = shutil.which("chromium") or shutil.which("google-chrome")
    with sync_playwright() as p:
        browser = p.chromium.launch(executable_path=path, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": WIDTH + 16, "height": 600}, device_scale_factor=scale)
        page.set_content(text)
        page.wait_for_function("document.title === 'drawn'")
        page.wait_for_timeout(500)
        page.screenshot(path=str(target), full_page=True)
        browser.close()
