"""The catalogue's effects in free runs against closed forms: stops, dead zone, waves per turn, levels, dwell.

Each effect acts alone on one mass, so that its motion is known: an oscillator with a gap, a pendulum, half cosines, an
integral over a bump, an equation for the instant of a break-away.
"""

import math

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipk, erf

from generators.steering import Mechanism, drawn_hand
from generators.steering import simulate as solve_with_events
from luztar.dynamics import simulate, trace
from luztar.errors import ParameterError

# A step that fits no period below.
STEP = 1e-3 * 1.0137
# Second order, less what an incommensurate grid scatters.
LEAST_ORDER = 1.9
BARE = {"steering.inertia_kg_m2": 2.0, "steering.ratio": 1.0, "steering.stiffness_nm_per_rad": 0.0}


def still(seconds: float, step: float = STEP) -> np.ndarray:
    return np.zeros(round(seconds / step) + 1)


def period_of(parameters: dict[str, float], start_rad: float, seconds: float, step: float = STEP) -> float:
    run = trace(parameters, still(seconds, step), sample_rate_hz=1.0 / step, start_rad=start_rad)
    turns = [e.time_s for e in run.events if e.kind == "reversal"]
    assert len(turns) >= 5 and run.balanced
    # What the integrator leaves of the energy is of second order; nothing brakes.
    assert run.energy_j["dry"] == 0.0 and run.energy_j["viscous"] == 0.0
    assert run.energy_j["stored_last"] == pytest.approx(run.energy_j["stored_first"], rel=1e-3)
    return (turns[4] - turns[0]) / 2.0


@pytest.mark.parametrize(
    ("stiffness", "limit"),
    [
        ("end_stop.stiffness_nm_per_rad", "end_stop.limit_rad"),
        ("dead_zone.stiffness_nm_per_rad", "dead_zone.half_width_rad"),
    ],
)
def test_a_stop_and_a_dead_zone_are_oscillators_with_a_gap(stiffness, limit):
    # T = 2 pi / w + 4 limit / (w A), A how far the start is beyond the limit.
    w, depth = math.sqrt(50.0 / 2.0), 0.3
    found = period_of({**BARE, stiffness: 50.0, limit: 0.05}, 0.05 + depth, 4.0, STEP / 10)
    assert found == pytest.approx(2.0 * math.pi / w + 4.0 * 0.05 / (w * depth), abs=1e-6)


@pytest.mark.parametrize(
    ("effect", "waves", "more"),
    [("once_per_rev", 1, {}), ("twice_per_rev", 2, {}), ("cogging", 5, {"cogging.per_turn": 5.0})],
)
def test_a_wave_per_turn_is_a_pendulum(effect, waves, more):
    # The pinion turns p times as far: y = n p phi + phase swings with y'' = -(n p^2 a / I) sin y, from the amplitude y0
    # with the period 4 K(sin^2(y0 / 2)) / w0.
    ratio, amplitude, phase, y0 = 16.0, 0.3, 0.4, 1.9
    parameters = {
        **BARE,
        "steering.ratio": ratio,
        f"{effect}.amplitude_nm": amplitude,
        f"{effect}.phase_rad": phase,
        **more,
    }
    w0 = math.sqrt(waves * ratio**2 * amplitude / 2.0)
    period = 4.0 * ellipk(math.sin(y0 / 2.0) ** 2) / w0
    start = (y0 - phase) / (waves * ratio)
    errors = [abs(period_of(parameters, start, 8.0, h) - period) for h in (2.0 * STEP, STEP)]
    # (w h)^2 / 24 of a period is what a step of second order leaves of a frequency, twice that for what bends.
    assert errors[1] < (w0 * STEP) ** 2 / 12.0 * period
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def decay_with_slope(t: np.ndarray, start: float, level: float, slope: float, stiffness: float) -> np.ndarray:
    """Half cosines about F / (k - c) on the way down and -F / (k + c) on the way up, each with its own frequency."""
    out, begin, amplitude, side = np.full_like(t, np.nan), 0.0, start, -1.0
    while abs(stiffness * amplitude) > level + slope * amplitude:
        k = stiffness + side * slope
        middle, w = -side * level / k, math.sqrt(k)
        inside = (t >= begin) & (t < begin + math.pi / w)
        out[inside] = middle + (amplitude - middle) * np.cos(w * (t[inside] - begin))
        begin, amplitude, side = begin + math.pi / w, 2.0 * middle - amplitude, -side
    return np.where(np.isnan(out), amplitude, out)


