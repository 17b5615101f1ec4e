"""Many parameter sets of one mechanism, over all threads."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from .. import _core
from .._arrays import vector
from ..errors import Interrupted, ParameterError
from . import drives as door
from .mechanism import Mechanism, lane_table

T = TypeVar("T")
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
        As :func:`simulate`, with the number of the lane.
    Interrupted
        A ``KeyboardInterrupt`` that carries the lanes that were done by then.

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
    batch = _Batch(mechanism, parameters, drives, sample_rate_hz, seconds, start, start_speed, substeps)
    samples = batch.rows.shape[1]
    place, speed = (np.empty((batch.lanes, len(mechanism.bodies), samples)) for _ in range(2))

    def run(part: slice) -> None:
        mechanism._network.simulate(
            batch.table[part], *batch.given, **batch.options, first=part.start, place=place[part], speed=speed[part]
        )

    def result(lanes: slice) -> Lanes:
        return Lanes(
            np.arange(samples) / batch.options["sample_rate_hz"],
            {b.name: place[lanes, i] for i, b in enumerate(mechanism.bodies)},
            {b.name: speed[lanes, i] for i, b in enumerate(mechanism.bodies)},
        )

    return batch.over(run, result, progress)


def summarise_lanes(
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
) -> dict[str, dict[str, np.ndarray]]:
    """Run many parameter sets and keep a few numbers of each body: memory does not grow with the length of the run.

    Arguments are those of :func:`simulate_lanes`.

    Returns
    -------
    dict of str to dict of str to ndarray, shape (lanes,)
        For each body ``last``, ``last_speed``, ``peak`` (of the magnitude), ``rms`` of its samples, rad or m, and
        ``at_rest_share``, the share of the samples at which it stood.

    Raises
    ------
    ParameterError, Interrupted
        As :func:`simulate_lanes`.

    Examples
    --------
    >>> import numpy as np
    >>> from luztar.mechanism import single_mass, summarise_lanes
    >>> lanes = {"spring.stiffness_n_per_m": np.array([1.0, 4.0])}
    >>> made = summarise_lanes(single_mass(stiffness=1.0), lanes, sample_rate_hz=100, seconds=9, start={"mass": 0.5})
    >>> made["mass"]["peak"].round(4).tolist()
    [0.5, 0.5]
    """
    batch = _Batch(mechanism, parameters, drives, sample_rate_hz, seconds, start, start_speed, substeps)
    names = _core.Mechanism.summary_names()
    out = np.empty((batch.lanes, len(mechanism.bodies), len(names)))

    def run(part: slice) -> None:
        mechanism._network.summarise(batch.table[part], *batch.given, **batch.options, first=part.start, out=out[part])

    def result(lanes: slice) -> dict[str, dict[str, np.ndarray]]:
        return {
            b.name: {name: out[lanes, i, j].copy() for j, name in enumerate(names)}
            for i, b in enumerate(mechanism.bodies)
        }

    return batch.over(run, result, progress)


class _Batch:
    """Lanes at the door of the core: a row of numbers each, and what they have in common."""

    def __init__(
        self,
        mechanism: Mechanism,
        parameters: Mapping[str, Any],
        drives: Mapping[str, Any] | None,
        sample_rate_hz: float,
        seconds: float | None,
        start: Mapping[str, float] | None,
        start_speed: Mapping[str, float] | None,
        substeps: int | None,
    ) -> None:
        rate = door.positive("sample_rate_hz", sample_rate_hz)
        samples = None if seconds is None else round(door.positive("seconds", seconds) * rate) + 1
        self.rows = door.channels(mechanism, drives or {}, samples)
        given = {name: vector(name, values) for name, values in parameters.items()}
        if not given:
            raise ParameterError("there are no lanes", "parameters", "Give at least one parameter, one value per lane.")
        self.lanes = next(iter(given.values())).size
        for name, values in given.items():
            if values.size != self.lanes:
                raise ParameterError(
                    f"{name} has {values.size} values, others {self.lanes}", name, "Give one value per lane."
                )
        self.table = lane_table(mechanism, given, self.lanes)
        starts = (door.by_body(*s) for s in (("start", mechanism, start), ("start_speed", mechanism, start_speed)))
        self.given = (self.rows, *starts)
        self.options = {"sample_rate_hz": rate, "substeps": door.parts(mechanism, 1.0 / rate, substeps)}

    def over(
        self,
        run: Callable[[slice], None],
        result: Callable[[slice], T],
        progress: Callable[[int, int], None] | None,
    ) -> T:
        """Run slices of lanes; between them an interrupt is heard, and what was done by then is kept."""
        chunk = max(1, int(CHUNK_STEPS // (self.rows.shape[1] * self.options["substeps"])))
        done = 0
        try:
            while done < self.lanes:
                last = min(done + chunk, self.lanes)
                run(slice(done, last))
                done = last
                if progress is not None:
                    progress(done, self.lanes)
        except KeyboardInterrupt:
            raise Interrupted(result(slice(0, done)), np.arange(done), self.lanes) from None
        return result(slice(0, done))
