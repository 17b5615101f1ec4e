"""Where the torque comes from: the load cell's force times the link distance, or a torque channel."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..errors import MeasurementError

if TYPE_CHECKING:
    from ..measurement.run import Run


class TorqueSource(NamedTuple):
    """The torque of one run, the channel it rests on, and a note where there was a choice."""

    torque_nm: np.ndarray
    channel: str
    note: str | None


def torque_of(run: Run, link_distance_m: float) -> TorqueSource:
    """Return a run's torque.

    A ``torque`` channel wins over ``force``: it is what the file calls torque, and multiplying again would apply the
    lever twice. The exception is a torque that the robot only *estimated* (motor current) beside a measured force:
    2.1.1 asks for accurate torque measurement, so the load cell wins.

    Parameters
    ----------
    run : Run
    link_distance_m : float [m]

    Raises
    ------
    MeasurementError
        Where the run has neither channel.
    """
    estimated = any(f.kind == "estimated_torque" for f in run.integrity.findings)
    if "torque" in run and "force" in run:
        if estimated:
            note = f"the torque channel is the robot's estimate: force * {link_distance_m:g} m is used instead (2.1.1)"
            return TorqueSource(run["force"] * link_distance_m, "force", note)
        note = "the file has torque and force: torque is used, force and the link distance are not"
        return TorqueSource(run["torque"], "torque", note)
    if "torque" in run:
        return TorqueSource(run["torque"], "torque", None)
    if "force" in run:
        note = f"torque = force * {link_distance_m:g} m (Annex I 10)"
        return TorqueSource(run["force"] * link_distance_m, "force", note)
    raise MeasurementError(
        "there is neither torque nor force",
        run.name,
        'Name the load cell\'s column: --map force="COLUMN" or --map torque="COLUMN*0.52".',
    )
