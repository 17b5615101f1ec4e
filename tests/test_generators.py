"""The simulated measurements are what they claim to be: checked before anything is calibrated on them."""

import numpy as np
import pytest

from generators import axis, typical
from generators.axis import simulate_axis, simulate_axis_full
from generators.hand_motion import Motion, from_speed, hand_motion
from generators.physics import CATALOGUE, OUTSIDE, axis_name, pieces_of_one_direction
from generators.rig import simulate_rig, simulate_rig_full, simulate_rig_set, simulate_rig_with_load
from generators.sensor import noise_of

QUIET = {"noise_nm": 0.0, "wander_nm": 0.0, "hum_nm": 0.0}
QUIET_AXIS = {"noise_n": 0.0, "wander_n": 0.0, "hum_n": 0.0}
ROUNDING_NM = 0.5001e-4  # torque is written to 1e-4 Nm
BASE = {"offset": {"level_nm": 0.05}, "coulomb": {"level_nm": 0.7}, "viscous": {"coefficient_nm_s_per_rad": 0.3}}
DEG = np.pi / 180.0


def quiet(hidden=None, **options):
    return simulate_rig_full(hidden, **({"base": BASE, "seed": 5} | QUIET | options))


def added(effect, parameters, **options):
    """What one effect adds to the torque, the run it was added to, and the mask of clear motion."""
    run = quiet({effect: parameters}, **options)
    without = quiet({}, **options)
    return run.clean_torque_nm - without.clean_torque_nm, run, away_from_reversals(run)


def away_from_reversals(run, distance_rad=0.5 * DEG):
    """Samples in motion at least this far beyond the last change of direction."""
    x = run.motion.position
    since = np.zeros_like(x)
    for first, last, direction in pieces_of_one_direction(x):
        if direction:
            since[first + 1 : last] = np.abs(x[first + 1 : last] - x[first])  # at `last` the speed is zero
    factor = round((run.time_s[1] - run.time_s[0]) / run.motion.step_s)
    return since[::factor] > distance_rad


# --- motion ---


@pytest.mark.parametrize("amplitude_deg", [45.0, 54.0, 180.0, 540.0])
def test_strokes_reach_beyond_the_amplitude_and_never_turn_back(amplitude_deg):
    for seed in range(5):
        motion = hand_motion(np.random.default_rng(seed), amplitude_deg=amplitude_deg, speeds_deg_s=(10.0, 120.0))
        moving = [p for p in pieces_of_one_direction(motion.position) if p[2]]
        assert len(moving) == 6
        ends_deg = np.rad2deg(motion.position[[first for first, _, _ in moving] + [moving[-1][1]]])
        assert np.all(np.abs(ends_deg) >= amplitude_deg - 1e-6)
        assert np.all(np.abs(ends_deg) <= amplitude_deg + 9.0 + 1e-6)
        assert np.all(np.sign(ends_deg[1:]) == -np.sign(ends_deg[:-1]))


def test_speed_stays_in_the_range_asked_for():
    for seed in range(20):
        motion = hand_motion(np.random.default_rng(seed), speeds_deg_s=(5.0, 60.0))
        speed_deg_s = np.abs(np.rad2deg(motion.speed))
        assert speed_deg_s.max() < 60.0 * 1.01
        middle = np.abs(motion.position) < 45.0 * DEG
        assert speed_deg_s[middle].min() > 5.0 * 0.99


def test_speed_and_acceleration_are_derivatives_of_the_angle():
    motion = hand_motion(np.random.default_rng(1))
    speed = np.gradient(motion.position, motion.step_s)
    assert np.max(np.abs(speed - motion.speed)) < 5e-3 * np.max(np.abs(motion.speed))
    # Smooth: no jump in acceleration at the start, end and turning of a stroke.
    assert np.max(np.abs(np.diff(motion.acceleration))) < 0.05 * np.max(np.abs(motion.acceleration))


def test_small_reversals_and_slow_breakaway():
    motion = hand_motion(np.random.default_rng(2), small_reversals=3, strokes=6)
    assert len([p for p in pieces_of_one_direction(motion.position) if p[2]]) == 6 + 2 * 3
    creeping = hand_motion(np.random.default_rng(2), slow_breakaway=True)
    for first, last, direction in pieces_of_one_direction(creeping.position):
        if direction:
            travel = np.abs(creeping.position[first:last] - creeping.position[first])
            start = (travel > 0.2 * DEG) & (travel < 0.45 * DEG)
            assert np.max(np.abs(creeping.speed[first:last][start])) < 2.1 * DEG


