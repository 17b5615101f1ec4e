"""Column headers taken apart: the name, the unit, and the channel that a name means."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from . import units as _units

# Names as they stand after `plain`: lower case, single spaces. Only names that can mean one channel are listed;
# "wheel angle", "load cell" or "column" could mean several and need --map.
_NAMES: Mapping[str, tuple[str, ...]] = {
    "time": ("time", "t", "zeit", "timestamp", "time stamp", "elapsed time", "messzeit", "temps", "tiempo"),
    "angle": (
        "angle",
        "sr angle",
        "steering angle",
        "steer angle",
        "steering wheel angle",
        "steering robot angle",
        "swa",
        "winkel",
        "lenkwinkel",
        "lenkradwinkel",
        "drehwinkel",
    ),
    "torque": (
        "torque",
        "sr torque",
        "sr column torque",
        "column torque",
        "steering torque",
        "steering wheel torque",
        "steering column torque",
        "measured torque",
        "moment",
        "drehmoment",
        "lenkmoment",
        "lenkradmoment",
        "handmoment",
    ),
    "force": ("force", "measured force", "kraft"),
    "position": ("position", "pos", "displacement", "weg"),
    "handwheel": ("handwheel", "hand wheel", "handwheel angle", "hand wheel angle"),
    "roadwheel": ("roadwheel", "road wheel", "roadwheel angle", "road wheel angle"),
    "load": ("load", "axial load", "normal load", "last"),
    "speed": ("speed", "vehicle speed", "forward speed", "longitudinal speed", "geschwindigkeit"),
    "yaw_rate": ("yaw rate", "yaw velocity", "yawrate", "gierrate", "giergeschwindigkeit"),
    "lateral_acceleration": ("lateral acceleration", "lateral acc", "ay", "querbeschleunigung"),
    "roll_angle": ("roll angle", "roll", "wankwinkel"),
}
_CHANNEL_OF: dict[str, str] = {name: key for key, names in _NAMES.items() for name in names}

# Words in round brackets that say something about the signal and are no unit.
_QUALIFIERS = frozenset({"estimated", "measured", "filtered", "raw", "unfiltered", "calculated"})


@dataclass(frozen=True)
class Column:
    """One column of a file: where it stands, its header, and the header taken apart.

    Attributes
    ----------
    index : int
        Position in the file, from 0.
    header : str
        As written in the file.
    name : str
        The header without its unit.
    unit : str or None
        The unit's spelling; None where the file gives none.
    """

    index: int
    header: str
    name: str
    unit: str | None

    @property
    def estimated(self) -> bool:
        """Whether the header calls the signal an estimate."""
        return "estimated" in self.name.lower()

    @property
    def channel(self) -> str | None:
        """The channel this name means, or None."""
        return channel_of(self.name)


def plain(name: str) -> str:
    """Return a name in lower case with single spaces between its words."""
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
    return " ".join(re.sub(r"[_\-./:]+", " ", spaced).lower().split())


def channel_of(name: str) -> str | None:
    """Return the channel that a column called ``name`` (without unit) means, or None."""
    bare = re.sub(r"\((\w+)\)", lambda m: "" if m[1].lower() in _QUALIFIERS else m[0], name)
    return _CHANNEL_OF.get(plain(bare)) or _CHANNEL_OF.get(" ".join(bare.lower().split()))


def parse_header(index: int, header: str, unit: str | None = None) -> Column:
    """Take a header apart: ``name_unit``, ``name [unit]``, ``name (unit)``, ``name / unit``.

    Parameters
    ----------
    index : int
        The column's position, from 0.
    header : str
        As written.
    unit : str, optional
        The unit from a row of its own, which then decides.
    """
    text = header.strip().strip('"').strip()
    if unit is not None and unit.strip().strip("[]()"):
        return Column(index, text, text, unit.strip())
    square = re.fullmatch(r"(.*?)\s*\[([^\[\]]*)\]", text)
    if square:
        return Column(index, text, square[1].strip(), square[2].strip() or None)
    round_ = re.fullmatch(r"(.*?)\s*\(([^()]*)\)", text)
    if round_:
        inside = round_[2].strip()
        is_unit = _units.find(inside) is not None
        is_word = inside.lower() in _QUALIFIERS or not inside
        if is_unit or (not is_word and channel_of(round_[1]) is not None):
            return Column(index, text, round_[1].strip(), inside)
        if not is_word:
            return Column(index, text, text, None)
    slash = re.fullmatch(r"(.*?)\s+/\s*(\S+)", text)
    if slash and _units.find(slash[2]) is not None:
        return Column(index, text, slash[1].strip(), slash[2])
    for parts in (2, 1):
        pieces = text.rsplit("_", parts)
        if len(pieces) == parts + 1 and pieces[0]:
            spelling = "_".join(pieces[1:])
            if _units.find(spelling) is not None:
                return Column(index, text, pieces[0], spelling)
    base, _, suffix = text.rpartition("_")
    if base and channel_of(text) is None and channel_of(base) is not None and _units.nearest(suffix):
        # "angle_dgr": meant as a unit and misspelt; kept as one so that the message can say so.
        return Column(index, text, base, suffix)
    return Column(index, text, text, None)
