"""luztar: friction and freeplay of steering mechanisms, measured, modelled, compared and named.

Importing this package loads NumPy and nothing else; everything below is loaded when it is first used.
"""

from __future__ import annotations

import importlib as _importlib
from typing import TYPE_CHECKING

from . import errors as errors
from ._core import __version__ as __version__

if TYPE_CHECKING:
    from . import regression as regression
    from . import signal as signal
    from . import stats as stats

_LAZY: dict[str, str] = {
    "regression": "regression",
    "signal": "signal",
    "stats": "stats",
}


def __getattr__(name: str) -> object:
    if name not in _LAZY:
        raise AttributeError(f"module 'luztar' has no attribute '{name}'")
    where = _LAZY[name]
    module = _importlib.import_module(f".{where.partition(':')[0]}", __name__)
    value = getattr(module, where.partition(":")[2]) if ":" in where else module
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(set(globals()) | set(_LAZY))
