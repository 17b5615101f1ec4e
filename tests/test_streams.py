"""What every pushed object does alike: copies, pickles, states in JSON, hostile arrays, threads, the frozen result."""

from __future__ import annotations

import copy
import json
import pickle
import sys
import threading
from collections.abc import Callable
from dataclasses import FrozenInstanceError, dataclass
from typing import Any

import numpy as np
import pytest

from luztar import regression, stats
from luztar.errors import ParameterError

RNG = np.random.default_rng(12)
X = RNG.standard_normal(3000) + 1e6
Y = 0.5 * X + RNG.standard_normal(3000)
ROWS = RNG.standard_normal((3000, 2))
COUNTS = RNG.integers(-2000, 2000, 3000).astype(np.int16)


@dataclass(frozen=True)
class Kind:
    """How one class is made, fed with the samples of a slice, and read."""

    make: Callable[[], Any]
    feed: Callable[[Any, slice], None]
    read: Callable[[Any], Any]


def fitted(o: Any) -> Any:
    return o.fit().to_dict()


KINDS = {
    "Moments": Kind(
        lambda: stats.Moments(shape=True, nan="skip", clipped_at=(-1e9, 1e6)),
        lambda o, s: o.push(X[s]),
        lambda o: o.describe().to_dict(),
    ),
    "Moments, plain": Kind(stats.Moments, lambda o, s: o.push(X[s]), lambda o: o.describe()),
    "Rolling": Kind(lambda: stats.Rolling(70), lambda o, s: o.push(X[s]), lambda o: (o.mean, o.std_population, o.min)),
    "QuantileSketch": Kind(
        lambda: stats.QuantileSketch(1e-3), lambda o, s: o.push(X[s]), lambda o: (o.quantile(0.3), o.max, o.count)
    ),
    "Counts": Kind(stats.Counts, lambda o, s: o.push(COUNTS[s]), lambda o: (o.quantile(0.3), o.mean, o.count)),
    "LineSums": Kind(lambda: regression.LineSums(forgetting=0.999), lambda o, s: o.push(X[s], Y[s]), fitted),
    "RollingLine": Kind(lambda: regression.RollingLine(70), lambda o, s: o.push(X[s], Y[s]), fitted),
    "TimeLine": Kind(lambda: regression.TimeLine(500.0, start_s=1e9), lambda o, s: o.push(Y[s]), fitted),
    "LinearSums": Kind(lambda: regression.LinearSums(2, forgetting=0.99), lambda o, s: o.push(ROWS[s], Y[s]), fitted),
    "PolynomialSums": Kind(
        lambda: regression.PolynomialSums(3, (X.min(), X.max())), lambda o, s: o.push(X[s], Y[s]), fitted
    ),
    "RollingPolynomial": Kind(lambda: regression.RollingPolynomial(2, 70), lambda o, s: o.push(X[s], Y[s]), fitted),
    "RecursiveLeastSquares": Kind(
        lambda: regression.RecursiveLeastSquares([0.0, 0.0], forgetting=0.99),
        lambda o, s: o.push(ROWS[s], Y[s]),
        lambda o: o.coefficients.tolist(),
    ),
}
every_kind = pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)


@every_kind
def test_a_copy_goes_on_alone_and_alike(kind: Kind) -> None:
    first = kind.make()
    kind.feed(first, slice(0, 1234))
    ways = [copy.copy, copy.deepcopy, lambda o: pickle.loads(pickle.dumps(o)), lambda o: o.copy()]
    ways.append(lambda o: type(o).from_state(json.loads(json.dumps(o.to_state(), allow_nan=False))))
    twins = [way(first) for way in ways]
    before = kind.read(first)
    assert all(type(twin) is type(first) and kind.read(twin) == before for twin in twins)
    kind.feed(first, slice(1234, 3000))
    after = kind.read(first)
    assert after != before
    for twin in twins:
        # what the original was fed since then did not reach the copies
        assert kind.read(twin) == before
        kind.feed(twin, slice(1234, 3000))
        if kind.make().__class__ in (regression.LinearSums, regression.PolynomialSums):
            # a state reflects the rows that wait, so that later blocks begin elsewhere: the same but for rounding
            assert twin.fit().coefficients == pytest.approx(first.fit().coefficients, rel=1e-6)
        else:
            assert kind.read(twin) == after


