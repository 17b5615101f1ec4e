"""What to do next, each sentence with the step of the bulletin it rests on."""

from __future__ import annotations

from collections.abc import Sequence

from .once_per_turn import OncePerTurn
from .record import Record
from .rules import RuleSet, judge
from .verification import Verification

# A hysteresis centre below this is not worth a sentence unless it decides (the size at which a pattern is prominent).
OFFSET_WORTH_SAYING_NM = 0.1
# A mean beyond ten times the limit, or a tenth of the lower one, is more often a unit than a robot.
UNIT_FACTOR = 10.0


def advise(
    verifications: Sequence[Verification],
    centred: Sequence[Verification],
    records: Sequence[Record],
    n_tests: int,
    same: Sequence[tuple[str, str]],
    offset_nm: float | None,
    pattern: OncePerTurn,
    rules: RuleSet,
) -> tuple[str, ...]:
    """Return the advice for a set of verifications, the most useful first.

    Parameters
    ----------
    verifications : sequence of Verification
        As recorded.
    centred : sequence of Verification
        The same with the hysteresis centre removed.
    records : sequence of Record
    n_tests : int
        How many different readings were given.
    same : sequence of (str, str)
        Names of runs that hold the same torque.
    offset_nm : float or None [Nm]
        The hysteresis centre.
    pattern : OncePerTurn
    rules : RuleSet
    """
    section = rules.section
    lines: list[str] = []
    lines += _units(verifications, records, rules)
    too_high = [v for v in verifications if v.below_max is False]
    too_low = [v for v in verifications if v.above_min is False]
    unsteady = [v for v in verifications if v.steady is False]
    cured = _cured_by_centring([*too_high, *too_low], centred, rules)
    if cured and offset_nm is not None:
        lines.append(
            f"The hysteresis is centred at {offset_nm:+.3f} Nm, and about 0 every mean would be within the limits (the "
            f"option to centre shows this on the data at hand). {_whose(rules)}"
        )
    elif offset_nm is not None and abs(offset_nm) >= OFFSET_WORTH_SAYING_NM:
        lines.append(f"The hysteresis is centred at {offset_nm:+.3f} Nm. {_whose(rules)}")
    if too_high and not cured:
        lines.append(
            f"The friction is too high: loosen the two thumb screws of the motor assembly by a quarter turn and take "
            f"the readings again ({section('loosen_screws')})."
        )
    if too_low and not cured:
        lines.append(
            f"The friction is too low to stand for hands on the wheel ({section('mean_above')}): check that the robot "
            f"is coupled and in free mode, then the load cell's sensitivity ({section('units')}) and the link distance "
            f"({section('link_distance')})."
        )
    lines += _pattern(pattern, bool(unsteady), rules)
    if unsteady and not pattern.prominent:
        lines.append(
            f"The friction is not steady ({section('std')}): look for a tight spot or a slope in the torque over "
            "angle, check that the load cell is at a right angle to the arm, and turn more evenly "
            f"({section('speed')})."
        )
    lines += _repeat(verifications, records, n_tests, same, rules)
    return tuple(lines)


def _whose(rules: RuleSet) -> str:
    """Return how to tell a sensor's offset, which may be shifted away, from friction that differs by direction."""
    zero, shift = rules.section("zero_load_cell"), rules.section("shift_offset")
    return (
        f"Read the load cell with nothing attached ({zero}): what it shows is an offset, to be shifted away before "
        f"the readings are taken again ({shift}); the rest is friction that differs between the directions, which no "
        "shift may hide."
    )


