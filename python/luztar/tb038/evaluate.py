"""From runs to a check."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from ..errors import MeasurementError, ParameterError
from . import filters
from .advice import advise
from .check import Check, FilterUse, Outcome, Trace
from .once_per_turn import once_per_turn
from .record import BOTH, Record, prepare
from .repeats import same_file_again, same_torque
from .rules import RuleSet
from .rules import rule_set as find_rule_set
from .verification import DIRECTION_WORD, Verification, pooled, verify

if TYPE_CHECKING:
    from ..measurement.run import Run

_DEFAULT = "TB 038 v1.0"
# Friction is reversed where its mean is below minus half its own standard deviation in both directions. A channel that
# shows noise alone stays within: of a crossing of two seconds or more the 6 Hz filter leaves 24 independent values, so
# that half a deviation is 2.4 standard errors, and both directions must be beyond.
REVERSED_DEVIATIONS = 0.5


def evaluate(
    runs: Run | Iterable[Run],
    *,
    link_distance_m: float = 0.52,
    centre: bool = False,
    rule_set: str | RuleSet = _DEFAULT,
) -> Check:
    """Check the friction of a steering robot by Euro NCAP TB 038, or by another rule set of its kind.

    Each run is filtered as a whole and then cropped to the window; its full crossings in one direction are one
    verification. The verdict is ``fail`` where a readable verification fails, else ``inconclusive`` where one is
    inconclusive or fewer runs than asked for were given, else ``pass``.

    Parameters
    ----------
    runs : Runs, iterable of Run, or Run
        Each with ``angle`` [rad] and either ``torque`` [Nm] or ``force`` [N].
    link_distance_m : float [m], > 0
        What a ``force`` is multiplied by (Annex I 10).
    centre : bool
        Take the hysteresis centre (one value for all runs, as the analogue offset is, Annex I 13) off the torque before
        the verdict; the result then also holds the verdict of the data as recorded.
    rule_set : str or RuleSet

    Returns
    -------
    Check

    Raises
    ------
    MeasurementError
        A channel is missing, or the torque's sign is reversed: the friction is negative in both directions of a run.
    ParameterError
        No runs, a link distance that is not positive, an unknown rule set.

    Notes
    -----
    Means and deviations agree with the exact answer to 1e-9 Nm on synthetic records
    (``test_figures_agree_with_scipy``). Every limit is compared at -1, 0 and +1 units in the last place
    (``test_tb038_limits.py``).

    References
    ----------
    .. [1] Euro NCAP Technical Bulletin TB 038, version 1.0, March 2022, sections 2.1.3, 2.2.2 to 2.2.8, Annex I.
    """
    rules = find_rule_set(rule_set)
    lever_m = _positive("link_distance_m", link_distance_m)
    given = _given(runs)
    records = [prepare(run, rules, lever_m) for run in given]
    recorded = _verifications(records, rules)
    _refuse_reversed(recorded)
    offset_nm = hysteresis_centre(recorded)
    centred = _verifications(records, rules, offset_nm=offset_nm or 0.0)
    n_tests = len(given) - len(same_file_again(given))
    outcome = Outcome(overall(recorded, n_tests, rules), recorded)
    other = None
    if centre:
        _refuse_reversed(centred)
        outcome, other = Outcome(overall(centred, n_tests, rules), centred), outcome
    shift_nm = (offset_nm or 0.0) if centre else 0.0
    pattern = once_per_turn(records, rules)
    used, sentence = _filter_use(records, outcome.verdict, n_tests, shift_nm, rules)
    advice = advise(recorded, centred, records, n_tests, same_torque(given, lever_m), offset_nm, pattern, rules)
    return Check(
        rule_set=rules.name,
        verdict=outcome.verdict,
        filter=used,
        verifications=outcome.verifications,
        offset_nm=offset_nm,
        once_per_rev=pattern,
        integrity=tuple(_report(run, record) for run, record in zip(given, records, strict=True)),
        advice=(*advice, *sentence),
        centred=bool(centre),
        other=other,
        rules=rules,
        traces=tuple(_traces(records, rules, shift_nm)),
    )


def overall(verifications: Sequence[Verification], n_tests: int, rules: RuleSet) -> str:
    """Return the overall verdict of a set of verifications.

    Parameters
    ----------
    verifications : sequence of Verification
    n_tests : int
        How many tests were given.
    rules : RuleSet
    """
    verdicts = [v.verdict for v in verifications]
    if "fail" in verdicts:
        return "fail"
    asked = rules.runs * rules.directions
    whole = n_tests >= rules.runs and len(verdicts) >= asked
    return "pass" if whole and all(verdict == "pass" for verdict in verdicts) else "inconclusive"


def hysteresis_centre(verifications: Sequence[Verification]) -> float | None:
    """Return the mean of the recorded torque's two directions [Nm], over the runs that have both; None without any."""
    centres = []
    for increasing, decreasing in _by_run(verifications):
        if increasing.mean_nm is not None and decreasing.mean_nm is not None:
            # mean_nm carries the sign of motion; the recorded mean of the decreasing direction is its opposite.
            centres.append((increasing.mean_nm - decreasing.mean_nm) / 2.0)
    return math.fsum(centres) / len(centres) if centres else None


