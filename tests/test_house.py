"""The house stands as planned: what depends on what, what importing costs, what the package holds."""

from __future__ import annotations

import ast
import importlib.metadata
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path

import pytest

import luztar
from luztar import _core, effects

TOP = Path(__file__).resolve().parents[1]
PACKAGE = TOP / "python" / "luztar"
MOST_LINES = 500

# Loaded when they are first needed, never by `import luztar`.
LAZY = {"jinja2", "pandas", "plotly", "pydantic", "rich", "scipy", "typer"}

# Who may import whom at the head of a module. `figure()` and `report()` of results reach upward inside functions.
FOUNDATION = {"_arrays", "_core", "_printed", "_stream", "errors"}
MAY_IMPORT = {
    "errors": set(),
    "_arrays": {"errors"},
    "_stream": {"errors"},
    "_printed": set(),
    "signal": FOUNDATION,
    "stats": FOUNDATION,
    "regression": FOUNDATION,
    "measurement": FOUNDATION,
    "tb038": FOUNDATION | {"measurement", "signal", "stats", "regression"},
    "model": FOUNDATION,
    "effects": FOUNDATION | {"model"},
    "dynamics": FOUNDATION,
    "mechanism": FOUNDATION,
    "projections": FOUNDATION,
    "vehicle": FOUNDATION | {"dynamics"},
    "manoeuvre": FOUNDATION | {"dynamics", "vehicle"},
    "diagnosis": FOUNDATION | {"measurement", "model"},
    "freerun": FOUNDATION | {"diagnosis", "dynamics", "measurement", "model", "vehicle"},
    "planning": FOUNDATION | {"diagnosis", "measurement", "model"},
}
# Not even inside a function.
NEVER = {
    "measurement": {"diagnosis", "model", "report", "cli", "app", "tb038"},
    "tb038": {"diagnosis", "model", "cli", "app"},
    "model": {"diagnosis", "measurement", "report", "cli", "app", "tb038"},
    "diagnosis": {"cli", "app"},
    "freerun": {"cli", "app", "report", "tb038"},
    "planning": {"cli", "app", "tb038"},
    "manoeuvre": {"cli", "app", "diagnosis", "tb038"},
    "report": {"cli", "app"},
}


