"""Robustness, maps, sensitivity and stage 1: the paper's statements, known indices, studies that go on."""

import json

import numpy as np
import pytest
from scipy import stats

import luztar
from luztar.errors import MeasurementError, ParameterError
from luztar.manoeuvre import manoeuvre, robust, sensitivity, synthesise
from luztar.manoeuvre.indices import by_bins, design, saltelli
from luztar.manoeuvre.journal import Journal

ISHIGAMI = {"a": (0.3139, 0.5576), "b": (0.4424, 0.4424), "c": (0.0, 0.2437)}
# The plain car is a third of the work and shows the same.
PLAIN = {"length_m": 55.0, "speed_m_s": 15.0, "model": "single_track", "tyre": "linear"}
GOOD = [1.658, 0.4906, 0.3542, 0.0, 0.4871, 0.3217]


def ishigami(u):
    x = np.pi * (2.0 * u - 1.0)
    return np.sin(x[..., 0]) + 7.0 * np.sin(x[..., 1]) ** 2 + 0.1 * x[..., 2] ** 4 * np.sin(x[..., 0])


@pytest.fixture(scope="module")
def angle():
    return manoeuvre("avoiding", **PLAIN)


@pytest.fixture(scope="module")
def by_angle(angle):
    return robust(angle, freeplay_half_width_rad=(0.0, 0.1), friction_nm=(0.0, 8.1), fine=(5, 4), effort="quick")


@pytest.fixture(scope="module")
def by_torque():
    task = manoeuvre("avoiding", steer="torque", **PLAIN)
    return robust(task, freeplay_half_width_rad=(0.0, 0.1), friction_nm=(0.0, 8.1), fine=(2, 2), effort="quick")


def stop_after(cells):
    """A progress that interrupts, as a user does, when so many cells are done."""

    def told(what, done, total):
        if done >= cells:
            raise KeyboardInterrupt

    return told


# --- the paper's statements ---


def test_under_an_angle_freeplay_dominates_and_friction_does_nearly_nothing(by_angle):
    spread = by_angle.spread()
    assert spread["freeplay"] > 0.2
    # Optimised again, the cost of 8.1 Nm is below what two seeds of a quick search differ by.
    assert spread["friction"] < 0.02
    nominal = by_angle.criterion[0]
    assert np.isfinite(nominal[:2]).all() and not np.isfinite(nominal[2:]).any()
    assert nominal[1] / nominal[0] < 1.1


def test_under_a_torque_friction_costs_what_it_did_not_under_an_angle(by_angle, by_torque):
    worse_by_angle = by_angle.criterion[0, 1] / by_angle.criterion[0, 0]
    worse_by_torque = by_torque.criterion[0, 1] / by_torque.criterion[0, 0]
    assert worse_by_torque - 1.0 > 5.0 * (worse_by_angle - 1.0)
    # And the gap, which the torque simply passes through, throws nobody out of the corridor.
    assert np.isfinite(by_torque.criterion[0, 2]) and not np.isfinite(by_angle.criterion[0, 2])


def test_the_table_is_what_each_signal_does_on_each_car(by_angle):
    for i in (0, 3):
        for j, (z, f) in enumerate(by_angle.pairs):
            vary = {"freeplay.gap_rad": 2.0 * z, "coulomb.level_nm": f}
            alone = by_angle.task.scores(by_angle.signals[i], vary)
            assert alone.criterion[0] == by_angle.criterion[i, j]
    assert (np.diag(by_angle.companion) <= by_angle.companion.min(axis=0) * 1.02).all()


def test_the_corners_of_the_finer_grid_are_the_cars_of_the_table(by_angle):
    fine = by_angle.fine_criterion
    corners = np.stack([fine[:, 0, 0], fine[:, 0, -1], fine[:, -1, 0], fine[:, -1, -1]], axis=1)
    assert np.array_equal(corners, by_angle.criterion)
    share = by_angle.infeasible_share
    assert share[by_angle.most_robust] == share.min()
    assert share[0] == np.mean(~np.isfinite(fine[0]))


def test_difference_signals_are_differences_from_the_own_car(by_angle):
    found = by_angle.differences(0)
    assert (found["y_m"][0] == 0.0).all()
    assert np.abs(found["y_m"][2]).max() > 10.0 * np.abs(found["y_m"][1]).max()


@pytest.mark.parametrize(("key", "most"), [("freeplay.gap_rad", 0.2), ("coulomb.level_nm", 8.1)])
def test_difference_signals_are_continuous_in_freeplay_and_friction(angle, key, most):
    def largest(cars):
        drive = angle.drive([GOOD] * cars, {key: np.linspace(0.0, most, cars)})
        return np.abs(np.diff(drive.y_m, axis=0)).max()

    # Four times closer neighbours drive four times closer paths, once they are close enough to see the steepest place;
    # a jump would stay.
    assert largest(641) == pytest.approx(largest(161) / 4.0, rel=0.05)


