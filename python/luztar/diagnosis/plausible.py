"""Whether a run can be what it is said to be, before a model is fitted to it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..errors import MeasurementError
from ..model import Model, card
from ..model.structure import Structure
from .clipped import with_doubt
from .prepare import Prepared, prepare_run

if TYPE_CHECKING:
    from ..measurement import Run

# A channel that stands still for more than this share of the record while the motion goes on measures nothing.
STUCK_SHARE = 0.05
# Friction turned about by less than this share of the effort's rms may be noise around a mechanism without friction.
REVERSED_SHARE = 0.05


def prepare_measured(runs: Sequence[Run], model: Model) -> tuple[Prepared, ...]:
    """Make measured runs ready; see :func:`luztar.diagnosis.prepare.prepare`.

    Raises
    ------
    MeasurementError
        As there; or what an effect of the model looks at was not recorded, a channel stands still, or the friction is
        negative in both directions.
    """
    if not runs:
        raise MeasurementError("there are no runs", "runs", "Give at least one run file.")
    made = []
    for number, run in enumerate(runs):
        require_channels(run, model)
        made.append(with_doubt(prepare_run(number, run, model), run, model))
        require_friction_sign(made[-1], model)
    return tuple(made)


def require_channels(run: Run, model: Model) -> None:
    """Refuse a run without what an effect of the model looks at, or whose motion or effort stands still.

    Raises
    ------
    MeasurementError
    """
    structure = model.structure
    for name in model.effects:
        channel = card(name, structure.name).channel
        if channel is not None and channel not in run:
            raise MeasurementError(
                f"the effect '{name}' needs the channel '{channel}', which was not recorded",
                run.name,
                f'Name its column, --map {channel}="COLUMN" (map= in Python), or take the effect out of the model.',
            )
    for channel in (structure.motion, structure.effort):
        _require_finite(run, channel)
        _require_change(run, channel)


def _require_finite(run: Run, channel: str) -> None:
    lost = [f for f in run.integrity.findings if f.kind == "not_finite" and f.channel == channel]
    # A file that ends in the middle says so before anything else.
    if run.integrity.complete and lost and not np.isfinite(run[channel]).all():
        more = f" (and {len(lost) - 1} more such places)" if len(lost) > 1 else ""
        raise MeasurementError(
            f"{lost[0].text}{more}",
            run.name,
            "Export the parts before and after as files of their own (Python: run.slice(from_s, to_s)).",
        )


def _require_change(run: Run, channel: str) -> None:
    values = run[channel]
    values = values[np.isfinite(values)]
    if values.size and float(np.ptp(values)) == 0.0:
        raise MeasurementError(
            f"the {channel} is {values[0]:.6g} over the whole record: it never changes",
            run.name,
            f'Check the channel and its cable, or name another column: --map {channel}="COLUMN".',
        )
    stuck = [f for f in run.integrity.findings if f.kind == "stuck" and f.channel == channel]
    # A finding without a stretch speaks of a channel that never changes, which was refused above.
    still_s = sum(b - a for f in stuck if f.from_s is not None for a, b in f.stretches_s())
    if still_s > STUCK_SHARE * run.duration_s:
        raise MeasurementError(
            f"{stuck[0].text} In all, it stands still for {still_s:.3g} s of {run.duration_s:.3g} s",
            run.name,
            "Check the channel and its cable, and record the run again.",
        )


def require_friction_sign(r: Prepared, model: Model) -> None:
    """Refuse a run whose friction drives the motion in both directions, as the check by TB 038 does.

    Raises
    ------
    MeasurementError
    """
    if "coulomb" not in model.effects:
        return
    structure: Structure = model.structure
    clear = r.usable & ~r.zone
    sides = [r.effort[clear & (np.sign(r.speed) == way)] * way for way in (1.0, -1.0)]
    if not all(side.size for side in sides):
        return
    up, down = (float(side.mean()) for side in sides)
    size = float(np.sqrt(np.mean(np.concatenate(sides) ** 2)))
    if up < 0.0 and down < 0.0 and -(up + down) / 2.0 > REVERSED_SHARE * size:
        unit, effort = structure.effort_unit, structure.effort
        raise MeasurementError(
            f"{effort} sign reversed: the friction is {up:.3g} {unit} with increasing and {down:.3g} {unit} with "
            f"decreasing {structure.motion}, as if it drove the motion",
            r.name,
            f'Turn the sign of the {effort}: --map {effort}="COLUMN*-1" (map= in Python).',
        )
