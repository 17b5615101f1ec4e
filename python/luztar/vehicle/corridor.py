"""The corridor that a car has to stay in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import refuse_not_finite
from ..errors import ParameterError


@dataclass(frozen=True)
class Corridor:
    """Sections with straight edges; between them the car is free.

    Parameters
    ----------
    from_m, to_m : array_like, shape (sections,) or (cars, sections)
        Where a section begins and ends, along x.
    right_m, left_m : array_like
        Its edges (y, left positive) where it begins.
    right_to_m, left_to_m : array_like, optional
        Its edges where it ends; the same where not given.

    Raises
    ------
    ParameterError
        Shapes that do not fit, values that are not finite. Sections that end before they begin are refused by a run.

    Examples
    --------
    >>> import luztar
    >>> lane = luztar.vehicle.Corridor(from_m=[0.0, 45.0], to_m=[15.0, 70.0], right_m=[-1.1, 2.4], left_m=[1.1, 4.9])
    """

    from_m: Any
    to_m: Any
    right_m: Any
    left_m: Any
    right_to_m: Any = None
    left_to_m: Any = None

    def __post_init__(self) -> None:
        given = {
            "from_m": self.from_m,
            "to_m": self.to_m,
            "right_m": self.right_m,
            "left_m": self.left_m,
            "right_to_m": self.right_m if self.right_to_m is None else self.right_to_m,
            "left_to_m": self.left_m if self.left_to_m is None else self.left_to_m,
        }
        try:
            arrays = np.broadcast_arrays(*(np.asarray(v, dtype=np.float64) for v in given.values()))
        except (TypeError, ValueError) as problem:
            raise ParameterError(
                f"sections do not fit together: {problem}", "corridor", "Give one value each."
            ) from None
        for name, array in zip(given, arrays, strict=True):
            if not 1 <= array.ndim <= 2 or array.size == 0:
                raise ParameterError(
                    f"sections have the shape {array.shape}", name, "Give (sections,) or (cars, sections) values."
                )
            refuse_not_finite(name, array)
            kept = np.array(array)
            kept.flags.writeable = False
            object.__setattr__(self, name, kept)

    @property
    def cars(self) -> int | None:
        """How many cars it speaks of; None for all alike."""
        return len(self.from_m) if self.from_m.ndim == 2 else None

    @property
    def sections(self) -> int:
        """How many sections it has."""
        return int(self.from_m.shape[-1])

    def laid_out(self, part: slice) -> np.ndarray:
        """Return what the core takes, for some of the cars."""
        fields = (self.from_m, self.to_m, self.right_m, self.right_to_m, self.left_m, self.left_to_m)
        chosen = [f[part] if self.cars is not None else f for f in fields]
        return np.ascontiguousarray(np.stack(chosen, axis=-1)).ravel()