def test_results_are_json_and_print_themselves(by_angle):
    text = json.dumps(by_angle.to_dict(), allow_nan=False)
    assert json.loads(text)["pairs"][0]["on_all_cars"][2] is None
    assert "most robust" in str(by_angle) and "<table>" in by_angle._repr_html_()


def test_where_nothing_is_within_the_limits_every_study_says_so(tmp_path):
    short = {**PLAIN, "length_m": 20.0}
    task = manoeuvre("avoiding", **short)
    table = robust(task, freeplay_half_width_rad=[0.0], friction_nm=[0.0], fine=(1, 1), effort="quick")
    assert "none: every signal breaks the limits" in str(table) and table.spread()["freeplay"] is None
    found = sensitivity(task, signal=table.signals[0], samples=64, ranges={"freeplay.gap_rad": (0.0, 0.1)})
    assert found.feasible == 0 and found.on_feasibility is None and found.on_criterion is None
    assert found.on_rank is not None and "none; all drives are alike" in str(found)
    for number, result in enumerate((table, found)):
        json.dumps(result.to_dict(), allow_nan=False)
        result.report(tmp_path / f"{number}.html")


# --- studies that go on ---


def test_an_interrupted_study_goes_on_and_gives_the_same_bits(tmp_path):
    options = {"lengths_m": [55.0, 70.0], "speeds_m_s": [12.0, 15.0], "effort": "quick", "tyre": "linear"}
    whole = luztar.manoeuvre.map("avoiding", model="single_track", **options)
    journal = tmp_path / "map.jsonl"
    with pytest.raises(KeyboardInterrupt):
        luztar.manoeuvre.map("avoiding", model="single_track", journal=journal, progress=stop_after(2), **options)
    lines = journal.read_text().splitlines()
    assert len(lines) == 3
    # The process was ended while it wrote.
    journal.write_text("\n".join([*lines, '{"cell": "70.0/12.0", "va']))
    told = []
    resumed = luztar.manoeuvre.map(
        "avoiding", model="single_track", journal=journal, progress=lambda *now: told.append(now), **options
    )
    assert resumed.to_dict() == whole.to_dict()
    assert len(journal.read_text().splitlines()) == 5
    assert whole.of("frequency_1_hz")[0, 1] > whole.of("frequency_1_hz")[0, 0]
    with pytest.raises(ParameterError, match="another study"):
        luztar.manoeuvre.map("avoiding", journal=journal, **options)


def test_an_interrupted_sensitivity_goes_on_and_gives_the_same_bits(angle, tmp_path):
    options = {"ranges": {"freeplay.gap_rad": (0.0, 0.2), "speed_m_s": (14.0, 16.0)}, "signal": GOOD, "samples": 256}
    whole = sensitivity(angle, **options)
    with pytest.raises(KeyboardInterrupt):
        sensitivity(angle, journal=tmp_path / "s.jsonl", progress=stop_after(128), **options)
    assert sensitivity(angle, journal=tmp_path / "s.jsonl", **options).to_dict() == whole.to_dict()


def test_a_journal_keeps_every_bit_and_nothing_foreign(tmp_path):
    path = tmp_path / "j.jsonl"
    value = [0.1 + 0.2, 1e-310, -0.0, None]
    first = Journal(path, {"a": 1}).cell("x", lambda: value)
    again = Journal(path, {"a": 1}).cell("x", lambda: pytest.fail("computed again"))
    assert [v if v is None else v.hex() for v in again] == [v if v is None else v.hex() for v in first]
    path.write_text("nonsense\n")
    with pytest.raises(ParameterError, match="no journal"):
        Journal(path, {"a": 1})
    with pytest.raises(ParameterError, match="cannot be used"):
        Journal(tmp_path, {"a": 1})


# --- sensitivity ---


def test_saltelli_indices_are_those_of_ishigami():
    found = saltelli("abc", ishigami(design(3, 4096, 1)), 0)
    for name, (first, total) in ISHIGAMI.items():
        for index, truth in ((found.first[name], first), (found.total[name], total)):
            assert index.value == pytest.approx(truth, abs=0.02)
            assert index.low <= truth <= index.high


def test_saltelli_indices_agree_with_scipy():
    mine = saltelli("abc", ishigami(design(3, 4096, 1)), 0)
    uniform = [stats.uniform()] * 3
    other = stats.sobol_indices(func=lambda u: ishigami(u.T), n=4096, dists=uniform, rng=np.random.default_rng(2))
    for i, name in enumerate("abc"):
        assert mine.first[name].value == pytest.approx(other.first_order[i], abs=0.03)
        assert mine.total[name].value == pytest.approx(other.total_order[i], abs=0.03)


