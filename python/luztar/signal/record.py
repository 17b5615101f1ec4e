"""Whole records: without delay, as an instrument would have filtered them, and their derivative."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, Literal, overload

import numpy as np

from .. import _core
from .._arrays import is_plain, pair, refuse_not_finite, rows_along, vector, whole_number, writable
from ..errors import ParameterError
from .design import CutoffAt, Design, Edges, LowPass, Missing
from .missing import held, split
from .stream import Filter

# What a scale is for.
_COUNTS = (np.dtype(np.int16), np.dtype(np.int32), np.dtype(np.float32))


@lru_cache(64, typed=True)
def _low_pass(
    poles: int, cutoff_hz: float, sample_rate_hz: float, cutoff_at: CutoffAt, edges: Edges, derivative: bool
) -> _core.ZeroPhase:
    design = LowPass(poles=poles, cutoff_hz=cutoff_hz, sample_rate_hz=sample_rate_hz, cutoff_at=cutoff_at)
    return design._both_ways(edges, derivative)


def _ready(
    poles: int, cutoff_hz: float, sample_rate_hz: float, cutoff_at: CutoffAt, edges: Edges, derivative: bool
) -> _core.ZeroPhase:
    try:
        return _low_pass(poles, cutoff_hz, sample_rate_hz, cutoff_at, edges, derivative)
    except TypeError:  # an argument that cannot be hashed: the design says which
        LowPass(poles=poles, cutoff_hz=cutoff_hz, sample_rate_hz=sample_rate_hz, cutoff_at=cutoff_at)._both_ways(edges)
        raise


@overload
def zero_phase(
    x: Any,
    *,
    design: Design | None = ...,
    sample_rate_hz: float | None = ...,
    cutoff_hz: float | None = ...,
    poles: int = ...,
    cutoff_at: CutoffAt = ...,
    edges: Edges = ...,
    axis: int = ...,
    out: np.ndarray | None = ...,
    missing: Missing = ...,
    scale: tuple[float, float] | None = ...,
    threads: int = ...,
    return_trusted: Literal[False] = ...,
) -> np.ndarray: ...
@overload
def zero_phase(
    x: Any,
    *,
    design: Design | None = ...,
    sample_rate_hz: float | None = ...,
    cutoff_hz: float | None = ...,
    poles: int = ...,
    cutoff_at: CutoffAt = ...,
    edges: Edges = ...,
    axis: int = ...,
    out: np.ndarray | None = ...,
    missing: Missing = ...,
    scale: tuple[float, float] | None = ...,
    threads: int = ...,
    return_trusted: Literal[True],
) -> tuple[np.ndarray, range]: ...
def zero_phase(
    x: Any,
    *,
    design: Design | None = None,
    sample_rate_hz: float | None = None,
    cutoff_hz: float | None = None,
    poles: int = 4,
    cutoff_at: CutoffAt = "per_pass",
    edges: Edges = "settled",
    axis: int = -1,
    out: np.ndarray | None = None,
    missing: Missing = "raise",
    scale: tuple[float, float] | None = None,
    threads: int = 1,
    return_trusted: bool = False,
) -> np.ndarray | tuple[np.ndarray, range]:
    """Filter a record without delay: forward, then backward.

    Parameters
    ----------
    x : array_like, shape (n,) or any with n along ``axis``, any unit
        n >= 1, finite unless ``missing`` says otherwise, of magnitude up to 1e150. Do not modify it during the call.
    design : LowPass, HighPass, BandPass or BandStop, optional
        What to run; without it the low pass of the next four.
    sample_rate_hz, cutoff_hz, poles, cutoff_at
        See :class:`LowPass`. The magnitude slope is that of ``2 * poles``.
    edges : {"settled", "scipy", "matlab", "gust"}
        "settled" continues the record beyond both ends by point reflection until the filter's memory has decayed to
        1e-9; a record shorter than that is continued forever, in closed form, down to a single sample, which stays
        itself. "scipy" does what ``scipy.signal.sosfiltfilt`` does by default, 3 (poles + 1) samples whatever the
        cut-off, "matlab" what ``filtfilt(b, a, x)`` does there, 3 poles samples; both need more samples than that, and
        at low cut-offs both ends of their answers are wrong. "gust" continues nothing: it starts both passes such that
        their order matters least [1]_, and takes O(n poles**2).
    axis : int
        The axis the samples follow each other along.
    out : ndarray, float64, shape of x, optional
        Where the result goes; may be ``x`` itself. After an error its content is of no use.
    missing : {"raise", "split", "hold"}
        What to do about NaN and infinities: refuse them with their positions; filter each finite stretch as a record of
        its own and leave NaN between; or hold the last finite sample (before the first one: that one).
    scale : (float, float), optional
        Unit per count and the value of zero counts: int16, int32 and float32 vectors are converted on their way in.
    threads : int
        Over how many threads several records are spread.
    return_trusted : bool
        Also return :meth:`LowPass.trusted`, the samples that the assumption about the edges moves by at most 1e-3 of
        what it is wrong by.

    Returns
    -------
    y : ndarray, shape of x, float64, unit of x
    trusted : range
        If ``return_trusted``.

    Raises
    ------
    ParameterError
        Empty, not real, not finite or too short; a parameter outside its interval; ``out`` of another shape or type.

    Notes
    -----
    A constant stays itself bit for bit and a ramp stays itself to rounding
    (``test_ramp_stays_the_same_ramp``). With ``edges="scipy"`` the result is scipy's to 5e-12 per pole of the largest
    sample at cut-offs above 1 % of the sample rate, which is scipy's own rounding
    (``test_scipy_edges_give_scipys_answer``). A forward pass is within ``poles * eps * (1 + sqrt(fs/fc))`` of the exact
    filter (``test_forward_filter_is_exact_to_rounding_at_low_cutoffs``). Cost O(n poles); releases the GIL.

    References
    ----------
    .. [1] Gustafsson, IEEE Transactions on Signal Processing 44 (1996) 988-992.

    Examples
    --------
    >>> zero_phase([5.0, 6.0, 7.0, 8.0], sample_rate_hz=1000, cutoff_hz=6).round(9)
    array([5., 6., 7., 8.])
    """
    if design is None:
        ready = _ready(poles, cutoff_hz, sample_rate_hz, cutoff_at, edges, False)  # type: ignore[arg-type]
    else:
        _nothing_but_the_design(design, sample_rate_hz, cutoff_hz)
        ready = design._both_ways(edges)
    y = _run(ready, x, axis, out, missing, scale, threads)
    if return_trusted:
        start, end = ready.trusted(y.shape[axis], 1e-3)
        return y, range(start, end)
    return y


def derivative(
    x: Any,
    *,
    design: Design | None = None,
    sample_rate_hz: float | None = None,
    cutoff_hz: float | None = None,
    poles: int = 4,
    cutoff_at: CutoffAt = "per_pass",
    edges: Edges = "settled",
    axis: int = -1,
    out: np.ndarray | None = None,
    missing: Missing = "raise",
    threads: int = 1,
) -> np.ndarray:
    """Return the time derivative of the record after :func:`zero_phase`, from the same states.

    Parameters
    ----------
    x, design, sample_rate_hz, cutoff_hz, poles, cutoff_at, edges, axis, out, missing, threads
        See :func:`zero_phase`; a low or band pass of at least two poles.

    Returns
    -------
    y : ndarray, shape of x, float64, unit of x per second
        The velocity of an angle channel. A ramp gives its slope; at the frequency f the trapezoidal rule reads
        ``tan(pi f / fs) / (pi f / fs)`` times the derivative: 1.2e-4 too much at 6 Hz and 1 kHz.

    Raises
    ------
    ParameterError
        As :func:`zero_phase`, or a design whose derivative grows with frequency.

    Examples
    --------
    >>> derivative([5.0, 6.0, 7.0, 8.0], sample_rate_hz=1000, cutoff_hz=6).round(6)
    array([1000., 1000., 1000., 1000.])
    """
    if design is None:
        ready = _ready(poles, cutoff_hz, sample_rate_hz, cutoff_at, edges, True)  # type: ignore[arg-type]
    else:
        _nothing_but_the_design(design, sample_rate_hz, cutoff_hz)
        ready = design._both_ways(edges, derivative=True)
    return _run(ready, x, axis, out, missing, None, threads)


def _nothing_but_the_design(design: Any, sample_rate_hz: float | None, cutoff_hz: float | None) -> None:
    if not isinstance(design, Design):
        raise ParameterError(f"design is {design!r}", "design", "Give a LowPass, HighPass, BandPass or BandStop.")
    if sample_rate_hz is not None or cutoff_hz is not None:
        raise ParameterError("design comes with a cut-off of its own", "cutoff_hz", "Give one or the other.")


def _run(
    ready: _core.ZeroPhase,
    x: Any,
    axis: int,
    out: np.ndarray | None,
    missing: Missing,
    scale: tuple[float, float] | None,
    threads: int,
) -> np.ndarray:
    """Filter whatever shape, into whatever array."""
    if threads != 1:
        threads = whole_number("threads", threads, 1, 1024)
    if missing == "raise" and scale is None and is_plain(x) and (axis == -1 or axis == 0):
        return _vector(ready, x, out)
    if missing not in ("raise", "split", "hold"):
        raise ParameterError(f"missing is {missing!r}", "missing", "Give 'raise', 'split' or 'hold'.")
    if scale is not None:
        return _counts(ready, x, scale, out)
    if missing == "raise" and axis == 0 and isinstance(x, np.ndarray) and x.ndim == 2 and x.dtype.kind in "fiu":
        return _frames(ready, x, out)
    rows, shape = rows_along("x", x, axis, finite=False)
    if missing == "hold":
        rows = held(rows)
    straight = out is not None and axis in (-1, len(shape) - 1) and out is not x
    if straight and writable("out", out, shape, contiguous=False).flags.c_contiguous:
        straight = not np.may_share_memory(rows, out)
    else:
        straight = False
    y = out.reshape(rows.shape) if straight and out is not None else np.empty_like(rows)
    if missing == "split":
        split(rows, y, ready.apply)
    else:
        try:
            ready.apply_rows(rows, y, threads)
        except ParameterError:
            refuse_not_finite("x", np.asarray(x))
            raise
    if straight and out is not None:
        return out
    y = np.moveaxis(y.reshape(shape), -1, axis)
    if out is None:
        return np.ascontiguousarray(y)
    writable("out", out, y.shape, contiguous=False)[...] = y
    return out


def _vector(ready: _core.ZeroPhase, x: np.ndarray, out: np.ndarray | None) -> np.ndarray:
    """Filter the usual case without a detour."""
    y = np.empty(x.shape) if out is None else out
    try:
        if ready.apply_plain(x, y):
            return y
        if out is x:
            ready.apply_in_place(writable("out", out, x.shape))
        else:
            ready.apply(x, y := np.empty(x.shape))
            writable("out", out, x.shape, contiguous=False)[...] = y
    except ParameterError:
        if x.size == 0:
            raise ParameterError(f"x has the shape {x.shape}", "x", "Give at least one sample.") from None
        refuse_not_finite("x", x)
        raise
    return y if out is None else out


def _frames(ready: _core.ZeroPhase, x: np.ndarray, out: np.ndarray | None) -> np.ndarray:
    """Filter the columns of a table as they lie."""
    rows_along("x", x[:1], 0, finite=False)
    in_place = out is not None and writable("out", out, x.shape, contiguous=False).flags.c_contiguous
    y = out if in_place and out is not None else np.empty(x.shape)
    # What is refused must be found before x is overwritten by its own result.
    if np.may_share_memory(x, y):
        refuse_not_finite("x", x)
    if y is not x:
        np.copyto(y, x)
    try:
        ready.apply_frames(y)
    except ParameterError:
        refuse_not_finite("x", x)
        raise
    if out is None or in_place:
        return y
    out[...] = y
    return out


def _counts(ready: _core.ZeroPhase, x: Any, scale: tuple[float, float], out: np.ndarray | None) -> np.ndarray:
    """Filter a vector of counts."""
    counts = np.asarray(x)
    counts = counts.astype(counts.dtype.newbyteorder("="), copy=False)
    if counts.dtype not in _COUNTS or counts.ndim != 1 or counts.size == 0:
        raise ParameterError(
            f"x is {counts.dtype} {counts.shape}", "x", "With a scale give a vector of int16, int32 or float32."
        )
    factor, offset = pair("scale", scale)
    y = np.empty(counts.shape) if out is None else writable("out", out, counts.shape)
    ready.apply_samples(np.require(counts, requirements=["C", "A"]), (factor, offset), y)
    return y


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
