"""Low-pass Butterworth filters that say what they are: zero phase on a record, causal on a stream.

``poles`` always counts one pass. The words of a filter (:func:`describe_filter`) state poles, passes and which
-3.01 dB point the cut-off means.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from . import _core
from ._arrays import number, rows_along, vector, whole_number, writable
from .errors import ParameterError

CutoffAt = Literal["per_pass", "overall"]
Edges = Literal["settled", "scipy"]

# What is left of the filter's memory where an extended edge begins: below the 24 bits of an acquisition card.
EDGE_TOLERANCE = 1e-9


@dataclass(frozen=True, kw_only=True)
class LowPass:
    """A low-pass Butterworth design; nothing is remembered between calls.

    Parameters
    ----------
    poles : int, 1 to 12
        Poles per pass.
    cutoff_hz : float [Hz], in [1e-9, 0.5) times ``sample_rate_hz``
        Where the magnitude is 1/sqrt(2).
    sample_rate_hz : float [Hz], > 0
    zero_phase : bool
        Forward and backward (zero phase, twice the slope), or forward only.
    cutoff_at : {"per_pass", "overall"}
        Whether the cut-off is that of one pass (both together are at -6.02 dB there) or of both together.

    Raises
    ------
    ParameterError
        A value outside its interval.

    Notes
    -----
    Designed from ``g = tan(pi fc / fs)`` and the dampings ``2 sin((2i+1) pi / 2N)`` [1]_, never through poles or
    polynomials in z. For "overall" with P passes of N poles, ``g`` is divided by ``(2**(1/P) - 1)**(1/(2N))``, which
    is exact at every cut-off; the magnitude there is held to 1e-9 dB by
    ``test_magnitude_is_minus_three_decibel_at_the_stated_frequency``.

    References
    ----------
    .. [1] Zavalishin, "The Art of VA Filter Design", chapters 3 and 4.

    Examples
    --------
    >>> print(LowPass(poles=2, cutoff_hz=6, sample_rate_hz=1000, cutoff_at="overall").describe())
    2 poles forward and 2 backward, 4-pole slope, -3.01 dB at 6.000 Hz overall (designed at 7.479 Hz), zero phase, \