def test_indices_by_bins_need_no_design():
    u = np.random.default_rng(4).random((8000, 3))
    found = by_bins("abc", u, ishigami(u), 0)
    for name, (first, _) in ISHIGAMI.items():
        assert found.first[name].value == pytest.approx(first, abs=0.03)
    few = by_bins("abc", u[:50], ishigami(u[:50]), 0)
    assert few is None and saltelli("abc", np.ones((100, 5)), 0) is None


def test_freeplay_decides_under_an_angle_and_no_drive_is_dropped(angle):
    ranges = {"freeplay.gap_rad": (0.0, 0.2), "coulomb.level_nm": (0.0, 8.1), "body.mass_kg": (1000.0, 1200.0)}
    found = sensitivity(angle, ranges=ranges, signal=GOOD, samples=256)
    assert found.drives == 256 * 5
    assert found.on_feasibility.rows == found.on_rank.rows == found.drives
    for indices in (found.on_feasibility, found.on_rank):
        first = {name: index.value for name, index in indices.total.items()}
        assert first["freeplay.gap_rad"] > 0.8 and first["coulomb.level_nm"] < 0.05
    assert 0 < found.on_criterion.rows < 2 * 256
    json.dumps(found.to_dict(), allow_nan=False)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"ranges": {}}, "no parameter varies"),
        ({"ranges": {"body.colour": (0.0, 1.0)}}, "body.colour"),
        ({"ranges": {"body.mass_kg": (2.0, 1.0)}}, "range of body.mass_kg"),
        ({"samples": 8}, "samples"),
        ({"samples": 100}, "no power of two"),
        ({"signal": [1.0, 2.0]}, "shape"),
    ],
)
def test_a_sensitivity_that_makes_no_sense_is_refused(angle, options, words):
    with pytest.raises(ParameterError, match=words):
        sensitivity(angle, **{"signal": GOOD, "samples": 64, **options})


def test_sets_that_do_not_ascend_are_refused(angle):
    with pytest.raises(ParameterError, match="ascending"):
        robust(angle, freeplay_half_width_rad=[0.1, 0.0])
    with pytest.raises(ParameterError, match="ascending"):
        robust(angle, friction_nm=[-1.0, 0.0])
    with pytest.raises(ParameterError, match="ascending"):
        luztar.manoeuvre.map("avoiding", lengths_m=[60.0, 50.0], speeds_m_s=[10.0])


# --- stage 1 ---


def registered(values, name, *, noise=0.0, offset=0.0, direction=1.0):
    t = np.arange(0.0, 9.0, 0.01)
    pieces = luztar.manoeuvre.Form(name).pieces(values, direction)
    trace = np.zeros(t.size)
    for start, amplitude, frequency in zip(pieces.start_s, pieces.amplitude, pieces.frequency_hz, strict=True):
        trace[t >= start] = amplitude * np.sin(2 * np.pi * frequency * (t[t >= start] - start))
    return trace + offset + noise * np.random.default_rng(0).standard_normal(t.size)


@pytest.mark.parametrize("direction", [1.0, -1.0])
@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("two_sines", [1.2, 0.5, 0.4, 1.0, 0.45, 0.5]),
        ("three_halves", [1.0, 0.5, 0.4, 0.8, 0.3, 0.4, 0.35]),
    ],
)
def test_the_signal_behind_a_noisy_trace_is_found(name, values, direction):
    noise = 0.01
    trace = registered(values, name, noise=noise, offset=0.03, direction=direction)
    found = synthesise(trace, 100.0)
    assert found.form.name == name and found.direction == direction
    # Several hundred samples of a hundredth of noise fix amplitudes of a half to far better than a hundredth.
    assert np.abs(found.values - values).max() < 0.01
    assert found.offset == pytest.approx(0.03, abs=2e-3)
    assert found.rms == pytest.approx(noise, rel=0.1) and found.explained > 0.995
    assert len(found.half_waves) == (4 if name == "two_sines" else 3)


def test_a_simulated_driver_is_fitted_and_driven_again(angle):
    drive = angle.drive(GOOD, every=1)
    found = synthesise(drive.handwheel_rad, 1.0 / angle.step_s)
    assert angle.scores(found.values).criterion[0] == pytest.approx(angle.scores(GOOD).criterion[0], rel=1e-2)


def test_a_trace_without_a_double_lane_change_is_refused():
    t = np.arange(0.0, 9.0, 0.01)
    with pytest.raises(MeasurementError, match="half waves found are left, right"):
        synthesise(np.where((t > 1) & (t < 3), np.sin(np.pi * (t - 1)), 0.0), 100.0)
    with pytest.raises(MeasurementError, match="none"):
        synthesise(np.zeros(500), 100.0)
    with pytest.raises(ParameterError, match="sample_rate_hz"):
        synthesise(np.zeros(500), 0.0)
