"""What is left of a batch: a few numbers per lane, and which lanes are done."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import ParameterError

_SHARES = (5.0, 50.0, 95.0)


@dataclass(frozen=True, eq=False)
class Summary(Mapping[str, np.ndarray]):
    """What :func:`summarise` returns: a mapping of names to arrays, one value or row per lane that is done.

    Attributes
    ----------
    kept : mapping of str to ndarray, shape (k,) or (k, m)
        The kept numbers of the lanes that are done, in the order of ``done``.
    lanes : int
        How many were asked for.
    done : ndarray of int, shape (k,)
        The lanes that are done, increasing; all of them unless the batch was interrupted.
    inputs : str
        A digest of what was asked for, so that a batch is only ever gone on with as it was begun.
    """

    kept: Mapping[str, np.ndarray]
    lanes: int
    done: np.ndarray
    inputs: str = field(repr=False)

    def __getitem__(self, name: str) -> np.ndarray:
        return self.kept[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.kept)

    def __len__(self) -> int:
        return len(self.kept)

    @property
    def complete(self) -> bool:
        """Whether every lane is done."""
        return self.done.size == self.lanes

    def to_dict(self) -> dict[str, Any]:
        """Return the summary as plain JSON values."""
        values = {name: array.tolist() for name, array in self.kept.items()}
        return {"lanes": self.lanes, "done": self.done.tolist(), "values": values}

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the summary as a NumPy archive (.npz), for :meth:`load`."""
        told = json.dumps({"schema": 1, "lanes": self.lanes, "inputs": self.inputs})
        with open(path, "wb") as file:
            np.savez(file, **{f"value.{k}": v for k, v in self.kept.items()}, done=self.done, told=np.array(told))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Summary:
        """Read a summary that :meth:`save` wrote.

        Raises
        ------
        ParameterError
            Where the file is none.
        """
        try:
            with np.load(path, allow_pickle=False) as file:
                told = json.loads(str(file["told"]))
                values = {k.removeprefix("value."): file[k] for k in file.files if k.startswith("value.")}
                return cls(values, int(told["lanes"]), file["done"], str(told["inputs"]))
        except (OSError, KeyError, ValueError) as error:
            raise ParameterError(f"no summary: {error}", str(path), "Give a file written by Summary.save.") from None

    def __str__(self) -> str:
        lines = [f"{self.done.size} of {self.lanes} lanes" if not self.complete else f"{self.lanes} lanes"]
        width = max((len(name) for name in self.kept), default=0)
        lines.append(f"{'':<{width}}" + "".join(f"{f'{share:g} %':>13}" for share in _SHARES))
        for name, array in self.kept.items():
            if array.ndim == 1 and array.size:
                shown = np.percentile(array, _SHARES)
                lines.append(f"{name:<{width}}" + "".join(f"{value:>13.5g}" for value in shown))
            else:
                lines.append(f"{name:<{width}}  {' x '.join(map(str, array.shape))} values")
        return "\n".join(lines)

    __repr__ = __str__
