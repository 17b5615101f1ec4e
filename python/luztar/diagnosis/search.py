"""Fitting with held-out prediction: every state visited by the search is judged by all folds at once.

A fold takes the visited state that leaves least on the strokes it was trained on, so that the inner parameters of a
prediction have not seen the stroke they predict.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .folds import Folds
from .polish import polish
from .profile import ROUNDS, Problem, State, refine


@dataclass
class Search:
    """The best state on all strokes and, per fold, on its training strokes.

    Attributes
    ----------
    folds : Folds
    best : State or None
    fold_states : list of State or None
    losses : ndarray, shape (strokes,)
        Held-out sum of squares of every stroke.
    """

    folds: Folds
    best: State | None = None

    def __post_init__(self) -> None:
        self.fold_states: list[State | None] = [None] * self.folds.count
        self._training = np.full(self.folds.count, np.inf)
        self.losses = np.full(self.folds.of_stroke.size, np.nan)
        self._least = np.inf

    def visit(self, state: State) -> None:
        """Let all folds judge a state."""
        losses, training = state.blocks.held_out(self.folds)
        for k in np.flatnonzero(training < self._training):
            inside = self.folds.of_stroke == k
            self.fold_states[k] = state
            self._training[k] = training[k]
            self.losses[inside] = losses[inside]
        if state.loss < self._least:
            self._least, self.best = state.loss, state

    @property
    def loss(self) -> float:
        """The least sum of squares on all strokes."""
        return self._least

    @property
    def held_out_loss(self) -> float:
        """The held-out sum of squares of all strokes."""
        return float(self.losses.sum())

    def refine(self, problem: Problem, only: str | None = None, rounds: int = ROUNDS) -> None:
        """Refine the best state, letting the folds judge every step."""
        assert self.best is not None
        refine(problem, self.best, only=only, rounds=rounds, visit=self.visit)

    def polish(self, problem: Problem) -> None:
        """Step all inner parameters of the best state together."""
        assert self.best is not None
        polish(problem, self.best, self.visit)
