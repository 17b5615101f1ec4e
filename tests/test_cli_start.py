"""What a user meets first: help, version, a quick start, a closed pipe."""

from __future__ import annotations

import subprocess
import sys

import pytest

from command_line import luztar

COMMANDS = ("demo", "tb038", "compare", "diagnose", "study", "fit", "plan", "simulate", "explain", "manoeuvre")

OPTIONS = {
    "demo": "--out --json --debug",
    "tb038": "--map --unit --link-distance-m --centre --resample --json --report --debug",
    "compare": "--model --map --unit --held-out --band --resample --json --debug",
    "diagnose": "--model --map --unit --held-out --band --resample --json --debug",
    "study": "--model --map --unit --held-out --band --resample --max-effects --json --report --debug",
    "fit": "--model --add --map --unit --held-out --band --resample --json --debug",
    "plan": "--structure --encoder-deg --step-m --rate --speed --speeds --angle --travel-m --runs --strokes --minutes "
    "--noise --friction --json --report --debug",
    "simulate": "--sine --seconds --rate --out --map --unit --resample --json --debug",
    "manoeuvre": "optimise robust sensitivity map",
    "explain": "--json --debug",
}


def test_version() -> None:
    import luztar as package

    assert luztar("--version").out == f"luztar {package.__version__}\n"


def test_help_lists_the_commands_that_work_and_the_exit_codes(capsys) -> None:
    from luztar.cli import main

    assert main(["--help"]) == 0
    out, _ = capsys.readouterr()
    listed = [line.split()[0] for line in out.split("Commands:")[1].split("\n\n")[0].splitlines() if line.strip()]
    assert tuple(listed) == COMMANDS
    assert "..." not in out.split("Commands:")[1]
    assert "2 inconclusive" in out


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_a_command(command: str, capsys) -> None:
    from luztar.cli import main

    assert main([command, "--help"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith(f"Usage: luztar {command}") and not err
    words = out.replace(",", " ").split()
    assert all(option in words for option in OPTIONS[command].split())


def test_no_command_shows_the_help_as_a_mistake(capsys) -> None:
    from luztar.cli import main

    assert main([]) == 3
    out, err = capsys.readouterr()
    assert not out and err.startswith("Usage: luztar")


def test_starting_loads_nothing_heavy() -> None:
    code = (
        "import sys\nfrom luztar.cli import main\nmain(['--version'])\nmain(['tb038', '--help'])\n"
        "heavy = {'numpy', 'scipy', 'pandas', 'plotly', 'jinja2', 'rich'}\n"
        "print(*sorted(heavy & set(sys.modules)), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr.split() == []


@pytest.mark.skipif(sys.platform == "win32", reason="pipes close in another way there")
@pytest.mark.parametrize("words", ["explain", "explain --json", "--help"])
def test_a_reader_that_leaves_early_is_no_error(words: str) -> None:
    command = f"{sys.executable} -m luztar {words}"
    done = subprocess.run(["bash", "-c", f"{command} | true; exit ${{PIPESTATUS[0]}}"], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_console_without_the_letters_gets_a_question_mark() -> None:
    import os

    command = [sys.executable, "-m", "luztar", "explain", "inertia"]
    done = subprocess.run(command, capture_output=True, env={**os.environ, "PYTHONIOENCODING": "ascii"})
    assert done.returncode == 0 and b"kg" in done.stdout


def test_explain_shows_the_whole_card(capsys) -> None:
    from luztar.cli import main
    from luztar.model import cards

    for card in cards():
        assert main(["explain", card.name]) == 0
        out, _ = capsys.readouterr()
        words = " ".join(out.split())
        for text in (card.title, card.equation, card.look, card.typical, card.cause, card.check, card.source):
            assert " ".join(text.split()) in words
        for parameter in card.parameters:
            assert parameter.key in out and parameter.unit in out


@pytest.mark.parametrize("word", ["Stribeck", "STRIBECK", " stribeck "])
def test_explain_does_not_mind_capitals(word: str, capsys) -> None:
    from luztar.cli import main

    assert main(["explain", word]) == 0
    assert capsys.readouterr().out.startswith("stribeck:")
    assert main(["explain", "Once per rev"]) == 0


def test_a_negative_number_of_effects_is_a_mistake(capsys) -> None:
    from luztar.cli import main

    assert main(["study", "run.csv", "--model", "rig", "--max-effects", "-1"]) == 3
    assert "--max-effects" in capsys.readouterr().err
