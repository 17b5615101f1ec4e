"""Pages of the double lane change in a real browser: every figure is drawn, nothing asked for or complained about."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from luztar.manoeuvre import manoeuvre, optimise, robust, sensitivity


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("pages")
    task = manoeuvre("avoiding", length_m=60.0, speed_m_s=15.0, model="single_track", tyre="linear")
    best = optimise(task, effort="quick")
    made = {
        "optimum": best,
        "robustness": robust(task, freeplay_half_width_rad=[0.0, 0.05], friction_nm=[0.0], fine=(4, 1), effort="quick"),
        "sensitivity": sensitivity(task, ranges={"freeplay.gap_rad": (0.0, 0.2)}, signal=best.best.values, samples=64),
    }
    for name, result in made.items():
        result.report(folder / f"{name}.html")
    return {name: folder / f"{name}.html" for name in made}


@pytest.mark.parametrize(("name", "figures"), [("optimum", 2), ("robustness", 4), ("sensitivity", 1)])
def test_every_figure_is_drawn_without_a_word_or_a_request(
    browser: Any, pages: dict[str, Path], name: str, figures: int
) -> None:
    page = browser.new_page(viewport={"width": 1100, "height": 900})
    said: list[str] = []
    asked: list[str] = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(pages[name].as_uri())
    page.wait_for_selector("html[data-drawn]", state="attached", timeout=60_000)
    page.wait_for_timeout(300)
    assert said == [] and asked == [pages[name].as_uri()]
    assert page.locator("[data-figure]").count() == figures
    assert page.locator("[data-figure] svg.main-svg").count() >= figures
    drawn = page.locator("[data-figure]").evaluate_all(
        "places => places.map(p => p.querySelectorAll('path.js-line, .bars path, .heatmaplayer image, .point').length)"
    )
    assert all(count > 0 for count in drawn), drawn
    page.close()
