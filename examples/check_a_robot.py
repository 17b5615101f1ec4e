"""Check a steering robot by TB 038: three runs in, a verdict out.

python check_a_robot.py run1.csv run2.csv run3.csv
"""

from __future__ import annotations

import sys

import luztar


def main(paths: list[str]) -> int:
    """Print the verdict and what stands behind it; the exit code is that of ``luztar tb038``."""
    # A column that is not known by its name: map={"torque": "ADC6*0.52"} (a force times the link distance of 0.52 m).
    runs = luztar.read(*paths)
    check = luztar.tb038.evaluate(runs)
    print(check.verdict)
    print(runs)
    print(check)
    return {"pass": 0, "fail": 1}.get(check.verdict, 2)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
