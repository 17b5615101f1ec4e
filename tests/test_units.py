import math

import pytest

from luztar.errors import MeasurementError
from luztar.measurement import units


@pytest.mark.parametrize(
    ("spelling", "quantity", "si"),
    [
        ("Nm", "torque", 1.0),
        ("N*m", "torque", 1.0),
        ("N.m", "torque", 1.0),
        ("N·m", "torque", 1.0),
        ("NÂ·m", "torque", 1.0),
        ("nm", "torque", 1.0),
        ("cNm", "torque", 0.01),
        ("mNm", "torque", 0.001),
        ("deg", "angle", math.pi / 180),
        ("°", "angle", math.pi / 180),
        ("Â°", "angle", math.pi / 180),
        ("Grad", "angle", math.pi / 180),
        ("rad", "angle", 1.0),
        ("mrad", "angle", 0.001),
        ("s", "time", 1.0),
        ("ms", "time", 0.001),
        ("m", "length", 1.0),
        ("mm", "length", 0.001),
        ("N", "force", 1.0),
        ("kN", "force", 1000.0),
        (" [ N m ] ", "torque", 1.0),
    ],
)
def test_a_spelling_means_one_unit(spelling, quantity, si):
    unit = units.parse(spelling, "here")
    assert (unit.quantity, unit.si) == (quantity, si)


def test_the_foot_pound_is_the_textbook_number():
    # NIST SP 811, appendix B.8: 1 lbf ft = 1.355 818 N m.
    assert units.parse("lbf.ft", "here").si == pytest.approx(1.355818, abs=5e-7)


def test_the_case_of_a_prefix_is_kept_apart():
    assert units.parse("mN", "here").si == 1e-3
    assert units.find("MN") is None


@pytest.mark.parametrize(
    ("spelling", "guess"), [("degg", "deg"), ("Nmn", "Nm"), ("radd", "rad"), ("kilonewtons", "kilonewton")]
)
def test_an_unknown_unit_is_an_error_with_the_nearest_guesses(spelling, guess):
    with pytest.raises(MeasurementError) as caught:
        units.parse(spelling, "file.csv, column 'angle'")
    assert spelling in caught.value.kind
    assert caught.value.where == "file.csv, column 'angle'"
    assert guess in caught.value.remedy


def test_every_quantity_has_a_symbol_that_is_its_own_unit():
    for quantity, symbol in units.SI_SYMBOL.items():
        unit = units.UNITS[symbol]
        assert (unit.quantity, unit.si) == (quantity, 1.0)


def test_no_spelling_stands_in_the_table_twice():
    spellings = [spelling for *_, row in units._TABLE for spelling in row.split()]
    assert len(spellings) == len(set(spellings))
