"""One measured run: named channels on one time axis, in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from html import escape
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from .._arrays import vector
from ..errors import MeasurementError, ParameterError
from .integrity import Finding, Integrity

if TYPE_CHECKING:
    from .runs import Runs

# The channels luztar knows, with the unit each has inside.
CHANNEL_UNITS: Mapping[str, str] = MappingProxyType(
    {
        "angle": "rad",
        "torque": "Nm",
        "force": "N",
        "position": "m",
        "handwheel": "rad",
        "roadwheel": "rad",
        "load": "N",
    }
)


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Run:
    """One measured run. From a file by :func:`luztar.read`, from arrays by calling this class.

    Parameters
    ----------
    time : array_like, shape (n,), optional
        Seconds, or the unit in ``units["time"]``; strictly increasing in a sound record. Either this or
        ``sample_rate_hz``.
    sample_rate_hz : float [Hz], > 0, optional
        For arrays sampled evenly from time 0.
    units : mapping of channel to unit, optional
        Units of the arrays given; a channel not named is taken as SI, with a finding.
    name : str
        What the run is called in results.
    **channels : array_like, shape (n,)
        ``angle``, ``torque``, ``force``, ``position``, ``handwheel``, ``roadwheel`` or ``load``. Values that are not
        finite keep their place and become findings.

    Attributes
    ----------
    name : str
    time_s : ndarray, shape (n,), float64, read-only
        Seconds, as in the file.
    channels : mapping of str to ndarray, shape (n,), float64, read-only
        In SI units (:data:`CHANNEL_UNITS`).
    integrity : Integrity
        What the source really held.
    source : str
        The file as it was named, or ``"arrays"``.
    sha256 : str or None
        Of the file as it lies on disk; None for arrays.

    Raises
    ------
    ParameterError
        Where arrays disagree in length, a channel is unknown, or neither time nor sample rate is given.

    Examples
    --------
    >>> import luztar
    >>> run = luztar.Run(sample_rate_hz=100, angle=[0.0, 90.0], torque=[0.5, 0.6], units={"angle": "deg"})
    >>> round(float(run["angle"][1]), 6)
    1.570796
    """

    name: str
    time_s: np.ndarray
    channels: Mapping[str, np.ndarray]
    integrity: Integrity
    source: str
    sha256: str | None

    def __init__(
        self,
        *,
        time: Any = None,
        sample_rate_hz: float | None = None,
        units: Mapping[str, str] | None = None,
        name: str = "run",
        **channels: Any,
    ) -> None:
        from .arrays import from_arrays

        parts = from_arrays(time, sample_rate_hz, units, name, channels)
        self._fill(*parts)

    def _fill(
        self,
        name: str,
        time_s: np.ndarray,
        channels: Mapping[str, np.ndarray],
        integrity: Integrity,
        source: str,
        sha256: str | None,
    ) -> None:
        frozen: dict[str, np.ndarray] = {}
        for key, values in channels.items():
            values.setflags(write=False)
            frozen[key] = values
        time_s.setflags(write=False)
        for attribute, value in (
            ("name", name),
            ("time_s", time_s),
            ("channels", MappingProxyType(frozen)),
            ("integrity", integrity),
            ("source", source),
            ("sha256", sha256),
        ):
            object.__setattr__(self, attribute, value)

    @classmethod
    def from_parts(
        cls,
        name: str,
        time_s: np.ndarray,
        channels: Mapping[str, np.ndarray],
        integrity: Integrity,
        source: str,
        sha256: str | None,
    ) -> Run:
        """Build a run from arrays that are already float64, SI, and nobody else's (they become read-only)."""
        run = object.__new__(cls)
        run._fill(name, time_s, channels, integrity, source, sha256)
        return run

    def __reduce__(self) -> tuple[Any, ...]:
        parts = (self.name, self.time_s, dict(self.channels), self.integrity, self.source, self.sha256)
        return (Run.from_parts, parts)

    def __len__(self) -> int:
        return int(self.time_s.size)

    def __contains__(self, channel: object) -> bool:
        return channel in self.channels

    def __getitem__(self, channel: str) -> np.ndarray:
        if channel in self.channels:
            return self.channels[channel]
        found = ", ".join(self.channels) or "none"
        if channel not in CHANNEL_UNITS:
            raise MeasurementError(
                f"there is no channel {channel!r}", self.name, f"The channels here are {found}; time is run.time_s."
            )
        columns = ", ".join(repr(c) for c in self.integrity.columns_found[:30])
        text = f"there is no channel {channel!r}; found: {found}" + (
            f"; columns in the file: {columns}" if columns else ""
        )
        remedy = f'Name its column: --map {channel}="COLUMN" (map= in Python).'
        # "torque_Xy": the name of the channel with something behind it that is no unit.
        meant = [c for c in self.integrity.columns_found if c.lower().replace(" ", "_").startswith(f"{channel}_")]
        if meant:
            unit = CHANNEL_UNITS[channel]
            remedy = (
                f'If {meant[0]!r} is it, its unit is not known: say --map {channel}="{meant[0]}" --unit '
                f"{channel}={unit} (map= and units= in Python), with the unit it is in."
            )
        raise MeasurementError(text, self.name, remedy)

    @property
    def duration_s(self) -> float:
        """Seconds from the first sample to the last."""
        return float(self.time_s[-1] - self.time_s[0])

    @property
    def sample_rate_hz(self) -> float:
        """Samples per second, from the whole record.

        Raises
        ------
        MeasurementError
            Where the record is not evenly sampled (see :meth:`require_even`).
        """
        self.require_even()
        rate = (len(self) - 1) / self.duration_s
        # Stamps carry rounding of one part in 10^9 or more in a long record: 499.9999999998 is 500.
        snapped = round(rate, 3)
        return snapped if abs(rate - snapped) <= 1e-9 * rate else rate

    def require_even(self) -> Run:
        """Return this run, or raise where one sampling interval does not describe it.

        Raises
        ------
        MeasurementError
            Names the first place and what to do.
        """
        for finding in self.integrity.findings:
            if finding.kind in ("gap", "duplicate_time", "reversed_time"):
                raise MeasurementError(
                    f"the time axis is broken: {finding.text}",
                    self.name,
                    "Export the parts before and after as files of their own (Python: run.split_at_gaps()).",
                )
        for finding in self.integrity.findings:
            if finding.kind == "uneven":
                median_s = self.integrity.dt_median_s or 0.0
                rate = f"{1.0 / median_s:.4g}" if median_s > 0.0 else "RATE"
                raise MeasurementError(
                    f"the sampling is uneven: {finding.text}",
                    self.name,
                    f"Bring it to an even rate: --resample {rate} (Python: run.resample({rate})).",
                )
        return self

    def resample(self, sample_rate_hz: float, *, method: str = "linear") -> Run:
        """Return the run on an even time axis; see :func:`luztar.measurement.resample.resample`."""
        from .resample import resample

        return resample(self, sample_rate_hz, method=method)

    def slice(self, from_s: float | None = None, to_s: float | None = None) -> Run:
        """Return the samples with ``from_s <= time_s <= to_s``; see :func:`luztar.measurement.resample.cut_out`."""
        from .resample import cut_out

        return cut_out(self, from_s, to_s)

    def split_at_gaps(self) -> Runs:
        """Return the stretches between gaps and breaks of the time axis, each a run of its own."""
        from .resample import split_at_gaps

        return split_at_gaps(self)

    def renamed(self, name: str) -> Run:
        """Return the same run under another name."""
        return Run.from_parts(name, self.time_s, self.channels, self.integrity, self.source, self.sha256)

    def with_finding(self, finding: Finding) -> Run:
        """Return the same run with one finding more in its integrity report."""
        integrity = replace(self.integrity, findings=(*self.integrity.findings, finding))
        return Run.from_parts(self.name, self.time_s, self.channels, integrity, self.source, self.sha256)

    def to_dict(self) -> dict[str, Any]:
        """Return what the run is, without its samples, as plain JSON values (no NaN)."""
        even = self.integrity.evenly_sampled
        return {
            "name": self.name,
            "source": self.source,
            "sha256": self.sha256,
            "rows": len(self),
            "sample_rate_hz": self.sample_rate_hz if even else None,
            "from_s": float(self.time_s[0]),
            "to_s": float(self.time_s[-1]),
            "channels": {key: CHANNEL_UNITS[key] for key in self.channels},
            "integrity": self.integrity.to_dict(),
        }

    def __repr__(self) -> str:
        even = self.integrity.evenly_sampled
        rate = f"{self.sample_rate_hz:g} Hz" if even else "not evenly sampled"
        marks = "" if self.integrity.complete else ", not complete"
        n_doubtful = len(self.integrity.doubtful)
        marks += f", {n_doubtful} doubtful finding{'s' if n_doubtful > 1 else ''}" if n_doubtful else ""
        return f"Run({self.name!r}: {', '.join(self.channels)}; {len(self)} rows, {self.duration_s:g} s, {rate}{marks})"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{escape(key)}</th><td>{np.nanmin(v):.4g} to {np.nanmax(v):.4g} {CHANNEL_UNITS[key]}</td>"
            f"<td>{escape(self.integrity.columns.get(key, ''))}</td></tr>"
            if np.isfinite(v).any()
            else f"<tr><th>{escape(key)}</th><td>no finite value</td><td></td></tr>"
            for key, v in self.channels.items()
        )
        return f"<p>{escape(repr(self))}</p><table>{rows}</table>{self.integrity._repr_html_()}"


def as_si(name: str, values: Any, n: int | None) -> np.ndarray:
    """Return a fresh float64 copy of one argument, NaN allowed, with its length checked against ``n``."""
    array = np.array(vector(name, values, minimum=2, finite=False))
    if n is not None and array.size != n:
        raise ParameterError(f"{name} holds {array.size} values, the time axis {n}", name, "Give arrays of one length.")
    return array