def test_duration_option():
    motion = hand_motion(np.random.default_rng(3), duration_s=60.0)
    assert 50.0 < motion.time_s[-1] < 80.0


# --- the base ---


def test_nothing_hidden_is_offset_level_and_viscous():
    run = quiet()
    clear = away_from_reversals(run)
    w = run.true_speed_rad_s
    expected_nm = 0.05 + 0.7 * np.sign(w) + 0.3 * w
    np.testing.assert_allclose(run.torque_nm[clear], expected_nm[clear], atol=ROUNDING_NM)


def test_friction_holds_its_torque_at_rest():
    run = quiet()
    x, friction = run.motion.position, run.force.friction
    rests = [p for p in pieces_of_one_direction(x) if p[2] == 0]
    assert len(rests) >= 6
    for number, (first, last, _) in enumerate(rests):
        assert np.ptp(friction[first : last + 1]) == 0.0
        assert abs(friction[last]) == pytest.approx(0.0 if number == 0 else 0.7, abs=1e-12)


def test_start_state():
    assert quiet(start_state=0.5).torque_nm[0] == pytest.approx(0.05 + 0.35)


@pytest.mark.parametrize("encoder_deg", [0.01, 0.02, 0.1])
def test_encoder_rounds_to_its_step(encoder_deg):
    run = quiet(encoder_deg=encoder_deg)
    steps = np.rad2deg(run.angle_rad) / encoder_deg
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)
    assert np.max(np.abs(run.angle_rad - run.true_angle_rad)) <= 0.5001 * encoder_deg * DEG


@pytest.mark.parametrize("rate_hz", [100.0, 250.0, 1000.0, 5000.0])
def test_sample_rates(rate_hz):
    time_s, angle_rad, torque_nm = simulate_rig(seed=1, sample_rate_hz=rate_hz)
    np.testing.assert_allclose(np.diff(time_s), 1.0 / rate_hz, rtol=1e-6)
    assert time_s.size == angle_rad.size == torque_nm.size
    assert 30.0 < time_s[-1] < 70.0


# --- the effects, one by one ---


@pytest.mark.parametrize(
    ("effect", "parameters", "law"),
    [
        ("offset", {"level_nm": 0.2}, lambda x, w, t: 0.2),
        ("coulomb", {"level_nm": 0.2}, lambda x, w, t: 0.2 * np.sign(w)),
        ("viscous", {"coefficient_nm_s_per_rad": 0.1}, lambda x, w, t: 0.1 * w),
        ("asymmetric_coulomb", {"difference_nm": 0.1}, lambda x, w, t: 0.1),
        ("asymmetric_viscous", {"difference_nm_s_per_rad": -0.4}, lambda x, w, t: -0.4 * np.abs(w)),
        ("drag", {"coefficient_nm_s2_per_rad2": 1.1}, lambda x, w, t: 1.1 * w * np.abs(w)),
        (
            "stribeck",
            {"extra_nm": 0.35, "speed_rad_s": 0.1},
            lambda x, w, t: 0.35 * np.exp(-((w / 0.1) ** 2)) * np.sign(w),
        ),
        ("stiffness", {"stiffness_nm_per_rad": 0.2}, lambda x, w, t: 0.2 * x),
        ("hardening", {"coefficient_nm_per_rad3": -0.3}, lambda x, w, t: -0.3 * x**3),
        (
            "dead_zone",
            {"stiffness_nm_per_rad": 0.6, "half_width_rad": 0.3, "centre_rad": 0.1},
            lambda x, w, t: 0.6 * ((x - 0.1) - np.clip(x - 0.1, -0.3, 0.3)),
        ),
        (
            "end_stop",
            {"stiffness_nm_per_rad": 4.0, "limit_rad": 0.8},
            lambda x, w, t: 4.0 * (x - np.clip(x, -0.8, 0.8)),
        ),
        ("once_per_rev", {"amplitude_nm": 0.2, "phase_rad": 1.0}, lambda x, w, t: 0.2 * np.sin(x + 1.0)),
        ("twice_per_rev", {"amplitude_nm": 0.2, "phase_rad": 1.0}, lambda x, w, t: 0.2 * np.sin(2 * x + 1.0)),
        ("cogging", {"amplitude_nm": 0.2, "phase_rad": 1.0, "per_turn": 5}, lambda x, w, t: 0.2 * np.sin(5 * x + 1.0)),
        ("position_coulomb", {"slope_nm_per_rad": 0.25}, lambda x, w, t: 0.25 * x * np.sign(w)),
        (
            "tight_spot",
            {"extra_nm": 0.3, "angle_rad": 0.2, "width_rad": 0.1},
            lambda x, w, t: 0.3 * np.exp(-((x - 0.2) ** 2) / 0.02) * np.sign(w),
        ),
        ("warmup", {"extra_nm": 0.3, "time_s": 10.0}, lambda x, w, t: 0.3 * np.exp(-t / 10.0) * np.sign(w)),
        ("drift", {"rate_nm_per_s": 0.02}, lambda x, w, t: 0.02 * t),
        ("torque_step", {"amplitude_nm": 0.2, "angle_rad": -0.2}, lambda x, w, t: 0.2 * np.tanh((x + 0.2) / 0.01)),
        (
            "torque_bump",
            {"amplitude_nm": 0.3, "angle_rad": 0.2, "width_rad": 0.1},
            lambda x, w, t: 0.3 * np.exp(-((x - 0.2) ** 2) / 0.02),
        ),
        ("time_sine", {"amplitude_nm": 0.1, "frequency_hz": 1.2}, lambda x, w, t: 0.1 * np.sin(2 * np.pi * 1.2 * t)),
        ("odd_product", {"coefficient_nm_s_per_rad": 0.3}, lambda x, w, t: 0.3 * np.sin(x) * w),
    ],
)
def test_law_away_from_reversals(effect, parameters, law):
    extra_nm, run, clear = added(effect, parameters)
    expected_nm = law(run.true_angle_rad, run.true_speed_rad_s, run.time_s) * np.ones(run.time_s.size)
    np.testing.assert_allclose(extra_nm[clear], expected_nm[clear], atol=1e-9)
    assert np.max(np.abs(extra_nm[clear])) > 0.02


