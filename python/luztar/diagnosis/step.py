"""One step of a study's ladder."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from .experiment import Experiment
from .fit import Fit


@dataclass(frozen=True)
class Step:
    """One step of the ladder.

    Attributes
    ----------
    added : str or None
        The effect added; None for the model as given.
    set : tuple of str
        What this step could not tell apart, the added one included.
    provisional : bool
        True where the study ended without an explanation.
    fit : Fit
    next_experiment : Experiment or None
        The test that would tell the set apart.
    """

    added: str | None
    set: tuple[str, ...]
    provisional: bool
    fit: Fit = field(repr=False)
    next_experiment: Experiment | None

    def to_dict(self) -> dict[str, Any]:
        """Return the step as the JSON interface prints it."""
        return {
            "added": self.added,
            "set": list(self.set),
            "provisional": self.provisional,
            "effects": list(self.fit.model.effects),
            "error": self.fit.error.to_dict(),
            "parameters": {k: v.to_dict() for k, v in self.fit.parameters.items()},
            "next_experiment": self.next_experiment.to_dict() if self.next_experiment else None,
        }
