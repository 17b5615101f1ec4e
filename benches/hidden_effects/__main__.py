"""Command line of the calibration: `python -m benches.hidden_effects --nulls 100 --per-effect 4 --out FOLDER`."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

# One thread per process: the processes share the work already. Before NumPy is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")


def _arguments() -> argparse.ArgumentParser:
    from .cases import EFFECTS, NOISES, OUTSIDE, TOP

    parser = argparse.ArgumentParser(prog="python -m benches.hidden_effects", description=__doc__)
    parser.add_argument("--nulls", type=int, default=100, help="cases with nothing hidden, per noise colour")
    parser.add_argument("--per-effect", type=int, default=4, help="cases per effect, size and noise colour")
    parser.add_argument("--outside-each", type=int, help="cases per effect outside the catalogue and noise colour")
    parser.add_argument("--sizes", type=float, nargs="+", default=[1.0, 0.3, 0.1], help="factors of the typical size")
    parser.add_argument("--noises", nargs="+", choices=NOISES, default=list(NOISES))
    parser.add_argument("--effects", nargs="+", choices=EFFECTS, default=list(EFFECTS), metavar="EFFECT")
    parser.add_argument("--outside", nargs="*", choices=OUTSIDE, default=list(OUTSIDE), metavar="EFFECT")
    parser.add_argument("--peers", type=int, default=0, help="cases per effect and noise colour for other programs")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--minutes", type=float, help="start no case after this time")
    parser.add_argument("--out", type=Path, default=TOP / "target" / "hidden_effects", help="folder of results.jsonl")
    parser.add_argument("--docs", type=Path, default=TOP / "docs", help="folder of validation.md and pictures")
    parser.add_argument("--page-only", action="store_true", help="run nothing, write the page from what is there")
    parser.add_argument("--no-page", action="store_true", help="run, write no page")
    parser.add_argument("--fast", action="store_true", help="two cases, to see that it runs")
    return parser


def main(given: list[str] | None = None) -> int:
    """Run the cases that are left and write the page."""
    options = _arguments().parse_args(given)
    if options.fast:
        options.nulls, options.per_effect, options.outside, options.peers = 1, 1, [], 0
        options.effects, options.sizes, options.noises = ["stiffness"], [1.0], ["50 ms"]
    from .cases import Settings, cases, method_digest, peers_digest
    from .pool import finished, run_all

    settings = Settings(method=method_digest())
    listed = cases(
        nulls=options.nulls,
        per_effect=options.per_effect,
        sizes=options.sizes,
        peers=options.peers,
        settings=settings,
        effects=options.effects,
        outside=options.outside,
        noises=options.noises,
        outside_each=options.outside_each,
    )
    path = options.out / "results.jsonl"
    if not options.page_only:
        run_all(listed, path, workers=options.workers, minutes=options.minutes)
    if not options.no_page:
        from .page import write

        # Everything this version of the method has finished, also what other options asked for.
        ends = (f"luztar {settings.method}", f"peers {peers_digest()}")
        mine = [r for r in finished(path).values() if r["key"].endswith(ends)]
        write(mine, settings, options.docs)
        sys.stderr.write(f"{len(mine)} cases on {options.docs / 'validation.md'}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