def test_inertia_is_acceleration():
    extra_nm, run, _ = added("inertia", {"inertia_kg_m2": 0.12})
    second = np.gradient(np.gradient(run.motion.position, run.motion.step_s), run.motion.step_s)[::10]
    assert np.max(np.abs(extra_nm - 0.12 * second)) < 0.02 * np.max(np.abs(extra_nm))


def test_delay_shifts_the_torque():
    late, prompt = quiet({"delay": {"time_s": 0.0413}}), quiet()
    expected = np.interp(prompt.time_s - 0.0413, prompt.motion.time_s, prompt.force.total)
    np.testing.assert_allclose(late.clean_torque_nm, expected, atol=1e-12)
    np.testing.assert_array_equal(late.angle_rad, prompt.angle_rad)


def test_load_channel_raises_the_level():
    time_s, angle_rad, torque_nm, load_n = simulate_rig_with_load(
        {"load": {"coefficient": 0.05}}, base=BASE, seed=5, **QUIET
    )
    run = quiet()
    clear = away_from_reversals(run)
    w = run.true_speed_rad_s
    expected_nm = (0.05 + 0.3 * w + (0.7 + 0.05 * load_n) * np.sign(w))[clear]
    np.testing.assert_allclose(torque_nm[clear], expected_nm, atol=2e-4)  # the load is written to 1e-3 N
    assert np.ptp(load_n) > 2.0


@pytest.mark.parametrize("shape", ["stop", "exponential"])
def test_presliding_shapes(shape):
    breakaway_rad = 2.0 * DEG
    run = quiet({"presliding": {"breakaway_rad": breakaway_rad, "shape": shape}})
    x, friction = run.motion.position, run.force.friction
    strokes = [p for p in pieces_of_one_direction(x) if p[2]]
    first, last, direction = strokes[1]
    travel = np.abs(x[first : last + 1] - x[first])
    begin = friction[first] / 0.7 * direction
    assert begin == pytest.approx(-1.0, abs=1e-6)
    if shape == "stop":
        expected = np.minimum(begin + travel / breakaway_rad, 1.0)
    else:
        expected = 1.0 - (1.0 - begin) * np.exp(-travel / breakaway_rad)
    np.testing.assert_allclose(direction * friction[first : last + 1] / 0.7, expected, atol=1e-9)


