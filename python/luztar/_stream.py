"""Copies, pickles and states: of what is pushed into, in a form that fits into JSON, and of results."""

from __future__ import annotations

from types import MappingProxyType
from typing import Any, Self

from .errors import ParameterError

_SCHEMA = 1


def same_kind(other: Any, kind: type) -> None:
    """Refuse to merge with an object of another kind.

    Raises
    ------
    ParameterError
    """
    if not isinstance(other, kind):
        raise ParameterError(f"other is of the type {type(other).__name__}", "other", f"Give another {kind.__name__}.")


class Mappings:
    """Lets a frozen result with read-only mappings be copied and pickled: those are written as plain dicts."""

    __slots__ = ()

    def __getstate__(self) -> dict[str, Any]:
        return {k: dict(v) if isinstance(v, MappingProxyType) else v for k, v in vars(self).items()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        for name, value in state.items():
            object.__setattr__(self, name, MappingProxyType(value) if isinstance(value, dict) else value)


class Stream:
    """Adds copies and stored states to a class of the core that has ``state()`` and ``restore()``."""

    __slots__ = ()

    def copy(self) -> Self:
        """Return an independent object with the same content."""
        twin = type(self)()
        twin.__setstate__(self.__getstate__())
        return twin

    __copy__ = copy

    def __deepcopy__(self, _memo: Any) -> Self:
        return self.copy()

    def __getstate__(self) -> tuple[list[int], list[float]]:
        return self.state()  # type: ignore[attr-defined]

    def __setstate__(self, state: tuple[list[int], list[float]]) -> None:
        self.restore(*state)  # type: ignore[attr-defined]

    def to_state(self) -> dict[str, Any]:
        """Return everything as JSON values; Python's ``json`` keeps every bit of a float."""
        integers, numbers = self.__getstate__()
        # JSON has no infinity: limits that were never set are stored as words
        plain = [v if abs(v) != float("inf") else ("inf" if v > 0 else "-inf") for v in numbers]
        return {"schema": _SCHEMA, "kind": type(self).__name__, "integers": integers, "numbers": plain}

    @classmethod
    def from_state(cls, state: dict[str, Any]) -> Self:
        """Return an object that goes on where the stored one stood.

        Raises
        ------
        ParameterError
            Not the state of an object of this class.
        """
        try:
            known = (state["schema"], state["kind"]) == (_SCHEMA, cls.__name__)
            integers, numbers = list(state["integers"]), [float(v) for v in state["numbers"]]
        except (KeyError, TypeError, ValueError) as wrong:
            raise ParameterError(f"state is not one of to_state() ({wrong!r})", "state", "Store it anew.") from None
        if not known:
            raise ParameterError(
                f"state is of a {state['kind']}, schema {state['schema']}", "state", f"Give one of a {cls.__name__}."
            )
        made = cls()
        try:
            made.__setstate__((integers, numbers))
        except (TypeError, OverflowError) as wrong:
            raise ParameterError(f"state cannot be read: {wrong}", "state", "Store it anew.") from None
        return made
