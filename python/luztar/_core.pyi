from collections.abc import Callable, Sequence
from typing import Any, Literal, Self, TypedDict, final, type_check_only

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import disjoint_base

__all__ = [
    "Bank",
    "Butterworth",
    "Counts",
    "Filter",
    "FixedLag",
    "LineSums",
    "LinearSums",
    "Mechanism",
    "MechanismStepper",
    "Moments",
    "PolynomialSums",
    "QuantileSketch",
    "Recording",
    "Recursive",
    "Rolling",
    "RollingLine",
    "RollingPolynomial",
    "ZeroPhase",
    "__version__",
    "car_names",
    "check_lanes",
    "drive_cars",
    "effect_cards",
    "even",
    "extremes",
    "fit_line",
    "fit_linear",
    "fit_polynomial",
    "held_out",
    "hold_or_slide",
    "huber",
    "instruction_sets",
    "lane_columns",
    "moments_by_label",
    "moments_by_window",
    "normal_equations",
    "project",
    "rolling",
    "run_lanes",
    "sampled_cubics",
    "simulate_steering",
    "solve_block",
    "whitened",
    "solve_bodies_exactly",
    "solve_steering_exactly",
    "steering_highest_rad_s",
    "steering_parameters",
    "theil_sen",
    "trace_steering",
]

__version__: str

# signal

@final
class Butterworth:
    def __new__(
        cls,
        poles: int,
        band: str,
        low_hz: float,
        high_hz: float,
        sample_rate_hz: float,
        passes: tuple[bool, bool],
        instruction_set: str,
    ) -> Butterworth: ...
    def describe(self) -> str: ...
    def magnitude(self, frequency_hz: float) -> float: ...
    def response(self, frequency_hz: float) -> list[float]: ...
    def settle_samples(self, tolerance: float) -> int: ...
    @property
    def designed_at_hz(self) -> list[float]: ...
    @property
    def delay_s(self) -> float: ...
    @property
    def settle_s(self) -> float: ...

def instruction_sets() -> list[str]: ...

@final
class ZeroPhase:
    def __new__(cls, design: Butterworth, edges: str, tolerance: float, derivative: bool) -> ZeroPhase: ...
    @property
    def instruction_set(self) -> str: ...
    def trusted(self, length: int, tolerance: float) -> tuple[int, int]: ...
    def apply(self, x: NDArray[np.float64], out: NDArray[np.float64]) -> None: ...
    def apply_plain(self, x: object, out: object) -> bool: ...
    def apply_in_place(self, x: NDArray[np.float64]) -> None: ...
    def apply_rows(self, x: NDArray[np.float64], out: NDArray[np.float64], threads: int) -> None: ...
    def apply_frames(self, frames: NDArray[np.float64]) -> None: ...
    def apply_samples(
        self,
        x: NDArray[np.int16] | NDArray[np.int32] | NDArray[np.float32],
        scale: tuple[float, float],
        out: NDArray[np.float64],
    ) -> None: ...

def extremes(x: NDArray[np.float64], count: int) -> NDArray[np.int64]: ...
def even(
    time: NDArray[np.float64], x: NDArray[np.float64], sample_rate_hz: float, max_gap_s: float, cubic: bool
) -> tuple[NDArray[np.float64], list[tuple[float, float]]]: ...

@final
class Filter:
    def __new__(cls, design: Butterworth, derivative: bool) -> Filter: ...
    def push(self, x: object) -> NDArray[np.float64] | None: ...
    def push_into(self, x: NDArray[np.float64], out: NDArray[np.float64]) -> None: ...
    def push_plain(self, x: object, out: object) -> bool: ...
    def push_in_place(self, x: NDArray[np.float64]) -> None: ...
    def push_counts(
        self, x: NDArray[np.int16] | NDArray[np.int32], scale: tuple[float, float], out: NDArray[np.float64]
    ) -> None: ...
    def push_single(self, x: NDArray[np.float32], out: NDArray[np.float32]) -> None: ...
    def reset(self, level: float | None) -> None: ...
    def copy(self) -> Filter: ...
    def state(self) -> list[float]: ...
    def restore(self, state: Sequence[float]) -> None: ...