def _given(runs: Any) -> list[Run]:
    from ..measurement.runs import Runs

    given = list(Runs(runs))
    if not given:
        raise ParameterError("there are no runs", "runs", "Give at least one, better three.")
    return given


def _positive(name: str, value: Any) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if isinstance(value, bool) or not (math.isfinite(number) and number > 0.0):
        raise ParameterError(f"{name} is {value!r}", name, "Give a positive number of metres.")
    return number


def _by_run(verifications: Sequence[Verification]) -> list[tuple[Verification, Verification]]:
    return list(zip(verifications[::2], verifications[1::2], strict=True))


def _verifications(
    records: Sequence[Record], rules: RuleSet, reading: str | None = None, offset_nm: float = 0.0
) -> tuple[Verification, ...]:
    return tuple(verify(record, way, rules, reading, offset_nm) for record in records for way in BOTH)


def _refuse_reversed(verifications: Sequence[Verification]) -> None:
    for increasing, decreasing in _by_run(verifications):
        if _clearly_negative(increasing) and _clearly_negative(decreasing):
            raise MeasurementError(
                f"torque sign reversed: the friction is {increasing.mean_nm:.3g} Nm with increasing and "
                f"{decreasing.mean_nm:.3g} Nm with decreasing angle, as if the robot turned the wheel",
                increasing.run,
                'Turn the sign of the torque: --map torque="COLUMN*-1" (force: --map force="COLUMN*-1").',
            )


def _clearly_negative(v: Verification) -> bool:
    if v.mean_nm is None or v.std_nm is None:
        return False
    return v.mean_nm < -REVERSED_DEVIATIONS * v.std_nm


def _filter_use(
    records: Sequence[Record], verdict: str, n_tests: int, offset_nm: float, rules: RuleSet
) -> tuple[FilterUse, list[str]]:
    words = filters.describe(rules.reading, rules)
    others = {
        reading: overall(_verifications(records, rules, reading, offset_nm), n_tests, rules)
        for reading in rules.other_readings
    }
    different = [f"{filters.describe(r, rules).passes}: {v}" for r, v in others.items() if v != verdict]
    text, sentence = words.text, []
    if different:
        text += f"; the verdict depends on this reading ({', '.join(different)})"
        sentence = [
            f"The verdict depends on how the filter is read ({rules.section('filter')}): {words.passes}: {verdict}; "
            f"{'; '.join(different)}. Agree on the reading before the result is used."
        ]
    return FilterUse(rules.poles, rules.cutoff_hz, words.passes, text, bool(different)), sentence


def _report(run: Run, record: Record) -> dict[str, Any]:
    report = run.integrity.to_dict()
    notes = [
        {"kind": "note", "text": text, "doubtful": False, "channel": None, "from_s": None, "to_s": None}
        for text in record.notes
    ]
    return {"run": run.name, **report, "findings": [*report["findings"], *notes]}


def _traces(records: Sequence[Record], rules: RuleSet, offset_nm: float) -> Iterable[Trace]:
    for record in records:
        for way in BOTH:
            for piece, crossing in pooled(record, way):
                angle = piece.angle_deg[crossing.inside]
                torque = piece.torque_nm[rules.reading][crossing.inside] - offset_nm
                angle.setflags(write=False)
                torque.setflags(write=False)
                yield Trace(record.name, DIRECTION_WORD[way], angle, torque)
