"""Draws mechanisms.png: the paper's mechanism as a network, and a run of it.

Needs playwright and Chromium (``python docs/pictures/mechanisms.py`` from the top of the repository).
"""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
from playwright.sync_api import sync_playwright
from plotly.offline import get_plotlyjs

from luztar.mechanism import power_assistance, simulate, steering_mechanism
from luztar.report import embed
from luztar.report.figures_of import values

WIDTH = 960
TARGET = Path(__file__).with_name("mechanisms.png")


def main() -> None:
    """Run the mechanism along a sine and take the picture."""
    m = steering_mechanism(assistance=power_assistance())
    psi = np.sin(np.pi * np.arange(1001) / 250.0)
    run = simulate(m, {"handwheel": psi}, sample_rate_hz=250.0)
    made = embed.safe_json([values(m.figure()), values(run.figure())])
    page_text = (
        f"<!DOCTYPE html><meta charset='utf-8'><body style='margin:8px;background:#fff;width:{WIDTH}px'>"
        f"<div id='a'></div><div id='b'></div><script>{embed.safe_script(get_plotlyjs())}</script><script>"
        f"const made={made};['a','b'].forEach((id,i)=>Plotly.newPlot(id,made[i].data,"
        f"{{...made[i].layout,width:{WIDTH}}},{{staticPlot:true}}));document.title='drawn'</script>"
    )
    browser_path = shutil.which("chromium") or shutil.which("google-chrome")
    with sync_playwright() as p:
        browser = p.chromium.launch(executable_path=browser_path, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": WIDTH + 16, "height": 600}, device_scale_factor=1.25)
        page.set_content(page_text)
        page.wait_for_function("document.title === 'drawn'")
        page.wait_for_timeout(500)
        page.screenshot(path=str(TARGET), full_page=True)
        browser.close()


if __name__ == "__main__":
    main()
