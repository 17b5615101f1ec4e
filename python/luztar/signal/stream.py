"""Causal filters on a stream: one channel or a bank of them."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, Self

import numpy as np

from .. import _core
from .._arrays import number, refuse_not_finite, vector, whole_number, writable
from ..errors import ParameterError
from .design import BandPass, BandStop, Design, HighPass, LowPass

_DESIGNS = {c.__name__: c for c in (LowPass, HighPass, BandPass, BandStop)}


def _design_state(design: Design) -> dict[str, Any]:
    return {"kind": type(design).__name__} | {f.name: getattr(design, f.name) for f in fields(design)}


def _design_of(state: dict[str, Any]) -> Design:
    kind = _DESIGNS.get(state.get("kind", ""))
    if kind is None:
        raise ParameterError(f"design is a {state.get('kind')!r}", "state", "Give what state() returned.")
    return kind(**{k: v for k, v in state.items() if k != "kind"})


def _one_pass(design: Design) -> Design:
    if not isinstance(design, Design) or design.zero_phase:
        raise ParameterError("design runs backward, too", "design", "Design it with zero_phase=False.")
    return design


class Filter:
    """A causal filter on a stream; what comes out does not depend on how the stream is cut, bit for bit.

    A new filter starts settled at the first sample it is given; :meth:`reset` chooses another start.

    Parameters
    ----------
    poles, cutoff_hz, sample_rate_hz
        The low pass; see :class:`LowPass`. :meth:`of` takes any other design.

    Raises
    ------
    ParameterError
        A value outside its interval.

    Notes
    -----
    One filter serves one channel and one thread: a push while another is running raises ``RuntimeError``. A refused
    chunk (NaN, infinite, too large) leaves the memory untouched. Chunk invariance, copies and pickles are held by
    ``test_filter_stream.py``. Chunks of 4096 samples and more release the GIL.

    Examples
    --------
    >>> f = Filter(poles=2, cutoff_hz=6, sample_rate_hz=1000)
    >>> f.push([1.5, 1.5])
    array([1.5, 1.5])
    """

    __slots__ = ("_core", "_derivative", "_design", "_push", "_push_plain")

    def __init__(self, *, poles: int = 4, cutoff_hz: float, sample_rate_hz: float) -> None:
        self._make(LowPass(poles=poles, cutoff_hz=cutoff_hz, sample_rate_hz=sample_rate_hz, zero_phase=False), False)

    def _make(self, design: Design, derivative: bool, core: _core.Filter | None = None) -> Self:
        self._design, self._derivative = design, derivative
        self._core = core or _core.Filter(design._design(), derivative)
        self._push, self._push_plain = self._core.push, self._core.push_plain
        return self

    @classmethod
    def of(cls, design: Design, *, derivative: bool = False) -> Self:
        """Return the filter of a design with one pass.

        Parameters
        ----------
        design : LowPass, HighPass, BandPass or BandStop
            With ``zero_phase=False``.
        derivative : bool
            Put out the time derivative of the filtered stream instead, per second; a low or band pass of at least two
            poles.

        Raises
        ------
        ParameterError
            A design with two passes, or one whose derivative grows with frequency.

        Examples
        --------
        >>> speed = Filter.of(LowPass(poles=2, cutoff_hz=6, sample_rate_hz=1000, zero_phase=False), derivative=True)
        >>> speed.push([3.0, 3.0])
        array([0., 0.])
        """
        return cls.__new__(cls)._make(_one_pass(design), bool(derivative))

    @property
    def design(self) -> Design:
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
        try:
            y = self._push(chunk)
        except ParameterError:
            refuse_not_finite("chunk", chunk)
            raise
        if y is None:  # not a contiguous vector of doubles
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
            May be ``chunk`` itself; may not overlap it otherwise. If both are float32, the arithmetic is float64 and
            only the storage is not.

        Raises
        ------
        ParameterError
            The chunk or ``out`` cannot be used; the memory is as it was.
        """
        try:
            if self._push_plain(chunk, out):
                return
        except ParameterError:
            refuse_not_finite("chunk", chunk)
            raise
        if isinstance(out, np.ndarray) and out.dtype == np.float32 and getattr(chunk, "dtype", None) == np.float32:
            self._push_single(chunk, out)
            return
        x = vector("chunk", chunk, minimum=0)
        writable("out", out, x.shape)
        if x is out:
            self._core.push_in_place(out)
        elif np.may_share_memory(x, out):
            raise ParameterError("out overlaps chunk", "out", "Give the chunk itself or memory apart from it.")
        else:
            self._core.push_into(x, out)

    def _push_single(self, chunk: np.ndarray, out: np.ndarray) -> None:
        x = np.require(chunk, requirements=["C", "A"])
        usable = out.flags.writeable and out.flags.c_contiguous and out.flags.aligned
        if out.ndim != 1 or x.shape != out.shape or not usable or np.may_share_memory(x, out):
            raise ParameterError(
                f"out is {out.dtype} {out.shape}",
                "out",
                f"Give contiguous memory apart from it, of the shape {x.shape}.",
            )
        refuse_not_finite("chunk", x)
        self._core.push_single(x, out)

    def push_counts(self, counts: np.ndarray, *, scale: float, offset: float = 0.0) -> np.ndarray:
        """Return the next output samples for counts of an acquisition card.

        Parameters
        ----------
        counts : ndarray of int16 or int32, shape (n,)
        scale, offset : float
            Unit per count and the value of zero counts, applied on the way in.

        Returns
        -------
        y : ndarray, shape (n,), float64
            The same bits as ``push(counts * scale + offset)``.

        Raises
        ------
        ParameterError
            Another type or shape.
        """
        counts = np.asarray(counts)
        if counts.ndim != 1 or counts.dtype.kind != "i" or counts.dtype.itemsize not in (2, 4):
            raise ParameterError(
                f"counts is {counts.dtype} {counts.shape}", "counts", "Give a vector of int16 or int32."
            )
        native = counts.astype(counts.dtype.newbyteorder("="), order="C", copy=False)
        y = np.empty(native.shape)
        self._core.push_counts(np.require(native, requirements=["C", "A"]), (float(scale), float(offset)), y)
        return y

    def reset(self, to: float | None = None) -> None:
        """Forget the past: settled at the level ``to``, or at the next sample if None; 0 is the filter at rest."""
        self._core.reset(None if to is None else number("to", to))

    def copy(self) -> Self:
        """Return an independent filter with the same memory."""
        twin = type(self).__new__(type(self))
        return twin._make(self._design, self._derivative, self._core.copy())

    __copy__ = copy

    def __deepcopy__(self, _memo: Any) -> Self:
        return self.copy()

    def state(self) -> dict[str, Any]:
        """Return design and memory as plain JSON values; :meth:`from_state` continues from them, bit for bit."""
        return {"design": _design_state(self._design), "derivative": self._derivative, "memory": self._core.state()}

    @classmethod
    def from_state(cls, state: dict[str, Any]) -> Self:
        """Return a filter that continues where :meth:`state` was taken.

        Raises
        ------
        ParameterError
            Not what :meth:`state` returned.
        """
        try:
            design, derivative, memory = state["design"], state["derivative"], state["memory"]
            found = cls.of(_design_of(design), derivative=derivative)
            found._core.restore(memory)
        except (KeyError, TypeError) as wrong:
            raise ParameterError(f"state lacks or mistakes {wrong}", "state", "Give what state() returned.") from None
        return found

    def __getstate__(self) -> dict[str, Any]:
        return self.state()

    def __setstate__(self, state: dict[str, Any]) -> None:
        other = self.from_state(state)
        self._make(other._design, other._derivative, other._core)

    def describe(self) -> str:
        """Return what the filter does, in words."""
        words = self._design.describe()
        return f"time derivative of: {words}" if self._derivative else words

    def __repr__(self) -> str:
        return f"<luztar.signal.Filter: {self.describe()}>"


