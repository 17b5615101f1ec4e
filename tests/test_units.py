import math

import pytest

import luztar
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


def test_an_unknown_unit_is_named_with_file_column_what_is_known_and_the_option(tmp_path):
    path = tmp_path / "gon.csv"
    path.write_text("time_s,angle [gon],torque [Nm]\n0,1,2\n1,2,3\n2,3,4\n")
    with pytest.raises(MeasurementError) as caught:
        luztar.read(path)
    said = str(caught.value)
    for words in (
        "gon.csv",
        "'angle [gon]'",
        "unknown unit 'gon' for angle",
        "rad, mrad, deg, rev",
        "--unit angle=rad",
    ):
        assert words in said
    # The option it names helps, and leaves a word of what was done.
    run = luztar.read(path, units={"angle": "deg"})[0]
    assert run["angle"][0] == pytest.approx(math.radians(1.0), rel=1e-15)
    assert any("'gon', is not known" in f.text for f in run.integrity.findings)


def test_a_channel_name_with_something_behind_it_is_offered_with_map_and_unit(tmp_path):
    path = tmp_path / "xy.csv"
    path.write_text("time_s,angle_deg,torque_Xy\n0,1,2\n1,2,3\n2,3,4\n")
    with pytest.raises(MeasurementError, match='--map torque="torque_Xy" --unit torque=Nm'):
        luztar.read(path)[0]["torque"]
    run = luztar.read(path, map={"torque": "torque_Xy"}, units={"torque": "Nm"})[0]
    assert run["torque"][2] == 4.0
