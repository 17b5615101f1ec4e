"""Filters that a standard prints, exactly as it does."""

from __future__ import annotations

from typing import Literal

from .._arrays import number
from ..errors import ParameterError
from .design import LowPass

# The design frequency of one pass per channel frequency class, as printed: the -3 dB point 5/3 CFC of both passes
# together, raised for the two passes.
_DESIGN_OVER_CLASS = {"SAE J211": 2.0775, "ISO 6487": 1.25 * 5 / 3}
_CLASSES = (60, 180, 600, 1000)
# SAE J211-1: at least ten samples per hertz of the class, six per hertz of its -3 dB point.
_LEAST_RATE_PER_CLASS = 10.0


def tb038(sample_rate_hz: float) -> LowPass:
    """Return the filter of Euro NCAP TB 038: 4 poles in all (2 forward, 2 backward), -3 dB at 6 Hz overall.

    Examples
    --------
    >>> tb038(1000).poles, tb038(1000).cutoff_at
    (2, 'overall')
    """
    return LowPass(poles=2, cutoff_hz=6.0, sample_rate_hz=sample_rate_hz, cutoff_at="overall")


def cfc(
    channel_class: Literal[60, 180, 600, 1000],
    sample_rate_hz: float,
    *,
    standard: Literal["SAE J211", "ISO 6487"] = "SAE J211",
) -> LowPass:
    """Return the filter of a channel frequency class: 2 poles forward and 2 backward, as the standard prints it.

    Parameters
    ----------
    channel_class : {60, 180, 600, 1000}
    sample_rate_hz : float [Hz], at least ten times the class
    standard : {"SAE J211", "ISO 6487"}
        The design frequency of each pass is 2.0775 times the class (SAE J211-1, appendix) or 1.25 * 5/3 times (ISO
        6487).

    Raises
    ------
    ParameterError
        Another class or standard, or a sample rate that is too low.

    Notes
    -----
    Not corrected in the tangent, as neither standard does it: the -3 dB point of both passes moves as the class nears
    the sample rate (CFC 600 at 10 kHz: -2.82 dB at 1000 Hz). The coefficients are those of
    ``scipy.signal.butter(2, 2.0775 * CFC)`` (``test_cfc_is_the_printed_recursion``).

    Examples
    --------
    >>> cfc(60, 1000).cutoff_hz
    124.65
    """
    if channel_class not in _CLASSES:
        raise ParameterError(f"channel_class is {channel_class!r}", "channel_class", f"Give one of {_CLASSES}.")
    if standard not in _DESIGN_OVER_CLASS:
        known = " or ".join(repr(s) for s in _DESIGN_OVER_CLASS)
        raise ParameterError(f"standard is {standard!r}", "standard", f"Give {known}.")
    least = _LEAST_RATE_PER_CLASS * channel_class
    if not number("sample_rate_hz", sample_rate_hz) >= least:
        raise ParameterError(
            f"sample_rate_hz is {sample_rate_hz}",
            "sample_rate_hz",
            f"Class {channel_class} needs at least {least:.0f} Hz, ten times the class.",
        )
    return LowPass(poles=2, cutoff_hz=_DESIGN_OVER_CLASS[standard] * channel_class, sample_rate_hz=sample_rate_hz)
