"""Importing luztar costs NumPy and nothing else."""

from __future__ import annotations

import subprocess
import sys


def test_import_loads_numpy_and_nothing_else() -> None:
    code = (
        "import sys, numpy; before = set(sys.modules); import luztar, luztar.signal, luztar.stats, luztar.regression; "
        "new = {m.partition('.')[0] for m in set(sys.modules) - before}; "
        "print(*sorted(m for m in new if m not in sys.stdlib_module_names))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["luztar"]
