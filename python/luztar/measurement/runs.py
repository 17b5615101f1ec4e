"""Several runs, in order, with names that differ."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from typing import Any, overload

from ..errors import MeasurementError, ParameterError
from .run import Run


class Runs(Sequence[Run]):
    """An immutable sequence of :class:`Run`.

    Parameters
    ----------
    runs : iterable of Run
        Names that repeat are told apart by a number: ``run.csv``, ``run.csv (2)``.
    """

    __slots__ = ("_runs",)
    _runs: tuple[Run, ...]

    def __init__(self, runs: Iterable[Run] = ()) -> None:
        given = [runs] if isinstance(runs, Run) else list(runs)
        used: set[str] = set()
        named: list[Run] = []
        for run in given:
            if not isinstance(run, Run):
                raise ParameterError(f"{type(run).__name__} is not a Run", "runs", "Give luztar.Run objects.")
            name, count = run.name, 1
            while name in used:
                count += 1
                name = f"{run.name} ({count})"
            used.add(name)
            named.append(run if name == run.name else run.renamed(name))
        object.__setattr__(self, "_runs", tuple(named))

    def __setattr__(self, attribute: str, value: object) -> None:
        raise AttributeError("Runs is immutable; make a new one")

    def __reduce__(self) -> tuple[Any, ...]:
        return (Runs, (self._runs,))

    @property
    def names(self) -> tuple[str, ...]:
        """The runs' names, in order."""
        return tuple(run.name for run in self._runs)

    def __len__(self) -> int:
        return len(self._runs)

    def __iter__(self) -> Iterator[Run]:
        return iter(self._runs)

    @overload
    def __getitem__(self, which: int | str) -> Run: ...
    @overload
    def __getitem__(self, which: slice) -> Runs: ...
    def __getitem__(self, which: int | str | slice) -> Run | Runs:
        if isinstance(which, slice):
            return Runs(self._runs[which])
        if isinstance(which, str):
            for run in self._runs:
                if run.name == which:
                    return run
            raise MeasurementError(f"there is no run {which!r}", "runs", f"The runs are {', '.join(self.names)}.")
        return self._runs[which]

    def __add__(self, other: Iterable[Run]) -> Runs:
        return Runs((*self._runs, *other))

    @property
    def complete(self) -> bool:
        """Whether every file was read to its end."""
        return all(run.integrity.complete for run in self._runs)

    def integrity_table(self) -> list[dict[str, Any]]:
        """Return one row per run: name, rows, rate, completeness, and the findings' texts."""
        return [
            {
                "run": run.name,
                "channels": list(run.channels),
                "rows_declared": run.integrity.rows_declared,
                "rows": len(run),
                "duration_s": run.duration_s,
                "sample_rate_hz": run.sample_rate_hz if run.integrity.evenly_sampled else None,
                "complete": run.integrity.complete,
                "doubtful": [f.text for f in run.integrity.doubtful],
                "other": [f.text for f in run.integrity.findings if not f.doubtful],
                "sha256": run.sha256,
            }
            for run in self._runs
        ]

    def to_dict(self) -> list[dict[str, Any]]:
        """Return every run's ``to_dict``, in order."""
        return [run.to_dict() for run in self._runs]

    def __repr__(self) -> str:
        lines = [f"Runs: {len(self)}"]
        width = max((len(name) for name in self.names), default=0)
        for row in self.integrity_table():
            rate = f"{row['sample_rate_hz']:g} Hz" if row["sample_rate_hz"] else "uneven"
            whole = "complete" if row["complete"] else "NOT COMPLETE"
            line = f"  {row['run']:<{width}}  {row['rows']:>8} rows  {row['duration_s']:>9.3f} s  {rate:>10}  {whole}"
            lines.append(f"{line}  {', '.join(row['channels'])}")
            lines += [f"    ! {text}" for text in row["doubtful"]]
            lines += [f"    - {text}" for text in row["other"]]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        head = (
            "<tr><th>run</th><th>channels</th><th>rows</th><th>s</th><th>Hz</th><th>complete</th><th>findings</th></tr>"
        )
        body = ""
        for row in self.integrity_table():
            rate = f"{row['sample_rate_hz']:g}" if row["sample_rate_hz"] else "uneven"
            texts = "<br>".join(escape(text) for text in row["doubtful"] + row["other"])
            body += (
                f"<tr><td>{escape(row['run'])}</td><td>{escape(', '.join(row['channels']))}</td><td>{row['rows']}</td>"
                f"<td>{row['duration_s']:.3f}</td><td>{rate}</td><td>{'yes' if row['complete'] else 'no'}</td>"
                f"<td>{texts}</td></tr>"
            )
        return f"<table>{head}{body}</table>"