def loaded_by(statement: str) -> set[str]:
    """The packages outside the standard library that a statement loads beyond NumPy's own."""
    code = (
        f"import sys, numpy; before = set(sys.modules); {statement}; "
        "new = {m.partition('.')[0] for m in set(sys.modules) - before}; "
        "print(*sorted(m for m in new if m not in sys.stdlib_module_names))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(run.stdout.split())


def test_import_loads_numpy_and_nothing_else() -> None:
    assert loaded_by("import luztar, luztar.signal, luztar.stats, luztar.regression") == {"luztar"}


def test_a_model_and_a_run_need_no_heavy_package() -> None:
    statement = "import luztar; luztar.Model.rig() + 'stribeck'; luztar.Run(sample_rate_hz=1.0, angle=[0.0, 1.0])"
    assert not loaded_by(statement) & LAZY


def test_core_and_distribution_are_of_one_version() -> None:
    workspace = tomllib.loads((TOP / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]["package"]["version"]
    assert _core.__version__ == luztar.__version__ == importlib.metadata.version("luztar") == workspace


def test_every_public_name_resolves_and_is_documented() -> None:
    for name in dir(luztar):
        value = getattr(luztar, name)
        assert name == "__version__" or (value.__doc__ or "").strip(), name
    for name in dir(effects):
        assert getattr(effects, name).__doc__.strip(), name
    with pytest.raises(AttributeError, match="no_such_name"):
        luztar.no_such_name  # noqa: B018


def test_the_installed_package_holds_every_file_that_is_no_code() -> None:
    built = {".py", ".pyc", ".so", ".pyd"}
    found = [p.relative_to(PACKAGE) for p in PACKAGE.rglob("*") if p.is_file() and p.suffix not in built]
    names = {p.as_posix() for p in found}
    assert {"py.typed", "_core.pyi", "demo_data/run1.csv.gz", "tb038/rule_sets/tb_038_v1_0.toml"} <= names
    assert [p.as_posix() for p in found if not files("luztar").joinpath(*p.parts).is_file()] == []


def test_the_installed_package_holds_the_licence() -> None:
    listed = importlib.metadata.files("luztar") or []
    assert any(path.name == "LICENSE" for path in listed)


# --- directions ---


def part_of(path: Path) -> str:
    """The part of the package that a file belongs to: a folder or a module of the top."""
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def imports(path: Path) -> Iterator[tuple[str, bool]]:
    """The parts of luztar that a file imports, and whether it does so inside a function or for types only."""
    package = ("luztar", *path.relative_to(PACKAGE).parts[:-1])

    def names(node: ast.AST) -> list[str]:
        if isinstance(node, ast.Import):
            return [alias.name for alias in node.names]
        if isinstance(node, ast.ImportFrom):
            start = ".".join(package[: len(package) - node.level + 1]) if node.level else ""
            base = ".".join(filter(None, (start, node.module)))
            return [f"{base}.{alias.name}" for alias in node.names] if base == "luztar" else [base]
        return []

    def walk(node: ast.AST, lazy: bool) -> Iterator[tuple[str, bool]]:
        for child in ast.iter_child_nodes(node):
            for name in names(child):
                top, _, rest = name.partition(".")
                if top == "luztar" and rest:
                    yield rest.partition(".")[0], lazy
            types_only = isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING"
            yield from walk(child, lazy or types_only or isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef))

    yield from walk(ast.parse(path.read_text(encoding="utf-8")), False)


def python_files() -> list[Path]:
    return sorted(PACKAGE.rglob("*.py"))


def test_imports_run_in_one_direction() -> None:
    wrong = []
    for path in python_files():
        own = part_of(path)
        for other, lazy in imports(path):
            at_head = not lazy and own in MAY_IMPORT and other != own and other not in MAY_IMPORT[own]
            if at_head or other in NEVER.get(own, ()):
                wrong.append(f"{path.relative_to(PACKAGE)} imports {other}")
    assert wrong == []


def test_the_parser_of_imports_sees_what_it_should() -> None:
    seen = dict(imports(PACKAGE / "diagnosis" / "study.py"))
    assert seen["model"] is False and seen["report"] is True and seen["measurement"] is True


def test_the_core_knows_no_python() -> None:
    manifest = tomllib.loads((TOP / "rust" / "core" / "Cargo.toml").read_text(encoding="utf-8"))
    assert not {"pyo3", "numpy", "luztar-bindings"} & set(manifest["dependencies"])
    if shutil.which("cargo") is None:
        pytest.skip("cargo is not at hand: only the manifest was read")
    tree = subprocess.run(
        [
            "cargo",
            "tree",
            "--locked",
            "--offline",
            "--package",
            "luztar",
            "--edges",
            "normal,build",
            "--prefix",
            "none",
        ],
        cwd=TOP,
        capture_output=True,
        text=True,
    )
    if tree.returncode != 0:
        pytest.skip(f"cargo tree: {tree.stderr.strip().splitlines()[-1]}")
    crates = {line.split()[0] for line in tree.stdout.splitlines() if line.strip()}
    assert "nalgebra" in crates
    assert not {c for c in crates if c.startswith("pyo3") or c == "numpy"}


# --- files ---


def tracked() -> list[Path]:
    if shutil.which("git") is None or not (TOP / ".git").exists():
        pytest.skip("not a git checkout")
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=TOP, capture_output=True, text=True, check=True).stdout
    return [TOP / name for name in listed.split("\0") if name and (TOP / name).is_file()]


def test_no_file_is_called_after_nothing() -> None:
    empty = {"utils", "util", "helpers", "helper", "common", "misc"}
    assert [p.name for p in tracked() if p.stem.strip("_") in empty] == []


def test_no_python_file_does_two_jobs() -> None:
    long = {
        p.name: n for p in tracked() if p.suffix == ".py" and (n := len(p.read_text("utf-8").splitlines())) > MOST_LINES
    }
    assert long == {}


# Spelt in pieces, so that this file does not find itself.
_PLACES = "|".join(("home", "root", "tmp", "work", "Users", "mnt", "private/var"))
ABSOLUTE = re.compile(rf"(?<![\w.~$}}/*])/(?:{_PLACES})/\w|\b[A-Z]:\\\\?Users\b")
UNFINISHED = re.compile("TO" + "DO|FIX" + "ME|X" + "XX")
TEXT = {"", ".md", ".py", ".pyi", ".rs", ".toml", ".json", ".html", ".css", ".js", ".j2", ".csv"}


def test_no_place_of_one_machine_and_nothing_unfinished_in_the_files() -> None:
    found = []
    for path in tracked():
        if path.suffix not in TEXT:
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            if ABSOLUTE.search(line) or UNFINISHED.search(line):
                found.append(f"{path.relative_to(TOP)}:{number}: {line.strip()[:80]}")
    assert found == []
