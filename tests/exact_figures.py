"""The exact figures of dry friction and freeplay: closed form, oracle and step of fixed cost side by side.

`python -m tests.exact_figures` prints them as the table of docs/dynamics.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from luztar.dynamics import Signal, exact, trace

from .one_mass_cases import body

# A step that fits no period below.
STEP_S = 1e-3 * 1.0137
PER_CYCLE = 2000
# What the oracle is trusted to, absolute and relative.
TRUST = 1e-10


@dataclass(frozen=True)
class Figure:
    """One figure.

    Attributes
    ----------
    name, value : str, float
        What it is, and its closed form.
    oracle, split : callable
        The same from a run.
    split_bound : float
        What the step's error may be: about three times what it was when the table was made.
    test : str
        The test in tests/test_oracle_exact.py that holds the oracle to the whole motion.
    """

    name: str
    value: float
    oracle: Callable[[], float]
    split: Callable[[], float]
    split_bound: float
    test: str


def times(events, *kinds: str) -> list[float]:
    """When something of these kinds happened."""
    return [e.time_s for e in events if e.kind in kinds]


def still(parts: dict[str, float], seconds: float, step: float = STEP_S, **start: float):
    """Return a traced run with the handwheel at rest."""
    return trace(parts, np.zeros(round(seconds / step)), sample_rate_hz=1.0 / step, **start)


def decay() -> list[Figure]:
    """Free decay with dry friction, and with viscous friction besides."""
    stiffness = (2.0 * math.pi * 1.0618033) ** 2
    dry = body(stiffness=stiffness, coulomb=0.1 * stiffness)
    zeta, d = 0.3, 0.01
    both = body(stiffness=1.0, coulomb=d, viscous=2.0 * zeta)
    kept = math.exp(-zeta * math.pi / math.sqrt(1.0 - zeta**2))
    third = 1.0
    for _ in range(3):
        third = kept * third - d * (1.0 + kept)
    after = 3.0 * math.pi / math.sqrt(1.0 - zeta**2)

    def turn(run) -> float:
        place = round(after / STEP_S)
        return float(np.abs(run.roadwheel_rad[place - 50 : place + 50]).max())

    dry_test, viscous_test = "free_decay_is_half_cosines_about_shifted_centres", "free_decay_with_viscous_friction"
    return [
        Figure(
            "decay: angle of rest",
            -0.03,
            lambda: exact(dry, 0.0, [0.0, 4.0], start_rad=1.03).roadwheel_rad[-1],
            lambda: still(dry, 4.0, start_rad=1.03).roadwheel_rad[-1],
            1e-9,
            dry_test,
        ),
        Figure(
            "decay: time of rest, s",
            5.0 * math.pi / math.sqrt(stiffness),
            lambda: times(exact(dry, 0.0, [0.0, 4.0], start_rad=1.03).events, "stick")[0],
            lambda: times(still(dry, 4.0, start_rad=1.03).events, "stick")[0],
            1.4e-5,
            dry_test,
        ),
        Figure(
            "decay, zeta = 0.3: third amplitude",
            third,
            lambda: abs(exact(both, 0.0, [0.0, 20.0], start_rad=1.0).events[3].angle_rad),
            lambda: turn(still(both, 20.0, start_rad=1.0)),
            6e-9,
            viscous_test,
        ),
    ]


def den_hartog(r: float, share: float, zeta: float) -> float:
    """Amplitude over P / k of the motion without stops (Den Hartog 1930)."""
    b, s = 1.0 / r, math.sqrt(1.0 - zeta**2)
    under = math.cosh(zeta * b * math.pi) + math.cos(b * s * math.pi)
    g = (math.sinh(zeta * b * math.pi) - zeta / s * math.sin(b * s * math.pi)) / under
    h = b / s * math.sin(b * s * math.pi) / under
    q = (1.0 - r**2) ** 2 + (2.0 * zeta * r) ** 2
    return -g * share + math.sqrt(1.0 / q - (h * share) ** 2)


# Frequency over natural frequency, F / P, damping, and the reference's eight digits.
DEN_HARTOG = [
    (0.6, 0.2, 0.0, 1.55060285),
    (0.8, 0.5, 0.0, 2.33223499),
    (1.2, 0.5, 0.0, 1.65746747),
    (1.5, 0.3, 0.0, 0.72111026),
    (0.7, 0.3, 0.1, 1.63078610),
    (1.3, 0.4, 0.05, 1.05301703),
]


def forced(parts: dict[str, float], r: float, cycles: int, force: Callable = np.cos, **start: float) -> np.ndarray:
    """Return the road wheel under a force of one frequency, 2000 steps to the cycle."""
    step = 2.0 * math.pi / r / PER_CYCLE
    load = force(r * step * np.arange(cycles * PER_CYCLE + 1))
    return trace(parts, np.zeros_like(load), load_nm=load, sample_rate_hz=1.0 / step, **start).roadwheel_rad


def swing(angle: np.ndarray) -> float:
    """Return the amplitude of the last ten cycles."""
    last = angle[-10 * PER_CYCLE :]
    return float(last.max() - last.min()) / 2.0


def oscillator() -> list[Figure]:
    """The oscillator under a force: Den Hartog's amplitudes, resonance, two stops."""
    out = []
    for r, share, zeta, _ in DEN_HARTOG:
        parts = body(stiffness=1.0, coulomb=share, viscous=2.0 * zeta)

        def reached(parts=parts, r=r) -> float:
            force = Signal.sine(1.0, r, math.pi / 2.0)
            return abs(exact(parts, 0.0, [0.0, 2000.0 * math.pi / r], load_nm=force).events[-1].angle_rad)

        name = f"Den Hartog r = {r}, F/P = {share}" + (f", zeta = {zeta}" if zeta else "")
        split = lambda parts=parts, r=r: swing(forced(parts, r, 240))  # noqa: E731
        test = "den_hartog_is_reached_from_rest"
        # The reference measured up to 7.1e-6 with the same step.
        out.append(Figure(name, den_hartog(r, share, zeta), reached, split, 1.5e-5, test))
    growing, bounded = body(stiffness=1.0, coulomb=0.7), body(stiffness=1.0, coulomb=0.8)
    out.append(
        Figure(
            "resonance, F/P = 0.7: growth in 400 cycles",
            400.0 * (math.pi - 2.8),
            lambda: (
                exact(
                    growing, 0.0, [0.0, 800.0 * math.pi], load_nm=Signal.sine(-1.0, 1.0), start_rad=2.0
                ).roadwheel_rad[-1]
                - 2.0
            ),
            lambda: forced(growing, 1.0, 400, lambda t: -np.sin(t), start_rad=2.0)[-1] - 2.0,
            8e-4,
            "at_resonance_the_amplitude_grows_by_pi_p_less_four_f",
        )
    )
    out.append(
        Figure(
            "resonance, F/P = 0.8: amplitude, two stops",
            # Root of the closed form in test_at_resonance_two_stops_bound_the_amplitude.
            0.2994310417484271,
            lambda: abs(exact(bounded, Signal.sine(1.0, 1.0), [0.0, 400.0]).events[-1].angle_rad),
            lambda: swing(forced(bounded, 1.0, 100)),
            6e-7,
            "at_resonance_two_stops_bound_the_amplitude",
        )
    )
    return out


