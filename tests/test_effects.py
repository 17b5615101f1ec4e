"""The catalogue of effects: complete cards, and the names that users' scripts rely on."""

from __future__ import annotations

import re

import pytest

from luztar import effects, errors
from luztar.model import Card, Model, card, cards
from luztar.model.cards import axis_key
from luztar.model.negative import WORDS, in_sense

# The public names, version 1 of the interface: effect -> kind and parameters, as a rig has them.
PUBLIC: dict[str, tuple[str, list[str]]] = {
    "offset": ("sensor", ["level_nm"]),
    "coulomb": ("friction_level", ["level_nm", "breakaway_rad"]),
    "viscous": ("torque", ["coefficient_nm_s_per_rad"]),
    "asymmetric_coulomb": ("friction_level", ["difference_nm"]),
    "asymmetric_viscous": ("torque", ["difference_nm_s_per_rad"]),
    "drag": ("torque", ["coefficient_nm_s2_per_rad2"]),
    "stribeck": ("friction_level", ["extra_nm", "speed_rad_s"]),
    "stiction": ("friction_level", ["extra_nm"]),
    "presliding": ("friction_level", ["breakaway_rad", "shape"]),
    "freeplay": ("transmission", ["gap_rad"]),
    "dead_zone": ("spring", ["stiffness_nm_per_rad", "half_width_rad"]),
    "stiffness": ("spring", ["stiffness_nm_per_rad"]),
    "hardening": ("spring", ["coefficient_nm_per_rad3"]),
    "end_stop": ("spring", ["stiffness_nm_per_rad", "limit_rad"]),
    "inertia": ("torque", ["inertia_kg_m2"]),
    "once_per_rev": ("torque", ["amplitude_nm", "phase_rad"]),
    "twice_per_rev": ("torque", ["amplitude_nm", "phase_rad"]),
    "cogging": ("torque", ["amplitude_nm", "phase_rad", "per_turn"]),
    "position_coulomb": ("friction_level", ["slope_nm_per_rad"]),
    "tight_spot": ("friction_level", ["extra_nm", "angle_rad", "width_rad"]),
    "load": ("friction_level", ["coefficient"]),
    "delay": ("sensor", ["time_s"]),
    "lead": ("sensor", ["time_s"]),
    "warmup": ("friction_level", ["extra_nm", "time_s"]),
    "drift": ("sensor", ["rate_nm_per_s"]),
    "dwell": ("friction_level", ["extra_nm", "time_s"]),
}
# The same parameters as an axis names them, n for nm and m for rad; a phase stays an angle.
AXIS = {
    "level_nm": "level_n",
    "breakaway_rad": "breakaway_m",
    "coefficient_nm_s_per_rad": "coefficient_n_s_per_m",
    "difference_nm": "difference_n",
    "difference_nm_s_per_rad": "difference_n_s_per_m",
    "coefficient_nm_s2_per_rad2": "coefficient_n_s2_per_m2",
    "extra_nm": "extra_n",
    "speed_rad_s": "speed_m_s",
    "shape": "shape",
    "gap_rad": "gap_m",
    "stiffness_nm_per_rad": "stiffness_n_per_m",
    "half_width_rad": "half_width_m",
    "coefficient_nm_per_rad3": "coefficient_n_per_m3",
    "limit_rad": "limit_m",
    "inertia_kg_m2": "inertia_kg",
    "amplitude_nm": "amplitude_n",
    "phase_rad": "phase_rad",
    "per_turn": "per_turn",
    "slope_nm_per_rad": "slope_n_per_m",
    "angle_rad": "angle_m",
    "width_rad": "width_m",
    "coefficient": "coefficient",
    "time_s": "time_s",
    "rate_nm_per_s": "rate_n_per_s",
}
UNITLESS = {"shape", "per_turn", "coefficient"}

real = [c for c in cards() if not c.is_decoy]
decoys = [c for c in cards() if c.is_decoy]


def name(c: Card) -> str:
    return c.name


