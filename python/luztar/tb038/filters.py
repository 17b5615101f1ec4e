"""The bulletin's "4-pole Butterworth, 6 Hz" and the three ways it is read.

Section 2.1.3 says neither whether the filter runs forward only or also backward, nor whether "4 pole" counts one pass
or both. The ruling is the usual meaning in crash testing: the data pass a two-pole filter twice, so that four poles act
in total, without delay, with -3 dB at 6 Hz overall. The two other readings are computed beside it, and where they would
give another verdict the result says so.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .rules import RuleSet


class Reading(NamedTuple):
    """One reading of the filter, in words."""

    passes: str
    text: str


_READINGS = {
    "two_forward_two_backward": Reading(
        "2 poles forward, 2 poles backward",
        "4 poles in total, zero phase, -3 dB at {cutoff:g} Hz overall",
    ),
    "four_forward_four_backward": Reading(
        "4 poles forward, 4 poles backward",
        "4 poles in each direction, zero phase, -3 dB at {cutoff:g} Hz in each pass",
    ),
    "four_forward": Reading("4 poles forward", "4 poles, causal, -3 dB at {cutoff:g} Hz, with its delay"),
}


def describe(reading: str, rules: RuleSet) -> Reading:
    """Return the words for one reading of the rule set's filter."""
    words = _READINGS[reading]
    return Reading(words.passes, words.text.format(cutoff=rules.cutoff_hz))


def low_pass(x: np.ndarray, sample_rate_hz: float, rules: RuleSet, reading: str) -> np.ndarray:
    """Filter one evenly sampled stretch by one reading of the rule set's filter.

    Parameters
    ----------
    x : ndarray, shape (n,), float64, finite
    sample_rate_hz : float [Hz], above twice the cut-off
    rules : RuleSet
    reading : str
        ``two_forward_two_backward``, ``four_forward_four_backward`` or ``four_forward``.

    Returns
    -------
    ndarray, shape (n,), the unit of ``x``
    """
    from .. import signal

    if reading == "two_forward_two_backward":
        return signal.zero_phase(
            x, sample_rate_hz=sample_rate_hz, cutoff_hz=rules.cutoff_hz, poles=2, cutoff_at="overall"
        )
    if reading == "four_forward_four_backward":
        return signal.zero_phase(x, sample_rate_hz=sample_rate_hz, cutoff_hz=rules.cutoff_hz, poles=4)
    if reading == "four_forward":
        return signal.causal(x, sample_rate_hz=sample_rate_hz, cutoff_hz=rules.cutoff_hz, poles=4)
    raise ValueError(f"unknown filter reading {reading!r}")


def unusable_rate(sample_rate_hz: float, rules: RuleSet) -> str | None:
    """Return why the filter cannot be built at this rate, or None."""
    needed_hz = 2.0 * rules.cutoff_hz
    if sample_rate_hz > needed_hz:
        return None
    return f"sampled at {sample_rate_hz:.4g} Hz; a {rules.cutoff_hz:g} Hz filter needs more than {needed_hz:g} Hz"
