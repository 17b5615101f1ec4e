"""The command that looks at a test beforehand."""

from command_line import luztar


def test_the_plan_prints_a_table_or_one_object():
    text = luztar("plan", "--structure", "rig", "--encoder-deg", "0.02", "--speed", "5", "38", "--angle", "50")
    assert text.code == 0 and "once_per_rev" in text.out and "cannot tell apart" in text.out
    made = luztar("plan", "--json", "--noise", "0.05", "--runs", "2").json
    assert made["test"]["noise"]["rms"] == 0.05 and made["test"]["runs"] == 2


def test_a_plan_can_be_written_as_a_page(tmp_path):
    made = luztar("plan", "--structure", "axis", "--report", "plan.html", folder=tmp_path)
    assert made.code == 0 and "report: plan.html" in made.err
    assert (tmp_path / "plan.html").stat().st_size > 10_000


def test_a_plan_without_sense_is_an_input_error():
    made = luztar("plan", "--angle", "-3", "--json")
    assert made.code == 3 and made.json["error"]["where"] == "--angle"
    assert luztar("plan", "--speeds", "fast").code == 3


def test_a_slip_of_the_pen_is_named_in_the_options_own_words_and_unit():
    wide = luztar("plan", "--angle", "1e6", "--json").json["error"]
    assert wide["where"] == "--angle" and wide["kind"].startswith("1e+06 deg")
    assert wide["remedy"] == "Give a number from 2.5 to 3600 deg."
    assert luztar("plan", "--structure", "axis", "--angle", "10", "--json").json["error"]["remedy"] == (
        "Give travel_m instead."
    )
