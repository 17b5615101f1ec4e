"""What README, docs and examples show runs as it stands there."""

from __future__ import annotations

import ast
import gzip
import re
import subprocess
import sys
from importlib.resources import files
from pathlib import Path

import pytest

import luztar

TOP = Path(__file__).resolve().parents[1]
EXAMPLES = TOP / "examples"
PAGES = sorted([TOP / "README.md", *(TOP / "docs").glob("*.md")], key=lambda p: p.name)
_BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(page: Path, language: str) -> list[str]:
    return [text for word, text in _BLOCK.findall(page.read_text(encoding="utf-8")) if word == language]


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the files that the pages speak of: three runs, a model file, a rule set."""
    for number in (1, 2, 3):
        packed = files("luztar").joinpath("demo_data", f"run{number}.csv.gz").read_bytes()
        (tmp_path / f"run{number}.csv").write_bytes(gzip.decompress(packed))
    (tmp_path / "model.toml").write_bytes((EXAMPLES / "model.toml").read_bytes())
    rules = files("luztar").joinpath("tb038", "rule_sets", "tb_038_v1_0.toml").read_bytes()
    (tmp_path / "ours.toml").write_bytes(rules)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_python_on_a_page_runs(page: Path, bench: Path) -> None:
    """All blocks of a page in order, one namespace; a comment `# -> value` holds what the line gives."""
    namespace: dict[str, object] = {}
    for block in blocks(page, "python"):
        exec(compile(block, page.name, "exec"), namespace)
        for line in block.splitlines():
            expression, arrow, expected = line.partition("  # -> ")
            if arrow:
                assert repr(eval(expression, namespace)) == expected.strip(), line


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_model_files_on_a_page_load(page: Path, tmp_path: Path) -> None:
    for block in blocks(page, "toml"):
        if "structure" in block:
            path = tmp_path / "model.toml"
            path.write_text(block, encoding="utf-8")
            several = 'structure = "mechanism"' in block
            luztar.mechanism.Mechanism.load(path) if several else luztar.Model.load(path)


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_links_on_a_page_lead_somewhere(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#\s]+)", text):
        if "://" not in target:
            assert (page.parent / target).exists(), target


def test_the_readme_names_the_two_commands() -> None:
    text = (TOP / "README.md").read_text(encoding="utf-8")
    assert "pip install . && luztar demo" in text
    assert "pip install '.[test]' && pytest" in text


def run_example(name: str, *arguments: str, cwd: Path) -> str:
    command = [sys.executable, "-W", "error", str(EXAMPLES / name), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, cwd=cwd)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_robot_check_runs_on_files(bench: Path) -> None:
    assert run_example("check_a_robot.py", "run1.csv", "run2.csv", "run3.csv", cwd=bench).splitlines()[0] == "pass"


def test_the_missing_effects_of_the_demo_are_found(tmp_path: Path) -> None:
    assert "named: stribeck, asymmetric_viscous" in run_example("find_missing_effect.py", cwd=tmp_path)


def test_the_model_file_of_the_examples_is_the_rig_with_a_start_value() -> None:
    model = luztar.Model.load(EXAMPLES / "model.toml")
    assert model.structure_name == "rig" and "stribeck" in model.effects


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.py")), ids=lambda p: p.name)
def test_an_example_says_what_it_does(path: Path) -> None:
    assert ast.get_docstring(ast.parse(path.read_text(encoding="utf-8")))


def test_the_mechanism_of_the_examples_is_the_papers_with_static_friction() -> None:
    from luztar.mechanism import Mechanism, steering_mechanism

    assert Mechanism.load(EXAMPLES / "steering_mechanism.toml") == steering_mechanism(king_pin_static_nm=6.0)
