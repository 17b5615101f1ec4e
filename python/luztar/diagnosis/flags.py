"""What is odd about the parameters of a fit: at a bound, without influence, or friction that drives the motion."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..model import Parameter, card
from .grids import is_continuous, is_sharpness, limits
from .jacobian import continuous, jacobian
from .misfit import rms, usable
from .prepare import Prepared
from .resolved import FILTER_MEMORY_PERIODS

if TYPE_CHECKING:
    from .fit import Fit

# An inner parameter this near to an end of its search (as a share of it) has stopped there: it is located to a fiftieth
# of its grid's spacing.
AT_BOUND = 0.01
# What changes the prediction by less than a hundredth of the noise floor cannot be seen in these data.
NO_INFLUENCE = 0.01
# Friction against its direction by less than this share of its greatest is the low pass ringing, and rounding.
NOT_PASSIVE = 0.02


@dataclass(frozen=True)
class Flag:
    """One remark on a fit.

    Attributes
    ----------
    kind : str
        ``at_bound``, ``no_influence``, ``not_passive``, ``one_direction``, ``clipped``, ``own_offset`` or
        ``own_delay``.
    parameter : str
        ``effect.parameter``; of ``not_passive`` the one that does most of it, of ``clipped`` empty.
    text : str
    """

    kind: str
    parameter: str
    text: str

    def to_dict(self) -> dict[str, str]:
        """Return the flag as plain JSON values."""
        return {"kind": self.kind, "parameter": self.parameter, "text": self.text}


def flags_of(fitted: Fit) -> tuple[Flag, ...]:
    """Return every flag of a fit: bounds first, then influence, then passivity.

    Parameters
    ----------
    fitted : Fit
    """
    silent = tuple(_without_influence(fitted))
    mute = {f.parameter.partition(".")[0] for f in silent if "contributes" in f.text}
    bounds = (f for f in _at_bounds(fitted) if f.parameter.partition(".")[0] not in mute)
    one_way = tuple(_one_way(fitted))
    if one_way:
        # The level and the offset are any two numbers with the right sum: what they are says nothing further.
        bounds = (f for f in bounds if f.parameter != one_way[0].parameter)
    return (*one_way, *bounds, *silent, *(() if one_way else _not_passive(fitted)), *_of_runs(fitted))


def _one_way(fitted: Fit) -> Iterator[Flag]:
    ways = {s.direction for r in fitted.runs for s in r.strokes}
    if len(ways) == 1 and {"offset", "coulomb"} <= set(fitted.model.effects):
        structure = fitted.model.structure
        word = "increasing" if ways == {1} else "decreasing"
        level = next(k for k in fitted.parameters if k.startswith("coulomb.level"))
        text = (
            f"every stroke goes with {word} {structure.motion}: friction cannot be told from an offset. Only their sum "
            "is known; record strokes in both directions, or take the offset out of the model."
        )
        yield Flag("one_direction", level, text)


def _of_runs(fitted: Fit) -> Iterator[Flag]:
    for r in fitted.runs:
        if r.doubt:
            yield Flag("clipped", "", f"{r.name}: {r.doubt}. The values rest on that.")
    yield from _own_sensors(fitted)


def _own_sensors(fitted: Fit) -> Iterator[Flag]:
    unit = fitted.model.structure.effort_unit
    key = f"offset.level_{'nm' if fitted.model.structure.motion_unit == 'rad' else 'n'}"
    for r in fitted.runs:
        if r.own_offset:
            way = "above" if r.own_offset > 0.0 else "below"
            size = f"{abs(r.own_offset):.3g} {unit}"
            text = f"{r.name} lies {size} {way} the other runs everywhere; taken off. Was the load cell zeroed anew?"
            yield Flag("own_offset", key, text)
        if r.own_delay_s:
            way = "later" if r.own_delay_s > 0.0 else "earlier"
            size = f"{1e3 * abs(r.own_delay_s):.3g} ms"
            text = (
                f"{r.name}: its {fitted.model.structure.effort} comes {size} {way} than in the other runs; taken off."
            )
            yield Flag("own_delay", "delay.time_s", text)


def _at_bounds(fitted: Fit) -> Iterator[Flag]:
    structure = fitted.model.structure_name
    for key, estimate in fitted.parameters.items():
        effect, _, name = key.partition(".")
        p = next(p for p in card(effect, structure).parameters if p.key == name)
        if key in fitted.model.known or p.role == "phase":
            continue
        value = f"{key} is {estimate.value:.4g}{f' {p.unit}' if p.unit else ''}"
        if p.role == "inner":
            end = _end_reached(p, estimate.value, fitted)
            if end:
                beyond = "it may be smaller, or nothing" if end == "lower" else "it may be larger"
                yield Flag("at_bound", key, f"{value}: the search stopped at its {end} end; {beyond}.")
        elif not p.low <= estimate.value <= p.high:
            allowed = f"at least {p.low:g}" if math.isinf(p.high) else f"{p.low:g} to {p.high:g}"
            yield Flag("at_bound", key, f"{value}; its card asks for {allowed} (luztar explain {effect}).")


def _end_reached(p: Parameter, value: float, fitted: Fit) -> str:
    if not is_continuous(p) or is_sharpness(p):
        return ""
    low, high = limits(p, fitted.runs)
    near = AT_BOUND * (high - low) if math.isfinite(high - low) and low <= 0.0 else AT_BOUND * abs(value)
    return "lower" if value <= low + near else "upper" if value >= high - near else ""


def _without_influence(fitted: Fit) -> Iterator[Flag]:
    structure = fitted.model.structure
    least = NO_INFLUENCE * fitted.noise_floor.rms
    mute = set()
    for name in fitted.model.effects:
        c = card(name, structure.name)
        if not c.linear:
            continue
        size = rms(usable(fitted.runs, _contribution(fitted, name)))
        if size < least:
            mute.add(name)
            text = f"{name} contributes {size:.2g} {structure.effort_unit} rms: these data do not show it."
            yield Flag("no_influence", f"{name}.{c.linear[0].key}", text)
    varied = [v for v in continuous(fitted.problem, fitted.state) if v.effect not in mute]
    if not varied:
        return
    made = jacobian(fitted.problem, fitted.state, varied)
    for k, v in enumerate(varied):
        value = fitted.state.terms.inner[v.effect][v.index]
        # The derivatives stand before the shift of the starts and the measurement.
        column = [m[:, m.shape[1] - 2 - len(varied) + k] for m in made.matrix]
        if rms(usable(fitted.runs, column)) * max(abs(value), v.step) < least:
            key = f"{v.effect}.{v.key}"
            yield Flag("no_influence", key, f"{key} may change by its own size and the prediction does not.")


def _contribution(fitted: Fit, name: str) -> list[np.ndarray]:
    """Return what an effect adds to the prediction of every run."""
    from .fit import columns_of

    terms, problem = fitted.state.terms, fitted.problem
    free = columns_of(fitted)
    values = [
        problem.fixed[(name, i)] if (name, i) in problem.fixed else fitted.state.coefficients[free.index((name, i))]
        for i in range(len(card(name, fitted.model.structure_name).linear))
    ]
    index = terms.effects.index(name)
    return [np.array(values) @ r.recording.columns(terms.pairs(), [index]) for r in fitted.runs]


def _not_passive(fitted: Fit) -> Iterator[Flag]:
    structure = fitted.model.structure
    # What a gap cuts off is what rubs: Coulomb friction with all that shapes it, and viscous friction.
    rubbing = [n for n in fitted.model.effects if card(n, structure.name).behind_gap]
    if not rubbing:
        return
    clear = [r.usable & ~_near_reversal(r, fitted.model.band_hz) for r in fitted.runs]
    parts = {n: np.concatenate([p[k] for p, k in zip(_contribution(fitted, n), clear, strict=True)]) for n in rubbing}
    speed = np.concatenate([r.speed[k] for r, k in zip(fitted.runs, clear, strict=True)])
    along = sum(parts.values()) * np.sign(speed)
    if not along.size or along.min() >= -NOT_PASSIVE * np.abs(along).max():
        return
    wrong = along < -NOT_PASSIVE * np.abs(along).max()
    worst = int(along.argmin())
    most = min(rubbing, key=lambda n: parts[n][worst] * np.sign(speed[worst]))
    pace = abs(float(speed[worst]))
    shown = f"{math.degrees(pace):.3g} deg/s" if structure.motion_unit == "rad" else f"{1000.0 * pace:.3g} mm/s"
    way = "increasing" if speed[worst] > 0.0 else "decreasing"
    size = f"{along[worst]:.3g} {structure.effort_unit}"
    text = (
        f"the friction of the model drives the motion in {_percent(float(wrong.mean()))} of the record, most at "
        f"{shown} with {way} {structure.motion} ({size}): no friction does that, so these values "
        "stand for something else."
    )
    yield Flag("not_passive", f"{most}.{card(most, structure.name).linear[0].key}", text)


def _near_reversal(r: Prepared, band_hz: float) -> np.ndarray:
    """Return where the low pass mixes both directions: as far as it remembers beyond the stretches of low speed."""
    reach = math.ceil(FILTER_MEMORY_PERIODS / band_hz / r.step_s)
    # A reversal between two kept samples has no stretch of low speed, but an onset.
    edges = [*np.flatnonzero(np.diff(r.zone.astype(np.int8))), *(s.onset for s in r.strokes)]
    near = r.zone.copy()
    for edge in edges:
        near[max(0, edge - reach) : edge + reach] = True
    return near


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %" if share >= 0.001 else "less than 0.1 %"


def flag_lines(flags: tuple[Flag, ...]) -> list[str]:
    """Return one line per flag."""
    return [f"  ! {f.text}" for f in flags]
