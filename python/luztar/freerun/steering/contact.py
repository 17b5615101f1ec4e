"""Which effects exclude each other at the contact of one mass."""

from __future__ import annotations

from collections.abc import Collection

from ...errors import ModelError
from ...model import Model

# On an elastic contact nothing is at rest: what is felt at rest only is no part of it.
APART: tuple[frozenset[str], ...] = (frozenset({"presliding", "stiction"}), frozenset({"presliding", "dwell"}))


def are_apart(effects: Collection[str]) -> bool:
    """Return whether two of some effects exclude each other in a free run."""
    return any(pair <= set(effects) for pair in APART)


def require_one_contact(model: Model) -> None:
    """Refuse a model whose contact is elastic and rigid at once.

    Raises
    ------
    ModelError
    """
    if are_apart(model.effects):
        others = " and ".join(e for e in ("stiction", "dwell") if e in model.effects)
        remedy = f"Take out presliding or {others}; stribeck goes with presliding."
        raise ModelError(f"presliding leaves nothing at rest, where {others} is felt", "effects", remedy)