def test_friction_that_changes_with_angle_decays_in_half_cosines_of_two_frequencies():
    errors, steps = [], np.array([4.0, 2.0, 1.0, 0.5]) * STEP
    for step in steps:
        parameters = {
            **BARE,
            "steering.inertia_kg_m2": 1.0,
            "steering.stiffness_nm_per_rad": 44.0,
            "coulomb.level_nm": 3.0,
            "position_coulomb.slope_nm_per_rad": 2.5,
        }
        run = trace(parameters, still(4.0, step), sample_rate_hz=1.0 / step, start_rad=1.03)
        assert run.balanced
        errors.append(float(np.abs(run.roadwheel_rad - decay_with_slope(run.time_s, 1.03, 3.0, 2.5, 44.0)).max()))
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] > LEAST_ORDER
    assert errors[2] < 1.5e-5 and run.speed_rad_s[-1] == 0.0


def test_a_tight_spot_takes_the_energy_under_its_bump():
    level, extra, angle, width, speed = 0.4, 3.0, 0.5, 0.06, 2.0
    parameters = {
        **BARE,
        "coulomb.level_nm": level,
        "tight_spot.extra_nm": extra,
        "tight_spot.angle_rad": angle,
        "tight_spot.width_rad": width,
    }
    errors = []
    for step in (STEP, STEP / 4.0):
        run = trace(parameters, still(0.5, step), sample_rate_hz=1.0 / step, start_speed_rad_s=speed)
        x = run.roadwheel_rad
        bump = (
            extra
            * width
            * math.sqrt(math.pi / 2.0)
            * (erf((x - angle) / width / math.sqrt(2.0)) + erf(angle / width / math.sqrt(2.0)))
        )
        exact = np.sqrt(speed**2 - 2.0 / 2.0 * (level * x + bump))
        errors.append(float(np.abs(run.speed_rad_s - exact).max()))
        assert run.balanced and x[-1] > angle + 5.0 * width
    assert errors[1] < errors[0] / 14.0 and errors[1] < 1e-6


def test_friction_in_proportion_to_the_load_breaks_away_later():
    # al t = F + c al t: t_b = F / (al (1 - c)), then q = al (1 - c) tau^3 / (6 I).
    level, share, rise = 1.0, 0.3, 0.7
    begin = level / (rise * (1.0 - share))
    t = np.arange(round(4.0 / STEP)) * STEP
    parameters = {**BARE, "coulomb.level_nm": level, "load.coefficient": share}
    run = trace(parameters, np.zeros_like(t), sample_rate_hz=1.0 / STEP, load_nm=rise * t)
    assert [e.kind for e in run.events] == ["slip"]
    assert run.events[0].time_s == pytest.approx(begin, abs=1e-12)
    tau = np.maximum(t - begin, 0.0)
    assert np.abs(run.roadwheel_rad - rise * (1.0 - share) * tau**3 / 12.0).max() < STEP**2
    # More friction than load: it never moves, however large the load.
    stuck = simulate({**parameters, "load.coefficient": 1.0}, t, sample_rate_hz=1.0 / STEP, load_nm=1e3 * t)
    assert not stuck.roadwheel_rad.any()


def test_dwell_breaks_away_when_the_load_has_caught_up_with_the_growing_friction():
    level, extra, grow, rise = 1.0, 0.8, 1.3, 0.7
    begin = brentq(lambda t: rise * t - level - extra * (1.0 - math.exp(-t / grow)), 0.1, 10.0, xtol=1e-14)
    parameters = {**BARE, "coulomb.level_nm": level, "dwell.extra_nm": extra, "dwell.time_s": grow}
    errors, steps = [], np.array([16.0, 8.0, 4.0, 2.0]) * STEP
    for step in steps:
        t = np.arange(round(4.0 / step)) * step
        run = trace(parameters, np.zeros_like(t), sample_rate_hz=1.0 / step, load_nm=rise * t)
        assert [e.kind for e in run.events] == ["slip"] and run.balanced
        errors.append(abs(run.events[0].time_s - begin))
        tau = np.maximum(t - begin, 0.0)
        exact = ((rise * begin - level) * tau**2 / 2.0 + rise * tau**3 / 6.0) / 2.0
        assert np.abs(run.roadwheel_rad - exact).max() < step**2
    # The growth is a straight line within a step; where in it the instant falls is chance.
    assert max(e / h**2 for e, h in zip(errors, steps, strict=True)) < extra / (8.0 * grow**2 * 0.3)


