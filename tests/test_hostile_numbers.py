"""Numbers at the ends of the range: every result is finite, or the call is refused in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from luztar import regression, stats
from luztar.errors import ParameterError

EXTREME = [0.0, -0.0, 1.0, -1.0, 3.3, 1e9, 1e16, 1e-160, 1e-300, -1e-300, 5e-324, 1e74, 1e75, 1e150, -1e150]
REFUSED = [math.nan, math.inf, -math.inf, 1e200]
number = st.one_of(st.floats(-10, 10), st.sampled_from(EXTREME), st.sampled_from(EXTREME + REFUSED))
row = st.tuples(number, number, number.map(abs))


def numbers(value: Any) -> Iterator[float]:
    """All floats in a nest of dictionaries and lists."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list | tuple):
        for part in value:
            yield from numbers(part)
    elif isinstance(value, float):
        yield value


def stream(made: Any, *chunk: Any) -> Any:
    made.push(*chunk)
    return made


@settings(max_examples=300)
@given(st.lists(row, max_size=40), st.integers(0, 5))
def test_a_result_is_finite_or_refused(rows: list[tuple[float, float, float]], degree: int) -> None:
    x, y, w = np.array(rows).reshape(-1, 3).T
    both = np.column_stack([x, w])
    calls: list[Callable[[], Any]] = [
        lambda: stats.describe(x).to_dict(),
        lambda: stats.describe(x, nan="skip").to_dict(),
        lambda: stats.rolling(x, max(1, x.size // 2)).to_dict(),
        lambda: stream(stats.QuantileSketch(0.05), x).quantile(0.4),
        lambda: regression.line(x, y).to_dict(),
        lambda: regression.line(x, y, w).to_dict(),
        lambda: stream(regression.LineSums(forgetting=0.9), x, y, w).fit().to_dict(),
        lambda: stream(regression.RollingLine(7), x, y).fit().to_dict(),
        lambda: regression.time_line(y, 100.0, start_s=1e9).to_dict(),
        lambda: regression.polynomial(x, y, degree).to_dict(),
        lambda: regression.polynomial(x, y, degree, w).to_dict(),
        lambda: regression.linear(both, y).to_dict(),
        lambda: regression.linear(both, y, w, intercept=False).to_dict(),
        lambda: stream(regression.RecursiveLeastSquares([0.0, 0.0], forgetting=0.9), both, y).coefficients.tolist(),
        lambda: regression.theil_sen(x, y).to_dict(),
        lambda: regression.huber(both, y).to_dict(),
    ]
    for call in calls:
        try:
            found = call()
        except ParameterError as refusal:
            assert str(refusal)
            continue
        assert all(math.isfinite(v) for v in numbers(found))
