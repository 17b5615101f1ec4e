"""Butterworth filters that say what they are: zero phase on a record, causal or with a fixed lag on a stream.

``poles`` always counts one pass. The words of a filter (:func:`describe_filter`, ``.describe()``) state poles, passes
and which -3.01 dB point the cut-off means.
"""

from __future__ import annotations

from .design import (
    EDGE_TOLERANCE,
    BandPass,
    BandStop,
    CutoffAt,
    Edges,
    HighPass,
    LowPass,
    Missing,
    describe_filter,
    instruction_sets,
)
from .extremes import extremes
from .fixed_lag import FixedLag
from .missing import stretches
from .presets import cfc, tb038
from .record import causal, derivative, zero_phase
from .stream import Filter, FilterBank
from .uneven import EvenRecord, resample

__all__ = [
    "EDGE_TOLERANCE",
    "BandPass",
    "BandStop",
    "CutoffAt",
    "Edges",
    "EvenRecord",
    "Filter",
    "FilterBank",
    "FixedLag",
    "HighPass",
    "LowPass",
    "Missing",
    "causal",
    "cfc",
    "derivative",
    "describe_filter",
    "extremes",
    "instruction_sets",
    "resample",
    "stretches",
    "tb038",
    "zero_phase",
]