@pytest.mark.parametrize("c", cards(), ids=name)
def test_a_card_is_complete(c: Card) -> None:
    for field in ("name", "title", "kind", "equation", "look", "cause", "check", "typical", "source"):
        assert getattr(c, field).strip(), field
    assert c.look.endswith(".") and c.cause.endswith(".") and c.check.endswith(".")
    for p in c.parameters:
        assert p.meaning.strip() and p.low < p.high
        assert p.symbol.strip() or p.role == "inner"


@pytest.mark.parametrize("c", real, ids=name)
def test_names_kinds_and_parameters_are_the_public_ones(c: Card) -> None:
    kind, keys = PUBLIC[c.name]
    assert c.kind == kind
    assert [p.key for p in c.parameters] == keys


@pytest.mark.parametrize("c", real, ids=name)
def test_an_axis_has_newtons_and_metres(c: Card) -> None:
    of_axis = card(c.name, "axis")
    assert [p.key for p in of_axis.parameters] == [AXIS[p.key] for p in c.parameters]
    for p in (*c.parameters, *of_axis.parameters):
        assert bool(p.unit) or p.key in UNITLESS, p.key
    if "phase_rad" not in [p.key for p in of_axis.parameters]:
        assert not any("rad" in p.unit or "Nm" in p.unit for p in of_axis.parameters)


def test_every_public_parameter_has_a_name_on_an_axis() -> None:
    for _, keys in PUBLIC.values():
        for key in keys:
            assert axis_key(key) == AXIS[key]


def test_two_decoys_of_different_kind_stand_beside_the_effects() -> None:
    assert len(decoys) >= 2
    assert not {c.name for c in decoys} & set(PUBLIC)


@pytest.mark.parametrize("c", real, ids=name)
def test_an_effect_needs_what_is_in_the_catalogue(c: Card) -> None:
    assert c.needs is None or c.needs in {other.name for other in real}


@pytest.mark.parametrize("c", real, ids=name)
def test_classes_carry_start_values_into_a_model(c: Card) -> None:
    make = getattr(effects, "".join(part.capitalize() for part in c.name.split("_")))
    start = {p.key: max(p.low, 0.0) + min(1.0, 0.5 * (p.high - max(p.low, 0.0))) for p in c.inner}
    base = Model("rig", tuple(dict.fromkeys(filter(None, (c.needs,)))))
    model = base + make(**start)
    assert c.name in model.effects
    assert {k: v for k, v in model.start.items() if k.startswith(f"{c.name}.")} == {
        f"{c.name}.{k}": v for k, v in start.items()
    }
    with pytest.raises(errors.ParameterError, match="no parameter"):
        make(no_such_parameter=1.0)


def test_a_misspelt_effect_is_refused_with_the_nearest_names() -> None:
    with pytest.raises(errors.ModelError, match="Did you mean stribeck"):
        Model.rig() + "stribek"


RIG_WORDS = re.compile(r"robot|wheel|torque|Nm|degree|TB 038|ring\b|\bangle|\barm\b|column|tyre|steering|thumb", re.I)


@pytest.mark.parametrize("c", [c for c in cards("axis") if not c.is_decoy], ids=name)
def test_an_axis_is_not_spoken_of_as_a_steering_robot(c: Card) -> None:
    texts = [c.title, c.look, c.cause, c.check, c.typical, *(p.meaning for p in c.parameters)]
    # A spring is no ring, and in once-per-turn effects a turn is the screw's.
    assert not [t for t in texts if RIG_WORDS.search(t.replace("spring", ""))]
    assert c.per_turn or not any(re.search(r"\bturn", t, re.I) for t in texts)
    assert all((c.look, c.cause, c.check))


@pytest.mark.parametrize("structure", ["rig", "axis"])
def test_a_negative_extra_is_told_in_its_own_words(structure: str) -> None:
    for effect in WORDS:
        c = card(effect, structure)
        key = c.linear[0].key
        assert c.linear[0].low < 0.0, "its sign is free"
        assert in_sense(c, {key: 0.3}) == c == in_sense(c, {})
        turned = in_sense(c, {key: -0.3})
        assert turned.look != c.look and turned.cause != c.cause and turned.check
    assert "regrease" in in_sense(card("stribeck"), {"extra_nm": -0.1}).check
    assert in_sense(card("stiffness"), {"stiffness_nm_per_rad": -1.0}) == card("stiffness")
