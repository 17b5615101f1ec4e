"""Many parameter sets of one mechanism, over all threads."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import vector
from ..errors import ParameterError
from . import drives as door
from .mechanism import Mechanism, lane_table

# Steps between two looks for an interrupt: 0.3 us each, 0.2 s on one thread.
CHUNK_STEPS = 600_000


@dataclass(frozen=True, repr=False)
class Lanes:
    """What :func:`simulate_lanes` returns.

    Attributes
    ----------
    time_s : ndarray, shape (n,)
    position, speed : dict of str to ndarray, shape (lanes, n)
        Of the bodies.
    """

    time_s: np.ndarray
    position: dict[str, np.ndarray]
    speed: dict[str, np.ndarray]

    def __len__(self) -> int:
        return len(next(iter(self.position.values())))

    def __str__(self) -> str:
        peaks = ", ".join(f"{n} {np.abs(q).max():.4g}" for n, q in self.position.items())
        return f"{len(self)} runs of {self.time_s[-1]:g} s; largest positions: {peaks}"

    __repr__ = __str__


def simulate_lanes(
    mechanism: Mechanism,
    parameters: Mapping[str, Any],
    drives: Mapping[str, Any] | None = None,
    *,
    sample_rate_hz: float,
    seconds: float | None = None,
    start: Mapping[str, float] | None = None,
    start_speed: Mapping[str, float] | None = None,
    substeps: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Lanes:
    """Run one mechanism with many parameter sets, all along the same drives.

    The bits of a lane are those of :func:`simulate` with its parameters, whatever its neighbours and the number of
    threads.

    Parameters
    ----------
    mechanism : Mechanism
    parameters : mapping of str to array_like, shape (lanes,)
        By the names of :meth:`Mechanism.parameters`, one value per lane.
    drives, sample_rate_hz, seconds, start, start_speed, substeps
        As :func:`simulate`; the substeps that are chosen suit the mechanism as it is, not each lane.
    progress : callable, optional
        Called with (lanes done, lanes); between the calls an interrupt is heard.

    Returns
    -------
    Lanes

    Raises
    ------
    ParameterError
        As :func:`simulate`, with the number of the lane (counted within its part of 256).

    Examples
    --------
    >>> import numpy as np
    >>> from luztar.mechanism import simulate_lanes, single_mass
    >>> levels = {"friction.kinetic_n": np.array([0.05, 0.1, 2.0]), "friction.static_n": np.array([0.05, 0.1, 2.0])}
    >>> m = single_mass(stiffness=1.0, kinetic=0.1)
    >>> lanes = simulate_lanes(m, levels, sample_rate_hz=100, seconds=60, start={"mass": 1.03})
    >>> lanes.position["mass"][:, -1].round(3).tolist()
    [0.03, -0.03, 1.03]
    """
    rate = door.positive("sample_rate_hz", sample_rate_hz)
    samples = None if seconds is None else round(door.positive("seconds", seconds) * rate) + 1
    rows = door.channels(mechanism, drives or {}, samples)
    given = {name: vector(name, values) for name, values in parameters.items()}
    if not given:
        raise ParameterError("there are no lanes", "parameters", "Give at least one parameter, one value per lane.")
    lanes = next(iter(given.values())).size
    for name, values in given.items():
        if values.size != lanes:
            raise ParameterError(f"{name} has {values.size} values, others {lanes}", name, "Give one value per lane.")
    table = lane_table(mechanism, given, lanes)
    place, speed = (np.empty((lanes, len(mechanism.bodies), rows.shape[1])) for _ in range(2))
    options = {
        "sample_rate_hz": rate,
        "substeps": door.parts(mechanism, 1.0 / rate, substeps),
    }
    starts = door.by_body("start", mechanism, start), door.by_body("start_speed", mechanism, start_speed)
    chunk = max(1, CHUNK_STEPS // (rows.shape[1] * options["substeps"]))
    for first in range(0, lanes, chunk):
        part = slice(first, first + chunk)
        mechanism._network.simulate(table[part], rows, *starts, **options, place=place[part], speed=speed[part])
        if progress is not None:
            progress(min(first + chunk, lanes), lanes)
    names = [b.name for b in mechanism.bodies]
    return Lanes(
        np.arange(rows.shape[1]) / rate,
        {name: place[:, i] for i, name in enumerate(names)},
        {name: speed[:, i] for i, name in enumerate(names)},
    )
