"""A run from a table in memory."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .._arrays import vector
from ..errors import MeasurementError, ParameterError
from .columns import check_keys
from .headers import parse_header
from .run import Run
from .table import Loaded, Table, to_run


def read_frame(
    frame: Any,
    *,
    units: Mapping[str, str] | None = None,
    map: Mapping[str, str] | None = None,
    name: str = "frame",
    sample_rate_hz: float | None = None,
) -> Run:
    """Read one run from a table whose column names are written like the headers of a file.

    Parameters
    ----------
    frame : pandas.DataFrame, a mapping of names to arrays, or anything with ``columns`` and ``frame[name]``
        Columns of one length; a time that is the index counts as a column. Values that are not finite keep their place
        and become findings.
    units : mapping of channel to unit, optional
        Units where a column name has none.
    map : mapping of channel to ``"COLUMN"`` or ``"COLUMN*FACTOR"``, optional
        As in :func:`luztar.read`.
    name : str
        What the run is called in results.
    sample_rate_hz : float [Hz], > 0, optional
        Declares the sample rate of a table without a time column.

    Returns
    -------
    Run

    Raises
    ------
    MeasurementError
        Names the column and the remedy.
    """
    from .arrays import check_rate

    names = list(frame) if isinstance(frame, Mapping) else list(getattr(frame, "columns", ()))
    if not names:
        raise ParameterError("the table has no columns", "frame", "Give a DataFrame or a mapping of names to arrays.")
    if hasattr(frame, "reset_index") and getattr(frame.index, "name", None) is not None:
        index = parse_header(0, str(frame.index.name))
        if index.channel == "time" and all(parse_header(0, str(n)).channel != "time" for n in names):
            frame = frame.reset_index()
            names = list(frame.columns)
    columns = [parse_header(i, str(column)) for i, column in enumerate(names)]
    where = str(name)

    def load(use: Sequence[int]) -> Loaded:
        values = {k: _column(frame, names, k, where) for k in use}
        sizes = {k: v.size for k, v in values.items()}
        if len(set(sizes.values())) > 1:
            listed = ", ".join(f"{names[k]!r} {n}" for k, n in sizes.items())
            raise MeasurementError(f"the columns differ in length: {listed}", where, "Give columns of one length.")
        return Loaded(values, rows_declared=next(iter(sizes.values())))

    rate = None if sample_rate_hz is None else check_rate(sample_rate_hz)
    return to_run(
        Table(columns, load, where),
        name=where,
        mapped=check_keys("map", map),
        units=check_keys("units", units),
        sample_rate_hz=rate,
    )


def _column(frame: Any, names: Sequence[Any], k: int, where: str) -> np.ndarray:
    by_place = getattr(frame, "iloc", None)
    column = by_place[:, k] if by_place is not None else frame[names[k]]
    try:
        if hasattr(column, "to_numpy"):
            # Nullable integers and floats of pandas hold pd.NA, which only this turns into NaN.
            kind = getattr(getattr(column, "dtype", None), "kind", "f")
            if kind in "fiub":
                try:
                    column = column.to_numpy(dtype=np.float64, na_value=np.nan)
                except TypeError:
                    column = column.to_numpy()
            else:
                column = column.to_numpy()
        return np.array(vector(str(names[k]), column, minimum=2, finite=False))
    except (ParameterError, TypeError, ValueError) as error:
        reason = error.kind if isinstance(error, ParameterError) else str(error)
        raise MeasurementError(reason, f"{where}, column {str(names[k])!r}", "Give a column of real numbers.") from None
