"""The report in a real browser: it draws, complains about nothing, asks nobody, and runs no name as code."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import luztar
from report_cases import HOSTILE, HOSTILE_TOO, STRIBECK, runs


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    study = luztar.study(luztar.Model.rig(), runs(HOSTILE, HOSTILE_TOO, "run3.csv", hidden=STRIBECK))
    path = tmp_path_factory.mktemp("report") / "report.html"
    study.report(path)
    return path


def opened(browser: Any, report: Path) -> tuple[Any, list[str], list[str]]:
    """The page, drawn; what the console said; what was asked for."""
    page = browser.new_page(viewport={"width": 1100, "height": 900})
    said: list[str] = []
    asked: list[str] = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("dialog", lambda dialog: (said.append(f"dialog {dialog.message}"), dialog.dismiss()))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(report.as_uri())
    page.wait_for_selector("html[data-drawn]", state="attached", timeout=60_000)
    page.wait_for_timeout(300)
    return page, said, asked


def test_it_draws_every_figure_without_a_word_or_a_request(browser: Any, report: Path) -> None:
    page, said, asked = opened(browser, report)
    assert said == []
    assert asked == [report.as_uri()]
    places = page.locator("[data-figure]").count()
    assert places == 8
    assert page.locator("[data-figure] svg.main-svg").count() >= places
    # No figure is empty: each has drawn at least one curve, bar, point or picture of a heat map.
    empty = page.evaluate(
        "[...document.querySelectorAll('[data-figure]')].filter(e =>"
        " !e.querySelector('.scatterlayer .trace, .barlayer .trace, .heatmaplayer .hm')).length"
    )
    assert empty == 0
    page.close()


def test_a_plan_and_a_card_draw_their_picture(browser: Any, tmp_path: Path) -> None:
    from luztar.cli import main

    luztar.plan().report(tmp_path / "plan.html")
    assert main(["explain", "stribeck", "--report", str(tmp_path / "card.html")]) == 0
    for name in ("plan.html", "card.html"):
        page, said, asked = opened(browser, tmp_path / name)
        assert said == [] and asked == [(tmp_path / name).as_uri()]
        assert page.locator("[data-figure] svg.main-svg").count() >= 1
        assert (tmp_path / name).stat().st_size < 2_500_000
        page.close()


def test_hostile_names_are_text(browser: Any, report: Path) -> None:
    page, said, _ = opened(browser, report)
    assert page.locator("img[onerror], a[href*='example.com']").count() == 0
    assert page.evaluate("document.querySelectorAll('svg a').length") == 0
    assert HOSTILE in page.locator("body").inner_text()
    # Hovering runs the figures' own text code.
    for place in page.locator("[data-figure]").all():
        place.hover()
        page.wait_for_timeout(50)
    assert [s for s in said if "dialog" in s] == []
    page.close()


def test_nothing_is_wider_than_the_page(browser: Any, report: Path) -> None:
    page, _, _ = opened(browser, report)
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
    page.close()


def test_on_paper_no_word_of_a_figure_is_cut(browser: Any, report: Path) -> None:
    page, _, _ = opened(browser, report)
    page.set_viewport_size({"width": 690, "height": 1000})
    page.emulate_media(media="print")
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    page.wait_for_timeout(500)
    # The names of the files are as long as a file system allows; the words of the figures are luztar's own.
    cut = page.evaluate(
        """() => [...document.querySelectorAll('[data-figure]')].flatMap(figure => {
            const box = figure.getBoundingClientRect();
            return [...figure.querySelectorAll('svg.main-svg text')].filter(text => {
                const own = text.getBoundingClientRect();
                return own.width && (own.left < box.left - 1 || own.right > box.right + 1);
            }).map(text => figure.dataset.figure + ': ' + text.textContent);
        })"""
    )
    assert [c for c in cut if ".csv" not in c] == []
    page.close()


def test_on_paper_a_figure_stands_with_what_introduces_it(browser: Any, report: Path) -> None:
    page, _, _ = opened(browser, report)
    page.emulate_media(media="print")
    parted = page.evaluate(
        """() => [...document.querySelectorAll('[data-figure]')].map(f => f.previousElementSibling).filter(
            e => e && getComputedStyle(e).breakAfter !== 'avoid').map(e => e.outerHTML)"""
    )
    assert parted == []
    page.close()
