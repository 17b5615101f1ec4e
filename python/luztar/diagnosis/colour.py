"""The colour of the noise, and what makes it white again.

Noise that wanders is strong where it is slow. Least squares that weigh all frequencies alike then judge by what is
known worst, and neighbouring strokes are wrong together. The spectrum of what a saturated model leaves is described by
``level (f^2 + pole^2) / (f^2 + zero^2)``: a wander that falls from ``zero_hz`` on until it drowns at ``pole_hz`` in
noise that is as strong at every frequency. The inverse is a filter of first order. Measurement, model and candidates go
through it alike, so that coefficients keep their meaning and what is left is white.

Source: Whittle 1953, Estimation and information in stationary time series, Arkiv for Matematik 2:423 (the fit to the
spectrum); Aitken 1935, On least squares and linear combination of observations, Proc. Royal Society of Edinburgh 55:42
(least squares after whitening).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .. import _core

# Where the wander begins to fall and where it drowns, in shares of the band.
ZEROS = np.geomspace(0.015, 0.6, 14)
POLE_OVER_ZERO = np.geomspace(1.4, 20.0, 10)
# A pole far above the band is none that the comparison sees.
HIGHEST_POLE = 1.6
# Up to this share of the band the low pass is known well enough to be taken off the spectrum.
SEEN = 0.8
# Fewer samples than this have no spectrum worth the name.
FEWEST_SAMPLES = 24
# Two parameters have to earn more likelihood than chance gives them in one of a hundred white records: 4.6, and half as
# much again, for neighbouring frequencies of a tapered piece are not independent.
WORTH = 7.0


@dataclass(frozen=True)
class Colour:
    """The shape of a noise spectrum.

    Attributes
    ----------
    zero_hz : float
        Frequency from which the wander falls.
    pole_hz : float
        Frequency from which the spectrum is flat; the same as ``zero_hz`` for white noise.
    """

    zero_hz: float = 1.0
    pole_hz: float = 1.0

    @property
    def whitening(self) -> tuple[float, float] | None:
        """Zero and pole of the filter that undoes it; None for white noise."""
        return (self.zero_hz, self.pole_hz) if self.pole_hz > self.zero_hz else None

    @property
    def text(self) -> str:
        """Say it in words; empty for white noise."""
        if self.whitening is None:
            return ""
        times = (self.pole_hz / self.zero_hz) ** 2
        strong = f"its power below {self.zero_hz:.2g} Hz is {times:.2g} times that above {self.pole_hz:.2g} Hz"
        return f"it wanders ({strong}): candidates are judged after whitening"

    def shape(self, frequency_hz: np.ndarray) -> np.ndarray:
        """Return the power over that of the flat part."""
        return (frequency_hz**2 + self.pole_hz**2) / (frequency_hz**2 + self.zero_hz**2)

    def flat_share(self, band_hz: float) -> float:
        """Return the share of the power below ``band_hz`` that the flat part alone would have."""
        zero, pole = self.zero_hz, self.pole_hz
        return band_hz / (band_hz + (pole**2 - zero**2) / zero * math.atan(band_hz / zero))

    def whitened(self, matrix: np.ndarray, step_s: float) -> np.ndarray:
        """Return columns, shape (n, q), through the filter."""
        if self.whitening is None:
            return matrix
        return np.asarray(_core.whitened(np.ascontiguousarray(matrix.T), step_s, *self.whitening)).T


WHITE = Colour()


def colour_of(pieces: Sequence[tuple[np.ndarray, float]], band_hz: float, low_passed: bool) -> Colour:
    """Read the colour off uninterrupted pieces of noise.

    Parameters
    ----------
    pieces : sequence of (ndarray of shape (n,), float)
        Noise, and the seconds between its samples.
    band_hz : float
        Upper edge of the comparison.
    low_passed : bool
        Whether the comparison's own low pass shaped the noise.
    """
    found, powers = [], []
    for piece, step_s in pieces:
        if piece.size < FEWEST_SAMPLES:
            continue
        taper = np.hanning(piece.size + 2)[1:-1]
        spectrum = np.abs(np.fft.rfft((piece - piece.mean()) * taper)) ** 2 / np.sum(taper**2)
        frequency = np.fft.rfftfreq(piece.size, step_s)
        # What the taper and the mean leave of the first line is not the noise's own.
        keep = (np.arange(frequency.size) >= 2) & (frequency <= SEEN * band_hz)
        found.append(frequency[keep])
        powers.append(spectrum[keep])
    frequency, power = (np.concatenate(v) if v else np.empty(0) for v in (found, powers))
    if frequency.size < FEWEST_SAMPLES or not (power > 0.0).all():
        return WHITE
    if low_passed:
        # Four poles, forward and backward: the power goes with the fourth power of one pass.
        power = power * (1.0 + (frequency / band_hz) ** 8) ** 2
    best, least = WHITE, frequency.size * math.log(float(power.mean())) - WORTH
    for zero in band_hz * ZEROS:
        for pole in zero * POLE_OVER_ZERO:
            if pole > HIGHEST_POLE * band_hz:
                break
            tried = Colour(float(zero), float(pole))
            shape = tried.shape(frequency)
            cost = frequency.size * math.log(float(np.mean(power / shape))) + float(np.log(shape).sum())
            if cost < least:
                best, least = tried, cost
    return best
