"""Draws ladder.png from the bundled runs: the ladder of errors above the loops before and after.

Needs playwright and Chromium (``python docs/pictures/draw.py`` from the top of the repository).
"""

from __future__ import annotations

import shutil
from importlib.resources import files
from pathlib import Path

from playwright.sync_api import sync_playwright
from plotly.offline import get_plotlyjs

import luztar
from luztar.report import embed
from luztar.report.figures import ladder, loops_before_after
from luztar.report.figures_of import values

WIDTH = 960
TARGET = Path(__file__).with_name("ladder.png")


def main() -> None:
    """Study the bundled runs and take the picture."""
    demo = files("luztar") / "demo_data"
    study = luztar.study(luztar.Model.rig(), luztar.read(*(demo / f"run{n}.csv.gz" for n in (1, 2, 3))))
    top, below = ladder(study), loops_before_after(study)
    below.update_layout(height=390)
    made = embed.safe_json([values(top), values(below)])
    page_text = (
        f"<!DOCTYPE html><meta charset='utf-8'><body style='margin:8px;background:#fff;width:{WIDTH}px'>"
        f"<div id='a'></div><div id='b'></div><script>{embed.safe_script(get_plotlyjs())}</script><script>"
        f"const made={made};['a','b'].forEach((id,i)=>Plotly.newPlot(id,made[i].data,"
        f"{{...made[i].layout,width:{WIDTH}}},{{staticPlot:true}}));document.title='drawn'</script>"
    )
    browser_path = shutil.which("chromium") or shutil.which("google-chrome")
    with sync_playwright() as p:
        browser = p.chromium.launch(executable_path=browser_path, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": WIDTH + 16, "height": 600}, device_scale_factor=1.5)
        page.set_content(page_text)
        page.wait_for_function("document.title === 'drawn'")
        page.wait_for_timeout(500)
        page.screenshot(path=str(TARGET), full_page=True)
        browser.close()


if __name__ == "__main__":
    main()
