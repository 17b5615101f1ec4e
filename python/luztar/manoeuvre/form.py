"""The form of the driver's signal: pieces of sines and constants, its parameters, where they are searched."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import ParameterError
from ..vehicle import Pieces
from .track import Track

# Every wave: half periods, sign of its first one, whether the signal may be held at zero before it.
WAVES = {
    "two_sines": ((2, 1.0, False), (2, -1.0, True)),
    "three_halves": ((1, 1.0, False), (1, -1.0, False), (1, 1.0, False)),
}
FORMS = tuple(WAVES)
# A wave's amplitude is searched between these multiples of the one that a linear car without lag would need: a tyre
# near its limit, a gap or friction under torque ask for more, cut corners for less.
LEAST_SHARE, MOST_SHARE = 0.25, 5.0
# No driver turns quicker to and fro.
HIGHEST_HZ = 2.5


@dataclass(frozen=True)
class Form:
    """The paper's piecewise sinusoidal and constant signal with unknown amplitudes, frequencies and switch times.

    Parameters
    ----------
    name : {"two_sines", "three_halves"}
        ``two_sines``: one whole sine to change lanes, zero, one whole sine of the other sign to come back.
        ``three_halves``: out, over, in, each half wave of its own; for avoiding without a hold.
    """

    name: str = "two_sines"

    def __post_init__(self) -> None:
        if self.name not in WAVES:
            raise ParameterError(f"there is no form {self.name!r}", "form", f"Known are: {', '.join(FORMS)}.")

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters; amplitudes in the unit of the signal (rad or Nm)."""
        made = ["start_s"]
        for number, (_, _, held) in enumerate(WAVES[self.name], start=1):
            made += ["hold_s"] if held else []
            made += [f"amplitude_{number}", f"frequency_{number}_hz"]
        return tuple(made)

    def pieces(self, values: Any, direction: float = 1.0) -> Pieces:
        """Return the signals of parameter rows.

        Parameters
        ----------
        values : array_like, shape (parameters,) or (cars, parameters)
            In the order of ``names``.
        direction : float
            1 to the left first, -1 to the right.

        Raises
        ------
        ParameterError
            A wrong number of parameters, values that are not finite, frequencies or times below 0.
        """
        rows = np.asarray(values, dtype=np.float64)
        if rows.ndim not in (1, 2) or rows.shape[-1] != len(self.names):
            remedy = f"Give {len(self.names)}: {', '.join(self.names)}."
            raise ParameterError(f"signal parameters have the shape {rows.shape}", "values", remedy)
        column = dict(zip(self.names, np.moveaxis(rows, -1, 0), strict=True))
        for name, each in column.items():
            if not np.isfinite(each).all() or (not name.startswith("amplitude") and (each < 0.0).any()):
                raise ParameterError(f"{name} is not finite or below 0", name, "Give finite numbers, times above 0.")
            if name.startswith("frequency") and (each <= 0.0).any():
                raise ParameterError(f"{name} is 0", name, "Give a frequency above 0 Hz.")
        starts, amplitudes, frequencies = [], [], []
        time = column["start_s"]
        quiet = np.zeros_like(time)
        for number, (halves, sign, held) in enumerate(WAVES[self.name], start=1):
            if held:
                starts.append(time)
                amplitudes.append(quiet)
                frequencies.append(quiet)
                time = time + column["hold_s"]
            frequency = column[f"frequency_{number}_hz"]
            starts.append(time)
            amplitudes.append(direction * sign * column[f"amplitude_{number}"])
            frequencies.append(frequency)
            time = time + 0.5 * halves / frequency
        starts.append(time)
        amplitudes.append(quiet)
        frequencies.append(quiet)
        return Pieces(
            start_s=np.stack(starts, axis=-1),
            amplitude=np.stack(amplitudes, axis=-1),
            frequency_hz=np.stack(frequencies, axis=-1),
        )

    def to_dict(self, values: Any) -> dict[str, float]:
        """Return parameters by their names."""
        return {name: float(v) for name, v in zip(self.names, values, strict=True)}


@dataclass(frozen=True)
class Box:
    """Where a form's parameters are searched: the unit cube, and what its points stand for.

    Frequencies are searched by their logarithm, amplitudes by the logarithm of their ratio to the one that shifts a
    linear car from lane to lane within one period, ``2 pi f^2 shift / (speed gain)``: along this ratio the criterion is
    a plain valley, along the amplitude itself it is a bent one.

    Parameters
    ----------
    form : Form
    track : Track
    speed_m_s : float
    gain : float
        Steady yaw rate over handwheel angle (1/s) or over torque (rad/s/Nm).
    """

    form: Form
    track: Track
    speed_m_s: float
    gain: float

    def limits(self) -> dict[str, tuple[float, float]]:
        """Return the range of every start, hold and frequency."""
        track, v = self.track, self.speed_m_s
        made = {
            "start_s": (0.0, track.other_m[0] / v),
            "hold_s": (0.0, (track.exit_m[0] - track.entry_m[1]) / v),
        }
        waves = WAVES[self.form.name]
        for number in range(1, len(waves) + 1):
            out = 2 * number <= len(waves) + 1
            longest = (track.other_m[1] if out else track.exit_m[1] - track.other_m[0]) / v
            way = (track.other_m[0] - track.entry_m[1] if out else track.exit_m[0] - track.other_m[1]) / v
            low = 1.0 / longest
            made[f"frequency_{number}_hz"] = (low, max(min(HIGHEST_HZ, 4.0 / way), 2.0 * low))
        return made

    def values(self, points: np.ndarray) -> np.ndarray:
        """Return the parameters that points of the unit cube, shape (n, parameters), stand for."""
        limits = self.limits()
        out = np.empty_like(points)
        place = {name: i for i, name in enumerate(self.form.names)}
        for name, i in place.items():
            if name.startswith("amplitude"):
                continue
            low, high = limits[name]
            if name.startswith("frequency"):
                out[:, i] = low * (high / low) ** points[:, i]
            else:
                out[:, i] = low + (high - low) * points[:, i]
        for name, i in place.items():
            if name.startswith("amplitude"):
                frequency = out[:, place[f"frequency_{name.partition('_')[2]}_hz"]]
                share = LEAST_SHARE * (MOST_SHARE / LEAST_SHARE) ** points[:, i]
                out[:, i] = share * self.linear_amplitude(frequency)
        return out

    def points(self, values: np.ndarray) -> np.ndarray:
        """Return the points of the unit cube that stand for parameters; the inverse of :meth:`values`."""
        limits = self.limits()
        out = np.empty_like(values)
        for i, name in enumerate(self.form.names):
            if name.startswith("amplitude"):
                at = self.form.names.index(f"frequency_{name.partition('_')[2]}_hz")
                share = values[:, i] / self.linear_amplitude(values[:, at])
                out[:, i] = np.log(share / LEAST_SHARE) / np.log(MOST_SHARE / LEAST_SHARE)
            else:
                low, high = limits[name]
                ratio = name.startswith("frequency")
                out[:, i] = np.log(values[:, i] / low) / np.log(high / low) if ratio else values[:, i] / high
        return out

    def linear_amplitude(self, frequency_hz: np.ndarray) -> np.ndarray:
        """Amplitude of one whole sine that shifts a linear car without lag from lane to lane."""
        return 2.0 * np.pi * frequency_hz**2 * abs(self.track.shift_m) / (self.speed_m_s * self.gain)
