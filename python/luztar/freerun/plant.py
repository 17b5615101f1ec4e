"""What a structure tells about how it is run freely: channels, parameters, starts of the searches."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from ..model import Card, Model, card, cards
from ..model.cards import own_cards

if TYPE_CHECKING:
    from ..measurement import Run
    from .parameters import Parameters
    from .record import Record

# What an effect has where it is to do next to nothing, as a share of what is large for it.
NEXT_TO_NOTHING = 1e-3


class Plant(ABC):
    """One kind of mechanism. The fits, tests and studies know no other door to it.

    Attributes
    ----------
    start_s : float
        What the model does not know of the start has died away after this time.
    scaled : bool
        Whether every channel out is taken in multiples of its noise: needed where there are several.
    first : tuple of str
        Effects that are fitted together with the bare mechanism.
    grids : mapping
        Start values of an effect's parameters, as shares of their sizes: of those that move events or have several
        valleys.
    structure_grid : mapping
        The same for the bare mechanism.
    least_share : mapping
        What must be above 0, and how far below its size the search goes.
    one_sided : frozenset of str
        What may not be negative, whatever its card says.
    choices : frozenset of str
        What is no size but one of two kinds.
    pairs : mapping
        What separates two effects, in words.
    """

    start_s: ClassVar[float]
    scaled: ClassVar[bool] = False
    first: ClassVar[tuple[str, ...]] = ("viscous", "offset")
    grids: ClassVar[Mapping[str, Mapping[str, tuple[float, ...]]]]
    structure_grid: ClassVar[Mapping[str, tuple[float, ...]]]
    least_share: ClassVar[Mapping[str, float]]
    one_sided: ClassVar[frozenset[str]]
    choices: ClassVar[frozenset[str]] = frozenset()
    pairs: ClassVar[Mapping[frozenset[str], str]]

    @abstractmethod
    def require(self, model: Model) -> None:
        """Refuse a model that lacks what these channels cannot show.

        Raises
        ------
        ModelError
        """

    @abstractmethod
    def outputs(self, model: Model) -> tuple[str, ...]:
        """Return the channels that the model can explain; those that every run holds are compared."""

    @abstractmethod
    def drives(self, model: Model, run: Run) -> dict[str, np.ndarray]:
        """Return what drives the model, by channel, as the simulation takes it."""

    @abstractmethod
    def start(self, model: Model, run: Run, drives: Mapping[str, np.ndarray]) -> tuple[float, ...]:
        """Return what is known of the state at the first sample."""

    @abstractmethod
    def sizes(self, records: Sequence[Record], model: Model) -> Mapping[str, float]:
        """Return a positive size for every parameter there may be: scales, and where searches start."""

    @abstractmethod
    def predict(self, parameters: Parameters, records: Sequence[Record], values: np.ndarray) -> list[np.ndarray]:
        """Return what value sets predict.

        Parameters
        ----------
        parameters : Parameters
        records : sequence of Record
        values : ndarray, shape (lanes, len(parameters.free))

        Returns
        -------
        list of ndarray, shape (lanes, n, outputs)
            One per run, in the channels' SI units. A lane that cannot be simulated is infinite.
        """

    def stroke_channel(self, model: Model) -> str:
        """Return the channel whose reversals part the strokes."""
        return model.structure.motion

    def keys(self, model: Model) -> tuple[str, ...]:
        """Return the keys of all parameters that the model has, those of the structure first."""
        return keys_of(model)

    def whole(self, key: str) -> bool:
        """Whether a parameter that has no start value stands at its size; else it stands at 0."""
        return key.startswith(("steering.", "viscous.")) or key == "stribeck.speed_rad_s"

    def sizes_for(self, effect: str, found: Mapping[str, float]) -> Mapping[str, float]:
        """Return sizes that what was found without the effect gives better than the records do."""
        return {}

    def nothing(self, key: str, size: float) -> float | None:
        """Return the value at which a parameter does next to nothing; None leaves it where it is."""
        return None if key == "stribeck.speed_rad_s" else NEXT_TO_NOTHING * size

    def candidates(self, model: Model, records: Sequence[Record]) -> tuple[Card, ...]:
        """Return the cards of the effects that a diagnosis of these records tries."""
        return tuple(
            c
            for c in cards(model.structure_name)
            if c.name not in model.effects
            and c.is_searched_on(model.structure_name)
            and (c.needs is None or c.needs in model.effects)
        )

    def same_as(self, card: Card, solved: Mapping[str, float], moved: Motion) -> str | None:
        """Return the simpler effect that a candidate came out as.

        Parameters
        ----------
        card : Card
        solved : mapping
            The parameters of the model with the candidate.
        moved : Motion
            How the model without it moves.
        """
        return None


@dataclass(frozen=True)
class Motion:
    """How a fitted model moves along its records.

    Attributes
    ----------
    model : Model
    records : sequence of Record
    simulated : sequence of ndarray, shape (n, outputs)
    """

    model: Model
    records: Sequence[Record]
    simulated: Sequence[np.ndarray]


def keys_of(model: Model) -> tuple[str, ...]:
    """Return the keys of the structure's own parameters, then those of the effects."""
    every = (*own_cards(model.structure_name), *(card(e, model.structure_name) for e in model.effects))
    return tuple(f"{c.name}.{p.key}" for c in every for p in c.parameters)