def test_exponential_presliding_solves_dahls_equation():
    """Against a plain time-stepping of dz/dx = (1 - sgn(w) z) / b on an uneven motion with small reversals."""
    rng = np.random.default_rng(8)
    motion = hand_motion(rng, strokes=2, small_reversals=2)
    breakaway_rad = 1.5 * DEG
    run = quiet({"presliding": {"breakaway_rad": breakaway_rad}}, motion=motion)
    z = 0.0
    stepped = np.zeros(motion.position.size)
    for i, dx in enumerate(np.diff(motion.position).tolist(), start=1):
        for _ in range(4):
            z += 0.25 * (dx - abs(dx) * z) / breakaway_rad
        stepped[i] = z
    assert np.max(np.abs(stepped - run.force.friction / 0.7)) < 2e-3


def test_stiction_peaks_at_break_away_and_is_gone_in_motion():
    options = {"motion": {"slow_breakaway": True}}
    for at_stop in (True, False):
        run = quiet({"stiction": {"extra_nm": 0.3, "at_stop": at_stop}}, **options)
        x, friction = run.motion.position, run.force.friction
        strokes = [p for p in pieces_of_one_direction(x) if p[2]]
        for first, last, direction in strokes:
            assert np.max(direction * friction[first : last + 1]) == pytest.approx(1.0, abs=2e-3)
            beyond = np.abs(x[first:last] - x[first]) > 3.0 * DEG
            fast = beyond & (np.abs(run.motion.speed[first:last]) > 3.0 * DEG)
            np.testing.assert_allclose(direction * friction[first:last][fast], 0.7, atol=1e-3)
            assert direction * friction[last] == pytest.approx(1.0 if at_stop else 0.7, abs=1e-3)


def test_dwell_grows_with_rest():
    run = quiet({"dwell": {"extra_nm": 0.4, "time_s": 0.5}}, motion={"dwell_s": (0.1, 3.0), "strokes": 8})
    t, x, friction = run.motion.time_s, run.motion.position, run.force.friction
    pieces = pieces_of_one_direction(x)
    checked = 0
    for before, now in zip(pieces, pieces[1:], strict=False):
        if before[2] == 0 and now[2] and before[0] > 0:
            rest_s = t[before[1]] - t[before[0]]
            peak = np.max(now[2] * friction[now[0] : now[1] + 1])
            assert peak == pytest.approx(0.7 + 0.4 * (1.0 - np.exp(-rest_s / 0.5)), abs=6e-3)
            checked += 1
    assert checked == 7


def test_nothing_is_transmitted_inside_the_gap():
    gap_rad = 0.06
    run = quiet({"freeplay": {"gap_rad": gap_rad}, "stribeck": {"extra_nm": 0.3, "speed_rad_s": 0.1}})
    np.testing.assert_array_equal(run.force.behind_gap[run.force.in_gap], 0.0)
    np.testing.assert_allclose(run.clean_torque_nm[run.in_gap], 0.05, atol=1e-12)
    x = run.motion.position
    strokes = [p for p in pieces_of_one_direction(x) if p[2]]
    for number, (first, last, direction) in enumerate(strokes):
        # The first crossing starts in the middle of the gap.
        width = 0.5 * gap_rad if number == 0 else gap_rad
        open_rad = np.abs(x[first + 1 : last + 1] - x[first])[run.force.in_gap[first + 1 : last + 1]]
        assert np.max(open_rad) == pytest.approx(width, abs=1e-3)
        clear = np.abs(x[first:last] - x[first]) > width + 0.5 * DEG
        w = run.motion.speed[first:last]
        expected = 0.7 * direction + 0.3 * w + 0.3 * np.exp(-((w / 0.1) ** 2)) * direction
        np.testing.assert_allclose(run.force.behind_gap[first:last][clear], expected[clear], atol=1e-9)


def test_a_small_reversal_inside_the_gap_meets_no_friction():
    """Forward 30 degrees, back 2 degrees in a gap of 4, forward again: contact exactly where it was lost."""
    step_s = 2e-4
    ramp = np.sin(np.linspace(0.0, np.pi, 2001))
    speed = np.concatenate([d * DEG * ramp / (ramp.sum() * step_s) for d in (30.0, -2.0, 10.0)])
    motion = from_speed(speed, 0.0, step_s)
    run = quiet({"freeplay": {"gap_rad": 4.0 * DEG}}, motion=motion)
    back = slice(2003, 4001)
    assert run.force.in_gap[back].all()
    top = motion.position[:2001].max()
    again = np.flatnonzero(~run.force.in_gap & (np.arange(speed.size) > 4001))[0]
    assert motion.position[again] == pytest.approx(top, abs=0.02 * DEG)


