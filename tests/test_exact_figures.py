"""Each exact figure from the oracle to 1e-10 and from the step of fixed cost, and the table of docs/dynamics.md."""

from pathlib import Path

import pytest

from . import test_oracle_exact
from .exact_figures import TRUST, Figure, figures

FIGURES = figures()
PAGE = Path(__file__).resolve().parents[1] / "docs" / "dynamics.md"


@pytest.mark.parametrize("figure", FIGURES, ids=lambda f: f.name)
def test_the_oracle_and_the_step_have_the_figure(figure: Figure):
    assert figure.oracle() == pytest.approx(figure.value, rel=TRUST, abs=TRUST)
    assert figure.split() == pytest.approx(figure.value, rel=0.0, abs=figure.split_bound)
    assert hasattr(test_oracle_exact, f"test_{figure.test}")


@pytest.mark.parametrize("figure", FIGURES, ids=lambda f: f.name)
def test_the_page_shows_the_figure(figure: Figure):
    row = next(line for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith(f"| {figure.name} |"))
    _, _, value, oracle, split, test, _ = (cell.strip() for cell in row.split("|"))
    assert float(value) == pytest.approx(figure.value, rel=1e-9)
    assert float(oracle) < TRUST * max(1.0, abs(figure.value))
    assert float(split) <= figure.split_bound
    assert test == f"`{figure.test}`"
