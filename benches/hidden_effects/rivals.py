"""How alike two effects look in one set of movements: the largest cosine that any rival reaches."""

from __future__ import annotations

import math

from luztar.diagnosis.candidates import try_all
from luztar.diagnosis.fit import fit_prepared
from luztar.diagnosis.floor import NoiseFloor
from luztar.diagnosis.prepare import prepare

from .cases import Case, Measured


def cosines(case: Case, measured: Measured, floor: NoiseFloor) -> dict[str, float]:
    """Return, per rival, the cosine between what is hidden and the nearest the rival can come to it.

    From the torque without noise, weighed as the noisy one: of what the model as given leaves, a rival refitted with
    its best inner parameters takes away the square of the cosine.
    """
    start = case.start()
    fitted = fit_prepared(start, prepare(measured.clean, start), (), floor)
    found, _ = try_all(fitted)
    # A candidate that is always folded into what is hidden (another word for it) is no rival.
    same = {c.name for c in found if c.card.becomes in case.right and not c.card.inner}
    losses = {c.name: c.search.loss for c in found if not c.card.is_decoy and c.name not in same}
    least = min((losses[n] for n in case.right if n in losses), default=math.nan)
    whole = fitted.search.loss - least
    if not whole > 0.0:
        return {}
    taken = {n: (fitted.search.loss - loss) / whole for n, loss in losses.items() if n not in case.right}
    return {n: math.sqrt(min(max(share, 0.0), 1.0)) for n, share in taken.items()}