def test_springs_and_per_turn_terms_sit_before_the_gap():
    run = quiet({"freeplay": {"gap_rad": 0.06}, "stiffness": {"stiffness_nm_per_rad": 0.2}})
    np.testing.assert_allclose(run.clean_torque_nm[run.in_gap], 0.05 + 0.2 * run.true_angle_rad[run.in_gap], atol=1e-12)


PASSIVE = [
    "coulomb", "asymmetric_coulomb", "stribeck", "stiction", "presliding", "freeplay", "position_coulomb",
    "tight_spot", "load", "warmup", "dwell", "drag", "asymmetric_viscous",
]  # fmt: skip


@pytest.mark.parametrize("effect", PASSIVE)
def test_friction_takes_energy(effect):
    """Work into the contact is never given back beyond what a bristle can store (level times break-away)."""
    rng = np.random.default_rng(11)
    for size in (1.0, 0.3):
        hidden, base = typical.draw(effect, size, rng) if effect != "coulomb" else ({}, typical.draw_base(rng))
        run = simulate_rig_full(hidden, base=base, seed=12, motion={"small_reversals": 2, "slow_breakaway": True})
        work_nm = np.concatenate([[0.0], np.cumsum(run.force.behind_gap[1:] * np.diff(run.motion.position))])
        breakaway_rad = hidden.get("presliding", {}).get("breakaway_rad", 0.01 * DEG)
        stored_nm = 1.6 * np.max(np.abs(run.force.friction)) * breakaway_rad + 1e-3
        assert np.max(np.maximum.accumulate(work_nm) - work_nm) < stored_nm
        assert work_nm[-1] > 1.0


@pytest.mark.parametrize("effect", [*typical.RIG, *typical.RIG_OUTSIDE])
@pytest.mark.parametrize("size", [1.0, 0.1])
def test_every_typical_effect_changes_the_torque_in_proportion(effect, size):
    hidden, base = typical.draw(effect, size, np.random.default_rng(4))
    options = {"base": base, "seed": 6, **QUIET, **typical.needs(effect)}
    change_nm = simulate_rig_full(hidden, **options).clean_torque_nm - simulate_rig_full({}, **options).clean_torque_nm
    assert np.all(np.isfinite(change_nm))
    assert 0.002 * size < np.sqrt(np.mean(change_nm**2)) < 0.6


def test_two_of_one_kind_and_two_kinds():
    one = {"amplitude_nm": 0.2, "phase_rad": 0.1, "per_turn": 5}
    two = {"amplitude_nm": 0.1, "phase_rad": 0.4, "per_turn": 7}
    both = quiet({"cogging": [one, two]}).clean_torque_nm
    separate = quiet({"cogging": one}).clean_torque_nm + quiet({"cogging": two}).clean_torque_nm
    np.testing.assert_allclose(both, separate - quiet().clean_torque_nm, atol=1e-12)


def test_wrong_names_are_refused():
    for hidden in ({"striebeck": {}}, {"stribeck": {"extra_nm": 0.3}}, {"stribeck": {"dF": 0.3}}):
        with pytest.raises(ValueError):
            simulate_rig(hidden)
    with pytest.raises(ValueError, match="noise"):
        simulate_rig(noise="pink")
    with pytest.raises(ValueError, match="shape"):
        simulate_rig({"presliding": {"breakaway_rad": 0.03, "shape": "dahl"}})
    assert set(typical.RIG_OUTSIDE) == set(OUTSIDE) and not set(OUTSIDE) & set(CATALOGUE)


# --- noise, seeds ---


@pytest.mark.parametrize(("colour", "time_s"), [("50 ms", 0.05), ("0.5 s", 0.5)])
def test_wander_has_the_size_and_time_constant_asked_for(colour, time_s):
    rate_hz, count = 100.0, 400_000
    wander = noise_of(count, rate_hz, np.random.default_rng(1), colour=colour, white=0.0, wander=0.03, hum=0.0)
    assert np.std(wander) == pytest.approx(0.03, rel=0.05)
    lag = round(time_s * rate_hz)
    assert np.corrcoef(wander[lag:], wander[:-lag])[0, 1] == pytest.approx(np.exp(-1.0), abs=0.03)


