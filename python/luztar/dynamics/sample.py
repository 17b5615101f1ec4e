"""Parameters drawn from distributions, one set per lane, numbered: lane 17 is the same whoever draws it."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from .._arrays import whole_number
from ..errors import ParameterError
from .distributions import Distribution, distribution

METHODS = ("random", "sobol")
# Sobol's sequence as SciPy makes it ends here.
SOBOL_LANES = 2**30
# Four numbers of 64 bits for each count of the generator.
PER_COUNT = 4


def sample(
    parameters: Mapping[str, Any],
    lanes: int,
    *,
    seed: int = 0,
    first: int = 0,
    method: str = "random",
) -> dict[str, Any]:
    """Draw parameters for many lanes, ready for :func:`simulate` and :func:`summarise`.

    Parameters
    ----------
    parameters : mapping of str to number, Uniform, Normal, LogNormal, Choice or mapping
        What is a number stays one. A mapping is a distribution as it stands in a file: ``{"uniform": [4, 12]}``.
    lanes : int
    seed : int, 0 <= seed < 2**64
    first : int
        The number of the first lane drawn: shards draw their own part of the same whole.
    method : {"random", "sobol"}
        ``random``: each lane and parameter has its own number from a counter-based generator (Philox), so that a
        parameter keeps its values when others come or go. ``sobol``: a scrambled sequence that fills the space evenly;
        means over the lanes then converge faster, best with a power of 2 of them.

    Returns
    -------
    dict of str to float or ndarray, shape (lanes,)
        The same bits for the same seed whatever the shards. Across machines this holds for uniform and choice; normal
        and lognormal go through SciPy's and NumPy's functions, which may differ in the last bit between versions and
        processors, as may SciPy's scrambling.

    Raises
    ------
    ParameterError
        Names the parameter whose distribution makes no sense.

    Examples
    --------
    >>> import luztar
    >>> from luztar.dynamics import Normal, Uniform, sample
    >>> drawn = sample({"steering.ratio": 16.0, "coulomb.level_nm": Uniform(4, 12),
    ...                 "freeplay.gap_rad": Normal(0.1, 0.02, low=0.0)}, 1000, seed=7)
    >>> drawn["steering.ratio"], drawn["coulomb.level_nm"].shape
    (16.0, (1000,))
    >>> part = sample({"coulomb.level_nm": Uniform(4, 12)}, 10, seed=7, first=990)
    >>> bool((part["coulomb.level_nm"] == drawn["coulomb.level_nm"][990:]).all())
    True
    """
    lanes = whole_number("lanes", lanes, 1, 2**40)
    first = whole_number("first", first, 0, 2**40)
    seed = whole_number("seed", seed, 0, 2**64 - 1)
    if method not in METHODS:
        raise ParameterError(f"there is no method {method!r}", "method", f"Known are: {', '.join(METHODS)}.")
    made = {key: distribution(key, given) for key, given in parameters.items()}
    drawn = sorted(key for key, value in made.items() if isinstance(value, Distribution))
    if method == "sobol" and drawn:
        shares = dict(zip(drawn, _sobol(len(drawn), lanes, first, seed).T, strict=True))
    else:
        shares = {key: _random(key, lanes, first, seed) for key in drawn}
    return {key: value.quantiles(shares[key]) if key in shares else value for key, value in made.items()}


def _random(name: str, lanes: int, first: int, seed: int) -> np.ndarray:
    """Return numbers inside (0, 1), one per lane, of a parameter's own stream."""
    stream = int.from_bytes(hashlib.blake2b(name.encode(), digest_size=8).digest(), "little")
    bits = np.random.Philox(key=np.array([seed, stream], dtype=np.uint64))
    bits.advance(first // PER_COUNT)
    skipped = first % PER_COUNT
    return _inside(bits.random_raw(lanes + skipped)[skipped:] >> np.uint64(11), 53)


def _sobol(dimensions: int, lanes: int, first: int, seed: int) -> np.ndarray:
    from scipy.stats import qmc

    if first + lanes > SOBOL_LANES:
        raise ParameterError(f"Sobol's sequence ends after {SOBOL_LANES} lanes", "lanes", 'Take method="random".')
    bits = np.random.Generator(np.random.Philox(seed))
    made = qmc.Sobol(dimensions, scramble=True, seed=bits)
    if first:
        made.fast_forward(first)
        points = made.random(lanes)
    else:
        # A first draw of one point: SciPy warns of a first draw that is no power of 2, which is no mistake here.
        points = np.concatenate([made.random(1), made.random(lanes - 1)]) if lanes > 1 else made.random(1)
    return _inside(np.rint(points * 2.0**30), 30)


def _inside(counts: np.ndarray, bits: int) -> np.ndarray:
    """Return the middles of the 2**bits cells of (0, 1): never 0, never 1, where a normal has no value."""
    return np.minimum((counts + 0.5) * 2.0**-bits, 1.0 - 2.0**-53)