def belt() -> list[Figure]:
    """A body on a belt, static friction above kinetic."""
    parts, speed, d = body(stiffness=1.0, coulomb=0.6, stiction=0.4), 0.2, 0.4

    def oracle(seconds: float = 30.0):
        return exact(parts, 0.0, [0.0, seconds], start_speed_rad_s=speed, ground_speed_rad_s=speed)

    def split():
        # In the belt's frame, where the spring's end moves the other way.
        t = np.arange(round(30.0 / STEP_S)) * STEP_S
        return trace(parts, -speed * t, sample_rate_hz=1.0 / STEP_S)

    def slipping(run) -> float:
        return times(run.events, "stick")[1] - times(run.events, "slip")[1]

    def sticking(run) -> float:
        return times(run.events, "slip")[2] - times(run.events, "stick")[1]

    def highest() -> float:
        run = split()
        return float((run.roadwheel_rad + speed * run.time_s).max())

    def held_at() -> float:
        run = split()
        held = times(run.events, "stick")[0]
        return float(run.roadwheel_rad[math.ceil(held / STEP_S)] + speed * held)

    slip = 2.0 * (math.pi - math.atan(d / speed))
    peak = 5.0 + math.atan2(speed, d)
    test = "the_belt_with_static_above_kinetic_friction"
    return [
        Figure("belt: time of slip, s", slip, lambda: slipping(oracle()), lambda: slipping(split()), 8e-7, test),
        Figure("belt: time of stick, s", 4.0, lambda: sticking(oracle()), lambda: sticking(split()), 1.1e-7, test),
        Figure(
            "belt: farthest", 0.6 + math.hypot(d, speed), lambda: oracle(peak).roadwheel_rad[-1], highest, 6e-8, test
        ),
        Figure(
            "belt: where it is held again",
            0.2,
            lambda: [e for e in oracle().events if e.kind == "stick"][0].angle_rad,
            held_at,
            2.1e-8,
            test,
        ),
    ]