def test_the_clock_of_dwell_starts_anew_after_every_motion():
    level, extra, grow = 1.0, 0.8, 0.4
    step = STEP / 4.0
    t = np.arange(round(6.0 / step)) * step
    # Up past the break-away, down to nothing so that it stops, a pause, up again.
    load = np.interp(t, [0.0, 1.0, 1.2, 1.25, 3.0, 6.0], [0.0, 2.5, 2.5, 0.0, 0.0, 3.0])
    parameters = {**BARE, "coulomb.level_nm": level, "dwell.extra_nm": extra, "dwell.time_s": grow}
    parameters["viscous.coefficient_nm_s_per_rad"] = 3.0
    run = trace(parameters, np.zeros_like(t), sample_rate_hz=1.0 / step, load_nm=load)
    assert [e.kind for e in run.events] == ["slip", "stick", "slip"]
    first, stop, second = (e.time_s for e in run.events)
    for at, rest in ((first, first), (second, second - stop)):
        held = level + extra * (1.0 - math.exp(-rest / grow))
        # The corners of the load are rounded by the cubic between samples; the ramps are not.
        assert np.interp(at, t, load) == pytest.approx(held, abs=1e-6)
    assert second - stop < second - 0.1


@pytest.mark.parametrize(
    "extra",
    [
        {"end_stop.stiffness_nm_per_rad": 900.0, "end_stop.limit_rad": 0.04},
        {"dead_zone.stiffness_nm_per_rad": 300.0, "dead_zone.half_width_rad": 0.02},
        {"once_per_rev.amplitude_nm": 0.5, "once_per_rev.phase_rad": 1.0},
        {"twice_per_rev.amplitude_nm": 0.3, "cogging.amplitude_nm": 0.2, "cogging.per_turn": 5.0},
        {"position_coulomb.slope_nm_per_rad": 60.0},
        {"tight_spot.extra_nm": 4.0, "tight_spot.angle_rad": 0.02, "tight_spot.width_rad": 0.02},
        {"load.coefficient": 0.3},
        {"dwell.extra_nm": 3.0, "dwell.time_s": 0.1},
        {"presliding.breakaway_rad": 0.004},
        {"presliding.breakaway_rad": 0.004, "presliding.shape": 1.0, "stribeck.extra_nm": 2.0},
        {"lugre.breakaway_rad": 0.004, "lugre.damping_nm_s_per_rad": 20.0, "stribeck.extra_nm": 2.0},
    ],
)
def test_the_energy_of_every_effect_is_accounted_for(extra):
    parameters = {
        "steering.inertia_kg_m2": 3.0,
        "steering.ratio": 16.0,
        "steering.stiffness_nm_per_rad": 60.0,
        "steering.aligning_nm_per_rad": 300.0,
        "freeplay.gap_rad": 0.1,
        "viscous.coefficient_nm_s_per_rad": 40.0,
        "coulomb.level_nm": 8.1,
        "stribeck.speed_rad_s": 0.05,
        **extra,
    }
    residual = []
    for count in (4003, 16_013):
        t = np.arange(count + 1) * (4.0 / count)
        load = 5.0 * np.sin(2.0 * t)
        run = trace(parameters, np.sin(math.pi * t), sample_rate_hz=count / 4.0, load_nm=load)
        assert run.balanced
        assert run.energy_j["dry"] > 0.0
        residual.append(abs(run.energy_j["residual"]) / run.energy_j["turnover"])
    # A sixteenth per quarter of the step; corners of the laws fall where they fall.
    assert residual[1] < residual[0] / 6.0 and residual[1] < 1e-5


