"""Whether the effort that a look compares was cut off by its channel's range: nothing is named from such data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..errors import DoubtfulError
from ..model import Model
from .prepare import Prepared

if TYPE_CHECKING:
    from ..measurement import Run

# Up to this share of the compared samples is a trifle: of a minute 0.06 s, the peak of one start. What is cut off at
# many starts or in whole strokes bends the very curve that names rest on.
CLIPPED_SHARE = 0.001


def with_doubt(prepared: Prepared, run: Run, model: Model) -> Prepared:
    """Return the run with what stands against naming an effect from it, if anything does.

    Parameters
    ----------
    prepared : Prepared
    run : Run
        Whose findings say where a channel stays at its extreme.
    model : Model
    """
    channel = model.structure.effort
    clipped = [f for f in run.integrity.findings if f.kind == "clipped" and f.channel == channel]
    if not clipped or not prepared.usable.any():
        return prepared
    compared = prepared.time_s[prepared.usable] + run.time_s[0]
    begins, ends = float(compared[0]), float(compared[-1]) + prepared.step_s
    parts = [(max(a, begins), min(b, ends)) for a, b in clipped[0].stretches_s()]
    share = sum(b - a for a, b in parts if b > a) / (ends - begins)
    if share <= CLIPPED_SHARE:
        return prepared
    rows = np.isfinite(run[channel])
    low, high = float(run[channel][rows].min()), float(run[channel][rows].max())
    at = [v for v in (low, high) if _stays(run, channel, v, clipped[0].stretches_s())]
    levels = " and ".join(f"{v:.6g}" for v in at)
    return replace(
        prepared,
        doubt=(
            f"the {channel} stays at {levels} {model.structure.effort_unit}, the end of its range, in "
            f"{100.0 * share:.2g} % of the samples compared: it is clipped"
        ),
    )


def _stays(run: Run, channel: str, value: float, stretches_s: Sequence[tuple[float, float]]) -> bool:
    first = np.searchsorted(run.time_s, [a for a, _ in stretches_s])
    return bool((run[channel][np.minimum(first, len(run) - 1)] == value).any())


def require_trustworthy(runs: Sequence[Prepared]) -> None:
    """Refuse to look for what is missing in runs that something stands against.

    Raises
    ------
    DoubtfulError
        Names the first such run, the level and the share.
    """
    for r in runs:
        if r.doubt:
            raise DoubtfulError(
                f"{r.doubt}; nothing is named from that",
                r.name,
                "Record with a wider range, or leave the run out. fit and compare still show what it holds.",
            )
