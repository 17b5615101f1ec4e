"""luztar: friction and freeplay of steering mechanisms, measured, modelled, compared and named.

Importing this package loads NumPy and nothing else; everything below is loaded when it is first used.
"""

from __future__ import annotations

import importlib as _importlib
from typing import TYPE_CHECKING

from . import errors as errors
from ._core import __version__ as __version__

if TYPE_CHECKING:
    from . import dynamics as dynamics
    from . import effects as effects
    from . import manoeuvre as manoeuvre
    from . import measurement as measurement
    from . import mechanism as mechanism
    from . import model as model
    from . import projections as projections
    from . import regression as regression
    from . import signal as signal
    from . import stats as stats
    from . import tb038 as tb038
    from . import vehicle as vehicle
    from .diagnosis import compare as compare
    from .diagnosis import diagnose as diagnose
    from .diagnosis import fit as fit
    from .diagnosis import study as study
    from .measurement import Run as Run
    from .measurement import Runs as Runs
    from .measurement import read as read
    from .measurement import read_frame as read_frame
    from .model import Model as Model
    from .planning import plan as plan

_LAZY: dict[str, str] = {
    "Model": "model:Model",
    "Run": "measurement:Run",
    "Runs": "measurement:Runs",
    "compare": "diagnosis:compare",
    "diagnose": "diagnosis:diagnose",
    "dynamics": "dynamics",
    "effects": "effects",
    "fit": "diagnosis:fit",
    "manoeuvre": "manoeuvre",
    "measurement": "measurement",
    "mechanism": "mechanism",
    "model": "model",
    "plan": "planning:plan",
    "projections": "projections",
    "read": "measurement:read",
    "read_frame": "measurement:read_frame",
    "regression": "regression",
    "signal": "signal",
    "stats": "stats",
    "study": "diagnosis:study",
    "tb038": "tb038",
    "vehicle": "vehicle",
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
    return sorted({"__version__", "errors", *_LAZY})
