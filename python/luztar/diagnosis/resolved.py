"""Whether a band and a decimation leave enough of a run's strokes to compare."""

from __future__ import annotations

import math
from collections.abc import Callable

from ..errors import MeasurementError
from ..model import Model

# The low pass mixes the time before into the time after an instant: its impulse response, 8 poles in all, has decayed
# to 1 % after 1.5 periods of the upper edge.
FILTER_MEMORY_PERIODS = 1.5
# A model of five effects with the shift of the starts has ten unknowns; below five samples for each a residual says
# nothing.
FEWEST_SAMPLES = 50


def require_resolved(
    run: str,
    model: Model,
    band_hz: float,
    rate_hz: float,
    duration_s: float,
    kept: int,
    strokes: int,
    usually: Callable[[], int],
) -> None:
    """Refuse a band so low that its filter mixes neighbouring strokes, or a decimation that leaves too few samples.

    Parameters
    ----------
    run : str
    model : Model
    band_hz, rate_hz : float
        The comparison's upper edge and the run's sample rate.
    duration_s : float
    kept : int
        Samples kept after the decimation.
    strokes : int
        As found after the smoothing that goes with the band.
    usually : callable
        Returns the strokes that the structure's own band shows.

    Raises
    ------
    MeasurementError
    """
    every = model.comparison.decimate or 1
    if model.comparison.band_hz is not None and band_hz * every >= 0.5 * rate_hz:
        raise MeasurementError(
            f"every {every}th sample of {rate_hz:g} Hz cannot show a band of {band_hz:.3g} Hz",
            run,
            f"Set comparison.decimate to at most {max(1, math.ceil(0.5 * rate_hz / band_hz) - 1)}, or leave it out.",
        )
    if band_hz < model.structure.band_hz:
        # The smoothing of a low band makes one stroke of many, or none.
        strokes = max(strokes, usually())
    if not strokes:
        return
    # With its dwell: over the whole record.
    stroke_s = duration_s / strokes
    memory_s = FILTER_MEMORY_PERIODS / band_hz
    if memory_s > stroke_s:
        least_hz = _up(FILTER_MEMORY_PERIODS / stroke_s)
        remedy = f"Compare with a --band of at least {least_hz:g} Hz (comparison.band_hz of the model)."
        if every > 1 and model.comparison.band_hz is None:
            most = max(1, min(math.floor(0.4 * rate_hz / least_hz), kept * every // (2 * FEWEST_SAMPLES)))
            remedy = f"Set comparison.decimate to at most {most}, or leave it out."
        raise MeasurementError(
            f"a band of {band_hz:.3g} Hz is too low: its filter mixes {memory_s:.3g} s, a stroke takes {stroke_s:.3g}",
            run,
            remedy,
        )
    if kept < FEWEST_SAMPLES:
        samples = f"{kept} samples are left"
        if every > 1:
            text = f"{samples} of every {every}th; at least {FEWEST_SAMPLES} are needed"
            most = max(1, kept * every // (2 * FEWEST_SAMPLES))
            raise MeasurementError(text, run, f"Set comparison.decimate to at most {most}, or leave it out.")
        text = f"{samples} in a band of {band_hz:.3g} Hz; at least {FEWEST_SAMPLES} are needed"
        raise MeasurementError(text, run, "Record longer, or compare with a larger --band.")


def _up(value: float) -> float:
    """Round up to two digits, so that the value named is one that is accepted."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return math.ceil(value / step) * step
