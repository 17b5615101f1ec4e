"""What each effect would add to a test, and how well another could imitate it, from one table of products.

Every effect is made into columns on the test's motion by the core, at typical inner parameters and over the grid on
which a search would look for them; an effect that shapes the contact is the difference of the modelled torque with and
without it. The columns are filtered like a measurement and multiplied with each other once. What the model in use
explains is taken off (a Schur complement); lengths and angles between what is left say the rest.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..diagnosis.equations import Weights, start_uncertainty_s
from ..diagnosis.prepare import Prepared
from ..diagnosis.profile import owners
from ..diagnosis.terms import Terms, inner_grid, start_terms
from ..model import Card, Model, cards
from .rehearse import Sensor, every_stroke, minutes
from .typical import Reach, typical_inner

# Beyond this many points of a grid neighbours are the same within a per cent of the effect's power.
MOST_POINTS = 40
# What is left of a column below this share of its length is rounding.
NOTHING = 1e-7


@dataclass(frozen=True)
class Variant:
    """One effect at one set of inner parameters.

    Attributes
    ----------
    effect : str
    inner : tuple of float
    at : slice
        Its columns in the table of products.
    """

    effect: str
    inner: tuple[float, ...]
    at: slice


@dataclass(frozen=True)
class Signatures:
    """What the effects of the catalogue add to one test.

    Attributes
    ----------
    model : Model
        The model in use; what it explains is taken off.
    products : ndarray, shape (q, q)
        Of all columns, what the model explains taken off, over the variance of one kept sample: a diagonal entry is
        the square of the standard errors of an effect of size one.
    typical : mapping of str to Variant
    grid : mapping of str to tuple of Variant
    start_s : float
        By how much the instant of a start is uncertain.
    strokes, samples : int
    minutes : float
    """

    model: Model
    products: np.ndarray = field(repr=False)
    typical: Mapping[str, Variant] = field(repr=False)
    grid: Mapping[str, tuple[Variant, ...]] = field(repr=False)
    start_s: float
    strokes: int
    samples: int
    minutes: float

    @property
    def effects(self) -> tuple[str, ...]:
        """The effects looked at."""
        return tuple(self.typical)

    def strength(self, variant: Variant) -> float:
        """Return the standard errors of a variant of size one; of the worse phase where it has one."""
        block = self.products[variant.at, variant.at]
        return math.sqrt(max(0.0, float(np.linalg.eigvalsh(block)[0])))

    def cosine(self, effect: str, rival: str) -> float:
        """Return how well a rival can imitate an effect at its typical inner parameters.

        1 where the rival, at the best of its own inner parameters and sizes, leaves nothing of it; of an effect with a
        phase, at the phase that is imitated best.
        """
        if (effect, rival) not in self._cosines:
            mine = self.typical[effect]
            self._cosines[effect, rival] = max((self.alike(mine, other) for other in self.grid[rival]), default=0.0)
        return self._cosines[effect, rival]

    def alike(self, a: Variant, b: Variant) -> float:
        """Return the cosine of the smallest angle between what two variants add to what the model explains."""
        between = self._directions[a.at, b.at]
        if between.size == 1:
            return min(1.0, abs(float(between[0, 0])))
        return float(min(1.0, np.linalg.svd(between, compute_uv=False)[0]))

    @functools.cached_property
    def _cosines(self) -> dict[tuple[str, str], float]:
        return {}

    @functools.cached_property
    def _directions(self) -> np.ndarray:
        """The products of all columns made orthonormal within each variant; nothing where nothing is left of it."""
        whiten = np.zeros_like(self.products)
        for variant in (v for grid in self.grid.values() for v in grid):
            try:
                root = np.linalg.cholesky(self.products[variant.at, variant.at])
            except np.linalg.LinAlgError:
                continue
            whiten[variant.at, variant.at] = np.linalg.inv(root)
        return whiten @ self.products @ whiten.T


def signatures(
    runs: Sequence[Prepared],
    model: Model,
    sensor: Sensor,
    sound: Mapping[str, float],
    only: Iterable[str] | None = None,
) -> Signatures:
    """Make the table of products for the runs of one test.

    Parameters
    ----------
    runs : sequence of Prepared
        Rehearsed.
    model : Model
        The model in use.
    sensor : Sensor
    sound : mapping of str to float
        First coefficient of effects of the model: what an effect that shapes the contact acts upon.
    only : iterable of str, optional
        The effects to look at; all that have a meaning where not given.
    """
    base = start_terms(model, runs)
    nominal = np.array([sound.get(name, 0.0) if i == 0 else 0.0 for name, i in owners(base, model)])
    wanted = None if only is None else set(only)
    looked_at = [
        c for c in cards(model.structure_name) if _has_meaning(c, model) and (wanted is None or c.name in wanted)
    ]
    reach = Reach.of(runs)
    typical: dict[str, Variant] = {}
    grid: dict[str, list[Variant]] = {}
    made = [[r.recording.columns(base.pairs(), list(range(len(base.effects)))).T] for r in runs]
    plain = [m[0] @ nominal for m in made]
    place = made[0][0].shape[1]
    for c in looked_at:
        usual = typical_inner(c, model, reach)
        for number, inner in enumerate([usual, *_thinned(inner_grid(c.name, model, runs))]):
            terms = base.having(c.name, inner)
            more = [added(r, terms, c, nominal, p) for r, p in zip(runs, plain, strict=True)]
            width = more[0].shape[1]
            variant = Variant(c.name, inner, slice(place, place + width))
            place += width
            for columns, column in zip(made, more, strict=True):
                columns.append(column)
            if number == 0:
                typical[c.name] = variant
            grid.setdefault(c.name, []).append(variant)
    level = abs(sound.get("coulomb", 0.0))
    variance = sensor.density(model.band_hz) / runs[0].step_s
    weights = Weights(sensor.noise_rms, max(level, 1e-9), model.band_hz)
    used = nominal.size
    gram, samples = _products(runs, made, base, weights)
    # The shift that all starts have in common is known to the uncertainty of a start.
    start_s = start_uncertainty_s(runs)
    gram[-1, -1] += variance / max(level * start_s, 1e-12) ** 2
    left = _freed(gram, [*range(used), gram.shape[0] - 1]) / variance
    shifted = {n: _moved(v, used) for n, v in typical.items()}
    return Signatures(
        model=model,
        products=left,
        typical=shifted,
        grid={n: tuple(_moved(v, used) for v in vs) for n, vs in grid.items()},
        start_s=start_s,
        strokes=len(every_stroke(runs)),
        samples=samples,
        minutes=minutes(runs),
    )


def _moved(v: Variant, by: int) -> Variant:
    return Variant(v.effect, v.inner, slice(v.at.start - by, v.at.stop - by))


def _has_meaning(c: Card, model: Model) -> bool:
    if not c.is_searched_on(model.structure_name) or c.is_decoy or c.channel or c.name in model.effects:
        return False
    if c.needs and c.needs not in model.effects:
        return False
    return not (c.per_turn and model.structure_name == "axis" and "pitch_m" not in model.known)


def _thinned(points: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
    if points == [()]:
        # Without inner parameters the typical variant is the only one.
        return []
    if len(points) <= MOST_POINTS:
        return points
    return [points[i] for i in np.unique(np.linspace(0, len(points) - 1, MOST_POINTS).round().astype(int))]


def added(r: Prepared, terms: Terms, c: Card, nominal: np.ndarray, plain: np.ndarray) -> np.ndarray:
    """Return what an effect adds: its own columns, or the change of the modelled torque where it shapes the contact."""
    index = terms.effects.index(c.name)
    if not c.shapes_others:
        return r.recording.columns(terms.pairs(), [index]).T
    others = [i for i in range(len(terms.effects)) if i != index]
    return (r.recording.columns(terms.pairs(), others).T @ nominal - plain)[:, None]


def _products(
    runs: Sequence[Prepared], made: Sequence[list[np.ndarray]], base: Terms, weights: Weights
) -> tuple[np.ndarray, int]:
    """Return the products of all columns and the common shift (last), each stroke's own shift eliminated."""
    total: np.ndarray | None = None
    samples = 0
    for r, columns in zip(runs, made, strict=True):
        table = np.column_stack([*columns, r.recording.start_shift(base.pairs())])
        for s in r.strokes:
            part = slice(s.first, s.last)
            a = table[part][r.usable[part]]
            gram = a.T @ a
            cross = gram[:, -1]
            gram = gram - np.outer(cross, cross) / (cross[-1] + weights.ridge(r.step_s, s.onset_uncertainty_s))
            total = gram if total is None else total + gram
            samples += len(a)
    assert total is not None
    return total, samples


def _freed(gram: np.ndarray, used: list[int]) -> np.ndarray:
    """Return the products of the other columns after a fit of the used ones."""
    rest = [i for i in range(gram.shape[0]) if i not in set(used)]
    scale = np.sqrt(np.maximum(np.diag(gram), np.finfo(float).tiny))
    scaled = gram / np.outer(scale, scale)
    inside = scaled[np.ix_(used, used)]
    across = scaled[np.ix_(used, rest)]
    left = scaled[np.ix_(rest, rest)] - across.T @ np.linalg.lstsq(inside, across, rcond=1e-12)[0]
    # A column that the model explains is left with rounding, which must not be compared with anything.
    gone = np.diag(left) < NOTHING
    left[gone, :] = 0.0
    left[:, gone] = 0.0
    outer = scale[rest]
    return left * np.outer(outer, outer)
