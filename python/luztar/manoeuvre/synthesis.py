"""Stage 1 of the paper: the form of the signal and its parameters from a registered handwheel trace."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import number, vector
from .._printed import Printed
from ..errors import MeasurementError, ParameterError
from .form import WAVES, Form

# A half wave counts when it reaches this share of the largest angle, and lasts while it is above the smaller one.
RAISED, ENDED = 0.3, 0.1
# The trace begins and ends straight ahead: this share of it at either end gives the first guess of the offset.
STRAIGHT_SHARE = 0.03
LEAST_SAMPLES = 50


@dataclass(frozen=True)
class HalfWave:
    """A stretch of the trace to one side: when it begins and ends (s), and its extreme (rad)."""

    from_s: float
    to_s: float
    extreme: float

    def to_dict(self) -> dict[str, float]:
        """Return the stretch as plain JSON values."""
        return {"from_s": self.from_s, "to_s": self.to_s, "extreme": self.extreme}


@dataclass(frozen=True)
class Synthesis(Printed):
    """What :func:`synthesise` returns.

    Attributes
    ----------
    form : Form
    values : ndarray
        Its parameters, in the order of its names; amplitudes above 0.
    direction : float
        1 where the manoeuvre goes to the left first, -1 to the right.
    offset : float
        The handwheel's angle straight ahead, in the unit of the trace.
    rms : float
        Of what the signal leaves of the trace.
    explained : float
        Share of the trace's variance that the signal explains.
    half_waves : tuple of HalfWave
        The segments found.
    tried : mapping of str to float
        The rms of every form that was fitted.
    """

    form: Form
    values: np.ndarray
    direction: float
    offset: float
    rms: float
    explained: float
    half_waves: tuple[HalfWave, ...]
    tried: dict[str, float]

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain JSON values."""
        return {
            "form": self.form.name,
            "parameters": self.form.to_dict(self.values),
            "direction": self.direction,
            "offset": self.offset,
            "rms": self.rms,
            "explained": self.explained,
            "half_waves": [w.to_dict() for w in self.half_waves],
            "tried": dict(self.tried),
        }

    def _rows(self) -> list[tuple[str, str]]:
        rows = [("form", self.form.name), ("first", "to the left" if self.direction > 0.0 else "to the right")]
        rows += [(name, f"{v:.5g}") for name, v in self.form.to_dict(self.values).items()]
        rows += [("offset", f"{self.offset:.4g}"), ("left over", f"rms {self.rms:.4g}, explained {self.explained:.4f}")]
        return rows


def synthesise(trace: Any, sample_rate_hz: float, *, form: str | None = None) -> Synthesis:
    """Find the piecewise sinusoidal and constant signal behind a registered trace.

    Half waves are found by two thresholds (0.3 and 0.1 of the largest angle); amplitudes, frequencies, switch times and
    the offset then follow by least squares over all samples.

    Parameters
    ----------
    trace : array_like, shape (n,), n >= 50
        Handwheel angle (rad) or torque (Nm) of one double lane change, straight ahead at both ends.
    sample_rate_hz : float, > 0
    form : {"two_sines", "three_halves"}, optional
        Both are tried where not given, and the one that leaves less is taken.

    Returns
    -------
    Synthesis

    Raises
    ------
    MeasurementError
        The trace shows no double lane change: names the half waves found.
    ParameterError
        An unknown form, samples that are not finite, a rate that is not positive.

    Examples
    --------
    >>> import numpy as np, luztar
    >>> t = np.arange(0.0, 8.0, 0.01)
    >>> trace = np.where((t > 1) & (t < 3), 0.5, 0) * np.sin(np.pi * (t - 1))
    >>> trace -= np.where((t > 4) & (t < 6), 0.4, 0) * np.sin(np.pi * (t - 4))
    >>> found = luztar.manoeuvre.synthesise(trace, 100.0)
    >>> found.form.name, found.values.round(3).tolist()
    ('two_sines', [1.0, 0.5, 0.5, 1.0, 0.4, 0.5])
    """
    values = vector("trace", trace, minimum=LEAST_SAMPLES)
    rate = number("sample_rate_hz", sample_rate_hz)
    if not (np.isfinite(rate) and rate > 0.0):
        raise ParameterError(f"sample_rate_hz is {rate:g}", "sample_rate_hz", "Give a rate above 0 Hz.")
    forms = [Form(form)] if form is not None else [Form(name) for name in WAVES]
    edge = max(2, round(STRAIGHT_SHARE * values.size))
    offset = 0.5 * float(np.median(values[:edge]) + np.median(values[-edge:]))
    waves = half_waves(values - offset, rate)
    direction = _direction(waves)
    time = np.arange(values.size) / rate
    fits = {f.name: (f, *_fitted(f, time, direction * values, _guess(f, waves), direction * offset)) for f in forms}
    chosen, parameters, level, rms = min(fits.values(), key=lambda fit: fit[3])
    return Synthesis(
        form=chosen,
        values=parameters,
        direction=direction,
        offset=direction * level,
        rms=rms,
        explained=1.0 - rms**2 / float(values.var()),
        half_waves=tuple(waves),
        tried={name: fit[3] for name, fit in fits.items()},
    )