@every_kind
def test_an_empty_object_has_a_state_too(kind: Kind) -> None:
    twin = pickle.loads(pickle.dumps(kind.make()))
    first = kind.make()
    for o in (first, twin):
        kind.feed(o, slice(0, 500))
    assert kind.read(twin) == kind.read(first)
    assert repr(first).startswith("<luztar.")


@every_kind
def test_a_foreign_state_is_refused_in_words(kind: Kind) -> None:
    made = kind.make()
    kind.feed(made, slice(0, 200))
    state = made.to_state()
    for spoilt in (
        {},
        {**state, "kind": "Other"},
        {**state, "schema": 99},
        {**state, "integers": state["integers"][:-1]},
        {**state, "integers": [*state["integers"], 1]},
        {**state, "integers": [-1] * len(state["integers"])},
        {**state, "integers": [2**63] * len(state["integers"])},
        {**state, "numbers": [*state["numbers"][1:], "nan"]},
        {**state, "numbers": [*state["numbers"], float("nan")]},
        {**state, "numbers": "many"},
    ):
        if isinstance(made, stats.Counts) and spoilt.get("numbers") != "many" and "integers" in spoilt:
            # counts are whole numbers only: whatever pairs fit into 32 bits are counts
            if spoilt["integers"] == state["integers"]:
                continue
        with pytest.raises(ParameterError):
            type(made).from_state(spoilt)


def looks(values: np.ndarray) -> dict[str, np.ndarray]:
    """The same numbers in every way an array can lie."""
    n = values.size
    spaced = np.zeros(2 * n)
    spaced[::2] = values
    frozen = values.copy()
    frozen.flags.writeable = False
    shifted = np.frombuffer(b"\0" + values.tobytes(), dtype=np.float64, offset=1)
    return {
        "strided": spaced[::2],
        "negative stride": values[::-1].copy()[::-1],
        "read-only": frozen,
        "big-endian": values.astype(">f8"),
        "unaligned": shifted,
        "list": values.tolist(),
        "tuple": tuple(values.tolist()),
        "column": np.asfortranarray(np.stack([values, values]))[0],
    }


@pytest.mark.parametrize("how", looks(np.ones(3)))
def test_every_way_an_array_can_lie_gives_the_same(how: str) -> None:
    x, y = looks(X)[how], looks(Y)[how]
    assert stats.describe(x) == stats.describe(X)
    assert np.array_equal(stats.rolling(x, 9).mean, stats.rolling(X, 9).mean)
    assert regression.line(x, y) == regression.line(X, Y)
    assert regression.theil_sen(x[:50], y[:50]) == regression.theil_sen(X[:50], Y[:50])
    assert np.array_equal(regression.polynomial(x, y, 3).coefficients, regression.polynomial(X, Y, 3).coefficients)
    assert np.array_equal(regression.linear(x, y).coefficients, regression.linear(X, Y).coefficients)
    assert regression.huber(x, y).scale == regression.huber(X, Y).scale
    for pushed in (stats.Moments(), stats.Rolling(5), stats.QuantileSketch(), regression.TimeLine(1.0)):
        other = pushed.copy()
        pushed.push(x)
        other.push(X)
        assert pushed.state() == other.state()


BAD = {
    "NaN": [1.0, np.nan, 2.0],
    "inf": [1.0, np.inf, 2.0],
    "object": np.array([1.0, None, 2.0], dtype=object),
    "text": ["a", "b", "c"],
    "complex": [1j, 2.0, 3.0],
    "dates": np.array(["2020-01-01"] * 3, dtype="M8[D]"),
    "two dimensions": np.ones((3, 3, 1)),
    "masked": np.ma.masked_array([1.0, 2.0, 3.0], [0, 1, 0]),
    "ragged": [[1.0], [1.0, 2.0], [3.0]],
    "huge": [1.0, 1e200, 2.0],
    "nothing at all": None,
}