def test_the_solver_of_the_generator_and_the_kernel_agree_on_every_rigid_effect():
    m = Mechanism(
        kinetic=5.0,
        static=8.0,
        half_gap=0.04,
        end_stop=(4000.0, 0.05),
        dead_zone=(300.0, 0.02),
        waves=((0.4, 1.0, 1), (0.2, -0.5, 2), (0.1, 0.3, 5)),
        slope=30.0,
        spot=(4.0, 0.02, 0.015),
    )
    times = np.arange(1200) / 200.0
    hand = drawn_hand(np.random.default_rng(3))
    exact = solve_with_events(m, hand, times)
    parameters = {
        "steering.inertia_kg_m2": m.inertia,
        "steering.ratio": m.ratio,
        "steering.stiffness_nm_per_rad": m.stiffness,
        "steering.aligning_nm_per_rad": m.aligning,
        "viscous.coefficient_nm_s_per_rad": m.viscous,
        "freeplay.gap_rad": 2.0 * m.half_gap,
        "coulomb.level_nm": m.kinetic,
        "stiction.extra_nm": m.static - m.kinetic,
        "end_stop.stiffness_nm_per_rad": 4000.0,
        "end_stop.limit_rad": 0.05,
        "dead_zone.stiffness_nm_per_rad": 300.0,
        "dead_zone.half_width_rad": 0.02,
        "once_per_rev.amplitude_nm": 0.4,
        "once_per_rev.phase_rad": 1.0,
        "twice_per_rev.amplitude_nm": 0.2,
        "twice_per_rev.phase_rad": -0.5,
        "cogging.amplitude_nm": 0.1,
        "cogging.phase_rad": 0.3,
        "cogging.per_turn": 5.0,
        "position_coulomb.slope_nm_per_rad": 30.0,
        "tight_spot.extra_nm": 4.0,
        "tight_spot.angle_rad": 0.02,
        "tight_spot.width_rad": 0.015,
    }
    errors = []
    for substeps in (4, 16):
        run = simulate(parameters, hand(times), sample_rate_hz=200.0, substeps=substeps)
        errors.append(float(np.abs(run.roadwheel_rad - exact).max()))
    # Second order until the solver's own tolerance (1e-9 relative) and the drive's cubic between samples show.
    assert errors[0] < 1e-5 and errors[1] < errors[0] / 8.0


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"end_stop.stiffness_nm_per_rad": -1.0}, "end_stop_nm_per_rad"),
        ({"end_stop.limit_rad": -0.1}, "end_stop_limit_rad"),
        ({"dead_zone.half_width_rad": -0.1}, "dead_zone_half_width_rad"),
        ({"cogging.amplitude_nm": 1.0}, "cogging_per_turn"),
        ({"tight_spot.extra_nm": 1.0}, "tight_spot_width_rad"),
        ({"tight_spot.extra_nm": -2.0, "tight_spot.width_rad": 0.1}, "tight_spot_nm.*-coulomb_nm"),
        ({"load.coefficient": -0.1}, "load_coefficient"),
        ({"dwell.extra_nm": -1.0, "dwell.time_s": 1.0}, "dwell_nm"),
        ({"dwell.extra_nm": 1.0}, "dwell_time_s"),
        ({"presliding.breakaway_rad": -1.0}, "presliding_breakaway_rad"),
        ({"presliding.breakaway_rad": 0.1, "presliding.shape": 2.0}, "stop.*Dahl"),
        ({"presliding.breakaway_rad": 0.1, "stiction.extra_nm": 1.0}, "stiction_nm.*elastic contact"),
        ({"presliding.breakaway_rad": 0.1, "dwell.extra_nm": 1.0, "dwell.time_s": 1.0}, "dwell_nm.*elastic contact"),
        ({"presliding.breakaway_rad": 0.1, "lugre.breakaway_rad": 0.1}, "lugre_breakaway_rad.*one law"),
        ({"lugre.breakaway_rad": 0.1, "coulomb.level_nm": 0.0}, "coulomb_nm"),
        ({"once_per_rev.phase_rad": math.nan}, "once_per_rev_phase_rad"),
    ],
)
def test_an_impossible_effect_is_named(change, word):
    with pytest.raises(ParameterError, match=word):
        simulate({**BARE, "coulomb.level_nm": 1.0, **change}, still(0.1), sample_rate_hz=1.0 / STEP)


def test_a_step_too_large_for_an_effect_names_it():
    for change, word in (
        ({"end_stop.stiffness_nm_per_rad": 1e7}, "end_stop_nm_per_rad"),
        ({"coulomb.level_nm": 10.0, "presliding.breakaway_rad": 1e-6}, "presliding_breakaway_rad"),
        ({"cogging.amplitude_nm": 1e6, "cogging.per_turn": 9.0}, "cogging_nm"),
    ):
        with pytest.raises(ParameterError, match=rf"step.*{word}.*substeps"):
            simulate({**BARE, **change}, still(0.1), sample_rate_hz=1.0 / STEP)
    elastic = {**BARE, "coulomb.level_nm": 1.0, "presliding.breakaway_rad": 0.1}
    with pytest.raises(ParameterError, match="presliding_breakaway_rad.*moreau_jean"):
        simulate(elastic, still(0.1), sample_rate_hz=1.0 / STEP, method="moreau_jean")