@final
class Bank:
    def __new__(cls, design: Butterworth, channels: int) -> Bank: ...
    def push_in_place(self, frames: NDArray[np.float64]) -> None: ...
    def reset(self, levels: Sequence[float] | None) -> None: ...
    def copy(self) -> Bank: ...
    def state(self) -> list[float]: ...
    def restore(self, state: Sequence[float]) -> None: ...

@final
class FixedLag:
    def __new__(cls, design: Butterworth, delay: int) -> FixedLag: ...
    @property
    def error_bound(self) -> float: ...
    def push_into(self, x: NDArray[np.float64], out: NDArray[np.float64]) -> None: ...
    def reset(self, level: float | None) -> None: ...
    def copy(self) -> FixedLag: ...

# stats

_State = tuple[list[int], list[float]]
_Floats = NDArray[np.float64]

@disjoint_base
class Moments:
    def __new__(cls, *, shape: bool = False, skip_nan: bool = False, clipped_at: tuple[float, float] = ...) -> Self: ...
    def push(self, chunk: ArrayLike) -> None: ...
    def merge(self, later: Moments) -> None: ...
    @property
    def settings(self) -> tuple[bool, bool, tuple[float, float]]: ...
    @property
    def count(self) -> int: ...
    @property
    def nan_count(self) -> int: ...
    @property
    def clipped_count(self) -> int: ...
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
    def skew(self) -> float | None: ...
    @property
    def excess_kurtosis(self) -> float | None: ...
    @property
    def min(self) -> float | None: ...
    @property
    def min_index(self) -> int | None: ...
    @property
    def max(self) -> float | None: ...
    @property
    def max_index(self) -> int | None: ...
    def figures(
        self,
    ) -> tuple[
        tuple[int, int, int],
        tuple[float | None, float | None, float | None, float | None],
        tuple[float | None, float | None],
        tuple[float | None, int | None, float | None, int | None],
    ]: ...
    def state(self) -> _State: ...
    def restore(self, integers: Sequence[int], numbers: Sequence[float]) -> None: ...

def moments_by_label(x: _Floats, labels: NDArray[np.int64], like: Moments) -> list[tuple[int, Moments]]: ...
def moments_by_window(x: _Floats, windows: Sequence[tuple[int, int]], like: Moments) -> list[Moments]: ...

@disjoint_base
class Rolling:
    def __new__(cls, window: int = 1) -> Self: ...
    def push(self, chunk: ArrayLike) -> None: ...
    def push_into(self, chunk: ArrayLike, out: _Floats) -> None: ...
    @property
    def window(self) -> int: ...
    @property
    def count(self) -> int: ...
    @property
    def mean(self) -> float | None: ...
    @property
    def std_population(self) -> float | None: ...
    @property
    def min(self) -> float | None: ...
    @property
    def max(self) -> float | None: ...
    def state(self) -> _State: ...
    def restore(self, integers: Sequence[int], numbers: Sequence[float]) -> None: ...

def rolling(x: _Floats, window: int, out: _Floats) -> None: ...

@disjoint_base
class QuantileSketch:
    def __new__(cls, relative_error: float = 0.01) -> Self: ...
    def push(self, chunk: ArrayLike) -> None: ...
    def merge(self, other: QuantileSketch) -> None: ...
    @property
    def relative_error(self) -> float: ...
    @property
    def count(self) -> int: ...
    @property
    def min(self) -> float | None: ...
    @property
    def max(self) -> float | None: ...
    def quantile(self, q: float) -> float | None: ...
    def state(self) -> _State: ...
    def restore(self, integers: Sequence[int], numbers: Sequence[float]) -> None: ...

