"""Statistics of records and streams: pushed in chunks, merged across parts, without cancellation."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from . import _core
from ._arrays import vector
from .errors import ParameterError


@dataclass(frozen=True)
class Description:
    """What a record holds, in the unit of the record.

    Attributes
    ----------
    count : int
    mean, rms, min, max : float
    std_population : float
        Squared deviations divided by n (the standard deviation of TB 038).
    std_sample : float or None
        Squared deviations divided by n - 1; None for a single sample.
    min_index, max_index : int
        Where the extremes were first met, from 0.
    """

    count: int
    mean: float
    std_population: float
    std_sample: float | None
    rms: float
    min: float
    min_index: int
    max: float
    max_index: int

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as plain JSON values."""
        return asdict(self)


class Moments:
    """Count, mean, spread and extremes of everything pushed so far.

    Parameters
    ----------
    x : array_like, shape (n,), optional
        The first chunk.

    Raises
    ------
    ParameterError
        Values that are not real, not finite or above 1e150 in magnitude; nothing of a refused chunk is added.

    Notes
    -----
    Blocks are centred on their own mean and joined by the pairwise update [1]_; the running mean keeps its rounding
    remainder. The standard deviation agrees with the exact rational answer to 14 digits on NumAcc1 to 4
    (``test_standard_deviation_has_fourteen_digits_of_the_exact_answer``). Merging equals pushing the joined record up
    to rounding (``test_merging_two_parts_is_pushing_both``). One object serves one thread: a push while another is
    running raises ``RuntimeError``.

    References
    ----------
    .. [1] Chan, Golub, LeVeque, The American Statistician 37 (1983) 242.

    Examples
    --------
    >>> m = Moments([1.0, 2.0])
    >>> m.push([3.0])
    >>> m.mean, m.std_sample, m.max_index
    (2.0, 1.0, 2)
    """

    __slots__ = ("_core",)

    def __init__(self, x: Any = None) -> None:
        self._core = _core.Moments()
        if x is not None:
            self.push(x)

    def push(self, chunk: Any) -> None:
        """Add samples: array_like, shape (n,), n >= 0, finite, of magnitude up to 1e150."""
        self._core.push(vector("chunk", chunk, minimum=0))

    def merge(self, later: Moments) -> None:
        """Add what another object has seen, as if it came after this one's samples."""
        if not isinstance(later, Moments):
            raise ParameterError(f"later is a {type(later).__name__}", "later", "Give another Moments.")
        self._core.merge(later._core.copy())

    def copy(self) -> Moments:
        """Return an independent object with the same content."""
        twin = Moments()
        twin._core = self._core.copy()
        return twin

    __copy__ = copy

    def __deepcopy__(self, _memo: Any) -> Moments:
        return self.copy()

    def __getstate__(self) -> tuple[Any, ...]:
        return self._core.state()

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        self._core = _core.Moments.from_state(*state)

    @property
    def count(self) -> int:
        """How many samples."""
        return self._core.count

    @property
    def mean(self) -> float | None:
        """The mean; None of nothing."""
        return self._core.mean

    @property
    def std_population(self) -> float | None:
        """The standard deviation with n (TB 038); None of nothing."""
        return self._core.std_population

    @property
    def std_sample(self) -> float | None:
        """The standard deviation with n - 1; None below two samples."""
        return self._core.std_sample

    @property
    def variance_population(self) -> float | None:
        """The variance with n; None of nothing."""
        return self._core.variance_population

    @property
    def variance_sample(self) -> float | None:
        """The variance with n - 1; None below two samples."""
        return self._core.variance_sample

    @property
    def rms(self) -> float | None:
        """The root of the mean square; None of nothing."""
        return self._core.rms

    @property
    def min(self) -> float | None:
        """The smallest sample; None of nothing."""
        found = self._core.min
        return None if found is None else found[0]

    @property
    def min_index(self) -> int | None:
        """Where the smallest sample was first met, from 0; None of nothing."""
        found = self._core.min
        return None if found is None else found[1]

    @property
    def max(self) -> float | None:
        """The largest sample; None of nothing."""
        found = self._core.max
        return None if found is None else found[0]

    @property
    def max_index(self) -> int | None:
        """Where the largest sample was first met, from 0; None of nothing."""
        found = self._core.max
        return None if found is None else found[1]

    def describe(self) -> Description:
        """Return everything at once.

        Raises
        ------
        ParameterError
            Nothing was pushed yet.
        """
        core = self._core
        if core.mean is None or core.std_population is None or core.rms is None or not (core.min and core.max):
            raise ParameterError("nothing was pushed yet", "Moments", "Push at least one sample.")
        return Description(core.count, core.mean, core.std_population, core.std_sample, core.rms, *core.min, *core.max)

    def __repr__(self) -> str:
        return f"<luztar.stats.Moments: {self.count} samples, mean {self.mean}, std {self.std_population}>"


def describe(x: Any) -> Description:
    """Describe a record: count, mean, standard deviations, rms, extremes and where they are.

    Parameters
    ----------
    x : array_like, shape (n,), any unit
        n >= 1, finite, of magnitude up to 1e150.

    Returns
    -------
    Description
        Frozen, in the unit of x.

    Raises
    ------
    ParameterError
        Empty, not real or not finite.

    Examples
    --------
    >>> describe([3.0, 1.0, 2.0]).min_index
    1
    """
    return Moments(vector("x", x)).describe()