def test_white_noise_and_hum():
    rate_hz, count = 500.0, 100_000
    white = noise_of(count, rate_hz, np.random.default_rng(2), colour="white", white=0.05, wander=0.03, hum=0.0)
    assert np.std(white) == pytest.approx(0.05, rel=0.01)
    assert abs(np.corrcoef(white[1:], white[:-1])[0, 1]) < 0.01
    hum = noise_of(count, rate_hz, np.random.default_rng(2), colour="white", white=0.0, wander=0.0, hum=0.01)
    spectrum = np.abs(np.fft.rfft(hum)) * 2.0 / count
    assert np.fft.rfftfreq(count, 1.0 / rate_hz)[np.argmax(spectrum)] == pytest.approx(50.0)
    assert spectrum.max() == pytest.approx(0.01, rel=1e-3)


def test_noise_of_a_run():
    run = simulate_rig_full(seed=9, noise="white", noise_nm=0.05, hum_nm=0.0)
    noise_nm = run.torque_nm - run.clean_torque_nm
    assert np.std(noise_nm) == pytest.approx(0.05, rel=0.03)
    assert abs(np.mean(noise_nm)) < 0.002


def test_same_seed_same_bytes_other_seed_other_run():
    for one, again in zip(simulate_rig(seed=4), simulate_rig(seed=4), strict=True):
        np.testing.assert_array_equal(one, again)
    assert simulate_rig(seed=4)[0].size != simulate_rig(seed=5)[0].size
    # What is hidden changes neither the hand nor the noise.
    plain = simulate_rig_full(seed=4)
    other = simulate_rig_full({"drift": {"rate_nm_per_s": 0.02}}, seed=4)
    np.testing.assert_array_equal(plain.angle_rad, other.angle_rad)
    np.testing.assert_allclose(other.torque_nm - plain.torque_nm, 0.02 * plain.time_s, atol=2e-4)


def test_runs_of_a_set_differ():
    runs = simulate_rig_set(seed=1)
    assert len(runs) == 3
    assert len({run.true_angle_rad[0] for run in runs}) == 3


# --- axis ---


def test_axis_is_its_four_parameters():
    run = simulate_axis_full(seed=1, **QUIET_AXIS)
    w, a = run.true_speed_m_s, run.motion.acceleration[::5]
    # Triangular parts turn round within the break-away; look where the speed is clear.
    clear = np.abs(w) > 0.005
    expected_n = -3.2 + 20.4 * np.sign(w) + 203.5 * w + 95.1 * a
    np.testing.assert_allclose(run.force_n[clear], expected_n[clear], atol=0.02)
    assert 15.0 < run.time_s[-1] < 40.0
    assert np.max(run.position_m) == pytest.approx(0.246, abs=1e-4)
    assert np.min(run.position_m) == pytest.approx(0.0, abs=1e-4)
    assert 0.1 < np.max(np.abs(w)) < 0.14


@pytest.mark.parametrize("effect", list(typical.AXIS))
def test_axis_effects(effect):
    hidden, base = typical.draw(effect, 1.0, np.random.default_rng(3), structure="axis")
    _, _, force_n = simulate_axis(hidden, base=base, seed=2, **QUIET_AXIS)
    _, _, plain_n = simulate_axis({}, base=base, seed=2, **QUIET_AXIS)
    assert 0.5 < np.std(force_n - plain_n) < 15.0


def test_axis_names_carry_n_and_m():
    assert axis_name("coefficient_nm_s2_per_rad2") == "coefficient_n_s2_per_m2"
    assert axis_name("breakaway_rad") == "breakaway_m"
    assert axis_name("phase_rad") == "phase_rad"
    for parameters in CATALOGUE.values():
        names = [axis_name(name) for name in parameters]
        assert len(set(names)) == len(names)
    turn = simulate_axis_full(
        {"once_per_rev": {"amplitude_n": 3.0, "phase_rad": 0.0}}, base={}, pitch_m=0.01, seed=1, **QUIET_AXIS
    )
    expected_n = 3.0 * np.sin(2.0 * np.pi * turn.true_position_m / 0.01)
    np.testing.assert_allclose(turn.force_n, expected_n, atol=ROUNDING_NM)
    assert len(axis.simulate_axis_set(seed=1)) == 2


def test_motion_may_be_given():
    motion = hand_motion(np.random.default_rng(0), step_s=2e-4)
    assert isinstance(motion, Motion)
    run = quiet(motion=motion)
    np.testing.assert_array_equal(run.true_angle_rad, motion.position[::10])
    with pytest.raises(ValueError, match="step"):
        quiet(motion=motion, sample_rate_hz=333.0)
