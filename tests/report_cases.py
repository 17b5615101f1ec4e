"""Studies and checks for the tests of the report; names as hostile as a file system or a user can make them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

import luztar
from generators.rig import simulate_rig
from luztar.diagnosis.study import Study
from luztar.diagnosis.verdict import Judgement

HOSTILE = "</script><img src=x onerror=alert(1)>.csv"
# A tag that plotly would turn into a link, a template's braces, a quote that would end an attribute.
HOSTILE_TOO = "<a href='https://example.com'>run</a> {{ 7*7 }} \"onload=\"alert(2) %{x}.csv"
STRIBECK = {"stribeck": {"extra_nm": 0.4, "speed_rad_s": 0.08}}


def run(name: str, seed: int, hidden: Mapping[str, object] | None = None, duration_s: float = 40.0) -> luztar.Run:
    time_s, angle_rad, torque_nm = simulate_rig(hidden, seed=seed, duration_s=duration_s, sample_rate_hz=250.0)
    return luztar.Run(time=time_s, angle=angle_rad, torque=torque_nm, name=name)


def runs(*names: str, hidden: Mapping[str, object] | None = None, duration_s: float = 40.0) -> luztar.Runs:
    return luztar.Runs(run(name, seed, hidden, duration_s) for seed, name in enumerate(names, start=11))


def with_verdict(study: Study, verdict: str, named: tuple[str, ...] = (), why: str = "") -> Study:
    """The study as if its last look had come out so, nothing having been added."""
    judgement = Judgement(verdict, named, named, {}, why)
    return replace(study, steps=study.steps[:1], looks=(replace(study.first, judgement=judgement),))


def provisional(study: Study) -> Study:
    """The study as if it had ended without an explanation."""
    judgement = Judgement("unexplained", (), (), {}, "a decoy without physics explains it best")
    steps = tuple(replace(s, provisional=s.added is not None) for s in study.steps)
    return replace(study, steps=steps, looks=(study.first, replace(study.last, judgement=judgement)))


def negated(given: luztar.Run) -> luztar.Run:
    return luztar.Run(time=given.time_s, angle=given["angle"], torque=-np.asarray(given["torque"]), name=given.name)
