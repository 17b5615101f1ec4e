"""Where the car has to stay: own lane, other lane, own lane again, and the road between them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .._arrays import number
from ..errors import ParameterError
from ..vehicle import Corridor

# luztar's choice, for the paper prints none of them: lanes of a Polish main road, an obstacle as long as a van, a lorry
# and its slow advance to be passed.
LANE_WIDTH_M = 3.5
ENTRY_M = 40.0
EXIT_M = 40.0
OBSTACLE_M = 8.0
PASSING_SHARE = 0.4
# The car begins with its reference point at x = 0; its tail reaches behind it.
BEHIND_M = 10.0
NAMES = ("avoiding", "overtaking", "iso_3888_1", "iso_3888_2")


@dataclass(frozen=True)
class Track:
    """A track of a double lane change: three lanes one after the other, and what lies between them.

    Parameters
    ----------
    name : str
    entry_m, other_m, exit_m : tuple of float (from, to)
        Where the three lanes lie along x.
    entry_edges_m, other_edges_m, exit_edges_m : tuple of float (right, left)
        Their edges across, y to the left; the car begins in the middle of the first.
    between : bool
        Whether the road between the lanes has edges, the outermost of the lanes; else the car is free there.

    Raises
    ------
    ParameterError
        A lane that ends before it begins, edges in the wrong order, lanes that overlap.
    """

    name: str
    entry_m: tuple[float, float]
    other_m: tuple[float, float]
    exit_m: tuple[float, float]
    entry_edges_m: tuple[float, float]
    other_edges_m: tuple[float, float]
    exit_edges_m: tuple[float, float]
    between: bool = True

    def __post_init__(self) -> None:
        for lane in ("entry", "other", "exit"):
            for key in (f"{lane}_m", f"{lane}_edges_m"):
                given = getattr(self, key)
                pair = tuple(number(key, v) for v in given) if np.ndim(given) == 1 else ()
                if len(pair) != 2 or not all(np.isfinite(pair)):
                    raise ParameterError(f"{key} is {given!r}", key, "Give two finite numbers.")
                if pair[1] <= pair[0]:
                    what = "ends before it begins" if key == f"{lane}_m" else "has its left edge right of its right one"
                    raise ParameterError(f"the {lane} lane {what}: {pair}", key, "Give the smaller number first.")
                object.__setattr__(self, key, pair)
        if not (self.entry_m[1] < self.other_m[0] and self.other_m[1] < self.exit_m[0]):
            raise ParameterError("the lanes overlap along x", "other_m", "Leave a way between them to change over.")
        if self.entry_m[0] > 0.0 or self.entry_m[1] <= 0.0:
            raise ParameterError("the car does not begin in the entry lane", "entry_m", "x = 0 has to lie in it.")

    @property
    def start_y_m(self) -> float:
        """The middle of the entry lane, where the car begins."""
        return 0.5 * sum(self.entry_edges_m)

    @property
    def shift_m(self) -> float:
        """From the middle of the entry lane to that of the other one."""
        return 0.5 * sum(self.other_edges_m) - self.start_y_m

    @property
    def length_m(self) -> float:
        """L: from the end of the entry lane to the beginning of the exit lane."""
        return self.exit_m[0] - self.entry_m[1]

    @property
    def narrowest_m(self) -> float:
        """Width of the narrowest lane."""
        return min(left - right for right, left in (self.entry_edges_m, self.other_edges_m, self.exit_edges_m))

    def sections(self) -> list[tuple[float, float, float, float]]:
        """Return from, to, right edge and left edge of every section (m)."""
        lanes = [
            (*self.entry_m, *self.entry_edges_m),
            (*self.other_m, *self.other_edges_m),
            (*self.exit_m, *self.exit_edges_m),
        ]
        if not self.between:
            return lanes
        road = []
        for before, after in zip(lanes, lanes[1:], strict=False):
            road.append((before[1], after[0], min(before[2], after[2]), max(before[3], after[3])))
        return [lanes[0], road[0], lanes[1], road[1], lanes[2]]

    def corridor(self) -> Corridor:
        """Return the sections as the simulation takes them."""
        columns = np.array(self.sections()).T
        return Corridor(from_m=columns[0], to_m=columns[1], right_m=columns[2], left_m=columns[3])

    def check_width(self, width_m: float) -> None:
        """Refuse a car that does not fit.

        Raises
        ------
        ParameterError
            The car is as wide as the narrowest lane, or wider.
        """
        if not 0.0 < width_m < self.narrowest_m:
            raise ParameterError(
                f"a car of {width_m:g} m does not fit into a lane of {self.narrowest_m:g} m ({self.name})",
                "body.width_m",
                "Give a wider lane or a narrower car, and a width above 0.",
            )

    def to_dict(self) -> dict[str, Any]:
        """Return the track as plain JSON values."""
        lanes = ("entry", "other", "exit")
        numbers = {k: list(getattr(self, k)) for lane in lanes for k in (f"{lane}_m", f"{lane}_edges_m")}
        return {"name": self.name, "length_m": self.length_m, **numbers, "between": self.between}

    def __str__(self) -> str:
        return (
            f"{self.name}: L = {self.length_m:g} m, the other lane from {self.other_m[0]:g} to {self.other_m[1]:g} m, "
            f"{self.shift_m:+.3g} m across, narrowest lane {self.narrowest_m:.3g} m"
        )


def avoiding(
    length_m: float,
    *,
    obstacle_m: float = OBSTACLE_M,
    lane_width_m: float = LANE_WIDTH_M,
    shift_m: float | None = None,
    entry_m: float = ENTRY_M,
    exit_m: float = EXIT_M,
) -> Track:
    """Return the paper's corridor for avoiding: out of the lane, past an obstacle, back, within L.

    Parameters
    ----------
    length_m : float
        L, from the end of the own lane to where it begins again.
    obstacle_m : float
        How long the other lane must be held, in the middle of L.
    lane_width_m : float
    shift_m : float, optional
        From lane to lane, middle to middle; a lane's width where not given. Negative: to the right.
    entry_m, exit_m : float
        Length of the own lane before (from the car's reference point) and after.

    Raises
    ------
    ParameterError
        Numbers that make no corridor.

    Notes
    -----
    The paper prints neither widths nor lengths (its fig. 6 only names L): they are luztar's choice.
    """
    return _paper("avoiding", length_m, obstacle_m, lane_width_m, shift_m, entry_m, exit_m)


def overtaking(
    length_m: float,
    *,
    passing_m: float | None = None,
    lane_width_m: float = LANE_WIDTH_M,
    shift_m: float | None = None,
    entry_m: float = ENTRY_M,
    exit_m: float = EXIT_M,
) -> Track:
    """Return the paper's corridor for overtaking: the other lane is held for a while.

    Parameters
    ----------
    length_m, lane_width_m, shift_m, entry_m, exit_m
        As :func:`avoiding`.
    passing_m : float, optional
        How long the other lane must be held; 0.4 L where not given.

    Raises
    ------
    ParameterError
        Numbers that make no corridor.
    """
    passing = PASSING_SHARE * number("length_m", length_m) if passing_m is None else passing_m
    return _paper("overtaking", length_m, passing, lane_width_m, shift_m, entry_m, exit_m)


def _paper(
    name: str,
    length_m: float,
    held_m: float,
    lane_width_m: float,
    shift_m: float | None,
    entry_m: float,
    exit_m: float,
) -> Track:
    given = {"length_m": length_m, "lane_width_m": lane_width_m, "entry_m": entry_m, "exit_m": exit_m}
    held_key = "obstacle_m" if name == "avoiding" else "passing_m"
    for key, value in {**given, held_key: held_m}.items():
        if not (np.isfinite(number(key, value)) and value > 0.0):
            raise ParameterError(f"{key} is {value:g}", key, "Give a length above 0 in metres.")
    if held_m >= length_m:
        raise ParameterError(
            f"the other lane has to be held for {held_m:g} m of {length_m:g} m: no way is left to change over",
            held_key,
            "Give a longer length_m.",
        )
    shift = lane_width_m if shift_m is None else number("shift_m", shift_m)
    half, way = 0.5 * lane_width_m, 0.5 * (length_m - held_m)
    own = (-half, half)
    return Track(
        name=name,
        entry_m=(-BEHIND_M, entry_m),
        other_m=(entry_m + way, entry_m + way + held_m),
        exit_m=(entry_m + length_m, entry_m + length_m + exit_m),
        entry_edges_m=own,
        other_edges_m=(shift - half, shift + half),
        exit_edges_m=own,
    )


def iso_3888_1(car_width_m: float, *, entry_m: float = 15.0, exit_m: float = 15.0) -> Track:
    """Return the track of ISO 3888-1, as Project Chrono's double-lane-change demonstration has it.

    Parameters
    ----------
    car_width_m : float
        The lanes depend on it: 1.1, 1.2 and 1.3 widths plus 0.25 m.
    entry_m, exit_m : float

    Raises
    ------
    ParameterError
        Not a positive width.

    Notes
    -----
    The text of the standard was not at hand; the numbers come from secondary sources. Between the lanes
    the car is free.
    """
    return _iso("iso_3888_1", car_width_m, entry_m, exit_m)


def iso_3888_2(car_width_m: float, *, entry_m: float = 12.0, exit_m: float = 12.0) -> Track:
    """Return the track of ISO 3888-2 (obstacle avoidance); parameters and reservations as :func:`iso_3888_1`.

    Raises
    ------
    ParameterError
        Not a positive width.
    """
    return _iso("iso_3888_2", car_width_m, entry_m, exit_m)


def _iso(name: str, width: float, entry_m: float, exit_m: float) -> Track:
    for key, value in {"car_width_m": width, "entry_m": entry_m, "exit_m": exit_m}.items():
        if not (np.isfinite(number(key, value)) and value > 0.0):
            raise ParameterError(f"{key} is {value:g}", key, "Give a length above 0 in metres.")
    half = 0.5 * (1.1 * width + 0.25)
    if name == "iso_3888_1":
        first, held, second = 30.0, 25.0, 25.0
        right, other, last = 3.5, 1.2 * width + 0.25, 1.3 * width + 0.25
    else:
        first, held, second = 13.5, 11.0, 12.5
        right, other, last = half + 1.0, width + 1.0, min(1.3 * width + 0.25, 3.0)
    begins = entry_m + first
    returns = begins + held + second
    return Track(
        name=name,
        entry_m=(-BEHIND_M, entry_m),
        other_m=(begins, begins + held),
        exit_m=(returns, returns + exit_m),
        entry_edges_m=(-half, half),
        other_edges_m=(right, right + other),
        exit_edges_m=(-half, last - half),
        between=False,
    )


def named(name: str, *, length_m: float | None, car_width_m: float, **given: Any) -> Track:
    """Return a track by its name, one of ``NAMES``.

    Raises
    ------
    ParameterError
        An unknown name, or a length where the track has its own or none where it needs one.
    """
    if name not in NAMES:
        raise ParameterError(f"there is no manoeuvre {name!r}", "manoeuvre", f"Known are: {', '.join(NAMES)}.")
    if name.startswith("iso"):
        if length_m is not None:
            raise ParameterError(f"{name} has its own length", "length_m", "Leave it out.")
        return {"iso_3888_1": iso_3888_1, "iso_3888_2": iso_3888_2}[name](car_width_m, **given)
    if length_m is None:
        raise ParameterError(f"{name} needs the length L of its corridor", "length_m", "Give it in metres.")
    return {"avoiding": avoiding, "overtaking": overtaking}[name](length_m, **given)
