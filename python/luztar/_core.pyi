from collections.abc import Sequence
from typing import Literal, TypedDict, final, type_check_only

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Filter",
    "LineSums",
    "LowPass",
    "Moments",
    "Recording",
    "__version__",
    "effect_cards",
    "fit_line",
    "held_out",
    "normal_equations",
    "project",
    "simulate_steering",
    "solve_block",
    "steering_parameters",
    "trace_steering",
    "zero_phase",
]

__version__: str

# signal

@final
class LowPass:
    def __new__(
        cls, poles: int, cutoff_hz: float, sample_rate_hz: float, forward_backward: bool, overall: bool
    ) -> LowPass: ...
    def describe(self) -> str: ...
    def magnitude(self, frequency_hz: float) -> float: ...
    def settle_samples(self, tolerance: float) -> int: ...
    @property
    def designed_at_hz(self) -> float: ...
    @property
    def delay_s(self) -> float: ...
    @property
    def settle_s(self) -> float: ...

@final
class Filter:
    def __new__(cls, low_pass: LowPass) -> Filter: ...
    def push_into(self, x: NDArray[np.float64], out: NDArray[np.float64]) -> None: ...
    def push_in_place(self, x: NDArray[np.float64]) -> None: ...
    def reset(self, level: float | None) -> None: ...
    def copy(self) -> Filter: ...
    def state(self) -> NDArray[np.float64]: ...
    def restore(self, state: NDArray[np.float64]) -> None: ...

def zero_phase(
    low_pass: LowPass, tolerance: float | None, x: NDArray[np.float64], out: NDArray[np.float64]
) -> None: ...

# stats

@final
class Moments:
    def __new__(cls) -> Moments: ...
    def push(self, x: NDArray[np.float64]) -> None: ...
    def merge(self, later: Moments) -> None: ...
    def copy(self) -> Moments: ...
    @property
    def count(self) -> int: ...
    @property
    def mean(self) -> float | None: ...
    @property
    def variance_population(self) -> float | None: ...
    @property
    def variance_sample(self) -> float | None: ...
    @property
    def std_population(self) -> float | None: ...
    @property
    def std_sample(self) -> float | None: ...
    @property
    def rms(self) -> float | None: ...
    @property
    def min(self) -> tuple[float, int] | None: ...
    @property
    def max(self) -> tuple[float, int] | None: ...
    def state(self) -> tuple[int, list[float], int, int]: ...
    @staticmethod
    def from_state(count: int, state: list[float], min_index: int, max_index: int) -> Moments: ...

# regression

_Line = tuple[float, float, float | None, float | None, float, float | None, int]

def fit_line(x: NDArray[np.float64], y: NDArray[np.float64]) -> _Line: ...

@final
class LineSums:
    def __new__(cls) -> LineSums: ...
    def push(self, x: NDArray[np.float64], y: NDArray[np.float64]) -> None: ...
    def merge(self, other: LineSums) -> None: ...
    def copy(self) -> LineSums: ...
    @property
    def count(self) -> int: ...
    def fit(self) -> _Line: ...
    def state(self) -> tuple[int, list[float]]: ...
    @staticmethod
    def from_state(count: int, state: list[float]) -> LineSums: ...

# effects

@type_check_only
class _Parameter(TypedDict):
    key: str
    symbol: str
    meaning: str
    low: float
    high: float
    role: Literal["linear", "amplitude", "phase", "inner"]
    grid: tuple[str, float, float] | None

@type_check_only
class _Card(TypedDict):
    name: str
    title: str
    kind: Literal["torque", "friction_level", "spring", "transmission", "sensor", "decoy"]
    equation: str
    look: str
    cause: str
    check: str
    typical: str
    source: str
    behind_gap: bool
    per_turn: bool
    shapes_others: bool
    becomes: str | None
    channel: str | None
    needs: str | None
    parameters: list[_Parameter]

def effect_cards() -> list[_Card]: ...

# driven runs

_Rows = tuple[int, int, float]
_Terms = Sequence[tuple[str, Sequence[float]]]

@final
class Recording:
    def __new__(
        cls,
        position: NDArray[np.float64],
        *,
        sample_rate_hz: float,
        band_hz: float,
        decimate: int | None,
        anti_alias: bool,
        already_filtered: bool,
        hysteresis: float,
        minimum_travel: float,
        turn_rad_per_unit: float,
        load_n: NDArray[np.float64] | None,
    ) -> Recording: ...
    def __getnewargs_ex__(self) -> tuple[tuple[NDArray[np.float64]], dict[str, object]]: ...
    def __len__(self) -> int: ...
    @property
    def resolution(self) -> float: ...
    @property
    def slowest_speed(self) -> float: ...
    @property
    def range(self) -> float: ...
    @property
    def decimate(self) -> int: ...
    def kept(self) -> list[NDArray[np.float64]]: ...
    def strokes(self) -> list[tuple[int, int, float, float]]: ...
    def measured(self, channel: NDArray[np.float64]) -> NDArray[np.float64]: ...
    def start_shift(self, model: _Terms) -> NDArray[np.float64]: ...
    def columns(self, model: _Terms, wanted: Sequence[int]) -> NDArray[np.float64]: ...
    def normal_equations(
        self,
        model: _Terms,
        given: Sequence[tuple[int, float]],
        effort: NDArray[np.float64],
        strokes: Sequence[_Rows],
    ) -> NDArray[np.float64]: ...

def normal_equations(columns: NDArray[np.float64], strokes: Sequence[_Rows]) -> NDArray[np.float64]: ...
def solve_block(block: NDArray[np.float64], bound: float) -> NDArray[np.float64]: ...
def held_out(
    products: NDArray[np.float64], fold_of: Sequence[int], folds: int, bound: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...

# dynamics

def steering_parameters() -> list[str]: ...
def simulate_steering(
    parameters: NDArray[np.float64],
    starts: NDArray[np.float64],
    handwheel_rad: NDArray[np.float64],
    load_nm: NDArray[np.float64] | None,
    *,
    sample_rate_hz: float,
    substeps: int,
    method: str,
    width: str,
    phi: NDArray[np.float64],
    speed: NDArray[np.float64] | None,
) -> None: ...
def trace_steering(
    parameters: NDArray[np.float64],
    start: tuple[float, float],
    handwheel_rad: NDArray[np.float64],
    load_nm: NDArray[np.float64] | None,
    *,
    sample_rate_hz: float,
    substeps: int,
    method: str,
) -> tuple[NDArray[np.float64], NDArray[np.float64], list[tuple[float, str, float]], list[tuple[str, float]]]: ...

# projections

def project(
    name: str,
    x: NDArray[np.float64],
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    start: float,
    out: NDArray[np.float64],
) -> None: ...