def freeplay() -> list[Figure]:
    """The oscillator with freeplay, without and with dry friction."""
    inertia, stiffness, half_gap, depth, friction = 2.0, 50.0, 0.05, 0.3, 0.4
    w, d = math.sqrt(stiffness / inertia), friction / stiffness
    free = body(inertia=inertia, stiffness=stiffness, gap=2.0 * half_gap)
    rubbed = {**free, "coulomb.level_nm": friction}
    start = {"start_rad": depth + half_gap}

    def period(run) -> float:
        turns = times(run.events, "reversal")
        return (turns[12] - turns[0]) / 6.0

    x = depth
    for _ in range(3):
        x = -d + math.sqrt(d**2 + x * (x - 2.0 * d) - 4.0 * friction * half_gap / inertia / w**2)

    def third_exact() -> float:
        run = exact(rubbed, 0.0, [0.0, 6.0], **start)
        return abs([e for e in run.events if e.kind == "reversal"][2].angle_rad)

    def third() -> float:
        run = still(rubbed, 6.0, **start)
        turn = round(times(run.events, "reversal")[2] / STEP_S)
        return float(np.abs(run.roadwheel_rad[turn - 2 : turn + 3]).max())

    return [
        Figure(
            "freeplay oscillator: period, s",
            2.0 * math.pi / w + 4.0 * half_gap / (w * depth),
            lambda: period(exact(free, 0.0, [0.0, 12.0], **start)),
            lambda: period(still(free, 12.0, **start)),
            5e-6,
            "the_period_of_the_freeplay_oscillator",
        ),
        Figure(
            "freeplay with friction: third turn",
            x + half_gap,
            lambda: abs(
                [e for e in exact(rubbed, 0.0, [0.0, 6.0], **start).events if e.kind == "reversal"][2].angle_rad
            ),
            third,
            1.5e-6,
            "the_return_map_of_freeplay_with_friction",
        ),
    ]


def break_away() -> list[Figure]:
    """Loads and a handwheel that rise until friction gives way."""
    static, kinetic, rise, inertia, level, w = 1.0, 0.6, 0.7, 2.0, 1.5, 1.3
    parts = body(inertia=inertia, coulomb=kinetic, stiction=static - kinetic)
    steering = body(inertia=3.0, ratio=16.0, stiffness=60.0, gap=0.1, coulomb=8.1, stiction=3.9)
    t = np.arange(round(3.0 / STEP_S)) * STEP_S
    tau = t[-1] - static / rise

    def loaded(load: np.ndarray):
        return trace(parts, np.zeros_like(t), load_nm=load, sample_rate_hz=1.0 / STEP_S)

    ramp, sine, hand = Signal.polynomial(0.0, rise), Signal.sine(level, w), Signal.polynomial(0.0, 0.3)
    test = "break_away_on_a_ramp_and_on_a_sine"
    return [
        Figure(
            "break-away on a ramp, s",
            static / rise,
            lambda: exact(parts, 0.0, t, load_nm=ramp).events[0].time_s,
            lambda: loaded(rise * t).events[0].time_s,
            1e-12,
            test,
        ),
        Figure(
            "way after it, 3 s",
            ((static - kinetic) * tau**2 / 2.0 + rise * tau**3 / 6.0) / inertia,
            lambda: exact(parts, 0.0, t, load_nm=ramp).roadwheel_rad[-1],
            lambda: loaded(rise * t).roadwheel_rad[-1],
            1.5e-7,
            test,
        ),
        Figure(
            "break-away on a sine, s",
            math.asin(static / level) / w,
            lambda: exact(parts, 0.0, t, load_nm=sine).events[0].time_s,
            lambda: loaded(level * np.sin(w * t)).events[0].time_s,
            4e-7,
            test,
        ),
        Figure(
            "break-away of a handwheel behind its gap, s",
            (0.05 + 12.0 / (16.0 * 60.0)) / 0.3,
            lambda: times(exact(steering, hand, [0.0, 1.0]).events, "slip")[0],
            lambda: times(trace(steering, 0.3 * t, sample_rate_hz=1.0 / STEP_S).events, "slip")[0],
            1e-12,
            "a_ramp_of_the_handwheel_through_gap_and_friction",
        ),
    ]


def figures() -> list[Figure]:
    """Return all of them."""
    return [*decay(), *oscillator(), *belt(), *freeplay(), *break_away()]


def main() -> None:
    """Print the table."""
    print("| figure | closed form | oracle's error | error of `split` | test |")
    print("|---|---|---|---|---|")
    for f in figures():
        errors = [abs(run() - f.value) for run in (f.oracle, f.split)]
        print(f"| {f.name} | {f.value:.10g} | {errors[0]:.0e} | {errors[1]:.1e} | `{f.test}` |")


if __name__ == "__main__":
    main()