settles in 0.42 s
    """

    poles: int
    cutoff_hz: float
    sample_rate_hz: float
    zero_phase: bool = True
    cutoff_at: CutoffAt = "per_pass"

    def __post_init__(self) -> None:
        self._design()

    def _design(self) -> _core.LowPass:
        poles = whole_number("poles", self.poles, 1, 12)
        cutoff_hz = number("cutoff_hz", self.cutoff_hz)
        sample_rate_hz = number("sample_rate_hz", self.sample_rate_hz)
        if self.cutoff_at not in ("per_pass", "overall"):
            raise ParameterError(f"cutoff_at is {self.cutoff_at!r}", "cutoff_at", "Give 'per_pass' or 'overall'.")
        overall = self.cutoff_at == "overall"
        return _core.LowPass(poles, cutoff_hz, sample_rate_hz, bool(self.zero_phase), overall)

    def describe(self) -> str:
        """Return poles, passes, slope, cut-off, phase and settling time in words."""
        return self._design().describe()

    def magnitude(self, frequency_hz: float) -> float:
        """Return the magnitude after all passes at ``frequency_hz``, in [0, sample_rate_hz / 2]."""
        return self._design().magnitude(number("frequency_hz", frequency_hz))

    def settle_samples(self, tolerance: float = 1e-6) -> int:
        """Return the samples until the slowest pole has decayed to ``tolerance``, in (0, 1)."""
        return self._design().settle_samples(number("tolerance", tolerance))

    @property
    def designed_at_hz(self) -> float:
        """The -3.01 dB frequency of a single pass [Hz]."""
        return self._design().designed_at_hz

    @property
    def delay_s(self) -> float:
        """How late a slow signal comes out [s]; 0 for zero phase."""
        return self._design().delay_s

    @property
    def settle_s(self) -> float:
        """Seconds until one part in a million of a step is left."""
        return self._design().settle_s

    def to_dict(self) -> dict[str, Any]:
        """Return the design as plain JSON values, with its words."""
        return {
            "poles": self.poles,
            "passes": 2 if self.zero_phase else 1,
            "cutoff_hz": self.cutoff_hz,
            "sample_rate_hz": self.sample_rate_hz,
            "cutoff_at": self.cutoff_at,
            "text": self.describe(),
        }


def describe_filter(
    *,
    poles: int,
    cutoff_hz: float,
    sample_rate_hz: float,
    zero_phase: bool = True,
    cutoff_at: CutoffAt = "per_pass",
) -> str:
    """Return in words what a filter does; the parameters are those of :class:`LowPass`.

    Examples
    --------
    >>> describe_filter(poles=4, cutoff_hz=6, sample_rate_hz=1000, zero_phase=False)
    '4 poles forward, 4-pole slope, -3.01 dB at 6.000 Hz, causal, 0.06931 s late at low frequency, settles in 0.96 s'
    """
    design = LowPass(
        poles=poles, cutoff_hz=cutoff_hz, sample_rate_hz=sample_rate_hz, zero_phase=zero_phase, cutoff_at=cutoff_at
    )
    return design.describe()


def zero_phase(
    x: Any,
    *,
    sample_rate_hz: float,
    cutoff_hz: float,
    poles: int = 4,
    cutoff_at: CutoffAt = "per_pass",
    edges: Edges = "settled",
    axis: int = -1,
    out: np.ndarray | None = None,
) -> np.ndarray:
    """Low-pass a record without delay: forward, then backward.

    Parameters
    ----------
    x : array_like, shape (n,) or any with n along ``axis``, any unit
        n >= 1, finite, of magnitude up to 1e150. Do not modify it during the call.
    sample_rate_hz, cutoff_hz, poles, cutoff_at
        See :class:`LowPass`. The magnitude slope is that of ``2 * poles``.
    edges : {"settled", "scipy"}
        "settled" continues the record beyond both ends by point reflection until the filter's memory has decayed to
        1e-9, repeating the reflection for short records, and starts on the chord of the extension. "scipy" does what
        ``scipy.signal.sosfiltfilt`` does by default, 3 (poles + 1) samples whatever the cut-off, and needs more
        samples than that; at low cut-offs both ends of its answer are wrong.
    axis : int
        The axis the samples follow each other along.
    out : ndarray, float64, shape of x, optional
        Where the result goes; may be ``x`` itself.

    Returns
    -------
    y : ndarray, shape of x, float64, unit of x

    Raises
    ------
    ParameterError
        Empty, not real, not finite or too short; a parameter outside its interval; ``out`` of another shape or type;
        a cut-off so low that the edges need more than 2**26 samples.

    Notes
    -----
    A constant stays itself bit for bit and a ramp stays itself to rounding
    (``test_ramp_stays_the_same_ramp``). With ``edges="scipy"`` the result is scipy's to 5e-12 per pole of the largest
    sample at cut-offs above 1 % of the sample rate, which is scipy's own rounding
    (``test_scipy_edges_give_scipys_answer``). A forward pass is within ``poles * eps * (1 + sqrt(fs/fc))`` of the exact
    filter (``test_forward_filter_is_exact_to_rounding_at_low_cutoffs``). Cost O(n poles); releases the GIL.

    Examples
    --------
    >>> zero_phase([5.0, 6.0, 7.0, 8.0], sample_rate_hz=1000, cutoff_hz=6).round(9)
    array([5., 6., 7., 8.])
    """
    if edges not in ("settled", "scipy"):
        raise ParameterError(f"edges is {edges!r}", "edges", "Give 'settled' or 'scipy'.")
    design = LowPass(poles=poles, cutoff_hz=cutoff_hz, sample_rate_hz=sample_rate_hz, cutoff_at=cutoff_at)
    rows, shape = rows_along("x", x, axis)
    tolerance = EDGE_TOLERANCE if edges == "settled" else None
    if out is not None and len(shape) == 1 and out is not x and not np.may_share_memory(rows, out):
        _core.zero_phase(design._design(), tolerance, rows, writable("out", out, shape)[np.newaxis, :])
        return out
    y = np.empty_like(rows)
    _core.zero_phase(design._design(), tolerance, rows, y)
    y = np.moveaxis(y.reshape(shape), -1, axis)
    if out is None:
        return np.ascontiguousarray(y)
    writable("out", out, y.shape, contiguous=False)[...] = y
    return out


class Filter:
    """A causal low-pass on a stream; what comes out does not depend on how the stream is cut, bit for bit.

    A new filter starts settled at the first sample it is given; :meth:`reset` chooses another start.

    Parameters
    ----------
    poles, cutoff_hz, sample_rate_hz
        See :class:`LowPass`.

    Raises
    ------
    ParameterError
        A value outside its interval.

    Notes
    -----
    One filter serves one channel and one thread: a push while another is running raises ``RuntimeError``. A refused
    chunk (NaN, infinite, too large) leaves the memory untouched. Chunk invariance, copies and pickles are held by
    ``test_filter_stream.py``.

    Examples
    --------
    >>> f = Filter(poles=2, cutoff_hz=6, sample_rate_hz=1000)
    >>> f.push([1.5, 1.5])
    array([1.5, 1.5])
    """

    __slots__ = ("_core", "_design")

    def __init__(self, *, poles: int = 4, cutoff_hz: float, sample_rate_hz: float) -> None:
        self._design = LowPass(poles=poles, cutoff_hz=cutoff_hz, sample_rate_hz=sample_rate_hz, zero_phase=False)
        self._core = _core.Filter(self._design._design())

    @property
    def design(self) -> LowPass:
        """The filter's design."""
        return self._design

    def push(self, chunk: Any) -> np.ndarray:
        """Return the next ``len(chunk)`` output samples.

        Parameters
        ----------
        chunk : array_like, shape (n,), any unit
            n >= 0, finite, of magnitude up to 1e150.

        Returns
        -------
        y : ndarray, shape (n,), float64, unit of chunk

        Raises
        ------
        ParameterError
            The chunk cannot be used; the memory is as it was.
        """
        x = vector("chunk", chunk, minimum=0)
        y = np.empty_like(x)
        self._core.push_into(x, y)
        return y

    def push_into(self, chunk: np.ndarray, out: np.ndarray) -> None:
        """Write the next output samples into ``out``; nothing that grows with the chunk is allocated.

        Parameters
        ----------
        chunk : ndarray, shape (n,), any unit
            Contiguous float64 is used as it lies; anything else is converted first.
        out : ndarray, shape (n,), contiguous float64
            May be ``chunk`` itself; may not overlap it otherwise.

        Raises
        ------
        ParameterError
            The chunk or ``out`` cannot be used; the memory is as it was.
        """
        x = vector("chunk", chunk, minimum=0)
        writable("out", out, x.shape)
        if x is out:
            self._core.push_in_place(out)
        elif np.may_share_memory(x, out):
            raise ParameterError("out overlaps chunk", "out", "Give the chunk itself or memory apart from it.")
        else:
            self._core.push_into(x, out)

    def reset(self, to: float | None = None) -> None:
        """Forget the past: settled at the level ``to``, or at the next sample if None; 0 is the filter at rest."""
        self._core.reset(None if to is None else number("to", to))

    def copy(self) -> Filter:
        """Return an independent filter with the same memory."""
        twin = Filter.__new__(Filter)
        twin._design, twin._core = self._design, self._core.copy()
        return twin

    __copy__ = copy

    def __deepcopy__(self, _memo: Any) -> Filter:
        return self.copy()

    def __getstate__(self) -> dict[str, Any]:
        return {"design": self._design, "memory": self._core.state()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._design = state["design"]
        self._core = _core.Filter(self._design._design())
        self._core.restore(state["memory"])

    def describe(self) -> str:
        """Return what the filter does, in words."""
        return self._design.describe()

    def __repr__(self) -> str:
        return f"<luztar.signal.Filter: {self.describe()}>"


def causal(x: Any, *, sample_rate_hz: float, cutoff_hz: float, poles: int = 4) -> np.ndarray:
    """Low-pass a whole record forward only, as an instrument would have while recording it.

    Parameters
    ----------
    x : array_like, shape (n,), any unit
        n >= 1, finite, of magnitude up to 1e150.
    sample_rate_hz, cutoff_hz, poles
        See :class:`LowPass`.

    Returns
    -------
    y : ndarray, shape (n,), float64, unit of x
        Starts settled at ``x[0]``; late by ``LowPass(...).delay_s`` where the signal is slow.

    Raises
    ------
    ParameterError
        Empty, not real or not finite; a parameter outside its interval.

    Notes
    -----
    The same bits as :meth:`Filter.push` in any chunks (``test_filter_stream.py``).
    """
    record = vector("x", x)
    return Filter(poles=poles, cutoff_hz=cutoff_hz, sample_rate_hz=sample_rate_hz).push(record)