@disjoint_base
class Counts:
    def __new__(cls) -> Self: ...
    def push(self, chunk: ArrayLike) -> None: ...
    def merge(self, other: Counts) -> None: ...
    @property
    def count(self) -> int: ...
    @property
    def min(self) -> int | None: ...
    @property
    def max(self) -> int | None: ...
    @property
    def mean(self) -> float | None: ...
    @property
    def std_population(self) -> float | None: ...
    def neighbours(self, q: float) -> tuple[int, int, float] | None: ...
    def values(self) -> tuple[NDArray[np.int32], NDArray[np.uint64]]: ...
    def state(self) -> _State: ...
    def restore(self, integers: Sequence[int], numbers: Sequence[float]) -> None: ...

# regression

_Line = tuple[
    float,
    float,
    tuple[float | None, float | None, float | None, float | None],
    float,
    int,
    float,
    tuple[float, float, float],
]
_Linear = tuple[_Floats, _Floats | None, float | None, float, float, int, float]
_Polynomial = tuple[_Linear, _Floats, tuple[float, float]]

def fit_line(x: ArrayLike, y: ArrayLike, weights: _Floats | None) -> _Line: ...

@disjoint_base
class LineSums:
    def __new__(cls, *, forgetting: float = 1.0) -> Self: ...
    def push_points(self, x: ArrayLike, y: ArrayLike, weights: _Floats | None) -> None: ...
    def push_series(self, y: ArrayLike) -> None: ...
    def merge_points(self, other: LineSums) -> None: ...
    @property
    def count(self) -> int: ...
    def figures(self) -> _Line: ...
    def figures_over(self, origin: float, step: float) -> _Line: ...
    def state(self) -> _State: ...
    def restore(self, integers: Sequence[int], numbers: Sequence[float]) -> None: ...

@disjoint_base
class RollingLine:
    def __new__(cls, window: int = 2) -> Self: ...
    def push(self, x: ArrayLike, y: ArrayLike) -> None: ...
    @property
    def window(self) -> int: ...
    @property
    def count(self) -> int: ...
    def figures(self) -> _Line: ...
    def state(self) -> _State: ...
    def restore(self, integers: Sequence[int], numbers: Sequence[float]) -> None: ...

def fit_linear(x: ArrayLike, y: ArrayLike, weights: _Floats | None, intercept: bool) -> _Linear: ...

@disjoint_base
class LinearSums:
    def __new__(cls, predictors: int = 1, *, intercept: bool = True, forgetting: float = 1.0) -> Self: ...
    def push_rows(self, x: ArrayLike, y: ArrayLike, weights: _Floats | None) -> None: ...
    def merge(self, other: LinearSums) -> None: ...
    @property
    def predictors(self) -> int: ...
    @property
    def count(self) -> int: ...
    def figures(self) -> _Linear: ...
    def state(self) -> _State: ...
    def restore(self, integers: Sequence[int], numbers: Sequence[float]) -> None: ...

def fit_polynomial(x: ArrayLike, y: ArrayLike, weights: _Floats | None, degree: int) -> _Polynomial: ...

@disjoint_base
class PolynomialSums:
    def __new__(cls, degree: int = 1, domain: tuple[float, float] = ..., *, forgetting: float = 1.0) -> Self: ...
    def push_points(self, x: ArrayLike, y: ArrayLike, weights: _Floats | None) -> None: ...
    def merge(self, other: PolynomialSums) -> None: ...
    @property
    def degree(self) -> int: ...
    @property
    def count(self) -> int: ...
    def figures(self) -> _Polynomial: ...
    def state(self) -> _State: ...
    def restore(self, integers: Sequence[int], numbers: Sequence[float]) -> None: ...