def _units(verifications: Sequence[Verification], records: Sequence[Record], rules: RuleSet) -> list[str]:
    lines = []
    means = [abs(v.mean_nm) for v in verifications if v.mean_nm is not None]
    if means and (min(means) > UNIT_FACTOR * rules.mean_max_nm or max(means) < rules.mean_above_nm / UNIT_FACTOR):
        lines.append(
            f"Every mean is {min(means):.3g} to {max(means):.3g} Nm: check the torque's unit, sensitivity and link "
            f"distance ({rules.section('units')}, {rules.section('link_distance')})."
        )
    for increasing, decreasing in zip(verifications[::2], verifications[1::2], strict=True):
        # The half sum is the friction level whatever the offset; below zero the hysteresis loop runs the wrong way.
        if increasing.mean_nm is not None and decreasing.mean_nm is not None:
            if increasing.mean_nm + decreasing.mean_nm < 0.0:
                lines.append(f"{increasing.run}: the hysteresis runs the wrong way: is the torque's sign reversed?")
    for record in records:
        # A whole window in radians is 1.6; degrees taken for radians make it hundreds of turns.
        if record.angle_span_deg < 5.0:
            covered = f"{record.angle_span_deg:.3g} deg"
            lines.append(f"{record.name}: the angle covers only {covered}: are these radians read as degrees?")
        elif record.angle_span_deg > 3600.0:
            covered = f"{record.angle_span_deg / 360.0:.0f} turns"
            lines.append(f"{record.name}: the angle covers {covered}: are these degrees read as radians?")
    return lines


def _cured_by_centring(failed: Sequence[Verification], centred: Sequence[Verification], rules: RuleSet) -> bool:
    if not failed:
        return False
    means = [(v.mean_nm, v.std_nm) for v in centred if v.mean_nm is not None and v.std_nm is not None]
    found = [judge(mean, std, rules) for mean, std in means]
    return bool(found) and all(j.below_max and j.above_min for j in found)


def _pattern(pattern: OncePerTurn, unsteady: bool, rules: RuleSet) -> list[str]:
    if not pattern.prominent or pattern.amplitude_nm is None or pattern.range_deg is None:
        return []
    step = rules.section("recentre_ring")
    if pattern.identifiable:
        return [
            f"The torque varies once per turn by {pattern.amplitude_nm:.2f} Nm: recentre the gear ring to the steering "
            f"column ({step})."
        ]
    harm = "This also widens the standard deviation. " if unsteady else ""
    return [
        f"The torque varies with the angle as a once-per-turn pattern of {pattern.amplitude_nm:.2f} Nm would, but over "
        f"{pattern.range_deg:.0f} deg a spring looks the same. {harm}Turn from -180 to 180 deg once to tell them "
        f"apart; if it is once per turn, recentre the gear ring to the steering column ({step})."
    ]


def _repeat(
    verifications: Sequence[Verification],
    records: Sequence[Record],
    n_tests: int,
    same: Sequence[tuple[str, str]],
    rules: RuleSet,
) -> list[str]:
    section = rules.section
    lines = []
    kinds = {doubt.kind for record in records for found in record.doubts.values() for doubt in found}
    half = f"{rules.half_width_deg:g} deg"
    if kinds & {"start", "missing", "turned_back"}:
        lines.append(
            f"Start each motion beyond {half} and go past {half} on the other side without turning back "
            f"({rules.section('start')}, {rules.section('window')})."
        )
    if "speed" in kinds:
        lines.append(f"Turn more slowly, below {rules.speed_max_deg_s:g} deg/s ({rules.section('speed')}).")
    if "uneven" in kinds:
        lines.append("Export the record at a constant sample rate, or resample it, before the filter is applied.")
    for first, second in same:
        lines.append(
            f"{first} and {second} hold the same torque: each test is a reading of its own ({section('runs')})."
        )
    if n_tests < rules.runs:
        there = "there is 1" if n_tests == 1 else f"there are {n_tests}"
        lines.append(f"Take {rules.runs} readings; {there} ({section('runs')}, {section('repeat')}).")
    elif any(v.verdict == "inconclusive" for v in verifications):
        lines.append(f"Repeat the readings that are inconclusive ({rules.section('repeat')}).")
    return lines
