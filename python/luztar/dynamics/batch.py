"""Free runs of many mechanisms side by side: whole trajectories, or a few numbers of each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from .. import _core
from ..errors import Interrupted, ParameterError
from . import lanes
from .batch_inputs import Inputs
from .batch_inputs import inputs as checked
from .keep import DEFAULT, Keep
from .keep import keep as kept
from .summary import Summary
from .trajectory import Trajectory

Progress = Callable[[int, int], None]


def simulate(
    parameters: Mapping[str, Any],
    handwheel_rad: Any,
    *,
    sample_rate_hz: float,
    load_nm: Any = None,
    start_rad: Any = 0.0,
    start_speed_rad_s: Any = 0.0,
    substeps: int = 1,
    method: str = "split",
    width: str = "widest",
    progress: Progress | None = None,
) -> Trajectory:
    """Run the steering model along a handwheel angle.

    Parameters
    ----------
    parameters : mapping of str to float or array_like, shape (lanes,)
        Keys as in model files (``steering.inertia_kg_m2``, ``coulomb.level_nm`` ...); what is not given is 0. Arrays
        make lanes: one trajectory per value, side by side.
    handwheel_rad : array_like, shape (n,) or (lanes, n), n >= 2
        Evenly sampled, one drive for all lanes or one each; between the samples a cubic runs through the four nearest.
        Or a function that returns the drives, shape (k, n), of the lanes whose numbers, shape (k,), it is given: it is
        asked for a few at a time, so that the drives of a million lanes need not fit into memory.
    sample_rate_hz : float, > 0
    load_nm : array_like, shape (n,) or (lanes, n), or a function, optional
        Torque on the road wheel.
    start_rad, start_speed_rad_s : float or array_like, shape (lanes,)
    substeps : int, >= 1
        Steps per sampling interval. The step times the highest circular frequency of the springs must stay below 2.
    method : {"split", "moreau_jean"}
        ``split``: second order, reversals and break-aways located inside the step; the default. ``moreau_jean``: first
        order.
    width : {"widest", "avx512", "avx2", "baseline"}
        Instruction set, for tests: the bits are the same. One that the processor lacks gives way to the next.
    progress : callable, optional
        Called with (lanes done, lanes) up to 20 times a second.

    Returns
    -------
    Trajectory

    Raises
    ------
    ParameterError
        A negative inertia, friction, gap or step, NaN, a step too large for the stiffest spring: named with its value
        and its lane.
    Interrupted
        A ``KeyboardInterrupt`` that carries the trajectories of the lanes that were done by then.

    Examples
    --------
    >>> import numpy as np, luztar
    >>> psi = np.sin(np.pi * np.arange(2001) / 500)
    >>> mechanism = {"steering.inertia_kg_m2": 3.0, "steering.ratio": 16.0, "steering.stiffness_nm_per_rad": 60.0,
    ...              "viscous.coefficient_nm_s_per_rad": 40.0, "coulomb.level_nm": 8.1, "freeplay.gap_rad": 0.1}
    >>> run = luztar.dynamics.simulate(mechanism, psi, sample_rate_hz=500)
    >>> round(float(run.roadwheel_rad.max()), 4)
    0.059
    """
    given = checked(
        parameters,
        handwheel_rad,
        load_nm,
        start_rad,
        start_speed_rad_s,
        sample_rate_hz=sample_rate_hz,
        substeps=substeps,
    )
    wanted = kept(("trace",), None, None, samples=given.samples, rate_hz=given.rate_hz)
    phi, speed = (np.empty((given.lanes, given.samples)) for _ in range(2))
    done = np.zeros(given.lanes, bool)
    rows = np.empty((given.lanes, wanted.width))
    time_s = np.arange(given.samples) / given.rate_hz
    try:
        _run(given, wanted, np.arange(given.lanes), rows, done, phi, speed, method, width, progress)
    except KeyboardInterrupt:
        found = np.flatnonzero(done)
        raise Interrupted(Trajectory(time_s, phi[found], speed[found]), found, given.lanes) from None
    return Trajectory(time_s, phi, speed) if given.many else Trajectory(time_s, phi[0], speed[0])


def summarise(
    parameters: Mapping[str, Any],
    handwheel_rad: Any,
    *,
    sample_rate_hz: float,
    load_nm: Any = None,
    start_rad: Any = 0.0,
    start_speed_rad_s: Any = 0.0,
    substeps: int = 1,
    method: str = "split",
    width: str = "widest",
    keep: Any = DEFAULT,
    window_s: float | None = None,
    times_s: Any = None,
    progress: Progress | None = None,
    resume: Summary | None = None,
) -> Summary:
    """Run many mechanisms and keep a few numbers of each: memory does not grow with the length of the run.

    Arguments that are not named here are those of :func:`simulate`. The bits do not depend on the number of threads,
    the instruction set, the neighbours of a lane, or on whether the batch was interrupted.

    Parameters
    ----------
    keep : sequence of str
        Reducers:

        - ``last``: ``last_rad``, ``last_speed_rad_s``, the state at the last sample
        - ``peak``: ``peak_rad``, the largest angle on either side; ``rms``: ``rms_rad``; both of the samples
        - ``at_rest``: ``at_rest_share``, the share of the samples at which the road wheel stood
        - ``events``: ``stick_count``, ``slip_count``, ``reversal_count``, ``contact_count``, ``release_count``
        - ``energy``: ``energy_dry_j`` and so on, the energies of a :class:`Trace`
        - ``envelope``: ``least_rad``, ``greatest_rad``, shape (lanes, windows), the extremes of every ``window_s``
        - ``samples``: ``sample_rad``, ``sample_speed_rad_s``, shape (lanes, times), the state at ``times_s``
        - ``trace``: ``roadwheel_rad``, ``speed_rad_s``, shape (lanes, n): all samples, which need memory
    window_s : float, optional
        Length of a window of the envelope; the last one may be shorter.
    times_s : array_like, shape (m,), optional
        Instants of samples, increasing.
    progress : callable, optional
        Called with (lanes done, lanes) up to 20 times a second.
    resume : Summary, optional
        What an interrupted call with the same arguments had finished; only the other lanes are run.

    Returns
    -------
    Summary
        A mapping of the names above to arrays, shape (lanes,) or as said.

    Raises
    ------
    ParameterError
        As :func:`simulate`; all lanes are looked at before the first is run.
    Interrupted
        A ``KeyboardInterrupt`` that carries the finished lanes as a :class:`Summary` in ``partial``.

    Examples
    --------
    >>> import numpy as np, luztar
    >>> psi = np.sin(np.pi * np.arange(2001) / 500)
    >>> mechanism = {"steering.inertia_kg_m2": 3.0, "steering.ratio": 16.0, "steering.stiffness_nm_per_rad": 60.0,
    ...              "viscous.coefficient_nm_s_per_rad": 40.0, "coulomb.level_nm": np.array([0.0, 8.0, 2000.0])}
    >>> many = luztar.dynamics.summarise(mechanism, psi, sample_rate_hz=500, keep=("at_rest", "events"))
    >>> many["at_rest_share"].round(2).tolist()
    [0.0, 0.05, 1.0]
    >>> many["stick_count"].tolist()
    [0.0, 4.0, 0.0]
    """
    given = checked(
        parameters,
        handwheel_rad,
        load_nm,
        start_rad,
        start_speed_rad_s,
        sample_rate_hz=sample_rate_hz,
        substeps=substeps,
    )
    wanted = kept(keep, window_s, times_s, samples=given.samples, rate_hz=given.rate_hz)
    n = given.samples if wanted.trace else 0
    rows, phi, speed = (np.empty((given.lanes, values)) for values in (wanted.width, n, n))
    done = np.zeros(given.lanes, bool)
    # Beforehand: an interrupt is not to wait for it.
    digest = given.digest(wanted.names, wanted.window, wanted.chosen, method)
    if resume is not None:
        _take_up(resume, digest, wanted, rows, phi, speed, done)

    def result() -> Summary:
        found = np.flatnonzero(done)
        whole = slice(None) if found.size == given.lanes else found
        values = wanted.unpack(rows[whole])
        if wanted.trace:
            values |= {"roadwheel_rad": phi[whole], "speed_rad_s": speed[whole]}
        return Summary(values, given.lanes, found, digest)

    try:
        _run(given, wanted, np.flatnonzero(~done), rows, done, phi, speed, method, width, progress)
    except KeyboardInterrupt:
        partial = result()
        raise Interrupted(partial, partial.done, given.lanes) from None
    return result()


def _run(
    given: Inputs,
    wanted: Keep,
    index: np.ndarray,
    rows: np.ndarray,
    done: np.ndarray,
    phi: np.ndarray,
    speed: np.ndarray,
    method: str,
    width: str,
    progress: Progress | None,
) -> None:
    """Run the lanes of an index, writing into the rows of all lanes; ``done`` is right also after an interrupt."""
    lanes.check_method(method)
    chunk = given.chunk(rows.shape[1] + (2 * given.samples if wanted.trace else 0))
    given.check(chunk, method)
    told = 0

    def tell(count: int) -> None:
        nonlocal told
        if progress is not None and count > told:
            told = count
            progress(count, given.lanes)

    for first in range(0, index.size, chunk):
        part = index[first : first + chunk]
        before = given.lanes - index.size + first
        # Lanes that follow each other are written where they belong; those of a batch gone on with, by way of a copy.
        run = slice(int(part[0]), int(part[-1]) + 1)
        straight = run.stop - run.start == part.size
        places = [a[run] if straight else np.empty((part.size, *a.shape[1:]), a.dtype) for a in (rows, phi, speed)]
        finished = np.zeros(part.size, bool)
        parameters, starts, psi, load = given.part(part)
        try:
            _core.run_lanes(
                parameters,
                starts,
                psi,
                load,
                sample_rate_hz=given.rate_hz,
                substeps=given.substeps,
                method=method,
                width=width,
                **wanted.options,
                rows=places[0],
                done=finished,
                phi=places[1] if wanted.trace else None,
                speed=places[2] if wanted.trace else None,
                told=lambda count, before=before: tell(before + count),
            )
        finally:
            if not straight:
                for a, place in zip((rows, phi, speed), places, strict=True):
                    a[part] = place
            done[part] = finished
        lanes.require_bounded(part, places[1 if wanted.trace else 0])
        tell(before + part.size)


def _take_up(
    resume: Summary, digest: str, wanted: Keep, rows: np.ndarray, phi: np.ndarray, speed: np.ndarray, done: np.ndarray
) -> None:
    """Write what was done before into the rows of all lanes."""
    if not isinstance(resume, Summary) or resume.inputs != digest:
        remedy = "Give the partial result of a call with the same arguments."
        raise ParameterError("it was not begun like this", "resume", remedy)
    wanted.pack(resume.kept, rows, resume.done)
    if wanted.trace:
        phi[resume.done], speed[resume.done] = resume["roadwheel_rad"], resume["speed_rad_s"]
    done[resume.done] = True
