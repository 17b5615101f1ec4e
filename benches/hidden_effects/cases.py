"""What is hidden, at what size, in what noise: the list of cases and the measurements of each."""

from __future__ import annotations

import functools
import hashlib
import sys
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import luztar

TOP = Path(__file__).resolve().parents[2]
# The generator belongs to the tests: it shares no code with what it tests.
if str(TOP / "tests") not in sys.path:
    sys.path.append(str(TOP / "tests"))

from generators import typical  # noqa: E402
from generators.rig import RigRun, simulate_rig_set  # noqa: E402

NOISES = ("white", "50 ms", "0.5 s")
NOTHING = "nothing"
EFFECTS = tuple(typical.RIG)
OUTSIDE = tuple(typical.RIG_OUTSIDE)
# While moving, a friction that differs by direction is an offset: either name is right.
ALSO_RIGHT: Mapping[str, tuple[str, ...]] = {"asymmetric_coulomb": ("offset",)}
# These are searched from a model without an offset, for that is what they are or look like.
_WITHOUT_OFFSET = ("offset", "asymmetric_coulomb")


@dataclass(frozen=True)
class Settings:
    """What all cases of a calibration share.

    Attributes
    ----------
    runs, strokes : int
        Runs per case and strokes per run.
    wander_nm : float
        Standard deviation of the slow part of the noise.
    method : str
        Short digest of the code that decides, so that results of two versions are never added up.
    """

    runs: int = 3
    strokes: int = 6
    wander_nm: float = 0.02
    method: str = ""


@dataclass(frozen=True)
class Case:
    """One hidden effect (or none) in one set of runs."""

    effect: str
    size: float
    noise: str
    number: int
    settings: Settings = Settings()
    peers: bool = False

    @property
    def key(self) -> str:
        """What identifies a finished case in the file of results."""
        s = self.settings
        what = f"peers {peers_digest()}" if self.peers else f"luztar {s.method}"
        shared = f"{s.runs} runs of {s.strokes} strokes, wander {s.wander_nm:g}"
        return f"{self.effect} | {self.size:g} | {self.noise} | {self.number} | {shared} | {what}"

    @property
    def kind(self) -> str:
        """Return ``null``, ``outside`` or ``effect``."""
        return "null" if self.effect == NOTHING else "outside" if self.effect in OUTSIDE else "effect"

    @property
    def right(self) -> tuple[str, ...]:
        """The names that are right."""
        return () if self.kind != "effect" else (self.effect, *ALSO_RIGHT.get(self.effect, ()))

    def start(self) -> luztar.Model:
        """Return the model that the search starts from."""
        base = ("coulomb", "viscous") if self.effect in _WITHOUT_OFFSET else ("offset", "coulomb", "viscous")
        return luztar.Model("rig", base)

    def true_model(self) -> luztar.Model:
        """Return the model that holds the hidden effect."""
        return self.start() + self.effect if self.kind == "effect" else self.start()

    def seed(self) -> int:
        """Return the seed: every case has a hand, a rig and a noise of its own."""
        text = f"{self.effect}|{self.size:g}|{self.noise}|{self.number}"
        return zlib.crc32(text.encode())


@dataclass(frozen=True)
class Measured:
    """The runs of a case and the truth behind them."""

    runs: list[luztar.Run]
    clean: list[luztar.Run]
    raw: list[RigRun]
    hidden: dict[str, dict[str, object]]
    base: dict[str, dict[str, float]]

    def truth(self) -> dict[str, float]:
        """Return every parameter of the rig, keyed ``effect.parameter``."""
        both = {**self.base, **self.hidden}
        return {f"{e}.{k}": float(v) for e, p in both.items() for k, v in p.items() if not isinstance(v, str)}


def measure(case: Case) -> Measured:
    """Draw a rig around the table of typical sizes and record it."""
    seed = case.seed()
    effect = None if case.kind == "null" else case.effect
    hidden, base = typical.draw(effect, case.size, np.random.default_rng(seed))
    if case.effect in _WITHOUT_OFFSET:
        del base["offset"]
    options = dict(typical.needs(effect))
    motion = {"strokes": case.settings.strokes, **options.pop("motion", {})}
    raw = simulate_rig_set(
        hidden,
        base=base,
        runs=case.settings.runs,
        seed=seed,
        noise=case.noise,
        wander_nm=case.settings.wander_nm,
        motion=motion,
        **options,
    )
    return Measured(_as_runs(raw, clean=False), _as_runs(raw, clean=True), raw, hidden, base)


def _as_runs(raw: Sequence[RigRun], *, clean: bool) -> list[luztar.Run]:
    made = []
    for i, r in enumerate(raw, start=1):
        load = {} if r.load_n is None else {"load": r.load_n}
        torque = r.clean_torque_nm if clean else r.torque_nm
        made.append(luztar.Run(time=r.time_s, angle=r.angle_rad, torque=torque, name=f"run{i}", **load))
    return made


@functools.cache
def peers_digest() -> str:
    """Return a short digest of how the other programs are used."""
    return hashlib.sha256(Path(__file__).with_name("peers.py").read_bytes()).hexdigest()[:8]


def method_digest() -> str:
    """Return a short digest of the sources that fit, test and name."""
    digest = hashlib.sha256()
    package = Path(luztar.__file__).parent
    places = [package / "diagnosis", package / "model", package / "measurement", TOP / "rust" / "core" / "src"]
    for place in places:
        for path in sorted(p for p in place.rglob("*") if p.suffix in (".py", ".rs")):
            digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()[:8]


def cases(
    *,
    nulls: int,
    per_effect: int,
    sizes: Sequence[float],
    peers: int,
    settings: Settings,
    effects: Sequence[str] = EFFECTS,
    outside: Sequence[str] = OUTSIDE,
    noises: Sequence[str] = NOISES,
    outside_each: int | None = None,
) -> list[Case]:
    """Return all cases in the order in which they are worth having: whatever is cut short is balanced."""
    listed = [Case(NOTHING, 0.0, noise, i, settings) for i in range(nulls) for noise in noises]
    rounds = max(per_effect, outside_each or 0)
    for i in range(rounds):
        if i < per_effect:
            listed += [Case(e, s, n, i, settings) for s in sizes for n in noises for e in effects]
        if i < (per_effect if outside_each is None else outside_each):
            listed += [Case(e, 1.0, n, i, settings) for n in noises for e in outside]
    # False alarms are the rate that matters most: ten times as many records with nothing hidden.
    for i in range(min(nulls, 10 * peers)):
        listed += [Case(NOTHING, 0.0, noise, i, settings, peers=True) for noise in noises]
    for i in range(peers):
        listed += [Case(e, 1.0, n, i, settings, peers=True) for n in noises for e in (*effects, *outside)]
    return listed
