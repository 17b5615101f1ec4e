"""The figure of a free run: rests shaded, friction over speed on the law, energies that add up; drawn by a browser."""

import numpy as np
import pytest

from luztar.dynamics import trace

MECHANISM = {
    "steering.inertia_kg_m2": 3.0,
    "steering.ratio": 16.0,
    "steering.stiffness_nm_per_rad": 60.0,
    "viscous.coefficient_nm_s_per_rad": 40.0,
    "coulomb.level_nm": 8.1,
    "stiction.extra_nm": 3.9,
    "freeplay.gap_rad": 0.1,
}
RATE_HZ = 500


@pytest.fixture(scope="module")
def run():
    return trace(MECHANISM, np.sin(np.pi * np.arange(2001) / RATE_HZ), sample_rate_hz=RATE_HZ)


def curve(figure, name):
    (found,) = [t for t in figure.data if t.name == name]
    return np.array(found.x, float), np.array(found.y, float)


def test_what_is_shaded_is_at_rest(run):
    shaded = [(s.x0, s.x1) for s in run.figure().layout.shapes if s.yref == "y domain"]
    assert len(shaded) == 5
    inside = np.zeros(run.time_s.size, bool)
    for first, last in shaded:
        inside |= (run.time_s >= first) & (run.time_s <= last)
    assert np.array_equal(inside, run.speed_rad_s == 0.0)


def test_friction_in_motion_lies_on_the_law(run):
    speed, torque = curve(run.figure(), "friction in motion")
    law = 8.1 * np.sign(speed) + 40.0 * np.deg2rad(speed)
    # The mean over a step after the sample: half a step of the greatest rate of change of the speed, 0.25 rad/s in
    # 10 ms, times mu.
    assert np.abs(torque - law).max() < 0.5 * 40.0 * 25.0 / RATE_HZ
    # At rest it is what is held: below static friction, and above kinetic somewhere.
    _, held = curve(run.figure(), "held at rest")
    assert 8.1 < np.abs(held).max() <= 12.0


def test_the_bars_are_the_ledger(run):
    (bars,) = [t for t in run.figure().data if t.type == "bar"]
    values = dict(zip(bars.y, bars.x, strict=True))
    assert values["handwheel"] == pytest.approx(run.energy_j["handwheel"], rel=1e-5)
    assert sum(v for name, v in values.items() if name != "residual") == pytest.approx(values["residual"], abs=1e-4)


def test_a_run_that_never_moves_and_one_without_rest_have_a_figure():
    still = trace({**MECHANISM, "freeplay.gap_rad": 10.0}, np.sin(np.arange(100) / 50), sample_rate_hz=50)
    assert len(still.figure().layout.shapes) == 2
    free = {"steering.inertia_kg_m2": 1.0, "steering.ratio": 1.0, "steering.stiffness_nm_per_rad": 9.0}
    swings = trace(free, np.zeros(100), sample_rate_hz=50, start_rad=1.0)
    assert len(swings.figure().layout.shapes) == 0


def test_a_browser_draws_it_without_a_word(run, tmp_path, browser):
    path = tmp_path / "run.html"
    run.figure().write_html(path)
    page = browser.new_page(viewport={"width": 1100, "height": 940})
    said = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.goto(path.as_uri())
    page.wait_for_selector(".main-svg .scatterlayer .trace", state="attached", timeout=60_000)
    page.wait_for_timeout(300)
    # No title or label may lie on another.
    boxes = page.evaluate(
        "[...document.querySelectorAll('.annotation-text, .xtitle, .ytitle, .legendtext')].map(e => {"
        " const b = e.getBoundingClientRect(); return [e.textContent, b.left, b.top, b.right, b.bottom]})"
    )
    page.close()
    assert said == []
    assert len(boxes) > 10
    for i, (name, left, top, right, bottom) in enumerate(boxes):
        for other, left2, top2, right2, bottom2 in boxes[i + 1 :]:
            apart = right <= left2 or right2 <= left or bottom <= top2 or bottom2 <= top
            assert apart, (name, other)
