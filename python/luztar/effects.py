"""The effects by class name: ``luztar.effects.Stribeck(speed_rad_s=0.1)`` adds start values to ``model + effect``."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from .errors import ModelError, ParameterError
from .model.cards import card, cards
from .model.model import Effect

if TYPE_CHECKING:
    from .planning.looks import Look


def _class_name(name: str) -> str:
    return "".join(part.capitalize() for part in name.split("_"))


def _maker(name: str) -> Callable[..., Effect]:
    keys = {p.key for s in ("rig", "axis") for p in card(name, s).parameters}

    def make(**start: float) -> Effect:
        unknown = sorted(set(start) - keys)
        if unknown:
            remedy = f"It has: {', '.join(sorted(keys)) or 'none'}."
            raise ParameterError(f"{name} has no parameter {', '.join(unknown)}", _class_name(name), remedy)
        return Effect(name, dict(start))

    make.__name__ = make.__qualname__ = _class_name(name)
    make.__doc__ = f"{card(name).title}: {card(name).equation}. {card(name).look}"
    return make


_MAKERS = {_class_name(c.name): c.name for c in cards() if not c.is_decoy}


def look(effect: str) -> Look:
    """Return what an effect looks like on a friction rig: torque over angle with and without it; see ``.figure()``."""
    from .planning.looks import look

    return look(effect)


def __getattr__(name: str) -> Callable[..., Effect]:
    if name in _MAKERS:
        return _maker(_MAKERS[name])
    if name.startswith("_"):
        raise AttributeError(name)
    raise AttributeError(str(ModelError(f"there is no effect '{name}'", "effects", f"Known: {', '.join(_MAKERS)}.")))


def __dir__() -> list[str]:
    return sorted([*_MAKERS, "look"])