class FilterBank:
    """Equal causal filters for the channels of a stream of frames, side by side in the processor's registers.

    Parameters
    ----------
    design : LowPass, HighPass, BandPass or BandStop
        With ``zero_phase=False``.
    channels : int, > 0

    Raises
    ------
    ParameterError
        A value outside its interval.

    Notes
    -----
    A channel's results do not depend on its neighbours nor on how the stream is cut, bit for bit
    (``test_bank_is_as_many_filters``).

    Examples
    --------
    >>> bank = FilterBank(LowPass(poles=2, cutoff_hz=6, sample_rate_hz=1000, zero_phase=False), channels=2)
    >>> bank.push([[1.0, 2.0], [1.0, 2.0]])
    array([[1., 2.],
           [1., 2.]])
    """

    __slots__ = ("_channels", "_core", "_design")

    def __init__(self, design: Design, channels: int) -> None:
        self._design = _one_pass(design)
        self._channels = whole_number("channels", channels, 1, 2**20)
        self._core = _core.Bank(design._design(), self._channels)

    @property
    def design(self) -> Design:
        """The design of every channel."""
        return self._design

    @property
    def channels(self) -> int:
        """How many channels."""
        return self._channels

    def push(self, frames: Any) -> np.ndarray:
        """Return the next frames.

        Parameters
        ----------
        frames : array_like, shape (n, channels)

        Returns
        -------
        y : ndarray, shape (n, channels), float64

        Raises
        ------
        ParameterError
            The frames cannot be used; the memory is as it was.
        """
        y = np.array(frames, dtype=np.float64, order="C", ndmin=1)
        if y.ndim != 2 or y.shape[1] != self._channels:
            raise ParameterError(f"frames has the shape {y.shape}", "frames", f"Give (n, {self._channels}).")
        refuse_not_finite("frames", y)
        self._core.push_in_place(y)
        return y

    def push_in_place(self, frames: np.ndarray) -> None:
        """Filter frames where they lie; nothing is allocated.

        Parameters
        ----------
        frames : ndarray, shape (n, channels), contiguous float64

        Raises
        ------
        ParameterError
            The frames cannot be used; they and the memory are as they were.
        """
        shape = (len(frames), self._channels) if isinstance(frames, np.ndarray) and frames.ndim else (0, self._channels)
        self._core.push_in_place(writable("frames", frames, shape))

    def reset(self, to: Any = None) -> None:
        """Forget the past: settled at one level per channel, or at the next frame if None."""
        self._core.reset(None if to is None else vector("to", to).tolist())

    def copy(self) -> FilterBank:
        """Return an independent bank with the same memory."""
        twin = FilterBank.__new__(FilterBank)
        twin._design, twin._channels, twin._core = self._design, self._channels, self._core.copy()
        return twin

    __copy__ = copy

    def __deepcopy__(self, _memo: Any) -> FilterBank:
        return self.copy()

    def __getstate__(self) -> dict[str, Any]:
        return {"design": self._design, "channels": self._channels, "memory": self._core.state()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(state["design"], state["channels"])  # type: ignore[misc]
        self._core.restore(state["memory"])

    def __repr__(self) -> str:
        return f"<luztar.signal.FilterBank: {self._channels} channels, {self._design.describe()}>"