@disjoint_base
class RollingPolynomial:
    def __new__(cls, degree: int = 1, window: int = 2) -> Self: ...
    def push(self, x: ArrayLike, y: ArrayLike) -> None: ...
    @property
    def degree(self) -> int: ...
    @property
    def window(self) -> int: ...
    @property
    def count(self) -> int: ...
    def figures(self) -> _Polynomial: ...
    def state(self) -> _State: ...
    def restore(self, integers: Sequence[int], numbers: Sequence[float]) -> None: ...

@disjoint_base
class Recursive:
    def __new__(cls, start: Sequence[float] = ..., *, start_error: float = 1e6, forgetting: float = 1.0) -> Self: ...
    def push_rows(self, x: ArrayLike, y: ArrayLike, errors: _Floats | None) -> None: ...
    @property
    def coefficients(self) -> _Floats: ...
    @property
    def size(self) -> int: ...
    @property
    def count(self) -> int: ...
    def state(self) -> _State: ...
    def restore(self, integers: Sequence[int], numbers: Sequence[float]) -> None: ...

def theil_sen(x: _Floats, y: _Floats, normal_quantile: float) -> tuple[float, float, float, float, int]: ...
def huber(x: ArrayLike, y: ArrayLike, intercept: bool, threshold: float) -> tuple[_Linear, float, int, int]: ...

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
    structures: list[str]
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
        whitening: tuple[float, float] | None = None,
    ) -> NDArray[np.float64]: ...

def normal_equations(columns: NDArray[np.float64], strokes: Sequence[_Rows]) -> NDArray[np.float64]: ...
def whitened(columns: NDArray[np.float64], step_s: float, zero_hz: float, pole_hz: float) -> NDArray[np.float64]: ...
def solve_block(block: NDArray[np.float64], bound: float) -> NDArray[np.float64]: ...
def held_out(
    products: NDArray[np.float64], fold_of: Sequence[int], folds: int, bound: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...

# dynamics

def steering_parameters() -> list[str]: ...
def steering_highest_rad_s(
    parameters: NDArray[np.float64], wound_rad: float, first: int = 0
) -> NDArray[np.float64]: ...
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
def lane_columns(
    samples: int, events: bool, energy: bool, window: int, chosen: Sequence[int]
) -> list[tuple[str, int]]: ...
def check_lanes(
    parameters: NDArray[np.float64],
    starts: NDArray[np.float64],
    handwheel_rad: NDArray[np.float64],
    load_nm: NDArray[np.float64] | None,
    *,
    sample_rate_hz: float,
    substeps: int,
    method: str,
    first: int,
) -> None: ...
def run_lanes(
    parameters: NDArray[np.float64],
    starts: NDArray[np.float64],
    handwheel_rad: NDArray[np.float64],
    load_nm: NDArray[np.float64] | None,
    *,
    sample_rate_hz: float,
    substeps: int,
    method: str,
    width: str,
    events: bool,
    energy: bool,
    window: int,
    chosen: Sequence[int],
    rows: NDArray[np.float64],
    done: NDArray[np.bool_],
    phi: NDArray[np.float64] | None,
    speed: NDArray[np.float64] | None,
    told: Callable[[int], object] | None,
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
) -> tuple[
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.float64],
    list[tuple[float, str, float]],
    list[tuple[str, float]],
]: ...

# mechanism

_End = tuple[str, float]
_ElementParts = tuple[str, str, _End, _End, Sequence[float], _End, Sequence[tuple[float, float]]]
_EnergyParts = tuple[list[float], list[float], list[float], list[float]]

