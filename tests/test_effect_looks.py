"""What effects look like: the pictures come from the laws, and what they show is what the cards say."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import luztar
from command_line import luztar as run
from luztar.errors import ModelError

TOP = Path(__file__).resolve().parents[1]


def added(name):
    shown = luztar.effects.look(name)
    return shown, shown.with_effect_nm - shown.plain_nm


def test_a_spring_is_a_straight_line_over_the_angle():
    shown, more = added("stiffness")
    slope = more / shown.angle_rad
    inside = np.abs(shown.angle_rad) > 0.2
    # Angle and torque come from one law through one low pass; what is left is the encoder's step.
    assert np.ptp(slope[inside]) < 0.02 * np.abs(slope[inside]).mean()


def test_direction_dependent_viscous_friction_adds_the_same_way_both_ways():
    _, more = added("asymmetric_viscous")
    assert more.min() > -0.02 * more.max()


def test_a_gap_only_takes_away():
    shown, more = added("freeplay")
    moving = np.abs(shown.plain_nm) > 0.7
    # Inside the gap nothing is felt; the low pass rings by a tenth of a jump.
    assert (np.abs(shown.with_effect_nm) - np.abs(shown.plain_nm))[moving].max() < 0.15
    assert np.abs(more).max() > 0.5


def test_a_load_or_the_loop_itself_has_no_picture():
    for name in ("load", "coulomb", "decoy_time"):
        with pytest.raises(ModelError, match=name):
            luztar.effects.look(name)


def test_a_card_is_written_with_its_picture(tmp_path):
    page = tmp_path / "stribeck.html"
    done = run("explain", "stribeck", "--report", page)
    assert done.code == 0 and "Stribeck" in done.out
    assert "plotly" in page.read_text(encoding="utf-8").lower()
    bare = tmp_path / "load.html"
    assert run("explain", "load", "--report", bare).code == 0
    assert "channel" in bare.read_text(encoding="utf-8")


def test_the_page_of_effects_is_what_the_cards_say():
    place = TOP / "docs" / "pictures" / "effects.py"
    spec = importlib.util.spec_from_file_location("draw_effects", place)
    drawer = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(drawer)
    assert (TOP / "docs" / "effects.md").read_text(encoding="utf-8") == drawer.page()