@pytest.mark.parametrize("bad", BAD.values(), ids=BAD)
def test_what_is_no_record_is_refused_and_leaves_nothing_behind(bad) -> None:
    good = [1.0, 2.0, 4.0]
    calls: list[Callable[[], object]] = [
        lambda: stats.describe(bad),
        lambda: stats.rolling(bad, 2),
        lambda: stats.by_label(bad, [0, 0, 1]),
        lambda: stats.by_direction(bad, good),
        lambda: stats.by_window(bad, [(0, 2)]),
        lambda: regression.line(bad, good),
        lambda: regression.line(good, bad),
        lambda: regression.polynomial(bad, good, 1),
        lambda: regression.polynomial(good, bad, 1),
        lambda: regression.linear(bad, good),
        lambda: regression.linear(good, bad),
        lambda: regression.theil_sen(bad, good),
        lambda: regression.huber(good, bad),
        lambda: regression.time_line(bad, 1.0),
    ]
    streams: list[tuple[Any, Callable[[Any], None]]] = [
        (stats.Moments(good), lambda o: o.push(bad)),
        (stats.Rolling(2), lambda o: o.push(bad)),
        (regression.LineSums(), lambda o: o.push(bad, good)),
        (regression.LineSums(forgetting=0.9), lambda o: o.push(good, bad)),
        (regression.RollingLine(2), lambda o: o.push(good, bad)),
        (regression.TimeLine(1.0), lambda o: o.push(bad)),
        (regression.LinearSums(1), lambda o: o.push(good, bad)),
        (regression.PolynomialSums(1), lambda o: o.push(good, bad)),
        (regression.RollingPolynomial(1, 3), lambda o: o.push(bad, good)),
        (regression.RecursiveLeastSquares([0.0]), lambda o: o.push(good, bad)),
    ]
    if bad is not BAD["huge"]:
        streams.append((stats.QuantileSketch(), lambda o: o.push(bad)))
    if bad is BAD["nothing at all"]:
        calls.pop(0)  # describe(None) is Moments() of nothing, refused as such below
    for call in calls:
        with pytest.raises(ParameterError):
            call()
    for stream, push in streams:
        before = stream.state()
        with pytest.raises(ParameterError):
            push(stream)
        assert stream.state() == before, type(stream)
    with pytest.raises(ParameterError):
        stats.describe(None)


def test_an_empty_chunk_changes_nothing() -> None:
    nothing = np.empty(0)
    for kind in KINDS.values():
        o = kind.make()
        kind.feed(o, slice(0, 300))
        before = o.state()
        kind.feed(o, slice(5, 5))
        assert o.state() == before
    for call in (stats.describe, lambda x: regression.line(x, x), lambda x: regression.polynomial(x, x, 0)):
        with pytest.raises(ParameterError):
            call(nothing)


def test_two_threads_on_two_objects_give_what_one_gives() -> None:
    x = np.random.default_rng(0).standard_normal(400_000)
    made = [stats.Moments(shape=True) for _ in range(4)]

    def work(m: stats.Moments) -> None:
        for part in np.array_split(x, 7):
            m.push(part)

    threads = [threading.Thread(target=work, args=(m,)) for m in made]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert all(m.state() == stats.Moments(x, shape=True).state() for m in made)


def test_a_long_push_lets_other_threads_run() -> None:
    x, m = np.zeros(4_000_000), stats.Moments()
    refused: list[bool] = []
    interval = sys.getswitchinterval()
    # nobody takes the interpreter lock away within this time: another thread runs only if the push gives it up
    sys.setswitchinterval(10.0)
    try:
        for _ in range(50):
            gate = threading.Lock()
            gate.acquire()

            def other(gate: threading.Lock = gate) -> None:
                gate.acquire()
                try:
                    m.push(1.0)
                except RuntimeError:
                    refused.append(True)

            thread = threading.Thread(target=other)
            thread.start()
            gate.release()
            m.push(x)
            thread.join()
            if refused:
                break
    finally:
        sys.setswitchinterval(interval)
    # the other thread met the object in the middle of the push, and was told so
    assert refused


def test_results_are_frozen_and_print_themselves() -> None:
    results = [
        stats.describe(X),
        regression.line(X, Y),
        regression.linear(ROWS, Y),
        regression.polynomial(X, Y, 2),
        regression.theil_sen(X[:99], Y[:99]),
        regression.huber(X, Y),
        stats.rolling(X, 10),
    ]
    for result in results:
        json.dumps(result.to_dict(), allow_nan=False)
        with pytest.raises(FrozenInstanceError):
            result.n = 0
        if not isinstance(result, stats.RollingFigures):
            # every row of the text is a row of the table
            assert result._repr_html_().count("<tr>") == len(str(result).splitlines()) > 2
    assert "<th>mean</th>" in stats.describe(X)._repr_html_()


def test_merging_something_else_is_refused() -> None:
    for kind in KINDS.values():
        o = kind.make()
        if hasattr(o, "merge"):
            with pytest.raises((TypeError, ParameterError)):
                o.merge(3)