@final
class Mechanism:
    def __new__(
        cls,
        bodies: Sequence[tuple[str, float]],
        driven: Sequence[str],
        loads: Sequence[tuple[str, str]],
        elements: Sequence[_ElementParts],
    ) -> Mechanism: ...
    def parameters(self) -> list[tuple[str, str, float]]: ...
    def longest_step(self) -> tuple[float, int | None]: ...
    def trace(
        self,
        channels: NDArray[np.float64],
        start: NDArray[np.float64],
        start_speed: NDArray[np.float64],
        *,
        sample_rate_hz: float,
        substeps: int,
        gauss_seidel: bool,
    ) -> tuple[
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.float64],
        list[int],
        NDArray[np.int8],
        NDArray[np.bool_],
        list[tuple[float, int, str, float]],
        int,
        _EnergyParts,
    ]: ...
    def simulate(
        self,
        values: NDArray[np.float64],
        channels: NDArray[np.float64],
        start: NDArray[np.float64],
        start_speed: NDArray[np.float64],
        *,
        first: int,
        sample_rate_hz: float,
        substeps: int,
        place: NDArray[np.float64],
        speed: NDArray[np.float64],
    ) -> None: ...
    def summarise(
        self,
        values: NDArray[np.float64],
        channels: NDArray[np.float64],
        start: NDArray[np.float64],
        start_speed: NDArray[np.float64],
        *,
        first: int,
        sample_rate_hz: float,
        substeps: int,
        out: NDArray[np.float64],
    ) -> None: ...
    @staticmethod
    def summary_names() -> list[str]: ...

@final
class MechanismStepper:
    def __new__(
        cls,
        mechanism: Mechanism,
        step_s: float,
        substeps: int,
        start: Sequence[float],
        start_speed: Sequence[float],
        channels: Sequence[float],
    ) -> MechanismStepper: ...
    def step(self, channels: NDArray[np.float64], place: NDArray[np.float64], speed: NDArray[np.float64]) -> None: ...
    def read_into(self, place: NDArray[np.float64], speed: NDArray[np.float64]) -> None: ...
    @property
    def time_s(self) -> float: ...
    def modes(self) -> list[int]: ...
    def torques_into(self, torque: NDArray[np.float64]) -> None: ...
    def copy(self) -> MechanismStepper: ...
    def state(self) -> tuple[list[int], list[float]]: ...
    def restore(self, integers: Sequence[int], numbers: Sequence[float]) -> None: ...

def hold_or_slide(
    matrix: NDArray[np.float64],
    free: NDArray[np.float64],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    gauss_seidel: bool,
) -> tuple[list[float], list[float], int, int, bool]: ...

# oracle

_Signal = tuple[_Floats, _Floats, _Floats]
_Exact = tuple[_Floats, _Floats, list[tuple[float, str, int, int, float]]]

def sampled_cubics(values: NDArray[np.float64], sample_rate_hz: float) -> NDArray[np.float64]: ...
def solve_steering_exactly(
    parameters: NDArray[np.float64],
    start: tuple[float, float],
    handwheel: _Signal,
    load: _Signal,
    *,
    ground_speed: float,
    times_s: NDArray[np.float64],
    most_events: int,
) -> _Exact: ...
def solve_bodies_exactly(
    bodies: NDArray[np.float64],
    loads: Sequence[_Signal],
    stiffness: NDArray[np.float64],
    damping: NDArray[np.float64],
    springs: Sequence[tuple[float, float, NDArray[np.float64], _Signal]],
    starts: Sequence[tuple[float, float]],
    *,
    times_s: NDArray[np.float64],
    most_events: int,
) -> _Exact: ...

# projections

def project(
    name: str,
    x: NDArray[np.float64],
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    start: float,
    out: NDArray[np.float64],
) -> None: ...

# vehicle

def car_names() -> tuple[list[str], list[str], list[str], list[str]]: ...
def drive_cars(
    cars: NDArray[np.float64],
    starts: NDArray[np.float64],
    durations_s: NDArray[np.float64],
    speed: tuple[Any, ...],
    hand: tuple[Any, ...],
    corridor: NDArray[np.float64] | None,
    *,
    sections: int,
    steer: str,
    model: str,
    tyre: str,
    step_s: float,
    every: int,
    width: str,
    summary: NDArray[np.float64],
    traces: NDArray[np.float64],
) -> None: ...