def half_waves(values: np.ndarray, rate_hz: float) -> list[HalfWave]:
    """Return the stretches in which the trace is clearly on one side."""
    size = float(np.abs(values).max())
    found: list[HalfWave] = []
    for sign in (1.0, -1.0):
        above = np.concatenate([[False], sign * values > ENDED * size, [False]])
        starts = np.flatnonzero(~above[:-1] & above[1:])
        ends = np.flatnonzero(above[:-1] & ~above[1:])
        for start, end in zip(starts, ends, strict=True):
            extreme = float((sign * values[start:end]).max())
            if extreme >= RAISED * size and size > 0.0:
                found.append(HalfWave(start / rate_hz, end / rate_hz, sign * extreme))
    return sorted(found, key=lambda wave: wave.from_s)


def _direction(waves: list[HalfWave]) -> float:
    signs = [1.0 if wave.extreme > 0.0 else -1.0 for wave in waves]
    first = signs[0] if signs else 1.0
    if [first * s for s in signs] not in ([1.0, -1.0, -1.0, 1.0], [1.0, -1.0, 1.0]):
        shown = ", ".join("left" if s > 0.0 else "right" for s in signs) or "none"
        raise MeasurementError(
            f"the trace shows no double lane change: half waves found are {shown}",
            "trace",
            "Give one manoeuvre, straight ahead at both ends: out, back, back, out.",
        )
    return first


def _guess(form: Form, waves: list[HalfWave]) -> np.ndarray:
    """First values of a form's parameters from the half waves, split or joined where their number differs."""
    if form.name == "two_sines" and len(waves) == 3:
        over = waves[1]
        middle = 0.5 * (over.from_s + over.to_s)
        parts = (HalfWave(over.from_s, middle, over.extreme), HalfWave(middle, over.to_s, over.extreme))
        waves = [waves[0], *parts, waves[2]]
    if form.name == "three_halves" and len(waves) == 4:
        waves = [waves[0], HalfWave(waves[1].from_s, waves[2].to_s, waves[1].extreme), waves[3]]
    made = [waves[0].from_s]
    at = 0
    for halves, _, held in WAVES[form.name]:
        part = waves[at : at + halves]
        if held:
            made.append(max(part[0].from_s - waves[at - 1].to_s, 0.0))
        size = float(np.mean([abs(wave.extreme) for wave in part]))
        made += [size, 0.5 * halves / (part[-1].to_s - part[0].from_s)]
        at += halves
    return np.array(made)


def _fitted(
    form: Form, time: np.ndarray, trace: np.ndarray, guess: np.ndarray, offset: float
) -> tuple[np.ndarray, float, float]:
    """Parameters, offset and rms of the least-squares fit."""
    from scipy.optimize import least_squares

    lows = [-np.inf if name.startswith("amplitude") else 0.0 for name in form.names]
    lows = [
        1e-3 / time[-1] if name.startswith("frequency") else low for name, low in zip(form.names, lows, strict=True)
    ]
    start = np.append(np.maximum(guess, np.array(lows)), offset)
    # The size of a step of each parameter that matters: its own, or the manoeuvre's.
    scale = np.append(np.maximum(np.abs(guess), 0.05 * np.abs(guess).max()), np.abs(trace).max())
    made = least_squares(
        lambda p: played(form, p[:-1], time) + p[-1] - trace,
        start,
        bounds=(np.append(lows, -np.inf), np.full(start.size, np.inf)),
        x_scale=scale,
    )
    return made.x[:-1], float(made.x[-1]), float(np.sqrt(2.0 * made.cost / time.size))


def played(form: Form, values: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """Return a signal, to the left first, at times (s)."""
    pieces = form.pieces(values)
    at = np.searchsorted(pieces.start_s, time_s, side="right") - 1
    angle = 2.0 * np.pi * pieces.frequency_hz[at] * (time_s - pieces.start_s[at])
    return np.where(at >= 0, pieces.amplitude[at] * np.sin(angle), 0.0)
