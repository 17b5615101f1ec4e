"""The designs: what passes, how many poles, how many passes and which -3.01 dB point is meant."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, ClassVar, Literal

import numpy as np

from .. import _core
from .._arrays import number, real, whole_number
from ..errors import ParameterError

CutoffAt = Literal["per_pass", "overall"]
Edges = Literal["settled", "scipy", "matlab", "gust"]
Missing = Literal["raise", "split", "hold"]
InstructionSet = Literal["auto", "scalar", "sse2", "avx2", "avx512"]

# What is left of the filter's memory where an extended edge begins: below the 24 bits of an acquisition card.
EDGE_TOLERANCE = 1e-9


@dataclass(frozen=True, kw_only=True)
class Design:
    """What every design has; use :class:`LowPass`, :class:`HighPass`, :class:`BandPass` or :class:`BandStop`."""

    poles: int
    sample_rate_hz: float
    zero_phase: bool = True
    cutoff_at: CutoffAt = "per_pass"
    instruction_set: InstructionSet = "auto"

    _band: ClassVar[str]

    def __post_init__(self) -> None:
        self._design()

    def __getstate__(self) -> dict[str, Any]:
        return {f.name: getattr(self, f.name) for f in fields(self)}

    def _ends(self) -> tuple[float, float]:
        raise NotImplementedError

    def _design(self) -> _core.Butterworth:
        return self._made

    @cached_property
    def _made(self) -> _core.Butterworth:
        poles = whole_number("poles", self.poles, 1, 12)
        low_hz, high_hz = self._ends()
        sample_rate_hz = number("sample_rate_hz", self.sample_rate_hz)
        if self.cutoff_at not in ("per_pass", "overall"):
            raise ParameterError(f"cutoff_at is {self.cutoff_at!r}", "cutoff_at", "Give 'per_pass' or 'overall'.")
        if self.instruction_set not in ("auto", *instruction_sets()):
            known = ", ".join(instruction_sets())
            raise ParameterError(
                f"instruction_set is {self.instruction_set!r}", "instruction_set", f"This processor has {known}."
            )
        passes = (bool(self.zero_phase), self.cutoff_at == "overall")
        return _core.Butterworth(poles, self._band, low_hz, high_hz, sample_rate_hz, passes, self.instruction_set)

    def _both_ways(self, edges: Edges, derivative: bool = False) -> _core.ZeroPhase:
        try:
            return self._ready[edges, derivative]
        except (KeyError, TypeError):  # not yet, or not a word
            pass
        if edges not in ("settled", "scipy", "matlab", "gust"):
            raise ParameterError(f"edges is {edges!r}", "edges", "Give 'settled', 'scipy', 'matlab' or 'gust'.")
        ready = _core.ZeroPhase(self._design(), edges, EDGE_TOLERANCE, derivative)
        return self._ready.setdefault((edges, derivative), ready)

    @cached_property
    def _ready(self) -> dict[tuple[str, bool], _core.ZeroPhase]:
        return {}

    def describe(self) -> str:
        """Return poles, passes, slope, cut-off, phase and settling time in words."""
        return self._design().describe()

    def magnitude(self, frequency_hz: float) -> float:
        """Return the magnitude after all passes at ``frequency_hz``, in [0, sample_rate_hz / 2]."""
        if isinstance(frequency_hz, np.ndarray | list | tuple):
            shape = real("frequency_hz", frequency_hz).shape
            raise ParameterError(
                f"frequency_hz has the shape {shape}", "frequency_hz", "Give one; response takes many."
            )
        return self._design().magnitude(number("frequency_hz", frequency_hz))

    def response(self, frequency_hz: Any) -> np.ndarray:
        """Return the complex response after all passes, the shape of ``frequency_hz`` [Hz]; real for zero phase.

        Raises
        ------
        ParameterError
            A frequency outside [0, sample_rate_hz / 2].
        """
        design = self._design()
        frequencies = real("frequency_hz", frequency_hz)
        found = np.array([design.response(float(f)) for f in frequencies.ravel()], dtype=np.float64)
        return found.reshape(-1, 2).view(np.complex128).reshape(frequencies.shape)

    def settle_samples(self, tolerance: float = 1e-6) -> int:
        """Return the samples until the slowest pole has decayed to ``tolerance``, in (0, 1)."""
        return self._design().settle_samples(number("tolerance", tolerance))

    def trusted(self, length: int, tolerance: float = 1e-3) -> range:
        """Return the samples of a record of ``length`` that its surroundings cannot move by more than ``tolerance``.

        Parameters
        ----------
        length : int, > 0
        tolerance : float, in (0, 1)
            Per unit of the difference between the assumed and the true signal beyond the ends: the sum of the
            magnitudes of the zero-phase impulse response from there on, times at most 1.01.

        Returns
        -------
        range
            Empty where the record is too short.

        Raises
        ------
        ParameterError
            A value outside its interval, or a design with one pass.
        """
        length = whole_number("length", length, 1, 2**62)
        start, end = self._both_ways("settled").trusted(length, number("tolerance", tolerance))
        return range(start, end)

    def impulse_response(self, length: int) -> np.ndarray:
        """Return ``length`` outputs for a one at the first sample; for zero phase for a one in the middle."""
        return self._of_rest(length, step=False)

    def step_response(self, length: int) -> np.ndarray:
        """Return ``length`` outputs for a step up at the first sample; for zero phase in the middle."""
        return self._of_rest(length, step=True)

    def _of_rest(self, length: int, step: bool) -> np.ndarray:
        length = whole_number("length", length, 1, 2**31)
        if not self.zero_phase:
            x = np.ones(length) if step else np.eye(1, length)[0]
            causal = _core.Filter(self._design(), False)
            causal.reset(0.0)
            causal.push_into(x, x_out := np.empty_like(x))
            return x_out
        # Enough of the same on both sides that the ends are not seen.
        margin = self.settle_samples(1e-16)
        x = np.zeros(length + 2 * margin)
        x[margin + length // 2 : None if step else margin + length // 2 + 1] = 1.0
        self._both_ways("settled").apply_in_place(x)
        return x[margin : margin + length].copy()

    @property
    def delay_s(self) -> float:
        """How late the middle of the pass band comes out [s]; 0 for zero phase."""
        return self._design().delay_s

    @property
    def settle_s(self) -> float:
        """Seconds until one part in a million of a step is left."""
        return self._design().settle_s

    def to_dict(self) -> dict[str, Any]:
        """Return the design as plain JSON values, with its words."""
        low_hz, high_hz = self._ends()
        ends = {"cutoff_hz": low_hz} if high_hz == 0.0 else {"low_hz": low_hz, "high_hz": high_hz}
        band = {} if self._band == "low" else {"band": self._band}
        return {
            "poles": self.poles,
            "passes": 2 if self.zero_phase else 1,
            **band,
            **ends,
            "sample_rate_hz": self.sample_rate_hz,
            "cutoff_at": self.cutoff_at,
            "text": self.describe(),
        }


@dataclass(frozen=True, kw_only=True)
class LowPass(Design):
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
    instruction_set : {"auto", "scalar", "sse2", "avx2", "avx512"}
        The registers the filter runs in; results agree to 1e-13 of the largest sample.

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

    cutoff_hz: float

    _band: ClassVar[str] = "low"

    def _ends(self) -> tuple[float, float]:
        return number("cutoff_hz", self.cutoff_hz), 0.0

    @property
    def designed_at_hz(self) -> float:
        """The -3.01 dB frequency of a single pass [Hz]."""
        return self._design().designed_at_hz[0]


@dataclass(frozen=True, kw_only=True)
class HighPass(LowPass):
    """A high-pass Butterworth design; the parameters are those of :class:`LowPass`.

    For "overall", ``g`` is multiplied by ``(2**(1/P) - 1)**(1/(2N))``.

    Examples
    --------
    >>> HighPass(poles=2, cutoff_hz=5, sample_rate_hz=1000, zero_phase=False).magnitude(0.0)
    0.0
    """

    _band: ClassVar[str] = "high"


@dataclass(frozen=True, kw_only=True)
class BandPass(Design):
    """A band-pass Butterworth design.

    Parameters
    ----------
    poles : int, 2 to 12, even
        Poles per pass: half of them shape each side of the band.
    low_hz, high_hz : float [Hz], in [1e-9, 0.5) times ``sample_rate_hz``
        Where the magnitude is 1/sqrt(2).
    sample_rate_hz, zero_phase, cutoff_at, instruction_set
        See :class:`LowPass`. For "overall" the width of the band is corrected in the tangent; its middle, the
        geometric mean of the tangents, stays.

    Raises
    ------
    ParameterError
        A value outside its interval.

    Examples
    --------
    >>> round(BandPass(poles=4, low_hz=5, high_hz=20, sample_rate_hz=1000, cutoff_at="overall").magnitude(20), 12)
    0.707106781187
    """

    low_hz: float
    high_hz: float

    _band: ClassVar[str] = "pass"

    def _ends(self) -> tuple[float, float]:
        return number("low_hz", self.low_hz), number("high_hz", self.high_hz)

    @property
    def designed_at_hz(self) -> tuple[float, float]:
        """The -3.01 dB frequencies of a single pass [Hz]."""
        low, high = self._design().designed_at_hz
        return low, high


@dataclass(frozen=True, kw_only=True)
class BandStop(BandPass):
    """A band-stop Butterworth design; the parameters are those of :class:`BandPass`.

    Examples
    --------
    >>> BandStop(poles=2, low_hz=49, high_hz=51, sample_rate_hz=1000).magnitude(0.0)
    1.0
    """

    _band: ClassVar[str] = "stop"


def instruction_sets() -> list[str]:
    """Return the instruction sets this processor has, the narrowest first."""
    return _core.instruction_sets()


def describe_filter(
    *,
    poles: int,
    cutoff_hz: float,
    sample_rate_hz: float,
    zero_phase: bool = True,
    cutoff_at: CutoffAt = "per_pass",
) -> str:
    """Return in words what a low pass does; the parameters are those of :class:`LowPass`.

    Examples
    --------
    >>> describe_filter(poles=4, cutoff_hz=6, sample_rate_hz=1000, zero_phase=False)
    '4 poles forward, 4-pole slope, -3.01 dB at 6.000 Hz, causal, 0.06931 s late at low frequency, settles in 0.96 s'
    """
    design = LowPass(
        poles=poles, cutoff_hz=cutoff_hz, sample_rate_hz=sample_rate_hz, zero_phase=zero_phase, cutoff_at=cutoff_at
    )
    return design.describe()
