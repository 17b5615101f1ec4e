"""What `import luztar` costs on top of NumPy: `python benches/bench_import.py`.

Each figure is the median over fresh interpreters, timed inside each one so that its own start does not count. The aim
is 40 ms beyond NumPy; a test holds what may be loaded (tests/test_house.py), no test holds a time.
"""

from __future__ import annotations

import statistics
import subprocess
import sys

RUNS = 15
STATEMENTS = (
    "import luztar",
    "import luztar.measurement",
    "import luztar.model",
    "import luztar.tb038",
    "import luztar.diagnosis",
)


def milliseconds(statement: str) -> float:
    """Return the time one statement takes in a fresh interpreter that has NumPy already."""
    code = f"import time, numpy; t = time.perf_counter(); {statement}; print(1e3 * (time.perf_counter() - t))"
    return float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout)


def main() -> None:
    """Print one line per statement."""
    milliseconds(STATEMENTS[0])  # the first run may compile byte code
    for statement in STATEMENTS:
        times = [milliseconds(statement) for _ in range(RUNS)]
        print(f"{statement:<28} {statistics.median(times):6.1f} ms  (least {min(times):.1f}, {RUNS} interpreters)")


if __name__ == "__main__":
    main()
