"""One run of a mechanism with everything that happened in it."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from ..errors import ParameterError
from . import drives as door
from .mechanism import Mechanism
from .result import Event, MechanismRun

SOLVERS = ("active_set", "gauss_seidel")


def simulate(
    mechanism: Mechanism,
    drives: Mapping[str, Any] | None = None,
    *,
    sample_rate_hz: float,
    seconds: float | None = None,
    start: Mapping[str, float] | None = None,
    start_speed: Mapping[str, float] | None = None,
    substeps: int | None = None,
    solver: str = "active_set",
) -> MechanismRun:
    """Run a mechanism.

    Parameters
    ----------
    mechanism : Mechanism
    drives : mapping of str to array_like, shape (n,)
        Channels by name: positions of driven nodes (rad or m) and loads (Nm or N); a load that is not given is 0.
        Between the samples runs a cubic through the four nearest.
    sample_rate_hz : float, > 0
    seconds : float, optional
        Length of the run where no channel is given.
    start, start_speed : mapping of str to float, optional
        Of bodies, rad or m, rad/s or m/s; 0 where none is given.
    substeps : int, optional
        Steps of the core per sampling interval; where not given, as many as keep a step below a tenth of the longest
        that the springs allow (:attr:`Mechanism.longest_step_s`).
    solver : {"active_set", "gauss_seidel"}
        How it is decided which frictions hold; the second is for tests, the motion is the same.

    Returns
    -------
    MechanismRun

    Raises
    ------
    ParameterError
        A channel that is unknown, missing or not finite; a step too large, with the spring and the longest step; a
        motion without bounds, with its instant.

    Notes
    -----
    Second order in the step through stick, slip and reversal of frictions on a body's own coordinate; of frictions
    between bodies, observed orders are 1.97 to 2.06 (``tests/test_mechanism_order.py``). A relative speed of friction
    that holds is exactly 0.

    Examples
    --------
    >>> import numpy as np
    >>> from luztar.mechanism import simulate, single_mass
    >>> run = simulate(single_mass(stiffness=1.0, kinetic=0.1), sample_rate_hz=100, seconds=20, start={"mass": 1.03})
    >>> round(float(run.position["mass"][-1]), 3)
    -0.03
    """
    rate = door.positive("sample_rate_hz", sample_rate_hz)
    samples = None if seconds is None else round(door.positive("seconds", seconds) * rate) + 1
    rows = door.channels(mechanism, drives or {}, samples)
    if solver not in SOLVERS:
        raise ParameterError(f"there is no solver {solver!r}", "solver", f"Known are: {', '.join(SOLVERS)}.")
    place, speed, torque, frictions, modes, redundant, events, crowded, energy = mechanism._network.trace(
        rows,
        door.by_body("start", mechanism, start),
        door.by_body("start_speed", mechanism, start_speed),
        sample_rate_hz=rate,
        substeps=door.parts(mechanism, 1.0 / rate, substeps),
        gauss_seidel=solver == "gauss_seidel",
    )
    bodies = [b.name for b in mechanism.bodies]
    elements = [e.name for e in mechanism.elements]
    given = {d.name: rows[i] for i, d in enumerate(mechanism.driven)}
    speeds = {name: np.gradient(row, 1.0 / rate, edge_order=min(2, row.size - 1)) for name, row in given.items()}
    by_element, by_node, by_load, (first, last, turnover, residual) = energy
    return MechanismRun(
        mechanism=mechanism,
        time_s=np.arange(rows.shape[1]) / rate,
        position=MappingProxyType({**dict(zip(bodies, place, strict=True)), **given}),
        speed=MappingProxyType({**dict(zip(bodies, speed, strict=True)), **speeds}),
        torque=MappingProxyType(dict(zip(elements, torque, strict=True))),
        sliding=MappingProxyType({elements[e]: row for e, row in zip(frictions, modes, strict=True)}),
        redundant=redundant,
        events=tuple(Event(t, elements[e], kind, int(direction)) for t, e, kind, direction in events),
        crowded_steps=crowded,
        energy_j=MappingProxyType(
            {
                **{name: -value for name, value in zip(elements, by_element, strict=True)},
                **dict(zip(mechanism.channels, (*by_node, *by_load), strict=True)),
                "stored_first": first,
                "stored_last": last,
                "turnover": turnover,
                "residual": residual,
            }
        ),
    )
