"""The page docs/validation.md: what was promised, what came out, with the number of cases beside every rate."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from .cases import ALSO_RIGHT, EFFECTS, NOISES, OUTSIDE, Settings, typical
from .markdown import table
from .tables import intervals, naming, nothing_hidden, outside, peers
from .tally import ALIKE, Rate, Record, coverage, distinct, of_kind, rate


def write(records: Sequence[Record], settings: Settings, folder: Path) -> None:
    """Write validation.md and its pictures into a folder."""
    try:
        from .pictures import draw
    except ImportError:
        pictures: list[str] = []
    else:
        pictures = draw(records, folder / "pictures")
    folder.mkdir(parents=True, exist_ok=True)
    parts = [
        _head(records, settings),
        _targets(records),
        _picture(pictures, "calibration_names.png", "Names by effect and size"),
        naming(records),
        outside(records),
        _picture(pictures, "calibration_nothing_hidden.png", "Nothing hidden: p-values and kinds of test"),
        nothing_hidden(records),
        _picture(pictures, "calibration_intervals.png", "Coverage of the intervals"),
        intervals(records),
        peers(records),
        _sizes(),
        _failed(records),
    ]
    (folder / "validation.md").write_text("\n\n".join(p for p in parts if p) + "\n", encoding="utf-8")


def _head(records: Sequence[Record], s: Settings) -> str:
    counts = Counter(r["kind"] for r in records if not r["peers"])
    return f"""# How often it is right

Effects of known size are hidden in simulated records of a hand-turned rig, and `luztar.study` is asked what is
missing. The generator (`tests/generators`) shares no code with the engine: true motion, one friction contact, encoder
of 0.02 degrees, white noise of 0.05 Nm, hum, and a slow wander of {s.wander_nm:g} Nm with a time constant of 50 ms or
0.5 s, or none ("white"). Every case has its own rig, hand and noise; sizes lie within a factor of 1.25 around the
[table](#typical-sizes), times the size factor. {s.runs} runs of {s.strokes} strokes each, at 500 Hz.

This page is written by `python -m benches.hidden_effects` (matplotlib, lmfit and pysindy
are needed for pictures and peers only). It can be stopped and goes on where it was. Cases on this page:
{counts["null"]} with nothing hidden, {counts["effect"]} with an effect of the catalogue, {counts["outside"]} with one
outside it, all with one version of the method (`{s.method}`). Brackets hold Wilson's 95 % interval."""


def _targets(records: Sequence[Record]) -> str:
    rows = []

    def row(what: str, target: str, found: Rate, low: float, high: float) -> None:
        if not found.tries:
            met = "—"
        else:
            below, above = found.interval
            inside = low <= found.share <= high
            sure = (
                (low <= below or low == 0.0) and (above <= high or high == 1.0)
                if inside
                else (above < low or below > high)
            )
            met = ("yes" if inside else "no") if sure else ("open, so far yes" if inside else "open, so far no")
        rows.append((what, target, found, met))

    null = of_kind(records, "null")
    row("nothing hidden, an effect is named", "at most 1 %", rate(null, lambda r: r["named"]), 0.0, 0.01)
    for noise in NOISES:
        here = [r for r in null if r["noise"] == noise]
        found = rate(here, lambda r: r["said_missing"])
        row(f"nothing hidden, something is called missing, {noise}", "3–7 %", found, 0.03, 0.07)
    small = [r for r in of_kind(records, "effect") if r["size"] == 0.3]
    clear = [r for r in small if distinct(r)]
    row(f"size 0.3, rivals' cosine below {ALIKE:g}: exact name", "at least 95 %", rate(clear, _exact), 0.95, 1.0)
    alike = [r for r in small if not distinct(r)]
    row("size 0.3, elsewhere: truth in a set of at most 3", "at least 95 %", rate(alike, _in_set), 0.95, 1.0)
    beyond = rate(of_kind(records, "outside"), lambda r: r["verdict"] == "unexplained")
    row("outside the catalogue: unexplained", "at least 95 %", beyond, 0.95, 1.0)
    every = [found for found, _ in coverage([r for r in records if not r["peers"]]).values()]
    held = Rate(sum(f.hits for f in every), sum(f.tries for f in every))
    row("95 % intervals hold the truth (all parameters)", "93–97 %", held, 0.93, 0.97)
    return "## Targets\n\n" + table(("What", "Target", "Found", "Met"), rows)


def _exact(r: Record) -> bool:
    return bool(r["exact"])


def _in_set(r: Record) -> bool:
    return bool(r["in_set"])


def _picture(made: Sequence[str], name: str, text: str) -> str:
    return f"![{text}](pictures/{name})" if name in made else ""


def _sizes() -> str:
    rows = []
    for name in (*EFFECTS, *OUTSIDE):
        t = (typical.RIG | typical.RIG_OUTSIDE)[name]
        sized = ", ".join(f"{k} {'±' if t.either_sign else ''}{v:g}" for k, v in t.sized.items())
        rest = [f"{k} {v:g}" for k, v in t.inner.items()]
        rest += [f"{k} {low:.3g} to {high:.3g}" for k, (low, high) in t.uniform.items()]
        rest += [f"{k} {' or '.join(map(str, v)) if isinstance(v, tuple) else v}" for k, v in t.fixed.items()]
        rows.append((name, sized, ", ".join(rest)))
    also = "; ".join(f"{k}: also {', '.join(v)}" for k, v in ALSO_RIGHT.items())
    return (
        "## Typical sizes\n\nSize factor 1. What is sized grows with the factor, the rest says where, how fast or how "
        "wide. Below the line of the catalogue (from torque_step on) nothing has a name.\n\n"
        + table(("Effect", "Sized", "The rest"), rows, text=True)
        + f"\n\nCounted as right too: {also}. `offset` and `asymmetric_coulomb` are looked for from a model without an "
        "offset. Stiction and dwell are recorded with slow break-aways and dwells of different length, without which "
        "they do not show."
    )


def _failed(records: Sequence[Record]) -> str:
    failed = [r for r in records if "failed" in r]
    if not failed:
        return ""
    rows = Counter(f"{r['effect']}: {r['failed']}" for r in failed)
    return "## Cases that stopped with an error\n\n" + "\n".join(f"- {n} × {what}" for what, n in rows.most_common())
